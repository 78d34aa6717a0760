"use strict";
// What part of the world the scene shows, and the road in it.

const ROOM = 1.3;  // width of the view in vehicle lengths, on a wide screen
const EDGE = 12;    // between the view's edge and the vehicle, px
const BAR = 36;     // of the largest force of a tyre at most, px
const BELOW = BAR + 26;  // from the ground to the lower edge: below the bars stand the distances, px
const LEAST_HEIGHT = 160, MOST_HEIGHT = 460;  // of the scene, px
const MOST_RISE = 0.6;  // of the vehicle's height: room kept above it for its jumps

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

/** How high the vehicle rises above its height at the start during the run, m, from some of the frames. */
function findRise(prepared) {
  const column = prepared.places[prepared.vehicle.main][1], every = Math.max(1, Math.floor(column.length / 500));
  let rise = 0;
  for (let k = 0; k < column.length; k += every) rise = Math.max(rise, column[k] - column[0]);
  return rise;
}

/** The box [x0, y0, x1, y1] around the vehicles of all runs shown, as they stand at the start; m. */
function boxOfAll(shown) {
  const ends = (find, corner) => find(...shown.map((one) => one.vehicle.box[corner]));
  return [ends(Math.min, 0), ends(Math.min, 1), ends(Math.max, 2), ends(Math.max, 3)];
}

/** The scene's height for its width, px, and how large vehicles are drawn, px/m: as large as the width allows. shown: the run that
 * the view follows, and the one that it is overlaid with; room: kept above them, px. */
function fitScene(shown, width, room) {
  const [x0, y0, x1, y1] = boxOfAll(shown), length = Math.max(x1 - x0, 1e-3), tall = Math.max(y1 - y0, 1e-3);
  if (!shown[0].vehicle.wheels.length) {
    const height = Math.min(Math.max(0.88 * width * tall / length + 30, LEAST_HEIGHT), MOST_HEIGHT);
    return {height: Math.round(height + room), scale: 0.88 * Math.min(width / Math.max(x1 - x0, 1e-6), height / Math.max(y1 - y0, 1e-6))};
  }
  const seen = tall + Math.min(Math.max(...shown.map(findRise)), MOST_RISE * tall);
  const widest = width / ((width < 560 ? 1.12 : ROOM) * length);
  const height = Math.min(Math.max(widest * seen + BELOW + 3 * EDGE, LEAST_HEIGHT), MOST_HEIGHT);
  return {height: Math.round(height + room), scale: Math.min(widest, (height - BELOW - 3 * EDGE) / seen)};
}

/** World metres → pixels. A mechanism is seen whole from one place, a vehicle is followed. */
function makeView(shown, time, width, height, scale, room) {
  const prepared = shown[0], at = frameAt(prepared, time), [x0, y0, x1, y1] = boxOfAll(shown);
  if (!prepared.vehicle.wheels.length) {
    return {
      scale, width, height, room, left: 0.5 * (x0 + x1 - width / scale), right: 0.5 * (x0 + x1 + width / scale),
      X: (wx) => 0.5 * width + scale * (wx - 0.5 * (x0 + x1)), Y: (wy) => 0.5 * (height + room) - scale * (wy - 0.5 * (y0 + y1)),
    };
  }
  const length = Math.max(x1 - x0, 1e-3);
  const bx = between(prepared.places[prepared.vehicle.main][0], at), startX = prepared.places[prepared.vehicle.main][0][0];
  const x = bx + 0.5 * (x0 + x1) - startX;
  let ground = 0;
  for (let k = -4; k <= 4; ++k) ground += heightOfRoad(prepared.road, x + k * length / 4) / 9;
  const top = height - BELOW - scale * (Math.max(...shown.map((one) => findTop(one, frameAt(one, time)))) - ground);  // of the vehicles, px
  const edge = room > 0 ? LABEL_TOP + room + EDGE : EDGE;
  const base = height - BELOW + Math.max(0, edge - top);  // a vehicle that flies high takes the view along
  return {
    scale, width, height, room, left: x - 0.5 * width / scale, right: x + 0.5 * width / scale,
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

/** Distances along the road, where the results tell its direction; edged, as where it falls the bar of a tyre's force lies behind them. */
function drawDistances(context, view, road) {
  if (!road || !road.direction) return;
  const step = [0.5, 1, 2, 5, 10, 20, 50].find((one) => one * view.scale > 60) || 100;
  const along = (x) => road.direction * x - road.origin;
  const [from, to] = [along(view.left), along(view.right)].sort((a, b) => a - b);
  context.fillStyle = style("--soft");
  context.strokeStyle = style("--ground");
  context.lineWidth = 4;
  context.lineJoin = "round";
  context.font = "11px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "alphabetic";
  for (let k = Math.ceil(from / step); k * step <= to; ++k) {
    const x = view.X((k * step + road.origin) / road.direction);
    if (x < 20 || x > view.width - 20) continue;
    const text = `${formatTick(k * step)} m`, y = view.height - 4;
    context.strokeText(text, x, y);
    context.fillText(text, x, y);
    context.fillRect(x - 0.5, view.height - 20, 1, 5);
  }
}

/** The name of a run whose vehicle has left the view, at the edge where it did: it drives another way, or at another speed. */
function nameBeyond(context, view, prepared, time) {
  const x = view.X(between(prepared.places[prepared.vehicle.main][0], frameAt(prepared, time))), name = prepared.run.label;
  if (x >= 0 && x <= view.width) return "";
  context.font = "12px system-ui, sans-serif";
  context.textBaseline = "middle";
  context.textAlign = "left";
  const text = x < 0 ? `← ${name}` : `${name} →`;
  drawPlate(context, text, x < 0 ? 8 : view.width - 8 - context.measureText(text).width, view.height - BELOW - 20, colourOf(prepared.index));
  return text;
}

/** Which way the vehicle travels, and by how much deflections are magnified. */
function drawCaptions(context, view, vehicle, magnification) {
  context.save();
  context.font = "12px system-ui, sans-serif";
  context.textBaseline = "middle";
  context.textAlign = "left";
  context.fillStyle = context.strokeStyle = style("--soft");
  if (vehicle.wheels.length) {
    const forward = vehicle.heading === "+x", [from, to] = forward ? [12, 52] : [52, 12], back = forward ? -7 : 7;
    context.lineWidth = 1.5;
    drawStroke(context, [[from, 16], [to, 16]]);
    drawStroke(context, [[to + back, 11], [to, 16], [to + back, 21]]);
    context.fillText("travel", 60, 16);
  }
  if (player.flexible) {
    context.textAlign = "right";
    context.fillText(`deflections × ${magnification}`, view.width - 12, 16);
  }
  context.restore();
}
