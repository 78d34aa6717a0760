"use strict";
// The tables: summary, frequencies, checks, the runs' settings.

/** Rows of all runs by their subject and their name: [{of, name, unit, values: [one a run, or null]}]. */
function collectStatistics() {
  const rows = new Map();
  data.runs.forEach((run, index) => {
    for (const row of run.statistics) {
      const key = `${row.of}\u0000${row.name}`;
      if (!rows.has(key)) rows.set(key, {...row, values: data.runs.map(() => null), steps: data.runs.map(() => 0)});
      rows.get(key).values[index] = row.value;
      rows.get(key).steps[index] = row.step;
    }
  });
  return [...rows.values()];
}

function runHeadings() {
  return data.runs.map((run, index) =>
    element("th", {class: "number", scope: "col"}, element("span", {class: "key", style: `--c:${colourOf(index)}`}), run.label));
}

/** Whether the numbers of a run are over the same span of time as those of the first. */
const sameSpan = (index) => data.runs[index].window.every((time, k) => Math.abs(time - data.runs[0].window[k]) < 1e-6);

/** The spans of time that the numbers of the tables are over, with the runs where these differ. */
function describeSpans() {
  const print = (run) => `${run.window.map(formatTick).join(" to ")} s`;
  if (data.runs.every((_, index) => sameSpan(index))) return `${print(data.runs[0])}.`;
  return `spans that differ: ${data.runs.map((run) => `${run.label} ${print(run)}`).join("; ")}. Where a run's span is not that of ` +
    `${data.runs[0].label}, no difference in per cent is given.`;
}

/** The difference to the first run, in per cent; nothing where the first is nearly 0. */
function difference(value, first) {
  if (value === null || first === null || Math.abs(first) < 1e-12) return "";
  const percent = 100 * (value / first - 1);
  if (!Number.isFinite(percent) || Math.abs(percent) > 999) return "";
  return `${percent < 0 ? "−" : "+"}${Math.abs(percent).toFixed(Math.abs(percent) < 9.95 ? 1 : 0)} %`;
}

function fillStatistics(table, rows) {
  const head = element("tr", {}, element("th", {scope: "col"}, "quantity"), element("th", {scope: "col"}, "unit"), ...runHeadings());
  table.replaceChildren(element("thead", {}, head));
  let body = null, of = null;
  const [doubtful, bodies] = ["summary", "loads"].map((section) => new Set(warningsOf(section).flatMap((one) => one.of)));
  const keyOf = (row) => `${row.of}\u0000${row.unit}`, peaks = new Map();  // so that the rows of a subject share their units
  const numbersOf = (row) => row.values.filter((value) => typeof value === "number").map(Math.abs);
  for (const row of rows) peaks.set(keyOf(row), Math.max(peaks.get(keyOf(row)) ?? -Infinity, ...numbersOf(row)));
  const isDoubtful = (row) => doubtful.has(row.of) || bodies.has(row.name.startsWith("deflection") ? row.of.split(".")[0] : row.of);
  for (const row of rows) {
    if (row.of !== of) {
      of = row.of;
      body = element("tbody");
      const heading = element("th", {class: "group", colspan: data.runs.length + 2, scope: "rowgroup"}, of);
      if (isDoubtful(row)) heading.append(" ", element("span", {class: "bad", title: "see the warnings above"}, "⚠ see the warnings above"));
      body.append(element("tr", {}, heading));
      table.append(body);
    }
    const {unit, factor} = readable(row.unit, peaks.get(keyOf(row)));
    const cells = row.values.map((value, index) => {
      const isText = typeof value === "string";
      const cell = element("td", {class: isText ? "number words" : "number"}, value === null ? "–" : isText ? value : format(factor * value));
      if (data.runs.length > 1) cell.append(" ", element("small", {}, index && of !== "computation" && !isText && sameSpan(index) ? difference(value, row.values[0]) : ""));
      const step = (row.steps || [])[index];
      if (step) cell.append(" ", element("small", {title: "the file does not hold it at every output"}, `of rows every ${formatTick(1e3 * step)} ms`));
      return cell;
    });
    body.append(element("tr", {}, element("th", {scope: "row"}, row.name), element("td", {class: "unit"}, unit), ...cells));
  }
}

/** The warnings of all runs that belong to a section, each with its run. */
const warningsOf = (section) => data.runs.flatMap((run, index) =>
  run.warnings.filter((one) => one.section === section).map((one) => ({...one, run, index})));

/** The places for warnings: each section says those that concern its numbers. */
function fillWarnings() {
  for (const place of document.querySelectorAll("[data-warnings]")) {
    const found = warningsOf(place.dataset.warnings);
    place.hidden = found.length === 0;
    place.replaceChildren(...found.map(({text, run, index}) => element("li", {},
      element("span", {class: "key", style: `--c:${colourOf(index)}`}), element("strong", {}, run.label), `: ${text}`)));
  }
}

/** The rows in the summary; the others are under "All numbers". */
const inSummary = (row) => row.brief && !/displacement( along [xy])?, r\.m\.s\.|axial/.test(row.name);

const MOST_FREQUENCIES = 24;  // of a run, in its table

/** A table of modes for each run, beside each other where there is room. */
function fillFrequencies(place) {
  const shown = data.runs.map((run, index) => ({run, index, modes: run.vehicleModes.table})).filter(({modes}) => modes.length);
  place.replaceChildren(...shown.map(({run, index, modes}) => {
    const least = modes.slice(0, MOST_FREQUENCIES), count = modes.length > least.length ? `, the lowest ${least.length} of ${modes.length}` : "";
    const headings = ["mode", "Hz", "damping", "who moves"].map((text, k) => element("th", {class: k < 3 ? "number" : "", scope: "col"}, text));
    const rows = least.map((mode) => element("tr", {}, ...[String(mode.number), format(mode.f), `${format(100 * mode.damping, 3)} %`]
      .map((text) => element("td", {class: "number"}, text)), element("td", {class: "who"}, mode.who.replaceAll(" %", "\u00a0%"))));
    return element("div", {class: "scroll", tabindex: "0", role: "region", "aria-label": `The vehicle's modes, ${run.label}`},
      element("table", {}, element("caption", {class: "note"}, element("span", {class: "key", style: `--c:${colourOf(index)}`}), `${run.label}${count}`),
        element("thead", {}, element("tr", {}, ...headings)), element("tbody", {}, ...rows)));
  }));
}

function fillChecks(place) {
  place.replaceChildren();
  byId("checks").hidden = !data.superelements.length;
  for (const found of data.superelements) {
    place.append(element("h3", {}, found.name), element("p", {class: "note"}, `Content hash `, element("code", {}, found.hash),
      `, used by ${found.runs.join(", ")}.`));
    if (found.problem) {
      place.append(element("p", {}, found.problem));
      continue;
    }
    const frequencies = found.frequencies.map((value) => format(value)).join(", ");
    const what = found.kind === "clamped" ? "Frequencies of the body held at its reference point" : "Frequencies of the free body";
    const others = found.others ? `; besides ${found.others} vectors for loads, which have none` : "";
    if (frequencies) place.append(element("p", {class: "note"}, `${what}: ${frequencies} Hz${found.more ? " …" : ""}${others}.`));
    const table = element("table", {}, element("thead", {}, element("tr", {}, element("th", {scope: "col"}, "check"),
      element("th", {class: "number", scope: "col"}, "value"), element("th", {class: "number", scope: "col"}, "allowed"),
      element("th", {scope: "col"}, "result"))));
    const body = element("tbody");
    const isJudged = (check) => check.tolerance < 1e9;
    for (const check of found.checks) {
      const judged = isJudged(check), passed = check.value <= check.tolerance;
      body.append(element("tr", {}, element("th", {scope: "row"}, check.name), element("td", {class: "number"}, format(check.value)),
        element("td", {class: "number"}, judged ? format(check.tolerance) : "–"),
        judged ? element("td", {class: passed ? "good" : "bad"}, passed ? "✓ passed" : "✗ failed") : element("td", {}, "–")));
    }
    table.append(body);
    const failed = found.checks.filter((check) => !(check.value <= check.tolerance)).length, count = found.checks.filter(isJudged).length;
    const result = failed ? `✗ ${failed} of ${count} checks failed` : `✓ All ${count} checks passed`;
    const details = element("details", failed ? {open: ""} : {}, element("summary", {id: `checks-of-${found.name}`, class: failed ? "bad" : "good"}, result),
      element("div", {class: "scroll", tabindex: "0", role: "region", "aria-label": `Checks of ${found.name}`}, table));
    place.append(details);
  }
}

function fillFacts(table) {
  const names = [...new Set(data.runs.flatMap((run) => run.facts.map(([name]) => name)))];
  const body = element("tbody");
  for (const name of names) {
    const texts = data.runs.map((run) => (run.facts.find(([other]) => other === name) || [name, "–"])[1]);
    const row = element("tr", {}, element("th", {scope: "row"}, name));
    if (texts.every((text) => text === texts[0])) {
      row.append(element("td", {class: "text", colspan: texts.length}, texts[0]));
    } else {
      row.append(...texts.map((text) => element("td", {class: "text"}, text)));
    }
    body.append(row);
  }
  const headings = runHeadings();
  for (const heading of headings) heading.className = "";
  table.replaceChildren(element("thead", {}, element("tr", {}, element("td"), ...headings)), body);
}

function fillTables() {
  fillWarnings();
  const rows = collectStatistics();
  fillStatistics(byId("summary-table"), rows.filter(inSummary));
  fillStatistics(byId("statistics-table"), rows);
  fillRide();
  fillFrequencies(byId("frequency-tables"));
  fillChecks(byId("check-tables"));
  fillFacts(byId("fact-table"));
}
