"use strict";
// The one clock of the animation and of all diagrams over time.

/** The time shown by the animation and the diagrams' cursor [s]. */
const clock = {
  time: Math.min(...data.runs.map((run) => run.span[0])),
  first: Math.min(...data.runs.map((run) => run.span[0])),
  last: Math.max(...data.runs.map((run) => run.span[1])),
  listeners: [],
  set(time) {
    this.time = Math.min(Math.max(time, this.first), this.last);
    for (const listener of this.listeners) listener(this.time);
  },
};
