"use strict";
// The vehicle on its road, drawn on a canvas from the runs' frames.

const ROOM = 1.55;  // width of the view in vehicle lengths, on a wide screen
const THUMB = 8;    // half the width of the scrubber's handle, px
const EDGE = 12;    // between the view's edge and the vehicle, px
const COILS = 5;    // of a spring
const COIL = 0.02, BLOCK = 0.02;  // of the vehicle's size: half a coil's width at most, half the side of a body that is a point

/** A run's numbers unpacked for drawing. */
function prepareRun(run, index) {
  const unpackAll = (columns) => columns.map(decode);
  const map = (object, convert) => Object.fromEntries(Object.entries(object).map(([name, value]) => [name, convert(value)]));
  const frames = run.frames;
  const tyres = map(frames.tyres, (one) => ({contact: decode(one.contact), force: decode(one.force), off: decode(one.off)}));
  const largest = Math.max(1, ...Object.values(tyres).map((one) => one.force.reduce((a, b) => Math.max(a, b), 0)));
  return {
    index, run, frames, vehicle: run.vehicle, tyres, largest, places: map(frames.places, unpackAll),
    amplitudes: map(frames.amplitudes, unpackAll), road: run.road && {...run.road, x: decode(run.road.x), h: decode(run.road.h)},
  };
}

/** Value of a column between frames. */
function between(column, at) {
  const k = Math.min(Math.floor(at), column.length - 2);
  return column[k] + (at - k) * (column[k + 1] - column[k]);
}

function frameAt(prepared, time) {
  const {first, last, count} = prepared.frames;
  return (count - 1) * Math.min(Math.max((time - first) / (last - first), 0), 1);
}

/** World positions of a body's nodes [[x, y] …] with deflections magnified. */
function nodesOf(prepared, body, at, magnification) {
  const [x, y, angle] = prepared.places[body.name].map((column) => between(column, at));
  const c = Math.cos(angle), s = Math.sin(angle);
  const eta = (prepared.amplitudes[body.name] || []).map((column) => magnification * between(column, at));
  return body.places.map(([px, py], node) => {
    let u = px, v = py;
    eta.forEach((amplitude, mode) => {
      u += body.shapes[node][0][mode] * amplitude;
      v += body.shapes[node][1][mode] * amplitude;
    });
    return [x + c * u - s * v, y + s * u + c * v];
  });
}

function heightOfRoad(road, x) {
  if (!road || road.x.length < 2) return 0;
  let low = 0, high = road.x.length - 1;
  if (x <= road.x[0]) return road.h[0];
  if (x >= road.x[high]) return road.h[high];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (road.x[middle] <= x) low = middle; else high = middle;
  }
  return road.h[low] + (x - road.x[low]) / (road.x[high] - road.x[low]) * (road.h[high] - road.h[low]);
}

/** The height of a vehicle's highest point, m. */
function findTop(prepared, at) {
  let top = -Infinity;
  for (const body of prepared.vehicle.bodies) {
    const nodes = nodesOf(prepared, body, at, 1);
    for (const [, y] of nodes) top = Math.max(top, y);
    for (const wheel of prepared.vehicle.wheels) if (wheel.body === body.name) top = Math.max(top, nodes[wheel.node][1] + wheel.radius);
  }
  return top;
}

/** Position and scale of the view: world metres → pixels. The view shows a mechanism whole, and follows a vehicle. */
function makeView(prepared, at, width, height) {
  const [x0, y0, x1, y1] = prepared.vehicle.box;
  if (!prepared.vehicle.wheels.length) {
    const scale = 0.88 * Math.min(width / Math.max(x1 - x0, 1e-6), height / Math.max(y1 - y0, 1e-6));
    return {
      scale, width, height, left: 0.5 * (x0 + x1 - width / scale), right: 0.5 * (x0 + x1 + width / scale),
      X: (wx) => 0.5 * width + scale * (wx - 0.5 * (x0 + x1)), Y: (wy) => 0.5 * height - scale * (wy - 0.5 * (y0 + y1)),
    };
  }
  const length = Math.max(x1 - x0, 1e-3), tall = Math.max(y1 - y0, 1e-3);
  const scale = Math.min(width / ((width < 560 ? 1.15 : ROOM) * length), height / (2.1 * tall));
  const bx = between(prepared.places[prepared.vehicle.main][0], at), startX = prepared.places[prepared.vehicle.main][0][0];
  const x = bx + 0.5 * (x0 + x1) - startX;
  let ground = 0;
  for (let k = -4; k <= 4; ++k) ground += heightOfRoad(prepared.road, x + k * length / 4) / 9;
  const top = 0.8 * height - scale * (findTop(prepared, at) - ground);  // of the vehicle, px
  const base = 0.8 * height + Math.max(0, EDGE - top);  // a vehicle that flies high takes the view along
  return {
    scale, width, height, left: x - 0.5 * width / scale, right: x + 0.5 * width / scale,
    X: (wx) => 0.5 * width + scale * (wx - x), Y: (wy) => base - scale * (wy - ground),
  };
}

function drawRoad(context, view, road) {
  const points = [[view.left, heightOfRoad(road, view.left)]];
  if (road) {
    for (let k = 0; k < road.x.length; ++k) if (road.x[k] > view.left && road.x[k] < view.right) points.push([road.x[k], road.h[k]]);
  }
  points.push([view.right, heightOfRoad(road, view.right)]);
  context.beginPath();
  points.forEach(([x, y], k) => (k ? context.lineTo(view.X(x), view.Y(y)) : context.moveTo(view.X(x), view.Y(y))));
  context.strokeStyle = style("--ground-line");
  context.lineWidth = 2;
  context.stroke();
  context.lineTo(view.width + 2, view.height);
  context.lineTo(-2, view.height);
  context.closePath();
  context.fillStyle = style("--ground");
  context.fill();
}

/** Distances along the road, where the results tell its direction. */
function drawDistances(context, view, road) {
  if (!road || !road.direction) return;
  const step = [0.5, 1, 2, 5, 10, 20, 50].find((one) => one * view.scale > 60) || 100;
  const along = (x) => road.direction * x - road.origin;
  const [from, to] = [along(view.left), along(view.right)].sort((a, b) => a - b);
  context.fillStyle = context.strokeStyle = style("--soft");
  context.lineWidth = 1;
  context.font = "11px system-ui, sans-serif";
  context.textAlign = "center";
  for (let k = Math.ceil(from / step); k * step <= to; ++k) {
    const x = view.X((k * step + road.origin) / road.direction);
    if (x < 20 || x > view.width - 20) continue;
    context.beginPath();
    context.moveTo(x, view.height - 20);
    context.lineTo(x, view.height - 15);
    context.stroke();
    context.fillText(`${formatTick(k * step)} m`, x, view.height - 4);
  }
}

function drawWheel(context, view, wheel, centre, colour, contact, share, alpha) {
  const [x, y] = [view.X(centre[0]), view.Y(centre[1])], radius = view.scale * wheel.radius;
  context.globalAlpha = alpha;
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fillStyle = contact ? colour + "22" : style("--bad") + "22";
  context.fill();
  context.strokeStyle = contact ? colour : style("--bad");
  context.lineWidth = contact ? 3.5 : 2.5;
  context.setLineDash(contact ? [] : [7, 5]);
  context.stroke();
  context.setLineDash([]);
  context.beginPath();
  context.arc(x, y, Math.max(3, 0.12 * radius), 0, 2 * Math.PI);
  context.fillStyle = colour;
  context.fill();
  if (contact) {
    const half = Math.max(4, 0.16 * radius), bottom = y + radius;
    context.fillStyle = style("--good");
    context.fillRect(x - half, bottom + 3, 2 * half, Math.max(2, 0.9 * radius * share));
  }
}

function drawSpring(context, view, [ax, ay], [bx, by], size) {
  const length = Math.hypot(bx - ax, by - ay) || 1, across = Math.min(COIL * size, 0.12 * length);
  const nx = -(by - ay) / length * across, ny = (bx - ax) / length * across;
  context.beginPath();
  context.moveTo(view.X(ax), view.Y(ay));
  for (let k = 0; k <= 2 * COILS; ++k) {
    const s = 0.15 + 0.7 * k / (2 * COILS), side = k === 0 || k === 2 * COILS ? 0 : k % 2 ? 1 : -1;
    context.lineTo(view.X(ax + s * (bx - ax) + side * nx), view.Y(ay + s * (by - ay) + side * ny));
  }
  context.lineTo(view.X(bx), view.Y(by));
  context.stroke();
}

function drawLine(context, view, [ax, ay], [bx, by]) {
  context.beginPath();
  context.moveTo(view.X(ax), view.Y(ay));
  context.lineTo(view.X(bx), view.Y(by));
  context.stroke();
}

/** A body all of whose points are one. */
function drawBlock(context, view, [x, y], half, colour) {
  context.fillStyle = colour;
  context.fillRect(view.X(x - half), view.Y(y + half), 2 * half * view.scale, 2 * half * view.scale);
}

/** Draws one vehicle. Returns the states of its tyres, for the text below. */
function drawVehicle(context, view, prepared, time, magnification, alpha) {
  const at = frameAt(prepared, time), colour = colourOf(prepared.index), vehicle = prepared.vehicle;
  const nodes = Object.fromEntries(vehicle.bodies.map((body) => [body.name, nodesOf(prepared, body, at, magnification)]));
  const end = ([name, place]) => (name === null ? place : nodes[name][place]);
  context.lineCap = context.lineJoin = "round";
  const told = [], [x0, y0, x1, y1] = vehicle.box, size = Math.max(x1 - x0, y1 - y0);
  for (const wheel of vehicle.wheels) {
    const tyre = prepared.tyres[wheel.name];
    const contact = tyre.contact[Math.round(at)] > 0.5, force = between(tyre.force, at);
    drawWheel(context, view, wheel, nodes[wheel.body][wheel.node], colour, contact, force / prepared.largest, alpha);
    told.push(`${wheel.name} ${contact ? `on the road, ${format(force / 1e3, 3)} kN` : "off the road"}`);
  }
  context.globalAlpha = alpha;
  context.strokeStyle = colour;
  context.lineWidth = 1.5;
  for (const link of vehicle.links) if (link.kind === "spring") drawSpring(context, view, end(link.ends[0]), end(link.ends[1]), size);
  for (const body of vehicle.bodies) {
    if (!body.lines.length) drawBlock(context, view, nodes[body.name][0], BLOCK * size, colour);
    body.lines.forEach(([a, b], number) => {
      const hanging = body.elements && number >= body.elements;
      context.lineWidth = hanging ? 2 : body.elements ? 6 : 4;
      drawLine(context, view, nodes[body.name][a], nodes[body.name][b]);
    });
  }
  context.fillStyle = style("--card");
  context.lineWidth = 1.5;
  for (const link of vehicle.links) if (link.kind === "rod") drawLine(context, view, end(link.ends[0]), end(link.ends[1]));
  for (const link of vehicle.links) {
    if (link.kind !== "joint") continue;
    const [x, y] = end(link.ends[0]);
    context.beginPath();
    context.arc(view.X(x), view.Y(y), 3.5, 0, 2 * Math.PI);
    context.fill();
    context.stroke();
  }
  for (const mark of vehicle.marks) {
    const [x, y] = nodes[mark.body][mark.node];
    context.beginPath();
    context.arc(view.X(x), view.Y(y), 6, 0, 2 * Math.PI);
    context.fillStyle = colour;
    context.fill();
  }
  context.globalAlpha = 1;
  return told;
}

const player = {runs: [], main: 0, other: -1, magnification: 1, speed: 1, playing: false, before: 0};

function drawScene() {
  const canvas = byId("scene");
  const {context, width, height} = prepareCanvas(canvas, Math.round(Math.min(Math.max(0.46 * canvas.clientWidth, 230), 430)));
  const main = player.runs[player.main];
  const view = makeView(main, frameAt(main, clock.time), width, height);
  player.view = view;
  if (main.vehicle.wheels.length) {
    drawRoad(context, view, main.road);
    drawDistances(context, view, main.road);
  }
  if (player.other >= 0) drawVehicle(context, view, player.runs[player.other], clock.time, player.magnification, 0.6);
  const told = drawVehicle(context, view, main, clock.time, player.magnification, 1);
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
  if (playing) requestAnimationFrame(advance);
}

function advance(now) {
  if (!player.playing) return;
  const elapsed = Math.min(Math.max(now - player.before, 0), 100) / 1e3;
  player.before = now;
  clock.set(clock.time + player.speed * elapsed);
  if (clock.time >= clock.last) setPlaying(false); else requestAnimationFrame(advance);
}

function makePlayer() {
  player.runs = data.runs.map(prepareRun);
  const options = data.runs.map((run, index) => ({value: String(index), label: run.label}));
  fillSelect(byId("main-run"), options);
  fillSelect(byId("other-run"), [{value: "-1", label: "no other run"}, ...options]);
  // The second run is drawn in front of the first, so that differences from the first are visible.
  player.main = data.runs.length > 1 ? 1 : 0;
  player.other = data.runs.length > 1 ? 0 : -1;
  byId("main-run").value = String(player.main);
  byId("other-run").value = String(player.other);
  const scrubber = byId("scrubber");
  Object.assign(scrubber, {min: clock.first, max: clock.last, step: 0.001, value: clock.first});
  scrubber.addEventListener("input", () => clock.set(Number(scrubber.value)));
  byId("main-run").addEventListener("change", (event) => { player.main = Number(event.target.value); drawScene(); });
  byId("other-run").addEventListener("change", (event) => { player.other = Number(event.target.value); drawScene(); });
  byId("speed").addEventListener("change", (event) => { player.speed = Number(event.target.value); });
  byId("magnification").addEventListener("input", (event) => {
    player.magnification = Number(event.target.value);
    byId("magnification-value").textContent = `× ${event.target.value}`;
    event.target.setAttribute("aria-valuetext", `${event.target.value} times`);
    drawScene();
  });
  byId("play").addEventListener("click", () => setPlaying(!player.playing));
  byId("scene").addEventListener("click", () => setPlaying(!player.playing));
  byId("player").addEventListener("keydown", (event) => {
    const typing = /^(SELECT|BUTTON)$/.test(event.target.tagName);
    if (event.key === " " && !typing) {
      event.preventDefault();
      setPlaying(!player.playing);
    }
  });
  clock.listeners.push(drawScene);
  drawScene();
}
