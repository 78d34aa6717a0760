"use strict";
// How much each mode of a flexible body takes part, and when.

function drawActive(found) {
  const canvas = byId("active-strip");
  const switching = found.modes.filter((mode) => decode(mode.switches).length > 0 || !mode.active);
  canvas.hidden = switching.length === 0;
  if (canvas.hidden) return;
  const {context, width} = prepareCanvas(canvas, 14 * found.modes.length + 4);
  context.font = "11px system-ui, sans-serif";
  const left = 12 + Math.max(...found.modes.map((mode) => context.measureText(mode.name).width)), [from, to] = zoomed || [clock.first, clock.last];
  const at = (time) => left + (width - left - 12) * Math.min(Math.max((time - from) / (to - from), 0), 1);
  context.textBaseline = "middle";
  found.modes.forEach((mode, row) => {
    const y = 14 * row + 8;
    context.fillStyle = style("--soft");
    context.fillText(mode.name, 4, y);
    const edges = [clock.first, ...decode(mode.switches), clock.last];
    for (let k = 0; k + 1 < edges.length; ++k) {
      const active = (k % 2 === 0) === mode.active;
      context.fillStyle = active ? colourOf(row) : style("--grid");
      context.fillRect(at(edges[k]), y - (active ? 4 : 1), at(edges[k + 1]) - at(edges[k]), active ? 8 : 2);
    }
  });
}

/** A mode with the frequency of its body, another vector without one. */
const nameMode = ({name, frequency}) => (frequency === null ? name : `${name}, ${format(frequency, 3)} Hz`);

function makeModeAmplitudes() {
  const options = data.runs.flatMap((run, index) =>
    run.modes.map((found, place) => ({value: `${index} ${place}`, label: `${found.body}, ${run.label}: ${found.total}`})));
  byId("modes").hidden = !options.length && !warningsOf("modes").length;
  byId("modes-body").hidden = !options.length;
  if (!options.length) return;
  const select = byId("mode-body");
  fillSelect(select, options);
  const chart = makeFigure(byId("mode-chart"), "mode-amplitudes", false);
  const draw = () => {
    const [index, place] = select.value.split(" ").map(Number);
    const found = data.runs[index].modes[place];
    const series = found.modes.map(unpack);
    let peak = 0;
    for (const one of series) for (const value of one.v) peak = Math.max(peak, Math.abs(value));
    const {unit, factor} = readable("m", peak);
    drawLinked(chart, mergeRows(series, series.map(() => factor)), found.modes.map(nameMode),
      found.modes.map((mode, row) => colourOf(row)), unit, `Modal amplitudes of ${found.body}`);
    chart.onZoom = () => drawActive(found);
    drawActive(found);
    const always = found.modes.every((mode) => mode.active && decode(mode.switches).length === 0);
    byId("mode-note").textContent = "An amplitude is drawn as the largest displacement that the mode alone gives along the body. " +
      (found.left ? `Drawn are the ${found.modes.length} largest of ${found.modes.length + found.left}. ` : "") +
      (found.others ? "Vectors that are no modes of the body alone have no frequency: a residual one is its response to loads. " : "") +
      (always ? "All of them take part throughout the run." : "Below: when each mode takes part.");
  };
  select.addEventListener("change", draw);
  linked.push(chart);
  redraws.push(draw);
  draw();
}
