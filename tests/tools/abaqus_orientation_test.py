"""How beams of Abaqus and CalculiX decks are turned: planar ones, and those whose nodes have normals."""

import unittest

import numpy as np
from abaqus_case import AbaqusCase

NODES = "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.{}\n3, 2., 0., 0.\n4, 3., 0., 0.\n5, 0., 0., 1.\n"
BEAMS = "*ELEMENT, TYPE={}, ELSET=A\n1, 1, 2\n2, 2, 3\n3, 3, 4\n"
SECTION = "*BEAM SECTION, ELSET=A, SECTION=RECT, MATERIAL=M\n2., 3.\n{}\n"


class AbaqusOrientation(AbaqusCase):
    """Beam element cross-section orientation; lines along x."""

    def assert_open(self, mesh, lines):
        self.assertEqual(np.flatnonzero(np.isnan(mesh.heights[:, 0])).tolist(), [line - 1 for line in lines])
        told = f"normals of nodes, by *NODE or *NORMAL, which turn beams {', '.join(map(str, lines))}"
        self.assertEqual(told in mesh.left_behind, bool(lines))

    def test_beams_whose_nodes_have_normals_are_left_open(self):
        for kind, normal, lines in (
            ("B31", ", 0., 0., 1.", [1, 2]), ("B33", ", , 1.", [1, 2]), ("B31", ", 0., 0., 0.", []),
            ("B31", ",", []), ("B21", ", 0., 1., 0.", []), ("T3D2", ", 0., 0., 1.", []),
        ):  # fmt: skip
            with self.subTest((kind, normal)):
                rod = "*SOLID SECTION, ELSET=A, MATERIAL=M\n2.\n"
                section = rod if kind == "T3D2" else SECTION.format("0., 1., 0.")
                mesh = self.read(NODES.format(normal) + BEAMS.format(kind) + section)
                if kind == "T3D2":
                    self.assertNotIn("normals of nodes", " ".join(mesh.left_behind))
                else:
                    self.assert_open(mesh, lines)
        self.assert_refused(NODES.format(", x") + BEAMS.format("B31"), "3: error: *NODE: 'x' is not a number")

    def test_beams_that_a_normal_names_are_left_open(self):
        text = NODES.format("") + BEAMS.format("B31") + SECTION.format("0., 1., 0.")
        for data, lines in (
            ("*NORMAL\n2, 2, 0., 0., 1.\n", [2]), ("*NORMAL, TYPE=ELEMENT\nB, 2, 0., 0., 1.\n", [2, 3]),
            ("*NORMAL, TYPE=CONTACT SURFACE\nS, 2, 0., 0., 1.\n", []),
        ):  # fmt: skip
            with self.subTest(data):
                self.assert_open(self.read(text + "*ELSET, ELSET=B\n2, 3\n" + data), lines)
        self.assert_refused(text + "*NORMAL\nC, 2, 0., 0., 1.\n", "15: error: *NORMAL: names the set 'C', which is not")

    def test_normals_of_a_part_are_those_of_its_instances(self):
        part = f"*PART, NAME=P\n{NODES.format(', 0., 0., 1.')}{BEAMS.format('B31')}{SECTION.format('')}*END PART\n"
        place = "*INSTANCE, NAME={0}, PART=P\n0., {0}.\n*END INSTANCE\n"
        mesh = self.read(f"{part}*ASSEMBLY, NAME=A\n{place.format(1)}{place.format(2)}*END ASSEMBLY\n")
        self.assertEqual(np.isnan(mesh.heights[:, 0]).tolist(), [True, True, False] * 2)

    def test_a_planar_beam_has_its_1_direction_normal_to_the_plane(self):
        # "For beams in a plane the n₁-direction is always (0, 0, -1)"; CalculiX makes a B31 of a B21.
        told = "1-directions that are given to planar beams 1, 2, 3: theirs is (0, 0, -1), as in Abaqus; CalculiX takes"
        for kind, given, height, is_told in (
            ("B21", "0., 1., 0.", [0, 1, 0], True), ("B23", "0., 1., 1.", [0, 1, 0], True),
            ("B21", "1., 0., 0.", [0, 1, 0], True), ("B21", "0., 0., 1.", [0, 1, 0], False),
            ("B21", "", [0, 1, 0], False), ("B31", "0., 1., 0.", [0, 0, 1], False),
        ):  # fmt: skip
            with self.subTest((kind, given)):
                mesh = self.read(NODES.format("") + BEAMS.format(kind) + SECTION.format(given))
                np.testing.assert_allclose(np.abs(mesh.heights), [height] * 3, atol=1e-15)
                self.assertEqual(told in "\n".join(mesh.left_behind), is_told)
        mesh = self.read(NODES.format("") + "*ELEMENT, TYPE=B21, ELSET=A\n1, 1, 2, 5\n" + SECTION.format(""))
        self.assertNotIn("1-directions", "\n".join(mesh.left_behind))  # node 5 is normal to the plane


if __name__ == "__main__":
    unittest.main()
