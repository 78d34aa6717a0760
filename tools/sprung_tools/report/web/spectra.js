"use strict";
// Spectra on logarithmic axes, with the vehicle's frequencies.

const SPECTRUM_DEPTH = 1e-7;  // of the peak: lower values are not drawn
let spectrum = null;  // the diagram
let spectrumNamed = [];  // how many frequencies of each run are named

/** Where a frequency is on the logarithmic axis of the spectra, px from the left of the diagram. */
function placeFrequency(graph, frequency) {
  const {x, w} = graph.getArea();
  const [from, to] = graph.xAxisRange();
  return x + w * Math.log(frequency / from) / Math.log(to / from);
}

/** Marks of a logarithmic axis: powers of ten times these digits. */
function markDecades(digits, print) {
  return (from, to) => {
    const marks = [];
    for (let power = Math.floor(Math.log10(from)); 10 ** power <= to; ++power) {
      for (const digit of digits) {
        const v = digit * Number(`1e${power}`);
        if (v >= from && v <= to) marks.push({v, label: print(v)});
      }
    }
    return marks;
  };
}

/** Dashed lines at the vehicle's frequencies. */
function markFrequencies(context, area, graph) {
  context.save();
  data.runs.forEach((run, index) => {
    const [from, to] = graph.xAxisRange();
    context.strokeStyle = colourOf(index);
    context.globalAlpha = 0.55;
    context.setLineDash([4, 3]);
    for (const {f} of run.vehicleModes.table) {
      if (f < from || f > to) continue;
      const x = placeFrequency(graph, f);
      context.beginPath();
      context.moveTo(x, area.y + 14 * data.runs.length + 2);
      context.lineTo(x, area.y + area.h);
      context.stroke();
    }
  });
  context.restore();
}

/** Names the frequencies above their lines, on the card's colour; where they crowd, only those with room. Returns how many
 * are named for each run. */
function nameFrequencies(graph) {
  const context = graph.hidden_ctx_, area = graph.getArea(), [from, to] = graph.xAxisRange();
  context.save();
  context.font = "11px system-ui, sans-serif";
  context.textBaseline = "middle";
  context.textAlign = "left";
  spectrumNamed = data.runs.map((run, index) => {
    let free = -Infinity, named = 0;
    for (const {f} of run.vehicleModes.table) {
      const x = placeFrequency(graph, f), text = format(f, 3);
      if (f < from || f > to || x < free || x + context.measureText(text).width > area.x + area.w) continue;
      free = x + drawPlate(context, text, x + 2, area.y + 8 + 14 * index, colourOf(index)) + 8;
      ++named;
    }
    return named;
  });
  context.restore();
}

function makeSpectra() {
  const points = [...new Set(data.runs.flatMap((run) => run.spectra.map((one) => one.name)))];
  const chart = makeFigure(byId("spectrum-chart"), "spectrum", true);
  const select = byId("spectrum-point");
  if (!points.length) {
    byId("spectra").hidden = true;
    return;
  }
  fillSelect(select, points.map((value) => ({value, label: value})));
  const draw = () => {
    const series = [], labels = [], colours = [];
    data.runs.forEach((run, index) => {
      const packed = run.spectra.find((one) => one.name === select.value);
      if (!packed) return;
      series.push({t: decode(packed.f), v: decode(packed.p).map((value) => Math.max(value, 1e-30))});
      labels.push(run.label);
      colours.push(colourOf(index));
    });
    const peak = Math.max(...series.map((one) => one.v.reduce((a, b) => Math.max(a, b), 0)));
    removeGraph(chart);
    chart.unit = "(m/s²)²/Hz";
    chart.plot.setAttribute("aria-label", `Spectrum of the acceleration of ${select.value}, ${labels.join(" and ")}`);
    chart.graph = spectrum = new Dygraph(chart.plot, mergeRows(series, series.map(() => 1)), {
      ...commonOptions(chart.legend, "(m/s²)²/Hz"), labels: ["frequency, Hz", ...labels], colors: colours, xlabel: "frequency, Hz",
      ylabel: "(m/s²)²/Hz", underlayCallback: markFrequencies, drawCallback: nameFrequencies,
      axes: {
        x: {logscale: true, valueFormatter: (value) => `${format(value)} Hz`, ticker: markDecades([1, 2, 5], formatTick)},
        y: {logscale: true, axisLabelWidth: 54, ticker: markDecades([1], powerOfTen), valueFormatter: (value) => format(value),
          valueRange: [SPECTRUM_DEPTH * peak, 30 * peak]},  // above the peak: room for the frequencies' names
      },
    });
  };
  select.addEventListener("change", draw);
  redraws.push(draw);
  draw();
}

/** 0.01 → "10⁻²". */
function powerOfTen(value) {
  const exponent = Math.log10(value);
  return `10${String(Math.round(exponent)).replace(/[-\d]/g, (sign) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(sign)])}`;
}
