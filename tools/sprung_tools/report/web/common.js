"use strict";
// What all parts of a page share: the data, colours, units, numbers.

const data = JSON.parse(document.getElementById("data").textContent);
const byId = (id) => document.getElementById(id);
const dark = matchMedia("(prefers-color-scheme: dark)");

/** base64 of little-endian float32 → Float32Array. */
function decode(text) {
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return new Float32Array(bytes.buffer);
}

/** Okabe and Ito's colours, which stay apart for colour-blind readers, each for light and dark paper. */
const PALETTE = [["#111111", "#f2f2f2"], ["#0072b2", "#56b4e9"], ["#d98600", "#f0a830"], ["#00875f", "#2fd09a"],
                 ["#b0588f", "#e592c6"], ["#c2410c", "#ff8a4c"], ["#6b5bd2", "#a99cff"], ["#5f6b76", "#aab4bd"]];
const colourOf = (index) => PALETTE[index % PALETTE.length][dark.matches ? 1 : 0];
const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** A unit as it is printed. */
const printUnit = (unit) => unit.replace("^1.75", "¹·⁷⁵").replace("^2", "²").replace("^3", "³");

/** A unit as it is printed, and the factor of its numbers that makes their size readable. */
function readable(unit, peak) {
  if (unit === "m" && peak < 1) return {unit: "mm", factor: 1e3};
  if (["N", "N m", "J"].includes(unit) && peak >= 1e3) return {unit: `k${unit}`, factor: 1e-3};
  if (unit === "Pa") return {unit: "MPa", factor: 1e-6};
  if (unit === "rad") return {unit: "°", factor: 180 / Math.PI};
  return {unit: printUnit(unit), factor: 1};
}

/** Four digits; powers of ten only where they are needed. */
function format(value, digits = 4) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-3) return value.toExponential(Math.max(digits - 3, 1)).replaceAll("-", "−");
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return value.toFixed(Number.isInteger(value) ? 0 : Math.min(decimals, 6)).replace("-", "−");
}

/** The values that an axis is marked at, without needless zeros. */
const formatTick = (value) => {
  const rounded = Number(value.toPrecision(6));
  return (Math.abs(rounded) < 1e7 ? String(rounded) : rounded.toExponential().replace("e+", "e")).replaceAll("-", "−");
};

/** An element with text or children. */
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

function fillSelect(select, options) {
  select.replaceChildren();
  const groups = new Map();
  for (const {value, label, group} of options) {
    let parent = select;
    if (group) {
      if (!groups.has(group)) {
        groups.set(group, element("optgroup", {label: group}));
        select.append(groups.get(group));
      }
      parent = groups.get(group);
    }
    parent.append(element("option", {value}, label));
  }
}

/** A canvas made as sharp as the screen. Returns its context with units of CSS pixels, and its size. */
function prepareCanvas(canvas, height) {
  const width = canvas.clientWidth;
  const ratio = window.devicePixelRatio || 1;
  canvas.style.height = `${height}px`;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  return {context, width, height};
}
