"use strict";
// The columns of the table, their scales and colours; the run that is chosen.

/** The least and the largest of some numbers, however many. */
const rangeOf = (numbers) => numbers.reduce(([low, high], one) => [Math.min(low, one), Math.max(high, one)], [Infinity, -Infinity]);

/** All columns: parameters, then measures. A column of texts has categories in order, and its numbers are their places. */
const columns = [...data.parameters, ...data.measures].map((one, index) => {
  const categories = one.categories || null, numbers = categories ? one.values.map((value) => categories.indexOf(value)) : one.values;
  const [low, high] = rangeOf(numbers.filter((value) => value !== null));
  return {name: one.name, unit: one.unit || "", values: one.values, numbers, categories, isParameter: index < data.parameters.length,
    low, high, index};
}).filter((one) => Number.isFinite(one.low));
const parameterColumns = columns.filter((one) => one.isParameter), measureColumns = columns.filter((one) => !one.isParameter);
const columnOf = (select) => columns.find((one) => one.index === Number(select.value));
/** The name and the unit of the numbers, which are shown as the table has them. */
const titleOf = (column) => (column.unit && column.unit !== "1" ? `${column.name}, ${printUnit(column.unit)}` : column.name);
const showNumber = (value) => String(Number(value.toPrecision(5))).replaceAll("-", "−");
const showValue = (column, run) =>
  column.numbers[run] === null ? "–" : column.categories ? column.categories[column.numbers[run]] :
    showNumber(column.numbers[run]);

/** Where a number lies on a column's scale, 0 to 1, with a margin at both ends. */
function placeOn(column, value) {
  const margin = column.categories ? 0.5 : 0.04 * (column.high - column.low) || 0.5 * Math.abs(column.high) || 1;
  return (value - column.low + margin) / (column.high - column.low + 2 * margin);
}

/** The values that a scale is marked at, with their texts. */
function marksOf(column, most = 6) {
  if (column.categories) return column.categories.map((text, value) => ({value, text}));
  if (column.high === column.low) return [{value: column.low, text: format(column.low)}];
  const raw = (column.high - column.low) / most, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((one) => one * power).find((one) => one >= raw);
  const marks = [];
  for (let k = Math.ceil(column.low / step); k * step <= column.high * (1 + 1e-12); ++k) marks.push({value: k * step, text: formatTick(k * step)});
  return marks;
}

/** Colours from low to high: points of viridis, by S. van der Walt and N. Smith, which keep their order without colour. */
const SCALE = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];

function colourAt(share) {
  const shown = dark.matches ? 0.2 + 0.8 * share : 0.95 * share;  // the darkest or lightest part would vanish in the paper
  const at = Math.min(Math.max(shown, 0), 1) * (SCALE.length - 1), k = Math.min(Math.floor(at), SCALE.length - 2);
  return `rgb(${SCALE[k].map((one, c) => Math.round(one + (at - k) * (SCALE[k + 1][c] - one))).join(",")})`;
}

const shareOf = (column, value) => (column.high > column.low ? (value - column.low) / (column.high - column.low) : 0.5);
const colourOfRun = (column, run) => (column && column.numbers[run] !== null ? colourAt(shareOf(column, column.numbers[run])) : style("--soft"));

const chosen = {run: null, listeners: []};
const diagrams = {named: []};  // the marks of the last axis across that are named

/** Chooses a run in all diagrams; null for none. */
function choose(run) {
  chosen.run = run;
  const parts = run === null ? [] : [...parameterColumns, ...measureColumns].map((one) => `${titleOf(one)}: ${showValue(one, run)}`);
  byId("chosen").textContent = run === null ? "" : `Run ${run + 1}. ${parts.join(" · ")}`;
  for (const listener of chosen.listeners) listener();
}

const optionsOf = (some) => some.map((one) => ({value: one.index, label: titleOf(one), group: one.isParameter ? "Parameters" : "Measures"}));

/** Runs that have a number in each of some columns. */
const runsWith = (...some) => data.rows.map((_, run) => run).filter((run) => some.every((one) => one.numbers[run] !== null));

/** A frame with marks and titles of both axes, so far below the top of the canvas. Returns the area inside. */
function drawAxes(context, width, height, across, up, top = 14) {
  context.font = "12px system-ui, sans-serif";
  const widest = rangeOf([0, ...up.marks.map(({text}) => context.measureText(text).width)])[1];
  const area = {left: Math.min(Math.max(70, 30 + widest), 0.4 * width), top, right: width - 14, bottom: height - 46};
  context.strokeStyle = style("--grid");
  context.fillStyle = style("--soft");
  context.textBaseline = "middle";
  const length = area.right - area.left;
  const marks = across.marks.map(({place, text}) => ({place, text: cutEnd(context, text, Math.max(length / across.marks.length, 80))}));
  const named = thinMarks(context, marks, length);
  for (const {place, text} of marks) {
    const x = area.left + place * length;
    context.textAlign = "center";
    if (named.some((one) => one.place === place)) context.fillText(text, x, area.bottom + 14);
    if (across.lines) strokeLine(context, x, area.top, x, area.bottom);
  }
  diagrams.named = named.map(({text}) => text);
  for (const {place, text} of up.marks) {
    const y = area.bottom - place * (area.bottom - area.top);
    context.textAlign = "right";
    context.fillText(cutEnd(context, text, area.left - 30), area.left - 6, y);
    if (up.lines) strokeLine(context, area.left, y, area.right, y);
  }
  context.strokeStyle = style("--line");
  context.strokeRect(area.left, area.top, area.right - area.left, area.bottom - area.top);
  context.textAlign = "center";
  context.fillText(across.title, (area.left + area.right) / 2, height - 10);
  context.save();
  context.translate(9, (area.top + area.bottom) / 2);
  context.rotate(-Math.PI / 2);
  context.fillText(shorten(context, up.title, area.bottom - area.top), 0, 0);
  context.restore();
  return area;
}

const SCALE_HEIGHT = 34, SCALE_WIDTH = 120;  // px

/** What the colours mean, at the top right of a canvas. */
function drawScale(context, width, column) {
  const ends = column.categories ? [column.categories[0], column.categories[column.categories.length - 1]] : [column.low, column.high].map(showNumber);
  context.font = "12px system-ui, sans-serif";
  context.textBaseline = "middle";
  context.textAlign = "left";
  const right = width - 14 - context.measureText(ends[1]).width, left = right - SCALE_WIDTH - 12, y = 14;
  const gradient = context.createLinearGradient(left, 0, left + SCALE_WIDTH, 0);
  for (let k = 0; k <= 8; ++k) gradient.addColorStop(k / 8, colourAt(k / 8));
  context.fillStyle = gradient;
  context.fillRect(left, y - 4, SCALE_WIDTH, 8);
  context.fillStyle = style("--soft");
  context.fillText(ends[1], right - 6, y);
  context.textAlign = "right";
  const room = left - 20, title = shorten(context, titleOf(column), Math.max(room - context.measureText(ends[0]).width - 12, 0));
  context.fillText(`${title}: ${ends[0]}`, left - 6, y);
}

function strokeLine(context, x1, y1, x2, y2) {
  context.beginPath();
  context.moveTo(x1, y1);
  context.lineTo(x2, y2);
  context.stroke();
}

/** The end of a text that is too wide: of a name, whose end says what it is. */
function shorten(context, text, width) {
  if (context.measureText(text).width <= width) return text;
  let end = text;
  while (end && context.measureText(`…${end}`).width > width) end = end.slice(1);
  return `…${end}`;
}

/** The beginning of a text that is too wide: of a value. */
function cutEnd(context, text, width) {
  if (context.measureText(text).width <= width) return text;
  let begin = text;
  while (begin && context.measureText(`${begin}…`).width > width) begin = begin.slice(0, -1);
  return `${begin}…`;
}

/** Of marks [{place, text}] along a length in px those that do not run into each other: every one, every second one … */
function thinMarks(context, marks, length) {
  let shown = marks;
  for (let every = 2; every <= marks.length; ++every) {
    const isFree = shown.every(({place, text}, k) => k === 0 || length * (place - shown[k - 1].place) >
      0.5 * (context.measureText(text).width + context.measureText(shown[k - 1].text).width) + 6);
    if (isFree) return shown;
    shown = marks.filter((_, k) => k % every === 0);
  }
  return shown;
}

const axisOf = (column) => ({title: titleOf(column), lines: true,
  marks: marksOf(column).map(({value, text}) => ({place: placeOn(column, value), text}))});

/** A canvas as it is saved: on the card's colour. */
function copyPicture(canvas) {
  const picture = element("canvas", {width: canvas.width, height: canvas.height}), context = picture.getContext("2d");
  context.fillStyle = style("--card");
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.drawImage(canvas, 0, 0);
  return picture;
}

/** Where a mouse event is in a canvas, in CSS pixels. */
function placeOfEvent(canvas, event) {
  const box = canvas.getBoundingClientRect();
  return [event.clientX - box.x, event.clientY - box.y];
}

/** The table of some columns as CSV. */
const writeColumns = (some) => [["run", ...some.map(titleOf)].map(quote), ...data.rows.map((_, run) =>
  [run + 1, ...some.map((one) => (one.numbers[run] === null ? "" : one.categories ? quote(one.categories[one.numbers[run]]) : one.numbers[run]))])]
  .map((row) => row.join(",")).join("\n") + "\n";
