"use strict";
// The mean of a measure over fields of two parameters.

const MOST_FIELDS = 16, PARTS = 8;

/** The fields of a parameter: one for each value, or parts of its range where there are many. [{name, has(number)}] */
function fieldsOf(column) {
  const distinct = [...new Set(column.numbers)].sort((a, b) => a - b);
  if (column.categories || distinct.length <= MOST_FIELDS) {
    return distinct.map((value) => ({name: column.categories ? column.categories[value] : showNumber(value), has: (one) => one === value}));
  }
  const step = (column.high - column.low) / PARTS;
  return Array.from({length: PARTS}, (_, k) => ({name: showNumber(Number((column.low + (k + 0.5) * step).toPrecision(3))),
    has: (one) => Math.min(Math.floor((one - column.low) / step), PARTS - 1) === k}));
}

/** Means [up][across]; null where no run lies. */
function calcFields(x, y, measure) {
  const across = fieldsOf(x), up = fieldsOf(y);
  const sums = up.map(() => across.map(() => [0, 0]));
  for (const run of runsWith(x, y, measure)) {
    const sum = sums[up.findIndex((one) => one.has(y.numbers[run]))][across.findIndex((one) => one.has(x.numbers[run]))];
    sum[0] += measure.numbers[run];
    sum[1] += 1;
  }
  return {across, up, means: sums.map((row) => row.map(([sum, count]) => (count ? sum / count : null)))};
}

function drawHeatMap() {
  const [x, y, measure] = ["heat-x", "heat-y", "heat-measure"].map((name) => columnOf(byId(name)));
  if (!x || !y || !measure) return;
  const {across, up, means} = calcFields(x, y, measure);
  const canvas = byId("heat-plot"), {context, width, height} = prepareCanvas(canvas, 380);
  const marks = (fields) => fields.map((one, k) => ({place: (k + 0.5) / fields.length, text: one.name}));
  const area = drawAxes(context, width, height, {title: titleOf(x), marks: marks(across)}, {title: titleOf(y), marks: marks(up)});
  const [low, high] = rangeOf(means.flat().filter((one) => one !== null));
  const dx = (area.right - area.left) / across.length, dy = (area.bottom - area.top) / up.length;
  context.textAlign = "center";
  means.forEach((row, j) => row.forEach((mean, i) => {
    if (mean === null) return;
    const share = high > low ? (mean - low) / (high - low) : 0.5, left = area.left + i * dx, top = area.bottom - (j + 1) * dy;
    context.fillStyle = colourAt(share);
    context.fillRect(left, top, dx + 0.5, dy + 0.5);
    context.fillStyle = share > 0.6 ? "#111111" : "#ffffff";
    if (dx > 44 && dy > 14) context.fillText(format(mean), left + dx / 2, top + dy / 2);
  }));
  canvas.setAttribute("aria-label", `Mean of ${titleOf(measure)} over ${titleOf(x)} and ${titleOf(y)}, ${format(low)} to ${format(high)}`);
}

function writeHeatMap() {
  const [x, y, measure] = ["heat-x", "heat-y", "heat-measure"].map((name) => columnOf(byId(name)));
  const {across, up, means} = calcFields(x, y, measure);
  return [[`${y.name} \\ ${x.name}`, ...across.map((one) => one.name)].map(quote),
    ...means.map((row, j) => [quote(up[j].name), ...row.map((one) => (one === null ? "" : Number(one.toPrecision(9))))])]
    .map((row) => row.join(",")).join("\n") + "\n";
}

function makeHeatMap() {
  byId("heat-map").hidden = parameterColumns.length < 2 || !measureColumns.length;
  if (byId("heat-map").hidden) return;
  const varied = [...parameterColumns].sort((a, b) => (b.high > b.low) - (a.high > a.low));  // those with one value come last
  const wanted = {"heat-x": [parameterColumns, varied[0]], "heat-y": [parameterColumns, varied[1]], "heat-measure": [measureColumns, measureColumns[0]]};
  for (const [name, [some, first]] of Object.entries(wanted)) {
    fillSelect(byId(name), optionsOf(some));
    byId(name).value = first.index;
    byId(name).addEventListener("change", drawHeatMap);
  }
  byId("heat-saves").replaceWith(makeSaveButtons("heat-map", writeHeatMap, () => copyPicture(byId("heat-plot"))));
}
