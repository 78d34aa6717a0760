"use strict";
// Diagrams, drawn by dygraphs; those over time have a common zoom.

const PIXELS_PER_LABEL = 50;  // of time: two marks on the smallest telephone, room for 59.995
const linked = [];  // diagrams over time: {graph, cursor}
const redraws = [];  // functions that draw something anew, for another colour scheme
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

/** The runs' names beside their colours, and under the mouse the values with their unit. */
function formatLegend(legend, unit) {
  return (info) => {
    legend.replaceChildren();
    for (const one of info.series) {
      if (!one.isVisible) continue;
      const entry = element("span", {class: "entry"}, element("span", {class: "key", style: `--c:${one.color}`}));
      const known = info.x !== undefined && one.y !== undefined && one.y !== null;
      entry.append(one.label + (known ? `: ${format(one.y)} ${unit}` : ""));
      legend.append(entry);
    }
    if (info.x !== undefined && info.xHTML) legend.prepend(element("span", {class: "entry"}, info.xHTML));
    return "";
  };
}

/** A frame for a diagram: head with a place for a menu and the legend, buttons that save it, plot, time cursor. */
function makeFigure(parent, name, tall) {
  const legend = element("div", {class: "legend"});
  const head = element("div", {class: "chart-head"}, legend);
  const plot = element("div", {class: tall ? "plot tall" : "plot", role: "img"});
  const cursor = element("div", {class: "cursor"});
  const figure = element("figure", {class: "chart"}, head, element("div", {class: "plot-box"}, plot, cursor));
  parent.append(figure);
  const chart = {name, figure, head, legend, plot, cursor, graph: null, unit: "", named: () => chart.graph.getLabels().length - 1};
  head.append(makeSaveButtons(name, () => writeGraphCsv(chart), () => drawGraphPicture(chart)));
  return chart;
}

/** Removes a diagram's graph. While the next one is made, nothing may ask the destroyed one. */
function removeGraph(chart) {
  if (chart.graph) chart.graph.destroy();
  chart.graph = null;
}

function commonOptions(legend, unit) {
  return {
    legend: "always", labelsDiv: element("div"), legendFormatter: formatLegend(legend, unit), connectSeparatedPoints: true,
    strokeWidth: 1.5, highlightCircleSize: 3, animatedZooms: false, gridLineColor: style("--grid"), gridLineWidth: 1,
    axisLineColor: style("--line"), interactionModel: touchModel(), rightGap: 12, xLabelHeight: 16, yLabelWidth: 18,
    axisLabelFontSize: 12, labelsKMB: false,
  };
}

/** A diagram over time that zooms with the others. rows: for dygraphs; labels: of the columns after the time. */
function drawLinked(chart, rows, labels, colours, unit, name) {
  removeGraph(chart);
  chart.unit = unit;
  chart.plot.setAttribute("aria-label", `${name} over time, ${labels.join(" and ")}; drag to zoom, double click for the whole run`);
  chart.graph = new Dygraph(chart.plot, rows, {
    ...commonOptions(chart.legend, unit), labels: ["time, s", ...labels], colors: colours, ylabel: unit, xlabel: "time, s",
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

const unpacked = new Map();
/** A packed history's numbers; kept. */
function unpack(packed) {
  if (!unpacked.has(packed)) unpacked.set(packed, {t: decode(packed.t), v: decode(packed.v)});
  return unpacked.get(packed);
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

function makeZoom() {
  for (const button of document.querySelectorAll("[data-zoom]")) button.addEventListener("click", () => zoomBy(button.dataset.zoom));
  clock.listeners.push(() => linked.forEach(placeCursor));
  setZoom(null);
}
