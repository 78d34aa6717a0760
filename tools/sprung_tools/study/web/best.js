"use strict";
// The best runs by a measure, and the runs that failed or were warned of.

const MOST_BEST = 12, MOST_FAILURES = 20, MOST_NAMED = 8;

function findBest(measure, order) {
  return runsWith(measure).sort((a, b) => order * (measure.numbers[a] - measure.numbers[b])).slice(0, MOST_BEST);
}

/** A name that may be broken after its slashes, dots and underscores. */
const breakable = (name) => name.split(/(?<=[/._])/).flatMap((part, k) => (k ? [element("wbr"), part] : [part]));

function fillBest() {
  const measure = columnOf(byId("best-measure"));
  if (!measure) return;
  const shown = [...parameterColumns, measure, ...measureColumns.filter((one) => one !== measure)];
  const head = element("tr", {}, element("th", {}, "run"), ...shown.map((one) => element("th", {class: "number"}, ...breakable(titleOf(one)))));
  const rows = findBest(measure, Number(byId("best-order").value)).map((run) => {
    const mark = data.rows[run].exit === 1 ? " !" : "";
    const row = element("tr", {class: run === chosen.run ? "chosen" : "", "data-run": run}, element("th", {scope: "row"}, `${run + 1}${mark}`),
      ...shown.map((one) => element("td", {class: "number"}, showValue(one, run))));
    row.addEventListener("click", () => choose(run));
    return row;
  });
  byId("best-table").replaceChildren(element("thead", {}, head), element("tbody", {}, ...rows));
}

/** The numbers of runs, the first ones where there are many. */
const nameRuns = (runs) => runs.slice(0, MOST_NAMED).map((run) => run + 1).join(", ") + (runs.length > MOST_NAMED ? ` … (${runs.length} runs)` : "");

/** What runs say, each text once with all runs that say it; errors first. */
function fillFailures() {
  const found = new Map();
  data.rows.forEach((row, run) => {
    const text = row.texts.map((one) => data.texts[one]).join("; "), key = `${row.isError} ${text}`;
    if (text && !found.has(key)) found.set(key, {runs: [], text, bad: row.isError});
    if (text) found.get(key).runs.push(run);
  });
  const told = [...found.values()].sort((a, b) => b.bad - a.bad || a.runs[0] - b.runs[0]);
  byId("failures").hidden = !told.length;
  const rows = told.slice(0, MOST_FAILURES).map(({runs, text, bad}) => element("tr", {}, element("th", {scope: "row"}, nameRuns(runs)),
    element("td", {class: bad ? "bad" : ""}, bad ? "error" : "warning"), element("td", {class: "text"}, text)));
  if (told.length > MOST_FAILURES) rows.push(element("tr", {}, element("td", {colspan: "3"}, `and ${told.length - MOST_FAILURES} more, in table.csv`)));
  byId("failure-table").replaceChildren(element("tbody", {}, ...rows));
}

function makeBest() {
  fillSelect(byId("best-measure"), optionsOf(measureColumns));
  for (const name of ["best-measure", "best-order"]) byId(name).addEventListener("change", fillBest);
  chosen.listeners.push(fillBest);
}
