"""runs/stations.py: how loads along a body are drawn, and the sign of their moments."""

import unittest

import numpy as np
from tool_test_case import ToolTestCase

from sprung_tools.runs.stations import ALONG_ELEMENTS, ALONG_X, place_stations


class Stations(ToolTestCase):
    def test_a_moment_of_an_element_that_is_drawn_against_x_has_the_other_sign(self):
        # Three elements of a beam, the middle one from right to left; the last one of the file is the first along x.
        layout = place_stations(np.array([(2.0, 0.0), (4.0, 0.0), (2.0, 0.0), (1.0, 0.1), (0.0, 0.1), (1.0, 0.1)]))
        np.testing.assert_array_equal(layout.order, [4, 5, 3, 2, 0, 1])
        np.testing.assert_allclose(layout.along, [0.0, 1.0, 1.0, 2.0, 2.0, 4.0])
        np.testing.assert_array_equal(layout.signs, [1.0, 1.0, -1.0, -1.0, 1.0, 1.0])
        self.assertEqual(layout.axis, ALONG_X)

    def test_members_above_each_other_are_drawn_one_after_the_other(self):
        # A rail, and a lower one beside its second half: over x a line would jump between both.
        rails = np.array([(0.0, 0.0), (2.0, 0.0), (2.0, 0.0), (4.0, 0.0), (2.5, -0.2), (3.5, -0.2)])
        layout = place_stations(rails)
        np.testing.assert_array_equal(layout.order, np.arange(6))
        np.testing.assert_allclose(layout.along, [0.0, 2.0, 2.0, 4.0, 4.0, 5.0])
        np.testing.assert_array_equal(layout.signs, np.ones(6))
        self.assertEqual(layout.axis, ALONG_ELEMENTS)

    def test_a_gap_leaves_a_chain_and_an_upright_post_does_not(self):
        chain = np.array([(0.0, 0.0), (2.0, 0.0), (2.5, 0.2), (4.0, 0.2)])
        self.assertEqual(place_stations(chain).axis, ALONG_X)
        for post in ([(2.0, 0.0), (2.0, 0.1)], [(1.0, 0.0), (1.0, 0.1)]):  # at a node, within an element
            self.assertEqual(place_stations(np.concatenate([chain, post])).axis, ALONG_ELEMENTS)


if __name__ == "__main__":
    unittest.main()
