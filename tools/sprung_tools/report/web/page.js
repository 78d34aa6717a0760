"use strict";
// Assembles the page, and answers the questions of its tests.

function fillHead() {
  byId("title").textContent = data.title;
  const fact = (run, name) => (run.facts.find(([other]) => other === name) || [])[1];
  const shared = ["road", "initial speed", "duration"].map((name) => {
    const texts = new Set(data.runs.map((run) => fact(run, name)));
    return texts.size === 1 ? [...texts][0] : undefined;
  });
  byId("subtitle").textContent = shared.filter(Boolean).join(" · ");
  byId("run-keys").replaceChildren(...data.runs.map((run, index) => element("li", {}, element("span", {class: "key",
    style: `--c:${colourOf(index)}`}), run.label)));
  byId("summary-note").textContent = (data.runs.length > 1 ? `Differences are to ${data.runs[0].label}. ` : "") +
    `Displacements and accelerations are vertical${data.runs.every((run) => run.vehicle.wheels.length) ? "" :
      ", or along the axis named: of a mechanism that along which the point moves more"}. Displacements are from ${data.runs.every((run) => run.balanced) ? "the run's static equilibrium" :
      "static equilibrium or, where none was sought, from the start"}. All rows but those of the computation are over the ` +
    `span of the run's [statistics], ${describeSpans()}`;
  byId("animation-heading").textContent = data.runs.some((run) => run.vehicle.wheels.length) ? "On the road" : "Motion";
  byId("spectra-heading").textContent = `Spectra of the ${data.runs.every((run) => run.vehicle.wheels.length) ? "vertical " : ""}acceleration`;
  byId("tyre-note").hidden = !data.runs.some((run) => run.vehicle.wheels.length);
  byId("joint-note").hidden = !data.runs.some((run) => run.modes.length);
  byId("line-note").hidden = !data.runs.some((run) => run.vehicleModes.table.length);
  byId("state").hidden = byId("tyre-note").hidden;
}

const errors = [];
window.addEventListener("error", (event) => errors.push(event.message));

function drawAll() {
  fillHead();
  fillTables();
  for (const draw of redraws) draw();
}

fillHead();
fillTables();
makePlayer();
makeHistories();
makeBands();
makeLoads();
makeSpectra();
makeVehicleModes();
makeModeAmplitudes();
makeZoom();
for (const link of document.querySelectorAll("nav a")) link.hidden = byId(link.hash.slice(1)).hidden;
dark.addEventListener("change", drawAll);
let resizing = 0;
window.addEventListener("resize", () => {
  cancelAnimationFrame(resizing);
  resizing = requestAnimationFrame(() => {
    if (!byId("player").hidden) drawScene();
    drawLoads();
    if (!byId("mode-player").hidden) drawVehicleMode();
    linked.forEach(placeCursor);
  });
});

const statisticOf = (run, of, name) => data.runs[run].statistics.find((row) => row.of === of && row.name === name).value;
const findBody = (name) => player.runs[player.main].vehicle.bodies.find((one) => one.name === name);

/** For tests: where the shown run's main body is at the clock's time, and what went wrong. */
window.sprungReport = {
  errors,
  clock,
  mainBody() {
    const main = player.runs[player.main], at = frameAt(main, clock.time);
    const [x, y, angle] = main.places[main.vehicle.main].map((column) => between(column, at));
    return {x, y, angle};
  },
  node: (body, point) => findBody(body).points[point],
  place: (body, node, magnification) => {
    const main = player.runs[player.main];
    return nodesOf(main, findBody(body), frameAt(main, clock.time), magnification)[node];
  },
};
document.documentElement.dataset.ready = "true";
