"""runs/mode_history.py: which modes were active, when that changed, and what was left out, of a small run with known
answers."""

import unittest

import numpy as np
from mode_runs import write_adaptive_run
from synthetic_results import NUM_SAMPLES, write_results
from tool_test_case import ToolTestCase

from sprung_tools.runs.mode_history import (
    Neglect,
    count_active,
    find_change_times,
    find_worst_neglect,
    read_mode_histories,
    read_neglected,
)
from sprung_tools.files.errors import InputError
from sprung_tools.files.results_file import open_results


class ModeHistories(ToolTestCase):
    def open_run(self, **options):
        results = open_results(write_adaptive_run(self.folder / "run.h5", **options))
        self.addCleanup(results.file.close)
        return results

    def test_modes_are_named_by_number_and_frequency_in_the_superelement(self):
        (history,) = read_mode_histories(self.open_run())
        self.assertEqual(history.body, "chassis")
        self.assertEqual(history.vectors, [(1, "free", 6.11), (3, "free", 38.3), (4, "residual", None)])

    def test_active_modes_are_counted_at_each_sample(self):
        results = self.open_run()
        counts = count_active(results)
        # Samples 5 ms apart: the second mode is there from 0.25 s up to 0.5 s, and from 0.75 s to the end.
        self.assertEqual(counts[results.time < 0.25].tolist(), [1] * 50)
        self.assertEqual(np.count_nonzero(counts == 2), NUM_SAMPLES - 50 - 50)

    def test_an_instant_of_several_changes_counts_once_and_other_events_do_not(self):
        np.testing.assert_allclose(find_change_times(self.open_run()), [0.25, 0.5])

    def test_the_mode_that_misses_most_is_found_for_deflection_and_acceleration(self):
        results = self.open_run()
        self.assertEqual(find_worst_neglect(results, 0), Neglect(0.03, "chassis", 3, 0.5))
        self.assertEqual(find_worst_neglect(results, 1), Neglect(0.008, "chassis", 2, 0.2))

    def test_a_run_without_an_indicator_gives_no_shares(self):
        results = self.open_run(is_adaptive=False)
        self.assertEqual(read_neglected(results), {})
        self.assertIsNone(find_worst_neglect(results, 0))

    def test_a_run_without_modes_is_refused(self):
        with open_results(write_results(self.folder / "rigid.h5", num_modes=0)) as results:
            with self.assertRaisesRegex(InputError, "rigid.h5: error: no body of this run has modes"):
                count_active(results)


if __name__ == "__main__":
    unittest.main()
