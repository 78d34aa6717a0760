"use strict";
// Main effects: the mean of a measure by the values of each parameter.

const effectsOf = (measure) => data.effects.filter((one) => one.measure === measure.name).sort((a, b) => (b.share ?? -1) - (a.share ?? -1));

const EFFECT_LEFT = 66, EFFECT_RIGHT = 8, LEAST_SHARE = 112;  // px; of the width of a parameter
const effectMarks = [];  // what stands below the parameters: {text, from, to, row}, px

/** The name of a group: a number with few digits, else the text. */
const nameGroup = (text) => (text.trim() !== "" && Number.isFinite(Number(text)) ? String(Number(Number(text).toPrecision(4))) : text)
  .replaceAll("-", "\u2212");

/** Names of the first and of the last group below their points [x, x], px, within a parameter's part of the diagram; in two rows
 * where one is too short. */
function nameEnds(context, groups, ends, left, share, y) {
  const names = [...new Set([groups[0], groups[groups.length - 1]].map(nameGroup))].map((one) => cutEnd(context, one, share - 8));
  const widths = names.map((one) => context.measureText(one).width);
  const starts = widths.map((width, k) => Math.min(Math.max(ends[k] - 0.5 * width, left + 4), left + share - 4 - width));
  const isNarrow = names.length > 1 && starts[0] + widths[0] + 6 > starts[1];
  context.textAlign = "left";
  names.forEach((text, k) => {
    const row = isNarrow ? k : 0;
    context.fillText(text, starts[k], y + 13 * row);
    effectMarks.push({text, from: starts[k], to: starts[k] + widths[k], row});
  });
}

function drawEffects() {
  const measure = columnOf(byId("effect-measure"));
  if (!measure) return;
  const found = effectsOf(measure), percent = (share) => `${(100 * share).toFixed(0)} %`,
    describe = (one) => (one.share === null ? "cannot be judged" : one.share > one.chance ? percent(one.share) : "no more than chance");
  byId("effect-table").replaceChildren(
    element("thead", {}, element("tr", {}, ...["parameter", "explains of the variance", "chance up to", "lowest mean", "highest mean"]
      .map((text, k) => element("th", {class: k ? "number" : ""}, text)))),
    element("tbody", {}, ...found.map((one) => element("tr", {}, element("th", {scope: "row"}, one.parameter),
      ...[describe(one), percent(one.chance), ...rangeOf(one.means).map((mean) => format(mean))]
        .map((text) => element("td", {class: "number"}, text))))));
  const canvas = byId("effect-plot");
  canvas.style.minWidth = `${EFFECT_LEFT + EFFECT_RIGHT + LEAST_SHARE * found.length}px`;
  const {context, width} = prepareCanvas(canvas, found.length ? 260 : 0);
  effectMarks.length = 0;
  if (!found.length) return;
  const means = found.flatMap((one) => one.means), [low, high] = rangeOf(means);
  const scale = {...measure, low, high, categories: null}, left = EFFECT_LEFT, top = 12, bottom = 200;
  const yOf = (value) => bottom - placeOn(scale, value) * (bottom - top), share = (width - left - EFFECT_RIGHT) / found.length;
  context.font = "11px system-ui, sans-serif";
  context.textBaseline = "middle";
  for (const {value, text} of marksOf(scale, 5)) {
    context.strokeStyle = style("--grid");
    strokeLine(context, left, yOf(value), width - EFFECT_RIGHT, yOf(value));
    context.fillStyle = style("--soft");
    context.textAlign = "right";
    context.fillText(text, left - 6, yOf(value));
  }
  found.forEach((one, k) => {
    const xs = one.groups.map((_, g) => left + share * (k + (g + 0.7) / (one.groups.length + 0.4)));
    context.strokeStyle = context.fillStyle = colourOf(1);
    context.beginPath();
    one.means.forEach((mean, g) => (g ? context.lineTo(xs[g], yOf(mean)) : context.moveTo(xs[g], yOf(mean))));
    context.stroke();
    one.means.forEach((mean, g) => context.fillRect(xs[g] - 2.5, yOf(mean) - 2.5, 5, 5));
    context.fillStyle = style("--soft");
    nameEnds(context, one.groups, [xs[0], xs[xs.length - 1]], left + share * k, share, bottom + 14);
    context.textAlign = "center";
    context.fillStyle = style("--ink");
    context.fillText(shorten(context, one.parameter, share - 10), left + share * (k + 0.5), bottom + 46);
  });
  canvas.setAttribute("aria-label", `Mean of ${titleOf(measure)} by ${found.map((one) => one.parameter).join(", ")}`);
}

function writeEffects() {
  const rows = data.effects.flatMap((one) => one.groups.map((group, k) => [one.measure, one.parameter, group, one.means[k], one.counts[k], one.share ?? ""]));
  return [["measure", "parameter", "group", "mean", "runs", "share"], ...rows].map((row) => row.map((one) => quote(String(one))).join(",")).join("\n") + "\n";
}

function makeEffects() {
  const varying = measureColumns.filter((one) => effectsOf(one).length);
  byId("effects").hidden = !varying.length;
  if (!varying.length) return;
  fillSelect(byId("effect-measure"), optionsOf(varying));
  byId("effect-measure").addEventListener("change", drawEffects);
  byId("effect-saves").replaceWith(makeSaveButtons("effects", writeEffects, () => copyPicture(byId("effect-plot"))));
}
