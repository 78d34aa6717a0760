"""Progress of long work: on a terminal a bar with the time left; elsewhere a line every ten seconds, so that short work
prints nothing."""

import sys
import time
from typing import TextIO

BETWEEN_LINES = 10.0  # s, where stderr is not a terminal
BETWEEN_BARS = 0.1  # s
WIDTH = 30  # characters in the bar


class Progress:
    """Reports progress on a stream (stderr if None): `with Progress("writing", 500) as progress: … progress.step()`."""

    def __init__(self, what: str, total: int, stream: TextIO | None = None) -> None:
        self.what, self.total, self.stream = what, max(total, 1), stream or sys.stderr
        self.done = 0
        self.begun = self.shown = time.monotonic()
        self.on_terminal = self.stream.isatty()

    def __enter__(self) -> "Progress":
        return self

    def __exit__(self, *_: object) -> None:
        if self.on_terminal and self.done:
            self.stream.write("\r\x1b[K")
            self.stream.flush()

    def report(self, text: str) -> None:
        """A line above the bar."""
        self.stream.write(f"\r\x1b[K{text}\n" if self.on_terminal else f"{text}\n")
        self.stream.flush()

    def step(self, count: int = 1, note: str = "") -> None:
        """Records that `count` more parts are done. note: follows the time left."""
        self.done += count
        now = time.monotonic()
        if now - self.shown < (BETWEEN_BARS if self.on_terminal else BETWEEN_LINES):
            return
        self.shown = now
        left = (now - self.begun) / self.done * (self.total - self.done)
        share = self.done / self.total
        if self.on_terminal:
            bar = ("█" * round(WIDTH * share)).ljust(WIDTH, "░")
            self.stream.write(f"\r{self.what} {bar} {100 * share:3.0f} %, {left:.0f} s left{note}\x1b[K")
        else:
            self.stream.write(f"{self.what}: {100 * share:.0f} %, {left:.0f} s left{note}\n")
        self.stream.flush()
