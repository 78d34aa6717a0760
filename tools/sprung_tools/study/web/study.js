"use strict";
// Assembles the page of a study.

function fillHead() {
  const failed = data.rows.filter((row) => row.exit !== 0 && row.exit !== 1).length;
  const doubtful = data.rows.filter((row) => row.exit === 1).length;
  byId("title").textContent = data.title;
  byId("subtitle").textContent = [`${data.rows.length} runs of ${data.run}`, `${data.command}, ${data.method}`, `${failed} failed`,
    doubtful ? `${doubtful} with a failed check` : ""].filter(Boolean).join(" · ");
}

function drawAll() {
  fillBest();
  drawScatter();
  drawHeatMap();
  drawParallel();
  drawEffects();
}

fillHead();
makeBest();
makeScatter();
makeHeatMap();
makeParallel();
makeEffects();
fillFailures();
drawAll();
for (const link of document.querySelectorAll("nav a")) link.hidden = byId(link.hash.slice(1)).hidden;
dark.addEventListener("change", drawAll);
let resizing = 0;
window.addEventListener("resize", () => {
  cancelAnimationFrame(resizing);
  resizing = requestAnimationFrame(drawAll);
});
document.documentElement.dataset.ready = "true";
