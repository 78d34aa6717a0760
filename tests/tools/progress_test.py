"""terminal/progress_bar.py: a bar with the time left on a terminal, a line now and then elsewhere, silence for short
work. The clock is a stand-in."""

import io
import unittest
from unittest import mock

from tool_test_case import TOOLS  # noqa: F401  puts tools/ on the path

from sprung_tools.terminal import progress_bar as progress
from sprung_tools.terminal.progress_bar import Progress


class Terminal(io.StringIO):
    def isatty(self):
        return True


class ProgressOfWork(unittest.TestCase):
    def setUp(self):
        patch = mock.patch.object(progress.time, "monotonic", lambda: self.now)
        patch.start()
        self.addCleanup(patch.stop)
        self.now = 100.0

    def work(self, stream, seconds_each, parts=10):
        """What stands on the stream after each part."""
        told = []
        with Progress("writing", parts, stream) as bar:
            for _ in range(parts):
                self.now += seconds_each
                bar.step()
                told.append(stream.getvalue())
        return told

    def test_a_terminal_sees_a_bar_with_the_time_left_that_is_wiped_at_the_end(self):
        stream = Terminal()
        told = self.work(stream, 2.0)
        self.assertIn("writing " + "█" * 9 + "░" * 21 + "  30 %, 14 s left", told[2])
        self.assertTrue(stream.getvalue().endswith("\r\x1b[K"))

    def test_a_bar_is_not_drawn_more_often_than_an_eye_sees(self):
        stream = Terminal()
        self.work(stream, 0.01, parts=100)
        self.assertLessEqual(stream.getvalue().count("writing"), 10)

    def test_a_file_gets_plain_lines_ten_seconds_apart(self):
        stream = io.StringIO()
        self.work(stream, 6.0)
        lines = stream.getvalue().splitlines()
        self.assertEqual(
            lines,
            [
                f"writing: {share} %, {left} s left"
                for share, left in ((20, 48), (40, 36), (60, 24), (80, 12), (100, 0))
            ],
        )

    def test_a_note_follows_the_time_left(self):
        stream = io.StringIO()
        with Progress("runs", 2, stream) as bar:
            self.now += 20.0
            bar.step(note=", 1 failed")
        self.assertEqual(stream.getvalue(), "runs: 50 %, 20 s left, 1 failed\n")

    def test_short_work_is_silent_in_a_file(self):
        stream = io.StringIO()
        self.work(stream, 0.5)
        self.assertEqual(stream.getvalue(), "")


if __name__ == "__main__":
    unittest.main()
