"use strict";
// Bending moment, shear and stresses along a flexible body at the animation's time, within their envelope over the run.

const LOADS_HEIGHT = 200, LOADS_LEFT = 62, LOADS_RIGHT = 14, LOADS_TOP = 26, LOADS_BOTTOM = 34;  // px
const loads = {all: [], shown: null, canvases: []};

function prepareLoads() {
  data.runs.forEach((run, index) => run.loads.forEach((found) => {
    const t = decode(found.t);
    const quantities = found.quantities.map((one) => ({...one, s: decode(one.s), v: decode(one.v), low: decode(one.low), high: decode(one.high)}));
    loads.all.push({...found, index, label: `${found.body}, ${run.label}`, t, quantities});
  }));
}

/** A load's values at all stations at a time, between the stored ones. */
function loadAt(found, quantity, time) {
  const {t} = found, n = quantity.s.length;
  let k = 0;
  while (k < t.length - 2 && t[k + 1] <= time) ++k;
  const share = t.length > 1 ? Math.min(Math.max((time - t[k]) / (t[k + 1] - t[k]), 0), 1) : 0;
  const next = Math.min(k + 1, t.length - 1);
  return Array.from({length: n}, (_, i) => quantity.v[k * n + i] + share * (quantity.v[next * n + i] - quantity.v[k * n + i]));
}

/** Where a load's values are in its diagram, px. */
function scaleLoad(quantity, width) {
  const s0 = Math.min(...quantity.s), s1 = Math.max(...quantity.s);
  let low = Math.min(0, ...quantity.low), high = Math.max(0, ...quantity.high);
  if (high - low < 1e-9) high = low + 1;
  const room = 0.08 * (high - low);
  low -= room;
  high += room;
  return {
    s0, s1, low, high, width,
    X: (s) => LOADS_LEFT + (width - LOADS_LEFT - LOADS_RIGHT) * (s - s0) / (s1 - s0 || 1),
    Y: (v) => LOADS_TOP + (LOADS_HEIGHT - LOADS_TOP - LOADS_BOTTOM) * (high - v) / (high - low),
  };
}

/** Round values for an axis, at most as many; more where these were fewer than three, from which no scale can be read. */
function markEvenly(low, high, most) {
  const rough = (high - low) / Math.max(most, 1), power = 10 ** Math.floor(Math.log10(rough));
  const steps = [0.5, 1, 2, 5, 10].map((digit) => digit * power), least = steps.findIndex((one) => one >= rough);
  const mark = (step) => {
    const first = Math.ceil(low / step - 1e-12), count = Math.floor(high / step + 1e-12) - first + 1;
    return Array.from({length: count}, (_, k) => (first + k) * step);
  };
  const marks = mark(steps[least]);
  return marks.length < 3 && least > 0 ? mark(steps[least - 1]) : marks;
}

function drawLoadAxes(context, scale, unit, factor, name, axis) {
  context.font = "12px system-ui, sans-serif";
  context.lineWidth = 1;
  context.textBaseline = "middle";
  for (const value of markEvenly(factor * scale.low, factor * scale.high, 5)) {
    const y = scale.Y(value / factor);
    context.strokeStyle = value === 0 ? style("--soft") : style("--grid");
    drawStroke(context, [[LOADS_LEFT, y], [scale.width - LOADS_RIGHT, y]]);
    context.fillStyle = style("--soft");
    context.textAlign = "right";
    context.fillText(formatTick(value), LOADS_LEFT - 6, y);
  }
  context.textAlign = "center";
  for (const s of markEvenly(scale.s0, scale.s1, (scale.width - LOADS_LEFT) / 70)) {
    context.fillText(formatTick(s), scale.X(s), LOADS_HEIGHT - LOADS_BOTTOM + 10);
  }
  context.fillText(axis, 0.5 * (LOADS_LEFT + scale.width), LOADS_HEIGHT - 8);
  context.textAlign = "left";
  context.fillStyle = style("--ink");
  context.fillText(`${name}, ${unit}`, LOADS_LEFT, 10);
}

function drawStroke(context, points) {
  context.beginPath();
  points.forEach(([x, y], k) => (k ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.stroke();
}

function drawLoad(canvas, found, quantity) {
  const {context, width} = prepareCanvas(canvas, LOADS_HEIGHT), scale = scaleLoad(quantity, width);
  const {unit, factor} = readable(quantity.unit, Math.max(...quantity.high.map(Math.abs), ...quantity.low.map(Math.abs)));
  const colour = colourOf(found.index), at = (values) => Array.from(quantity.s, (s, k) => [scale.X(s), scale.Y(values[k])]);
  context.beginPath();
  [...at(quantity.high), ...at(quantity.low).reverse()].forEach(([x, y], k) => (k ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.closePath();
  context.fillStyle = style("--envelope");
  context.fill();
  drawLoadAxes(context, scale, unit, factor, quantity.name, found.axis);
  context.strokeStyle = colour;
  context.lineWidth = 2;
  const now = loadAt(found, quantity, clock.time);
  drawStroke(context, at(now));
  for (const extreme of quantity.extremes) {
    context.beginPath();
    context.arc(scale.X(extreme.place), scale.Y(extreme.value), 4, 0, 2 * Math.PI);
    context.fillStyle = style("--bad");
    context.fill();
  }
  canvas.setAttribute("aria-label", `${quantity.name} along ${found.body} at ${clock.time.toFixed(3)} s, within its envelope over the run`);
  return now;
}

function drawLoads() {
  loads.canvases.forEach((canvas, k) => {
    const quantity = loads.shown && loads.shown.quantities[k];
    canvas.hidden = !quantity;
    if (quantity) drawLoad(canvas, loads.shown, quantity);
  });
}

/** A canvas for each quantity of the body that has most. */
function makeLoadCanvases() {
  const number = Math.max(...loads.all.map((one) => one.quantities.length));
  loads.canvases = Array.from({length: number}, (_, k) => element("canvas", {id: `load-${k + 1}`, role: "img"}));
  loads.canvases.forEach((canvas, k) => canvas.addEventListener("mousemove", (event) => tellLoad(event, loads.shown.quantities[k])));
  byId("load-diagrams").replaceChildren(...loads.canvases);
}

/** What stands under the mouse: place, value at the time, and the envelope there. */
function tellLoad(event, quantity) {
  const box = event.currentTarget.getBoundingClientRect(), scale = scaleLoad(quantity, box.width), x = event.clientX - box.x;
  let nearest = 0;
  quantity.s.forEach((s, k) => { if (Math.abs(scale.X(s) - x) < Math.abs(scale.X(quantity.s[nearest]) - x)) nearest = k; });
  const now = loadAt(loads.shown, quantity, clock.time)[nearest];
  const {unit, factor} = readable(quantity.unit, Math.max(...quantity.high.map(Math.abs), ...quantity.low.map(Math.abs)));
  byId("load-value").textContent = `${quantity.name} at ${format(quantity.s[nearest], 3)} m: ${format(factor * now)} ${unit} at ` +
    `${clock.time.toFixed(3)} s, ${format(factor * quantity.low[nearest])} to ${format(factor * quantity.high[nearest])} ${unit} over the run`;
}

/** Where and when the extremes are, each with a button that goes there. */
function fillExtremes(found) {
  const body = element("tbody");
  let number = 0;
  for (const quantity of found.quantities) {
    const all = [...quantity.extremes, quantity.difference, ...(quantity.own || [])].filter(Boolean);
    const {unit, factor} = readable(quantity.unit, Math.max(...all.map((one) => Math.abs(one.value))));
    for (const extreme of all) {
      const button = element("button", {type: "button", id: `load-show-${++number}`, class: "save"}, `${extreme.time.toFixed(3)} s`);
      button.addEventListener("click", () => clock.set(extreme.time));
      body.append(element("tr", {}, element("th", {scope: "row"}, `${quantity.name}, ${extreme.what}`),
        element("td", {class: "number"}, `${format(factor * extreme.value)} ${unit}`),
        element("td", {class: "number"}, extreme.where.replaceAll("-", "−")), element("td", {}, button)));
    }
  }
  byId("load-table").replaceChildren(element("thead", {}, element("tr", {}, element("th", {scope: "col"}, "extreme"),
    element("th", {class: "number", scope: "col"}, "value"), element("th", {class: "number", scope: "col"}, "where"),
    element("th", {scope: "col"}, "when"))), body);
}

/** What the extremes are of, where the file does not hold these loads at every output. */
function tellRows(found) {
  byId("rows-note").hidden = !found.step;
  if (!found.step) return;
  const isKnown = found.quantities.some((one) => one.own && one.own.length), span = data.runs[found.index].window.map(formatTick).join(" to ");
  byId("rows-note").textContent = `The file holds these loads every ${formatTick(1e3 * found.step)} ms: line, area, dots and extremes are of these rows, ` +
    "and between them a load may have been larger. " + (isKnown ? `What is called the largest of all outputs, of either sign, the run itself ` +
    `has found over the span of its [statistics], ${span} s.` : "The run did not store the largest of all its outputs.");
}

function writeLoadsCsv() {
  const rows = loads.shown.quantities.flatMap((one) => {
    const now = loadAt(loads.shown, one, clock.time);
    return Array.from(one.s, (s, k) => [`${one.name}, ${one.unit}`, s, now[k], one.low[k], one.high[k]]);
  });
  return writeCsv(["quantity", loads.shown.axis, `at ${clock.time.toFixed(3)} s`, "lowest", "highest"], rows);
}

function makeLoads() {
  prepareLoads();
  byId("loads").hidden = !loads.all.length;
  if (!loads.all.length) return;
  byId("difference-note").hidden = !loads.all.some((one) => one.quantities.some((quantity) => quantity.difference));
  const select = byId("load-body");
  fillSelect(select, loads.all.map((one, place) => ({value: String(place), label: one.label})));
  const show = () => {
    loads.shown = loads.all[Number(select.value)];
    byId("load-value").textContent = "";
    fillExtremes(loads.shown);
    tellRows(loads.shown);
    drawLoads();
  };
  select.value = String(loads.all.findIndex((one) => one.index === player.main) < 0 ? 0 : loads.all.findIndex((one) => one.index === player.main));
  select.addEventListener("change", show);
  makeLoadCanvases();
  byId("load-head").append(makeSaveButtons("loads-diagram", writeLoadsCsv, () => joinCanvases(loads.canvases.filter((one) => !one.hidden))));
  clock.listeners.push(drawLoads);
  redraws.push(drawLoads);
  show();
}

/** Canvases below each other on the card's colour. */
function joinCanvases(canvases) {
  const picture = element("canvas", {width: canvases[0].width, height: canvases.reduce((sum, one) => sum + one.height, 0)});
  const context = picture.getContext("2d");
  context.fillStyle = style("--card");
  context.fillRect(0, 0, picture.width, picture.height);
  let y = 0;
  for (const one of canvases) {
    context.drawImage(one, 0, y);
    y += one.height;
  }
  return picture;
}
