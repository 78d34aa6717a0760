"use strict";
// The vehicle's own modes about its equilibrium, drawn in motion.

const LEAST_MODE_HEIGHT = 140, MODE_HEIGHT = 300;  // px
const MODE_EDGE = 14;  // between the edge and all that moves, px: signs and lines are wider than the places of nodes
const LARGEST = 0.09;  // of the vehicle's size: the largest displacement at full amplitude
const PERIOD = 2;  // s, in which a mode is shown to move once to and fro
const modeShow = {run: 0, mode: 0, amplitude: 1, phase: Math.PI / 2, playing: false, before: 0};

const unpackedModes = new Map();
/** A run's nodes in equilibrium and their displacements; kept. */
function unpackVehicleModes(index) {
  if (!unpackedModes.has(index)) {
    const pairs = (text) => {
      const numbers = decode(text);
      return Array.from({length: numbers.length / 2}, (_, k) => [numbers[2 * k], numbers[2 * k + 1]]);
    };
    const map = (object) => Object.fromEntries(Object.entries(object).map(([name, text]) => [name, pairs(text)]));
    const {equilibrium, shapes} = data.runs[index].vehicleModes;
    unpackedModes.set(index, {equilibrium: map(equilibrium), shapes: shapes.map(map)});
  }
  return unpackedModes.get(index);
}

/** The least box [x0, y0, x1, y1] around nodes {body: [[x, y] …]} and wheels, of one or several positions of the vehicle. */
function boxAround(vehicle, ...positions) {
  const corners = positions.flatMap((nodes) => [...Object.values(nodes).flat(), ...vehicle.wheels.flatMap((wheel) => {
    const [x, y] = nodes[wheel.body][wheel.node];
    return [[x - wheel.radius, y - wheel.radius], [x + wheel.radius, y + wheel.radius]];
  })]);
  const along = (axis) => corners.map((corner) => corner[axis]);
  return [Math.min(...along(0)), Math.min(...along(1)), Math.max(...along(0)), Math.max(...along(1))];
}

/** Nodes moved by so many times their displacements in a mode. */
function moveNodes(equilibrium, shape, size) {
  return Object.fromEntries(Object.entries(equilibrium).map(([name, places]) =>
    [name, places.map(([x, y], k) => [x + size * shape[name][k][0], y + size * shape[name][k][1]])]));
}

/** The view that shows a mode wherever it moves to, and the scene's height, px. */
function fitMode(vehicle, equilibrium, shape, size, width) {
  const [x0, y0, x1, y1] = boxAround(vehicle, equilibrium, moveNodes(equilibrium, shape, size), moveNodes(equilibrium, shape, -size));
  const inside = Math.max(width - 2 * MODE_EDGE, 1), wide = Math.max(x1 - x0, 1e-6), tall = Math.max(y1 - y0, 1e-6);
  const height = Math.round(Math.min(MODE_HEIGHT, Math.max(LEAST_MODE_HEIGHT, inside * tall / wide + 2 * MODE_EDGE)));
  const scale = Math.min(inside / wide, (height - 2 * MODE_EDGE) / tall);
  return {
    scale, width, height, X: (x) => 0.5 * width + scale * (x - 0.5 * (x0 + x1)), Y: (y) => 0.5 * height - scale * (y - 0.5 * (y0 + y1)),
  };
}

function drawVehicleMode() {
  const canvas = byId("mode-scene"), run = data.runs[modeShow.run], {equilibrium, shapes} = unpackVehicleModes(modeShow.run);
  const [x0, y0, x1, y1] = boxAround(run.vehicle, equilibrium), size = LARGEST * Math.max(x1 - x0, y1 - y0), shape = shapes[modeShow.mode];
  const view = fitMode(run.vehicle, equilibrium, shape, size * Math.max(modeShow.amplitude, 1), canvas.clientWidth);
  const {context} = prepareCanvas(canvas, view.height);
  const nodes = moveNodes(equilibrium, shape, size * modeShow.amplitude * Math.sin(modeShow.phase));
  context.globalAlpha = 0.25;
  drawBodies(context, view, run.vehicle, equilibrium, style("--soft"));
  context.globalAlpha = 1;
  for (const wheel of run.vehicle.wheels) drawWheel(context, view, wheel, nodes[wheel.body][wheel.node], colourOf(modeShow.run), true);
  drawBodies(context, view, run.vehicle, nodes, colourOf(modeShow.run));
  Object.assign(modeShow, {nodes, view});
}

function advanceMode(now) {
  if (!modeShow.playing) return;
  modeShow.phase += 2 * Math.PI / PERIOD * Math.min(Math.max(now - modeShow.before, 0), 100) / 1e3;
  modeShow.before = now;
  drawVehicleMode();
  requestAnimationFrame(advanceMode);
}

function playMode(playing) {
  modeShow.playing = playing;
  modeShow.before = performance.now();
  byId("mode-play").textContent = playing ? "Pause" : "Play";
  byId("mode-play").setAttribute("aria-pressed", String(playing));
  if (playing) requestAnimationFrame(advanceMode);
}

function tellMode() {
  const found = data.runs[modeShow.run].vehicleModes.table[modeShow.mode];
  byId("mode-words").textContent = `${format(found.f)} Hz, damping ratio ${format(100 * found.damping, 3)} %: ${found.who}. ` +
    `Shown once in ${PERIOD} s; pale: in equilibrium.`;
  byId("mode-scene").setAttribute("aria-label", `Mode ${found.number} of the vehicle, ${found.who}`);
}

function makeVehicleModes() {
  const withModes = data.runs.map((run, index) => ({run, index})).filter(({run}) => run.vehicleModes.table.length);
  byId("vehicle-modes").hidden = !withModes.length;
  const drawn = withModes.filter(({run}) => run.vehicleModes.shapes.length);
  byId("mode-player").hidden = !drawn.length;
  if (!drawn.length) return;
  const select = byId("vehicle-mode");
  fillSelect(select, drawn.flatMap(({run, index}) => run.vehicleModes.shapes.map((_, mode) => {
    const {f, who} = run.vehicleModes.table[mode];
    return {value: `${index} ${mode}`, label: `${format(f, 3)} Hz: ${who.split("; ")[0]}`, group: run.label};
  })));
  const choose = () => {
    [modeShow.run, modeShow.mode] = select.value.split(" ").map(Number);
    tellMode();
    drawVehicleMode();
  };
  select.value = `${drawn[drawn.length - 1].index} 0`;
  select.addEventListener("change", choose);
  byId("mode-amplitude").addEventListener("input", (event) => {
    modeShow.amplitude = Number(event.target.value);
    drawVehicleMode();
  });
  byId("mode-play").addEventListener("click", () => playMode(!modeShow.playing));
  byId("mode-scene-png").addEventListener("click", () => saveCanvas("mode-scene"));
  redraws.push(drawVehicleMode);
  choose();
}
