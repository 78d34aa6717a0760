"use strict";
// The scene with its controls: which run, when, how fast, what is shown.

const THUMB = 8;  // half the width of the scrubber's handle, px
const MUCH = 0.06;  // of the vehicle's length: a magnified deflection that is larger is too much by default
const player = {
  runs: [], main: 0, other: -1, magnification: 1, speed: 1, playing: false, before: 0, labels: false, labelled: [], beyond: "", flexible: false, onStop: null,
};

/** One run's vehicle. Returns what its tyres do, for the text below. */
function drawVehicle(context, view, prepared, time, alpha) {
  const at = frameAt(prepared, time), colour = colourOf(prepared.index), vehicle = prepared.vehicle, told = [];
  const nodes = Object.fromEntries(vehicle.bodies.map((body) => [body.name, nodesOf(prepared, body, at, player.magnification)]));
  context.globalAlpha = alpha;
  for (const wheel of vehicle.wheels) {
    const tyre = prepared.tyres[wheel.name], centre = nodes[wheel.body][wheel.node];
    const contact = tyre.contact[Math.round(at)] > 0.5, force = between(tyre.force, at);
    drawWheel(context, view, wheel, centre, colour, contact);
    if (contact) drawTyreForce(context, view, wheel, centre, force / prepared.largest);
    told.push(`${wheel.name} ${contact ? `on the road, ${format(force / 1e3, 3)} kN` : "off the road"}`);
  }
  drawBodies(context, view, vehicle, nodes, colour);
  context.globalAlpha = 1;
  return {told, nodes};
}

function drawScene() {
  const canvas = byId("scene"), main = player.runs[player.main];
  const shown = player.other >= 0 ? [main, player.runs[player.other]] : [main];
  const room = player.labels ? roomForLabels(main.vehicle, canvas.clientWidth) : 0;
  const {height: wanted, scale} = fitScene(shown, canvas.clientWidth, room);
  const {context, width, height} = prepareCanvas(canvas, wanted);
  context.fillStyle = style("--sky");
  context.fillRect(0, 0, width, height);
  const view = makeView(shown, clock.time, width, height, scale, room);
  player.view = view;
  if (main.vehicle.wheels.length) drawRoad(context, view, main.road);
  if (player.other >= 0) drawVehicle(context, view, player.runs[player.other], clock.time, 0.6);
  player.beyond = player.other >= 0 ? nameBeyond(context, view, player.runs[player.other], clock.time) : "";
  const {told, nodes} = drawVehicle(context, view, main, clock.time, 1);
  if (main.vehicle.wheels.length) drawDistances(context, view, main.road);
  player.labelled = player.labels ? drawLabels(context, view, main.vehicle, nodes) : [];
  drawCaptions(context, view, main.vehicle, player.magnification);
  byId("state").textContent = told.join(" · ");
  byId("clock").textContent = `${clock.time.toFixed(3)} s`;
  const scrubber = byId("scrubber");
  if (document.activeElement !== scrubber || Math.abs(scrubber.value - clock.time) > 2e-3) scrubber.value = clock.time;
  scrubber.setAttribute("aria-valuetext", `${clock.time.toFixed(3)} seconds`);
  drawContacts();
}

/** Below the scrubber: for each tyre of the run, when it is off the road. */
function drawContacts() {
  const canvas = byId("contact-strip"), main = player.runs[player.main], names = Object.keys(main.tyres);
  canvas.hidden = names.length === 0;
  if (canvas.hidden) return;
  const {context} = prepareCanvas(canvas, 15 * names.length + 2);
  // Below the scrubber's track, which its thumb's middle runs along.
  const edge = canvas.getBoundingClientRect().left, track = byId("scrubber").getBoundingClientRect();
  const left = track.left - edge + THUMB, right = track.right - edge - THUMB;
  const at = (time) => left + (right - left) * (time - clock.first) / (clock.last - clock.first);
  context.font = "11px system-ui, sans-serif";
  context.textBaseline = "middle";
  names.forEach((name, row) => {
    const y = 15 * row + 8, off = main.tyres[name].off;
    context.fillStyle = style("--soft");
    context.fillText(name, 0, y, left - 8);
    context.fillStyle = style("--grid");
    context.fillRect(left, y - 1, right - left, 2);
    context.fillStyle = style("--bad");
    for (let k = 0; k + 1 < off.length; k += 2) context.fillRect(at(off[k]), y - 4, Math.max(1.5, at(off[k + 1]) - at(off[k])), 8);
  });
  context.fillStyle = style("--accent");
  context.fillRect(at(clock.time) - 1, 0, 2, 15 * names.length + 2);
}

function setPlaying(playing) {
  if (playing && clock.time >= clock.last - 1e-6) clock.set(clock.first);
  player.playing = playing;
  player.before = performance.now();
  const button = byId("play");
  button.textContent = playing ? "Pause" : "Play";
  button.setAttribute("aria-pressed", String(playing));
  if (playing) {
    requestAnimationFrame(advance);
  } else if (player.onStop) {
    player.onStop();
    player.onStop = null;
  }
}

function advance(now) {
  if (!player.playing) return;
  const elapsed = Math.min(Math.max(now - player.before, 0), 100) / 1e3;
  player.before = now;
  clock.set(clock.time + player.speed * elapsed);
  if (clock.time >= clock.last) setPlaying(false); else requestAnimationFrame(advance);
}

/** The largest displacement of a node by deflection during the run, m, from some of the frames. */
function findDeflection(prepared) {
  let largest = 0;
  for (const body of prepared.vehicle.bodies) {
    const columns = prepared.amplitudes[body.name] || [];
    if (!columns.length) continue;
    const every = Math.max(1, Math.floor(columns[0].length / 200));
    for (let k = 0; k < columns[0].length; k += every) {
      for (const shape of body.shapes) {
        const along = (axis) => columns.reduce((sum, column, mode) => sum + shape[axis][mode] * column[k], 0);
        largest = Math.max(largest, Math.hypot(along(0), along(1)));
      }
    }
  }
  return largest;
}

/** 10, or 5 where that is much; 1 without a flexible body. */
function chooseMagnification() {
  const shares = player.runs.filter(Boolean).map((one) => findDeflection(one) / Math.max(one.vehicle.box[2] - one.vehicle.box[0], 1e-9));
  const largest = Math.max(...shares);
  if (largest === 0) return 1;
  return 10 * largest > MUCH ? 5 : 10;
}

function setMagnification(value) {
  player.magnification = value;
  byId("magnification").value = String(value);
  byId("magnification-value").textContent = `× ${value}`;
  byId("magnification").setAttribute("aria-valuetext", `${value} times`);
}

function connectControls() {
  const scrubber = byId("scrubber");
  Object.assign(scrubber, {min: clock.first, max: clock.last, step: 0.001, value: clock.first});
  scrubber.addEventListener("input", () => clock.set(Number(scrubber.value)));
  byId("main-run").addEventListener("change", (event) => { player.main = Number(event.target.value); drawScene(); });
  byId("other-run").addEventListener("change", (event) => { player.other = Number(event.target.value); drawScene(); });
  byId("speed").addEventListener("change", (event) => { player.speed = Number(event.target.value); });
  byId("magnification").addEventListener("input", (event) => { setMagnification(Number(event.target.value)); drawScene(); });
  byId("labels").addEventListener("change", (event) => { player.labels = event.target.checked; drawScene(); });
  byId("play").addEventListener("click", () => setPlaying(!player.playing));
  byId("scene").addEventListener("click", () => {
    setPlaying(!player.playing);
    scrubber.focus({preventScroll: true});  // which the keys are for
  });
  byId("player").addEventListener("keydown", (event) => {
    const typing = /^(SELECT|BUTTON)$/.test(event.target.tagName) || event.target.type === "checkbox";
    if (event.key === " " && !typing) {
      event.preventDefault();
      setPlaying(!player.playing);
    }
  });
  byId("scene-png").addEventListener("click", () => saveCanvas("scene"));
  byId("scene-webm").hidden = !canRecord();
  byId("scene-webm").addEventListener("click", (event) => recordAnimation(event.currentTarget));
}

function makePlayer() {
  player.runs = data.runs.map((run, index) => (run.frames ? prepareRun(run, index) : null));
  player.flexible = player.runs.some((one) => one && one.run.modes.length);
  const drawn = player.runs.filter(Boolean), options = drawn.map(({index, run}) => ({value: String(index), label: run.label}));
  byId("unknown-note").textContent = data.runs.filter((run) => !run.frames)
    .map((run) => `${run.label} is not drawn: its file does not hold the motion of ${run.unknown.join(", ")}.`).join(" ");
  byId("player").hidden = !drawn.length;
  if (!drawn.length) return;
  fillSelect(byId("main-run"), options);
  fillSelect(byId("other-run"), [{value: "-1", label: "no other run"}, ...options]);
  // The second run in front of the first: what differs from the first is what one wants to see.
  player.main = drawn[Math.min(1, drawn.length - 1)].index;
  player.other = drawn.length > 1 ? drawn[0].index : -1;
  byId("main-run").value = String(player.main);
  byId("other-run").value = String(player.other);
  byId("magnify").hidden = !player.flexible;
  setMagnification(chooseMagnification());
  connectControls();
  clock.listeners.push(drawScene);
  redraws.push(drawScene);
  drawScene();
}
