"use strict";
// Parallel coordinates: an axis for each column, a line for each run.

const MOST_AXES = 14;
const parallel = {lines: []};

function drawParallel() {
  const shown = columns.slice(0, MOST_AXES), colour = columnOf(byId("parallel-colour"));
  const canvas = byId("parallel-plot"), {context, width, height} = prepareCanvas(canvas, 380);
  const top = 46, bottom = height - 12, step = (width - 130) / Math.max(shown.length - 1, 1), xs = shown.map((_, k) => 65 + k * step);
  const yOf = (column, value) => bottom - placeOn(column, value) * (bottom - top);
  const runs = data.rows.map((_, run) => run).filter((run) => data.measures.length === 0 || measureColumns.some((one) => one.numbers[run] !== null));
  parallel.lines = runs.map((run) => [run, shown.map((one, k) => (one.numbers[run] === null ? null : [xs[k], yOf(one, one.numbers[run])]))]);
  const draw = ([run, points], isChosen) => {
    context.strokeStyle = isChosen ? style("--bad") : colourOfRun(colour, run);
    context.lineWidth = isChosen ? 3 : 1;
    context.beginPath();
    let isDown = false;
    for (const point of points) {
      if (point) (isDown ? context.lineTo(...point) : context.moveTo(...point));
      isDown = Boolean(point);
    }
    context.stroke();
  };
  context.globalAlpha = runs.length > 200 ? 0.4 : 0.8;
  for (const line of parallel.lines) draw(line, false);
  context.globalAlpha = 1;
  for (const line of parallel.lines.filter(([run]) => run === chosen.run)) draw(line, true);
  context.font = "11px system-ui, sans-serif";
  context.lineWidth = 1;
  context.textBaseline = "middle";
  shown.forEach((one, k) => {
    context.strokeStyle = style("--ink");
    strokeLine(context, xs[k], top, xs[k], bottom);
    context.fillStyle = style("--ink");
    context.textAlign = "center";
    const title = shorten(context, titleOf(one), Math.max(1.5 * step - 16, 120)), half = 0.5 * context.measureText(title).width;
    context.fillText(title, Math.min(Math.max(xs[k], half + 2), width - half - 2), k % 2 ? 14 : 30);
    context.textAlign = "left";
    for (const {value, text} of marksOf(one, 5)) drawPlate(context, text, xs[k] + 5, yOf(one, value));
  });
  canvas.setAttribute("aria-label", `${runs.length} runs over ${shown.map((one) => one.name).join(", ")}`);
}

/** A text on the card's colour, so that it can be read on lines. */
function drawPlate(context, text, x, y) {
  context.fillStyle = style("--card");
  context.globalAlpha = 0.75;
  context.fillRect(x - 2, y - 6, context.measureText(text).width + 4, 12);
  context.globalAlpha = 1;
  context.fillStyle = style("--soft");
  context.fillText(text, x, y);
}

/** The run whose line is the nearest at a place; null if none is near. */
function findLine(x, y) {
  let found = null, least = 15;
  for (const [run, points] of parallel.lines) {
    for (let k = 1; k < points.length; ++k) {
      const [a, b] = [points[k - 1], points[k]];
      if (!a || !b || x < a[0] || x > b[0]) continue;
      const distance = Math.abs(a[1] + (x - a[0]) / (b[0] - a[0]) * (b[1] - a[1]) - y);
      if (distance < least) [found, least] = [run, distance];
    }
  }
  return found;
}

function makeParallel() {
  fillSelect(byId("parallel-colour"), optionsOf(columns));
  if (measureColumns.length) byId("parallel-colour").value = measureColumns[0].index;
  byId("parallel-colour").addEventListener("change", drawParallel);
  byId("parallel-saves").replaceWith(makeSaveButtons("parallel", () => writeColumns(columns), () => copyPicture(byId("parallel-plot"))));
  byId("parallel-plot").addEventListener("click", (event) => choose(findLine(...placeOfEvent(byId("parallel-plot"), event))));
  chosen.listeners.push(drawParallel);
}
