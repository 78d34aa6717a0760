"""signals/spans.py and terminal/number_ranges.py: spans of time, ranges of whole numbers."""

import unittest

import numpy as np
import tool_test_case  # noqa: F401  puts tools/ on the path

from sprung_tools.signals.spans import find_spans
from sprung_tools.terminal.number_ranges import format_ranges


class Spans(unittest.TestCase):
    time = np.arange(6.0)

    def find(self, *holds):
        return find_spans(np.array(holds, bool), self.time).tolist()

    def test_a_span_ends_with_the_sample_after_its_last(self):
        self.assertEqual(self.find(1, 0, 0, 1, 1, 0), [[0.0, 1.0], [3.0, 5.0]])

    def test_a_span_ends_with_the_last_sample_at_the_latest(self):
        self.assertEqual(self.find(0, 0, 0, 0, 1, 1), [[4.0, 5.0]])
        self.assertEqual(self.find(0, 0, 0, 0, 0, 1), [[5.0, 5.0]])

    def test_always_and_never(self):
        self.assertEqual(self.find(1, 1, 1, 1, 1, 1), [[0.0, 5.0]])
        self.assertEqual(self.find(0, 0, 0, 0, 0, 0), [])


class Ranges(unittest.TestCase):
    def test_neighbours_become_ranges(self):
        self.assertEqual(format_ranges([1, 2, 3, 7, 9, 10]), "1–3, 7, 9–10")
        self.assertEqual(format_ranges([4]), "4")
        self.assertEqual(format_ranges([]), "")


if __name__ == "__main__":
    unittest.main()
