"use strict";
// Where bodies and road are at a time, from the runs' frames.

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
