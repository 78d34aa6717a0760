"use strict";
// A vehicle on a canvas, from the places of its nodes.

const COILS = 5;    // of a spring
const COIL = 0.02;  // of the vehicle's size: half a coil's width at most
const MASS = 7;     // radius of the sign for a body that is a point, px
const LABEL_FONT = "11px system-ui, sans-serif", LABEL_GAP = 8, LABEL_ROW = 16, LABEL_TOP = 26, LABEL_EDGE = 4;  // px; LABEL_TOP is below the captions
const LOOSELY = 1.4, LEAST_LABEL_ROWS = 3, MOST_LABEL_ROWS = 9;  // the first: room in the rows over the names' own width

function drawWheel(context, view, wheel, centre, colour, contact) {
  const [x, y] = [view.X(centre[0]), view.Y(centre[1])], radius = view.scale * wheel.radius;
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
}

/** The bar below a tyre on the road, as long as its force: above the distances, unless the road falls. */
function drawTyreForce(context, view, wheel, centre, share) {
  const radius = view.scale * wheel.radius, half = Math.max(4, 0.16 * radius);
  context.fillStyle = style("--good");
  context.fillRect(view.X(centre[0]) - half, view.Y(centre[1]) + radius + 3, 2 * half, Math.max(2, Math.min(0.9 * radius, BAR) * share));
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

/** The sign of a mass: a circle, two quarters of which are filled. */
function drawMass(context, view, [x, y], colour) {
  const [px, py] = [view.X(x), view.Y(y)];
  context.fillStyle = style("--card");
  context.beginPath();
  context.arc(px, py, MASS, 0, 2 * Math.PI);
  context.fill();
  context.fillStyle = colour;
  for (const start of [0, Math.PI]) {
    context.beginPath();
    context.moveTo(px, py);
    context.arc(px, py, MASS, start, start + 0.5 * Math.PI);
    context.fill();
  }
  context.lineWidth = 1.5;
  context.beginPath();
  context.arc(px, py, MASS, 0, 2 * Math.PI);
  context.stroke();
}

/** The corners of the convex hull of places [[x, y] …], as numbers of places. [Andrew's monotone chain] */
function findHull(places) {
  const order = places.map((_, k) => k).sort((a, b) => places[a][0] - places[b][0] || places[a][1] - places[b][1]);
  const turn = (a, b, c) => (places[b][0] - places[a][0]) * (places[c][1] - places[a][1]) - (places[b][1] - places[a][1]) * (places[c][0] - places[a][0]);
  const size = Math.max(...places.flat().map(Math.abs), 1e-9);
  const half = (list) => {
    const chain = [];
    for (const k of list) {
      while (chain.length > 1 && turn(chain[chain.length - 2], chain[chain.length - 1], k) <= 1e-9 * size * size) chain.pop();
      chain.push(k);
    }
    return chain.slice(0, -1);
  };
  return [...half(order), ...half(order.reverse())];
}

const hulls = new Map();
/** A rigid body's hull; kept. */
function hullOf(body) {
  if (!hulls.has(body)) hulls.set(body, findHull(body.places));
  return hulls.get(body);
}

/** A body that moves as a whole: its hull and its points, or the sign of a mass if all its points are one. */
function drawRigid(context, view, body, nodes, colour) {
  const hull = hullOf(body);
  if (hull.length < 2) return drawMass(context, view, nodes[0], colour);
  context.lineWidth = hull.length > 2 ? 2.5 : 4;
  context.beginPath();
  hull.forEach((node, k) => (k ? context.lineTo : context.moveTo).call(context, view.X(nodes[node][0]), view.Y(nodes[node][1])));
  context.closePath();
  if (hull.length > 2) {
    context.fillStyle = colour + "33";
    context.fill();
  }
  context.stroke();
  context.fillStyle = colour;
  for (const [x, y] of nodes) context.fillRect(view.X(x) - 2, view.Y(y) - 2, 4, 4);
  return undefined;
}

/** A body with modes: its elements, and lines to points beside them. One from matrices has no elements: its nodes. */
function drawFlexible(context, view, body, nodes, colour) {
  body.lines.forEach(([a, b], number) => {
    context.lineWidth = number >= body.elements ? 2 : 6;
    drawLine(context, view, nodes[a], nodes[b]);
  });
  context.fillStyle = colour;
  if (!body.elements) for (const [x, y] of nodes) context.fillRect(view.X(x) - 3, view.Y(y) - 3, 6, 6);
}

/** Bodies, springs, rods, joints and monitored points of a vehicle whose nodes {body: [[x, y] …]} are known. */
function drawBodies(context, view, vehicle, nodes, colour) {
  const end = ([name, place]) => (name === null ? place : nodes[name][place]);
  const [x0, y0, x1, y1] = vehicle.box, size = Math.max(x1 - x0, y1 - y0);
  context.lineCap = context.lineJoin = "round";
  context.strokeStyle = colour;
  context.lineWidth = 1.5;
  for (const link of vehicle.links) if (link.kind === "spring") drawSpring(context, view, end(link.ends[0]), end(link.ends[1]), size);
  for (const body of vehicle.bodies) {
    const hasModes = body.shapes[0][0].length > 0;
    (body.elements || hasModes ? drawFlexible : drawRigid)(context, view, body, nodes[body.name], colour);
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
  context.fillStyle = colour;
  for (const mark of vehicle.marks) {
    const [x, y] = nodes[mark.body][mark.node];
    context.beginPath();
    context.arc(view.X(x), view.Y(y), 6, 0, 2 * Math.PI);
    context.fill();
  }
}

/** What has a name: monitored points, tyres, bodies, each with its place. */
function listNamed(vehicle, nodes) {
  return [
    ...vehicle.marks.map((mark) => [mark.name, nodes[mark.body][mark.node]]),
    ...vehicle.wheels.map((wheel) => [wheel.name, nodes[wheel.body][wheel.node]]),
    ...vehicle.bodies.map((body) => [body.name, middleOf(nodes[body.name])]),
  ];
}

/** The height that the names need above the vehicle in a scene of this width, px. */
function roomForLabels(vehicle, width) {
  const context = byId("scene").getContext("2d");
  context.save();
  context.font = LABEL_FONT;
  const names = [...vehicle.marks, ...vehicle.wheels, ...vehicle.bodies].map((one) => context.measureText(one.name).width + LABEL_GAP);
  context.restore();
  const rows = Math.ceil(LOOSELY * names.reduce((sum, one) => sum + one, 0) / width);
  return LABEL_ROW * Math.min(Math.max(rows, Math.min(names.length, LEAST_LABEL_ROWS)), MOST_LABEL_ROWS);
}

/** Where in a row with other names a name of some width is nearest to where it wants to begin, px; null where there is no room. */
function findRoom(others, wanted, width, end) {
  const starts = [wanted, ...others.flatMap((one) => [one.x - width - LABEL_GAP, one.x + one.width + LABEL_GAP])];
  const isFree = (x) => x >= LABEL_EDGE && x <= end && others.every((one) => one.x >= x + width + LABEL_GAP || x >= one.x + one.width + LABEL_GAP);
  const free = starts.map((x) => Math.round(x)).filter(isFree);
  return free.length ? free.reduce((best, x) => (Math.abs(x - wanted) < Math.abs(best - wanted) ? x : best)) : null;
}

/** Names in rows above the vehicle, where they hide none of it, each with a line to its place: as far down as they have room beside
 * each other, and no farther from above their places than needed; those without room anywhere are left out.
 * Returns what is drawn: names with x, y of the middle of their left edge and width, px, and what their lines go to. */
function drawLabels(context, view, vehicle, nodes) {
  const drawn = [];
  context.save();
  context.font = LABEL_FONT;
  context.textBaseline = "middle";
  context.textAlign = "left";
  for (const [name, [wx, wy]] of listNamed(vehicle, nodes)) {
    const to = [view.X(wx), view.Y(wy)], width = Math.ceil(context.measureText(name).width), end = view.width - width - LABEL_EDGE;
    const wanted = Math.round(Math.max(Math.min(to[0] - 0.5 * width, end), LABEL_EDGE));
    let best = null;
    for (let y = LABEL_TOP + view.room - 0.5 * LABEL_ROW, row = 0; y > LABEL_TOP; y -= LABEL_ROW, ++row) {
      const x = findRoom(drawn.filter((one) => one.y === y), wanted, width, end);
      const far = x === null ? Infinity : Math.max(Math.abs(x - wanted) - 0.5 * (width + LABEL_GAP), 0) + LABEL_ROW * row;
      if (far < (best ? best.far : Infinity)) best = {x, y, far};
    }
    if (best) drawn.push({name, x: best.x, y: best.y, width, to});
  }
  context.strokeStyle = style("--soft");
  context.lineWidth = 1;
  for (const {x, y, width, to} of drawn) drawStroke(context, [[Math.min(Math.max(to[0], x), x + width), y], to]);
  for (const {name, x, y} of drawn) drawPlate(context, name, x, y, style("--ink"));
  context.restore();
  return drawn;
}

function middleOf(places) {
  const mean = (axis) => places.reduce((sum, place) => sum + place[axis], 0) / places.length;
  return [mean(0), mean(1)];
}
