"use strict";
// The ride: how the driver's vibration is judged, third-octave bands, suspensions, tyres.

const MEASURES = [
  ["fore_aft", "fore and aft, weighted r.m.s. (Wd)", "m/s^2"], ["vertical", "vertical, weighted r.m.s. (Wk)", "m/s^2"],
  ["pitch", "pitch, weighted r.m.s. (We)", "rad/s^2"], ["total", "total of all three", "m/s^2"], ["words", "people's likely reaction", ""],
  ["mtvv", "vertical, largest r.m.s. of 1 s (MTVV)", "m/s^2"], ["dose", "vertical, vibration dose value (VDV)", "m/s^1.75"],
  ["crest", "vertical, crest factor", "1"], ["power", "absorbed power (6 W is borne for long)", "W"]];
const TRAVEL = [
  ["compression", "compression from equilibrium, largest", "m"], ["rebound", "rebound from equilibrium, largest", "m"],
  ["share", "compression over the way to the stop", "%"], ["hits", "stop struck", "times"], ["stopped", "on the stop", "s"],
  ["rebound_hits", "rebound stop struck", "times"], ["rebound_stopped", "on the rebound stop", "s"]];
const TYRE = [
  ["static", "static load", "N"], ["dynamic_rms", "load variation, r.m.s.", "N"], ["variation", "load variation over static load", "1"],
  ["greatest", "greatest load", "N"], ["off_ground", "off the ground", "s"], ["unloaded", "without load", "s"]];

/** Adds what the tables show and the data lack. */
function completeRide(kind, one) {
  if (kind === "travel") {
    const share = one.compression !== null && one.whole !== null && one.whole > 0 ? 100 * one.compression / one.whole : null;
    return {...one, share};
  }
  if (kind === "tyres") return {...one, variation: one.static ? one.dynamic_rms / one.static : null};
  return one;
}

/** Rows of all runs: [{of, name, unit, values: [one a run, or null]}]. kind: points, travel or tyres. */
function collectRide(kind, measures) {
  const names = [...new Set(data.runs.flatMap((run) => (run.ride ? run.ride[kind].map((one) => one.name) : [])))];
  return names.flatMap((of) => {
    const found = data.runs.map((run) => run.ride && run.ride[kind].find((one) => one.name === of)).map((one) => one && completeRide(kind, one));
    return measures.map(([key, name, unit]) => ({of, name, unit, values: found.map((one) => (one ? one[key] ?? null : null))}))
      .filter((row) => row.values.some((value) => value !== null));
  });
}

function fillRide() {
  byId("ride").hidden = !data.runs.some((run) => run.ride);
  if (byId("ride").hidden) return;
  fillStatistics(byId("ride-table"), [...collectRide("points", MEASURES), ...collectRide("travel", TRAVEL), ...collectRide("tyres", TYRE)]);
  const problems = data.runs.filter((run) => run.ride && run.ride.problem).map((run) => `${run.label}: ${run.ride.problem}`);
  const remarks = data.runs.flatMap((run) => (run.ride ? run.ride.remarks.map((one) => `${run.label}: ${one}`) : []));
  byId("ride-problem").textContent = [problems.length ? `The vibration is not judged. ${problems.join("; ")}` : "", remarks.join("; ")].filter(Boolean).join(" ");
  byId("ride-problem").hidden = !problems.length && !remarks.length;
  const seats = data.runs.some((run) => run.ride && run.ride.points.some((one) => one.name.endsWith(".seat")));
  byId("ride-note").textContent = (seats ? "" : "No point is called seat: the points of the summary are judged. ") + `Over ${describeSpans()} ISO 2631-1 judges vibration by weighted accelerations, Wk, Wd and ` +
    "We. Above a crest factor of 9, with shocks, the r.m.s. values say too little: look at MTVV and VDV. The total adds the squares, " +
    "the pitch with 0.4 m/rad. Travel counts from equilibrium, of one member; loads are those of all members together.";
}

/** The r.m.s. by third-octave bands, with the boundaries of reduced comfort. */
function makeBands() {
  const points = [...new Set(data.runs.flatMap((run) => (run.ride ? run.ride.points.map((one) => one.name) : [])))];
  byId("bands").hidden = !points.length;
  if (!points.length) return;
  const select = byId("bands-point"), chart = makeFigure(byId("bands-chart"), "bands-diagram", true);
  fillSelect(select, points.map((value) => ({value, label: value})));
  const {centres, curves} = data.boundaries, exposures = Object.keys(curves);
  const draw = () => {
    const labels = [], colours = [], series = {}, columns = [];
    data.runs.forEach((run, index) => {
      const found = run.ride && run.ride.points.find((one) => one.name === select.value);
      if (!found) return;
      labels.push(run.label);
      colours.push(colourOf(index));
      columns.push(found.bands.map((value) => (value === null ? null : Math.max(value, 1e-6))));
      series[run.label] = {drawPoints: true, pointSize: 2.5};
    });
    for (const exposure of exposures) {
      const label = `reduced comfort after ${exposure}`;
      labels.push(label);
      colours.push(style("--soft"));
      columns.push(curves[exposure]);
      series[label] = {strokePattern: [4, 3], strokeWidth: 1};
    }
    const peak = Math.max(...columns.flat());
    removeGraph(chart);
    chart.unit = "m/s²";
    chart.named = () => labels.length - exposures.length;
    chart.plot.setAttribute("aria-label", `Vertical acceleration of ${select.value} by third-octave bands, ${labels.join(" and ")}`);
    chart.graph = new Dygraph(chart.plot, centres.map((f, k) => [f, ...columns.map((column) => column[k])]), {
      ...commonOptions(chart.legend, "m/s²"), rightGap: 44, labels: ["frequency, Hz", ...labels], colors: colours, xlabel: "band, Hz", ylabel: "r.m.s., m/s²", series,
      legendFormatter: formatBands(chart.legend, exposures.length),
      drawCallback: (graph) => nameBoundaries(graph, chart.plot, exposures),
      axes: {
        x: {logscale: true, valueFormatter: (value) => `${format(value)} Hz`, ticker: markDecades([1, 2, 5], formatTick)},
        y: {logscale: true, axisLabelWidth: 54, ticker: markDecades([1], formatTick), valueFormatter: (value) => format(value),
          valueRange: [0.006, 2 * peak]},  // below the lowest mark, whose number would meet those of the other axis
      },
    });
  };
  select.addEventListener("change", draw);
  redraws.push(draw);
  draw();
}

/** The legend names the runs; the boundaries are named where their lines end. */
const formatBands = (legend, boundaries) => (info) =>
  formatLegend(legend, "m/s²")({...info, series: info.series.slice(0, info.series.length - boundaries)});

function nameBoundaries(graph, plot, exposures) {
  const {curves} = data.boundaries, area = graph.getArea(), left = area.x + area.w + 4;
  for (const name of plot.querySelectorAll(".boundary")) name.remove();
  for (const exposure of exposures) {
    const style = `left: ${left}px; top: ${graph.toDomYCoord(curves[exposure].at(-1))}px`;
    plot.append(element("div", {class: "dygraph-axis-label boundary", style}, exposure));
  }
}

/** A text on the card's colour, so that no grid line runs through it. */
function drawPlate(context, text, x, y, colour) {
  const width = context.measureText(text).width;
  context.fillStyle = style("--card");
  context.fillRect(x - 2, y - 7, width + 4, 14);
  context.fillStyle = colour;
  context.fillText(text, x, y);
  return width;
}
