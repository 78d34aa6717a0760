"use strict";
// Saving: a diagram as CSV and PNG, the animation as WebM where the browser can.

/** Has the browser save a file. */
function saveFile(name, blob) {
  const link = element("a", {href: URL.createObjectURL(blob), download: name});
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);  // when it has long been read
}

/** Saves what the canvas NAME shows as NAME.png. */
function saveCanvas(name) {
  byId(name).toBlob((blob) => saveFile(`${name}.png`, blob), "image/png");
}

const quote = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

/** Rows of numbers and texts with a heading line. A value that is not there is an empty cell. */
const writeCell = (value) => (value === null ? "" : typeof value === "string" ? quote(value) : Number(value.toPrecision(9)));
const writeCsv = (headings, rows) =>
  [headings.map(quote), ...rows.map((row) => row.map(writeCell))]
    .map((row) => row.join(",")).join("\n") + "\n";

function writeGraphCsv(chart) {
  const [first, ...labels] = chart.graph.getLabels();
  return writeCsv([first, ...labels.map((label) => `${label}, ${chart.unit}`)], chart.graph.rawData_);
}

/** A diagram with its axes' texts and its legend on the card's colour, as a canvas. */
function drawGraphPicture(chart) {
  const area = chart.plot.getBoundingClientRect(), ratio = window.devicePixelRatio || 1;
  const entries = placeLegend(chart, area.width), top = 24 + entries[entries.length - 1].y - LEGEND_TOP;
  const picture = element("canvas", {width: Math.round(area.width * ratio), height: Math.round((area.height + top) * ratio)});
  const context = picture.getContext("2d");
  context.scale(ratio, ratio);
  context.fillStyle = style("--card");
  context.fillRect(0, 0, area.width, area.height + top);
  for (const canvas of chart.plot.querySelectorAll("canvas")) context.drawImage(canvas, 0, top, area.width, area.height);
  context.fillStyle = style("--soft");
  context.textBaseline = "middle";
  context.textAlign = "center";
  context.font = "12px system-ui, sans-serif";
  for (const label of chart.plot.querySelectorAll(".dygraph-axis-label, .dygraph-label")) {
    const box = label.getBoundingClientRect(), turned = label.classList.contains("dygraph-ylabel");
    context.save();
    context.translate(box.x + 0.5 * box.width - area.x, box.y + 0.5 * box.height - area.y + top);
    if (turned) context.rotate(-Math.PI / 2);
    context.fillText(label.textContent, 0, 0);
    context.restore();
  }
  context.textAlign = "left";
  entries.forEach(({label, x, y}, k) => {
    context.fillStyle = chart.graph.getColors()[k];
    context.fillRect(x, y - 2, 24, 4);
    context.fillStyle = style("--ink");
    context.fillText(label, x + 30, y);
  });
  return picture;
}

const LEGEND_LEFT = 60, LEGEND_TOP = 12, LEGEND_LINE = 18;  // px

/** Where the names of a diagram's series stand above its picture, in as many lines as they need: [{label, x, y}]. */
function placeLegend(chart, width) {
  const context = element("canvas").getContext("2d");
  context.font = "12px system-ui, sans-serif";
  let x = LEGEND_LEFT, y = LEGEND_TOP;
  return chart.graph.getLabels().slice(1, 1 + chart.named()).map((label) => {
    const length = 46 + context.measureText(label).width;
    if (x > LEGEND_LEFT && x + length > width) {
      x = LEGEND_LEFT;
      y += LEGEND_LINE;
    }
    x += length;
    return {label, x: x - length, y};
  });
}

/** Two small buttons. csv: gives the text; picture: gives a canvas. */
function makeSaveButtons(name, csv, picture) {
  const make = (kind, label, use) => {
    const button = element("button", {type: "button", id: `${name}-${kind}`, class: "save", title: `Save as ${label}`}, label);
    button.addEventListener("click", use);
    return button;
  };
  return element("span", {class: "saves"},
    make("csv", "CSV", () => saveFile(`${name}.csv`, new Blob([csv()], {type: "text/csv"}))),
    make("png", "PNG", () => picture().toBlob((blob) => saveFile(`${name}.png`, blob), "image/png")));
}

const VIDEO = "video/webm";
const canRecord = () => typeof MediaRecorder === "function" && typeof HTMLCanvasElement.prototype.captureStream === "function" &&
  MediaRecorder.isTypeSupported(VIDEO);

/** Plays the run from its beginning, and offers for saving what the scene showed until playing ended. */
function recordAnimation(button) {
  const parts = [], recorder = new MediaRecorder(byId("scene").captureStream(), {mimeType: VIDEO});
  recorder.ondataavailable = (event) => { if (event.data.size) parts.push(event.data); };
  const file = byId("scene-file");
  if (file.href) URL.revokeObjectURL(file.href);
  file.hidden = true;
  recorder.onstop = () => {  // a link, since browsers save only what a hand asks for
    file.href = URL.createObjectURL(new Blob(parts, {type: VIDEO}));
    file.hidden = false;
    button.textContent = "Record WebM";
    button.disabled = false;
  };
  button.textContent = "Recording …";
  button.disabled = true;
  setPlaying(false);
  clock.set(clock.first);
  recorder.start();
  player.onStop = () => recorder.stop();
  setPlaying(true);
}
