"use strict";
// A point for each run over any two columns.

const scatter = {places: []};

function drawScatter() {
  const [x, y, colour] = ["scatter-x", "scatter-y", "scatter-colour"].map((name) => columnOf(byId(name)));
  if (!x || !y) return;
  const canvas = byId("scatter-plot"), {context, width, height} = prepareCanvas(canvas, 380);
  const area = drawAxes(context, width, height, axisOf(x), axisOf(y), colour ? SCALE_HEIGHT : undefined);
  if (colour) drawScale(context, width, colour);
  const runs = runsWith(x, y), radius = runs.length > 1000 ? 2 : 4;
  scatter.places = runs.map((run) => [run, area.left + placeOn(x, x.numbers[run]) * (area.right - area.left),
    area.bottom - placeOn(y, y.numbers[run]) * (area.bottom - area.top)]);
  for (const [run, px, py] of scatter.places) {
    context.fillStyle = colourOfRun(colour, run);
    context.beginPath();
    context.arc(px, py, radius, 0, 2 * Math.PI);
    context.fill();
  }
  for (const [, px, py] of scatter.places.filter(([run]) => run === chosen.run)) {
    context.strokeStyle = style("--bad");
    context.lineWidth = 2;
    context.beginPath();
    context.arc(px, py, radius + 4, 0, 2 * Math.PI);
    context.stroke();
  }
  canvas.setAttribute("aria-label", `${titleOf(y)} over ${titleOf(x)}, ${runs.length} runs`);
}

function makeScatter() {
  const first = measureColumns[0], second = measureColumns[1] || first;
  for (const [name, wanted] of [["scatter-x", parameterColumns[0]], ["scatter-y", first], ["scatter-colour", second]]) {
    fillSelect(byId(name), optionsOf(columns));
    if (wanted) byId(name).value = wanted.index;
    byId(name).addEventListener("change", drawScatter);
  }
  const shown = () => ["scatter-x", "scatter-y", "scatter-colour"].map((name) => columnOf(byId(name))).filter(Boolean);
  byId("scatter-saves").replaceWith(makeSaveButtons("scatter", () => writeColumns([...new Set(shown())]), () => copyPicture(byId("scatter-plot"))));
  byId("scatter-plot").addEventListener("click", (event) => {
    const [x, y] = placeOfEvent(byId("scatter-plot"), event);
    const near = scatter.places.map(([run, px, py]) => [run, Math.hypot(px - x, py - y)]).sort((a, b) => a[1] - b[1])[0];
    choose(near && near[1] < 20 ? near[0] : null);
  });
  chosen.listeners.push(drawScatter);
}
