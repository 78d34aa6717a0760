"""study/storage.py: what the runs of a study store, from the measures that it takes."""

import unittest

from tool_test_case import ToolTestCase

from sprung_tools.study.storage import choose_storage

POINTS = "output.store.points=reported"
RECOVERY, JOINTS, WRENCHES = (f"output.store.{one}=none" for one in ("recovery", "joints", "wrenches"))


class Storage(ToolTestCase):
    def test_what_no_measure_is_taken_from_is_left_out(self):
        for measures, expected in {
            ("points/chassis.seat/wk_rms", "program/energy_closure"): [POINTS, RECOVERY, JOINTS, WRENCHES],
            ("suspensions/*/compression", "tyres/front_tyre/*"): [POINTS, RECOVERY, JOINTS, WRENCHES],
            ("loads/chassis/moment",): [POINTS, JOINTS, WRENCHES],
            ("histories/joints/pin/reaction.1/max",): [POINTS, RECOVERY, WRENCHES],
            ("histories/forces/tyre/on_wheel.2/max", "histories/recovery/frame/axial.1/max"): [POINTS, JOINTS],
        }.items():
            self.assertEqual(choose_storage(measures, ["speed=3"]), expected, measures)

    def test_all_is_stored_where_a_pattern_may_mean_anything_or_the_study_chooses(self):
        self.assertEqual(choose_storage(["*/chassis*/rms"], []), [])
        self.assertEqual(choose_storage(["points/chassis.seat/rms"], ["output.precision=single"]), [])


if __name__ == "__main__":
    unittest.main()
