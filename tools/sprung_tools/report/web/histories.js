"use strict";
// Quantities over time, each diagram with a menu of them.

const NUM_HISTORIES = 4;

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
  const wanted = [/^Asked for/, /(displacement|position)( along [xy])?$/, /acceleration( along [xy])?$/, /^Deflection: .*body frame/, /force$/, /./, /./];
  const chosen = [];
  for (const pattern of wanted) {
    const found = byPattern(pattern, chosen);
    if (found && chosen.length < NUM_HISTORIES) chosen.push(found.value);
  }
  chosen.forEach((key, number) => {
    const chart = makeFigure(byId("history-charts"), `history-${number + 1}`, false);
    const select = element("select", {id: `history-${number + 1}`});
    fillSelect(select, channels);
    select.value = key;
    chart.head.prepend(element("label", {}, element("span", {}, `Diagram ${number + 1}`), select));
    select.addEventListener("change", () => drawHistory(chart, select.value));
    linked.push(chart);
    redraws.push(() => drawHistory(chart, select.value));
    drawHistory(chart, key);
  });
  const samples = [...new Set(data.runs.map((run) => run.samples))].join(", ");
  const coarse = data.runs.filter((run) => run.coarse.length).map((run) => `${run.label}: ${run.coarse.join("; ")}`);
  byId("history-note").textContent = "Drag in a diagram to zoom all of them, shift-drag to move, double click for the whole " +
    "run, click to set the animation's time; on a touch screen two fingers move and stretch. Histories of " +
    `${samples} samples are drawn by at most ${data.most}, with the least and greatest of each span of time; all numbers on ` +
    `this page are of all samples that the files hold${coarse.length ? `, which are fewer of some histories (${coarse.join(". ")})` : ""}. ` +
    "CSV saves what is drawn.";
}
