"use strict";
// Diagrams over time with a common zoom: histories and modal amplitudes. Drawn by dygraphs.

const NUM_HISTORIES = 4;
const PIXELS_PER_LABEL = 50;  // of time: two marks on the smallest telephone, room for 59.995
const linked = [];  // diagrams over time: {graph, cursor}
const charts = [];  // functions that draw everything anew, for another colour scheme
let zoomed = null;  // [from, to] s, null for the whole run
let following = false;

/** Histories [{t, v}] of unequal times → rows [time, value or null, …] for dygraphs. */
function mergeRows(series, factors) {
  const places = series.map(() => 0);
  const rows = [];
  for (;;) {
    let time = Infinity;
    series.forEach((one, k) => { if (places[k] < one.t.length) time = Math.min(time, one.t[places[k]]); });
    if (time === Infinity) return rows;
    const row = [time];
    series.forEach((one, k) => {
      const here = places[k] < one.t.length && one.t[places[k]] === time;
      row.push(here ? factors[k] * one.v[places[k]++] : null);
    });
    rows.push(row);
  }
}

/** One finger scrolls the page; two move and stretch the diagram. */
function touchModel() {
  const usual = Dygraph.defaultInteractionModel;
  const model = {...usual};
  model.touchstart = (event, graph, context) => {
    context.isTwoFingers = event.touches.length > 1;
    if (context.isTwoFingers) usual.touchstart(event, graph, context);
  };
  for (const name of ["touchmove", "touchend"]) {
    model[name] = (event, graph, context) => { if (context.isTwoFingers) usual[name](event, graph, context); };
  }
  return model;
}

function formatLegend(legend) {
  return (info) => {
    legend.replaceChildren();
    for (const one of info.series) {
      if (!one.isVisible) continue;
      const entry = element("span", {class: "entry"}, element("span", {class: "key", style: `--c:${one.color}`}));
      entry.append(one.label + (info.x === undefined || one.y === undefined || one.y === null ? "" : `: ${format(one.y)}`));
      legend.append(entry);
    }
    if (info.x !== undefined && info.xHTML) legend.prepend(element("span", {class: "entry"}, info.xHTML));
    return "";
  };
}

/** A frame for a diagram: head with a place for a menu and the legend, plot, time cursor. */
function makeFigure(parent, tall) {
  const legend = element("div", {class: "legend"});
  const head = element("div", {class: "chart-head"}, legend);
  const plot = element("div", {class: tall ? "plot tall" : "plot", role: "img"});
  const cursor = element("div", {class: "cursor"});
  const figure = element("figure", {class: "chart"}, head, element("div", {class: "plot-box"}, plot, cursor));
  parent.append(figure);
  return {figure, head, legend, plot, cursor};
}

function commonOptions(legend) {
  return {
    legend: "always", labelsDiv: element("div"), legendFormatter: formatLegend(legend), connectSeparatedPoints: true,
    strokeWidth: 1.5, highlightCircleSize: 3, animatedZooms: false, gridLineColor: style("--grid"), gridLineWidth: 1,
    axisLineColor: style("--line"), interactionModel: touchModel(), rightGap: 12, xLabelHeight: 16, yLabelWidth: 18,
    axisLabelFontSize: 12, labelsKMB: false,
  };
}

/** Removes a diagram's graph. While the next one is made, nothing may ask the destroyed one. */
function removeGraph(chart) {
  if (chart.graph) chart.graph.destroy();
  chart.graph = null;
}

/** A diagram over time that zooms with the others. rows: for dygraphs; labels: of the columns after the time. */
function drawLinked(chart, rows, labels, colours, unit, name) {
  removeGraph(chart);
  chart.plot.setAttribute("aria-label", `${name} over time, ${labels.join(" and ")}; drag to zoom, double click for the whole run`);
  chart.graph = new Dygraph(chart.plot, rows, {
    ...commonOptions(chart.legend), labels: ["time", ...labels], colors: colours, ylabel: unit, xlabel: "time, s",
    dateWindow: zoomed, includeZero: false,
    axes: {
      x: {valueFormatter: (value) => `${value.toFixed(3)} s`, axisLabelFormatter: formatTick, pixelsPerLabel: PIXELS_PER_LABEL},
      y: {axisLabelWidth: 54, axisLabelFormatter: formatTick, valueFormatter: (value) => format(value)},
    },
    drawCallback: (graph, isFirst) => { if (!isFirst) follow(graph); placeCursor(chart); },
    clickCallback: (event, time) => clock.set(time),
  });
  placeCursor(chart);
}

/** Gives the other diagrams the span of time that this one shows. */
function follow(graph) {
  if (following) return;
  const [from, to] = graph.xAxisRange();
  if (zoomed && Math.abs(zoomed[0] - from) < 1e-9 && Math.abs(zoomed[1] - to) < 1e-9) return;
  setZoom([from, to], graph);
}

function setZoom(span, source = null) {
  const whole = clock.last - clock.first;
  let [from, to] = span || [clock.first, clock.last];
  const length = Math.min(Math.max(to - from, whole * 1e-4), whole);
  from = Math.min(Math.max(from, clock.first), clock.last - length);
  to = from + length;
  zoomed = length > whole * 0.9999 ? [clock.first, clock.last] : [from, to];
  following = true;
  for (const chart of linked) if (chart.graph && chart.graph !== source) chart.graph.updateOptions({dateWindow: zoomed});
  following = false;
  byId("zoom-value").textContent = `${zoomed[0].toFixed(3)} s to ${zoomed[1].toFixed(3)} s`;
  for (const chart of linked) if (chart.onZoom) chart.onZoom();
}

function placeCursor(chart) {
  if (!chart.graph) return;
  const [from, to] = chart.graph.xAxisRange();
  const inside = clock.time >= from && clock.time <= to;
  chart.cursor.style.display = inside ? "block" : "none";
  if (inside) chart.cursor.style.left = `${chart.graph.toDomXCoord(clock.time)}px`;
}

/** All quantities that some run has, in the order of the runs' own lists. */
function listChannels() {
  const found = new Map();
  for (const run of data.runs) {
    for (const one of run.channels) if (!found.has(`${one.group}: ${one.name}`)) found.set(`${one.group}: ${one.name}`, one);
  }
  const groups = [...new Set([...found.values()].map((one) => one.group))];
  return [...found.entries()].sort((a, b) => groups.indexOf(a[1].group) - groups.indexOf(b[1].group))
    .map(([value, one]) => ({value, label: one.name, group: one.group}));
}

const unpacked = new Map();
/** A packed history's numbers; kept. */
function unpack(packed) {
  if (!unpacked.has(packed)) unpacked.set(packed, {t: decode(packed.t), v: decode(packed.v)});
  return unpacked.get(packed);
}

function drawHistory(chart, key) {
  const series = [], labels = [], colours = [];
  let first = null;
  data.runs.forEach((run, index) => {
    const packed = run.channels.find((one) => `${one.group}: ${one.name}` === key);
    if (!packed) return;
    first = first || packed;
    series.push(unpack(packed));
    labels.push(run.label);
    colours.push(colourOf(index));
  });
  let peak = 0;
  for (const one of series) for (const value of one.v) peak = Math.max(peak, Math.abs(value));
  const {unit, factor} = readable(first.unit, peak);
  drawLinked(chart, mergeRows(series, series.map(() => factor)), labels, colours, unit, first.name);
}

function makeHistories() {
  const channels = listChannels();
  const byPattern = (pattern, used) => channels.find((one) => pattern.test(one.value) && !used.includes(one.value));
  const wanted = [/^Asked for/, /displacement$|position$/, /acceleration$/, /^Deflection: .*body frame/, /force$/, /./, /./];
  const chosen = [];
  for (const pattern of wanted) {
    const found = byPattern(pattern, chosen);
    if (found && chosen.length < NUM_HISTORIES) chosen.push(found.value);
  }
  chosen.forEach((key, number) => {
    const chart = makeFigure(byId("history-charts"), false);
    const select = element("select", {id: `history-${number + 1}`});
    fillSelect(select, channels);
    select.value = key;
    chart.head.prepend(element("label", {}, element("span", {}, `Diagram ${number + 1}`), select));
    select.addEventListener("change", () => drawHistory(chart, select.value));
    linked.push(chart);
    charts.push(() => drawHistory(chart, select.value));
    drawHistory(chart, key);
  });
}

function drawActive(found) {
  const canvas = byId("active-strip");
  const switching = found.modes.filter((mode) => decode(mode.switches).length > 0 || !mode.active);
  canvas.hidden = switching.length === 0;
  if (canvas.hidden) return;
  const {context, width} = prepareCanvas(canvas, 14 * found.modes.length + 4);
  const left = 76, [from, to] = zoomed || [clock.first, clock.last];
  const at = (time) => left + (width - left - 12) * Math.min(Math.max((time - from) / (to - from), 0), 1);
  context.font = "11px system-ui, sans-serif";
  context.textBaseline = "middle";
  found.modes.forEach((mode, row) => {
    const y = 14 * row + 8;
    context.fillStyle = style("--soft");
    context.fillText(`mode ${mode.number}`, 4, y);
    const edges = [clock.first, ...decode(mode.switches), clock.last];
    for (let k = 0; k + 1 < edges.length; ++k) {
      const active = (k % 2 === 0) === mode.active;
      context.fillStyle = active ? colourOf(row) : style("--grid");
      context.fillRect(at(edges[k]), y - (active ? 4 : 1), at(edges[k + 1]) - at(edges[k]), active ? 8 : 2);
    }
  });
}

function makeModes() {
  const options = data.runs.flatMap((run, index) =>
    run.modes.map((found, place) => ({value: `${index} ${place}`, label: `${found.body}, ${run.label}`})));
  if (!options.length) {
    byId("modes-body").replaceChildren(element("p", {}, "All bodies are rigid in these runs."));
    return;
  }
  const select = byId("mode-body");
  fillSelect(select, options);
  const chart = makeFigure(byId("mode-chart"), false);
  const draw = () => {
    const [index, place] = select.value.split(" ").map(Number);
    const found = data.runs[index].modes[place];
    const series = found.modes.map(unpack);
    let peak = 0;
    for (const one of series) for (const value of one.v) peak = Math.max(peak, Math.abs(value));
    const {unit, factor} = readable("m", peak);
    drawLinked(chart, mergeRows(series, series.map(() => factor)), found.modes.map((mode) => `mode ${mode.number}`),
      found.modes.map((mode, row) => colourOf(row)), unit, `Modal amplitudes of ${found.body}`);
    chart.onZoom = () => drawActive(found);
    drawActive(found);
    const always = found.modes.every((mode) => mode.active && decode(mode.switches).length === 0);
    byId("mode-note").textContent = "An amplitude is drawn as the largest displacement that the mode alone gives along the body. " +
      (found.total > found.modes.length ? `The ${found.modes.length} largest of ${found.total} modes. ` : "") +
      (always ? "All of them take part throughout the run." : "Below: when each mode takes part.");
  };
  select.addEventListener("change", draw);
  linked.push(chart);
  charts.push(draw);
  draw();
}

function zoomBy(action) {
  const [from, to] = zoomed || [clock.first, clock.last];
  const length = to - from, middle = from <= clock.time && clock.time <= to ? clock.time : 0.5 * (from + to);
  if (action === "in") setZoom([middle - (middle - from) / 2, middle + (to - middle) / 2]);
  if (action === "out") setZoom([from - length / 2, to + length / 2]);
  if (action === "left") setZoom([from - length / 2, to - length / 2]);
  if (action === "right") setZoom([from + length / 2, to + length / 2]);
  if (action === "all") setZoom(null);
}

function makeCharts() {
  makeHistories();
  makeSpectra();
  makeModes();
  for (const button of document.querySelectorAll("[data-zoom]")) button.addEventListener("click", () => zoomBy(button.dataset.zoom));
  clock.listeners.push(() => linked.forEach(placeCursor));
  setZoom(null);
  const samples = [...new Set(data.runs.map((run) => run.samples))].join(", ");
  byId("history-note").textContent = `Drag in a diagram to zoom all of them, shift-drag to move, double click for the whole run, click to set ` +
    `the animation's time; on a touch screen two fingers move and stretch. Histories of ${samples} samples are drawn by at most ${data.most}, with the least and greatest of each ` +
    `span of time; all numbers on this page are of all samples.`;
}
