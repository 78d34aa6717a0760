"""Reading Nastran decks: positions, defaults, and sections, against numbers worked out by hand."""

import unittest

import numpy as np
from nastran_case import NastranCase
from polygons import box, find_extremes, find_farthest, integrate
from small_decks import NASTRAN

from sprung_tools.mesh_import.frame_properties import Shape

BAR = "CBAR,1,1,1,2,0.,1.,0.\n"
ROOT_HALF = np.sqrt(0.5)


class Reading(NastranCase):
    """Decks that are written to a file and read."""

    def test_digits_that_no_deck_means_are_refused(self):
        # Python's float() and int() take 1_0, and digits of other scripts.
        self.assert_refused(NASTRAN.replace("GRID,2,,1.", "GRID,2,,1_0."), "3: error: GRID: '1_0.' is no coordinate")
        self.assert_refused(NASTRAN.replace("GRID,2", "GRID,2_0"), "3: error: GRID: '2_0' is no node number")
        self.assert_refused(NASTRAN.replace("GRID,2", "GRID,٢"), "3: error: GRID: '٢' is no node number")

    def test_areas_and_second_moments_that_no_section_has_are_refused(self):
        for card, message in (
            ("PBAR,1,1,.1,-.2,.3", "b.bdf:5: error: PBAR: its I1 is -0.2, expected ≥ 0"),
            ("PBAR,1,1,.1,.2,-.3", "b.bdf:5: error: PBAR: its I2 is -0.3, expected ≥ 0"),
            ("PBAR,1,1,-.1,.2,.3", "b.bdf:5: error: PBAR: its area is -0.1, expected ≥ 0"),
            ("PBEAM,1,1,.1,-.2,.3", "b.bdf:5: error: PBEAM: its I1 is -0.2, expected ≥ 0"),
            ("PBEAM,1,1,.1,.2,.3,.25", "b.bdf:5: error: PBEAM: its I12 is 0.25, but I12² ≤ I1·I2, which is 0.06"),
            ("PBAR,1,1,.1,.2,.3\n,\n,,,-.25", "b.bdf:5: error: PBAR: its I12 is -0.25, but I12² ≤ I1·I2, which is"),
        ):
            with self.subTest(card):
                (self.folder / "b.bdf").write_text(NASTRAN.replace("ENDDATA", f"{card}\nENDDATA"), encoding="utf-8")
                self.assert_refuses(self.run_tool("convert_mesh", "b.bdf", "a.msh"), message)

    def test_blank_coordinates_are_zero(self):
        mesh = self.read(f"BEGIN BULK\nGRID,1\nGRID,2,,,3.,\n{BAR}ENDDATA\n")
        np.testing.assert_array_equal(mesh.positions, [[0.0, 0.0, 0.0], [0.0, 3.0, 0.0]])

    def test_a_punch_file_has_neither_begin_nor_end(self):
        text = f"GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\n{BAR}"
        mesh = self.read(text)
        self.assertEqual(len(mesh.lines), 1)
        self.assertIn("no ENDDATA ends the deck, as in punch files: is the file whole?", mesh.doubts)
        (self.folder / "a.pch").write_text(text, encoding="utf-8")
        process = self.run_tool("convert_mesh", "a.pch", "a.msh")
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertIn("\nremark: no ENDDATA ends the deck", process.stdout)

    def test_an_included_file_takes_its_place(self):
        (self.folder / "nodes.bdf").write_text("GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\n", encoding="utf-8")
        mesh = self.read(f"BEGIN BULK\nINCLUDE 'nodes.bdf'\n{BAR}ENDDATA\n")
        self.assertEqual(mesh.node_ids.tolist(), [1, 2])
        (self.folder / "b.bdf").write_text("INCLUDE 'none.bdf'\n", encoding="utf-8")
        process = self.run_tool("convert_mesh", "b.bdf", "a.msh")
        self.assert_refuses(process, "b.bdf:1: error: INCLUDE: there is no file")

    def test_a_mark_of_the_encoding_before_the_first_card_changes_nothing(self):
        (self.folder / "nodes.bdf").write_text("\ufeffGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\n", encoding="utf-8")
        mesh = self.read(f"\ufeff{BAR}INCLUDE 'nodes.bdf'\n")
        self.assertEqual((mesh.node_ids.tolist(), len(mesh.lines)), ([1, 2], 1))

    def test_nodes_in_turned_cylindrical_and_spherical_systems_are_where_they_are(self):
        # System 1 has its origin at (1, 2, 3), z along the basic x, and x along the basic y, so that y lies along z.
        systems = "CORD2R,1,0,1.,2.,3.,2.,2.,3.\n,1.,3.,3.\nCORD2C,2,1,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"
        systems += "CORD2S,3,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"
        nodes = "GRID,1,1,4.,5.,6.\nGRID,2,2,2.,90.,7.\nGRID,3,3,2.,90.,45.\nGRID,4,3,2.,45.,90.\n"
        mesh = self.read(f"BEGIN BULK\n{systems}{nodes}{BAR}ENDDATA\n")
        root = 2.0 * ROOT_HALF
        expected = [[7.0, 6.0, 8.0], [8.0, 2.0, 5.0], [root, root, 0.0], [0.0, root, root]]
        np.testing.assert_allclose(mesh.positions, expected, atol=1e-14)

    def test_a_system_by_three_nodes_and_the_default_system_of_nodes(self):
        corners = "GRID,11,0,5.,0.,0.\nGRID,12,0,5.,1.,0.\nGRID,13,0,5.,0.,1.\n"  # z along y, x along z, so y along x
        deck = f"BEGIN BULK\nGRDSET,,4\nCORD1R,4,11,12,13\n{corners}GRID,1,,1.,2.,3.\nGRID,2,0,0.,0.,0.\n{BAR}ENDDATA\n"
        np.testing.assert_allclose(self.read(deck).positions[0], [7.0, 3.0, 1.0], atol=1e-14)

    def test_property_and_orientation_may_come_from_baror(self):
        deck = NASTRAN.replace("CBAR,1,1,1,2,0.,1.,0.", "BAROR,,7,,,0.,0.,1.\nCBAR,1,,1,2")
        mesh = self.read(deck)
        self.assertEqual(list(mesh.element_sets), ["property_7"])
        np.testing.assert_array_equal(mesh.heights, [[0.0, 0.0, 1.0]])

    def test_an_orientation_by_a_node_and_one_in_a_node_s_own_system(self):
        by_node = NASTRAN.replace("GRID,2", "GRID,3,,0.,0.,9.\nGRID,2").replace("1,2,0.,1.,0.", "1,2,3")
        np.testing.assert_array_equal(self.read(by_node).heights, [[0.0, 0.0, 9.0]])
        turned = "CORD2R,5,,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\nGRID,1,,0.,0.,0.,5\n"  # its x lies along the basic y
        own = NASTRAN.replace("GRID,1,,0.,0.,0.\n", turned).replace("1,2,0.,1.,0.", "1,2,1.,0.,0.")
        np.testing.assert_allclose(self.read(own).heights, [[0.0, 1.0, 0.0]], atol=1e-15)

    def test_an_orientation_in_the_basic_system_by_offt(self):
        # Quick Reference Guide, CBAR: OFFT = "BGG" gives the orientation in the basic system, "GGG" (the default)
        # in the displacement system of end A. The x axis of system 5 is the basic y, its y axis the basic z.
        turned = "CORD2R,5,,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\nGRID,1,,0.,0.,0.,5\n"
        for orientation, expected in (
            ("CBAR,1,1,1,2,0.,1.,0.,BGG", [0.0, 1.0, 0.0]),
            ("CBAR,1,1,1,2,0.,1.,0.,GGG", [0.0, 0.0, 1.0]),
            ("BAROR,,,,,0.,1.,0.,bgo\nCBAR,1,1,1,2", [0.0, 1.0, 0.0]),
            ("BAROR,,,,,,,,BGG\nCBAR,1,1,1,2,0.,1.,0.,GGG", [0.0, 0.0, 1.0]),
        ):
            with self.subTest(orientation):
                deck = NASTRAN.replace("GRID,1,,0.,0.,0.\n", turned).replace("CBAR,1,1,1,2,0.,1.,0.", orientation)
                np.testing.assert_allclose(self.read(deck).heights, [expected], atol=1e-15)

    def test_a_mass_that_is_defined_twice_is_refused(self):
        mass = "CONM2,9,2,,5.\n"
        for again in (mass, "CONM2,9,1,,5.\n", "CONM2,09,2,,6.\n"):
            with self.subTest(again):
                text = NASTRAN.replace("ENDDATA", f"{mass}{again}ENDDATA")
                self.assert_refused(text, "6: error: CONM2: 9 is defined twice")

    def test_a_line_in_free_fields_has_ten_of_them(self):
        # Name, eight data fields (four after a *), and the mark of the continuation: more would be lost.
        bulk = NASTRAN.replace("ENDDATA", "{}\nENDDATA")
        for card, message in (
            ("CONM2,5,2,0,50.,,,,,1.,0.,1.,0.,0.,3.", "5: error: CONM2: has '1.' behind its 8 data fields"),
            ("SET1,7,1,1,1,1,1,1,2,1", "5: error: SET1: has '1' behind its 8 data fields, where only the mark"),
            ("SET1,7,1,1,1,1,1,1,2,,1", "5: error: SET1: has '1' behind its 8 data fields"),
            ("CONM2,5,2,0,50.,,,,,+1.", "5: error: CONM2: has '+1.' behind its 8 data fields"),
            ("SET1,7,1,1,1,1,1,1,2,,+", "5: error: SET1: has '+' behind its 8 data fields"),
            ("SET1,7,1,1,1,1,1,1,2,+A,2", "5: error: SET1: has '+A' behind its 8 data fields"),
            ("SET1,7\n,1,1,1,1,1,1,1,1,2", "6: error: continuation: has '2' behind its 8 data fields"),
            ("GRID*,7,,1.,2.,3.", "5: error: GRID*: has '3.' behind its 4 data fields"),
        ):
            with self.subTest(card):
                self.assert_refused(bulk.format(card), message)
        for card in ("SET1,7,1,1,1,1,1,1,1,+\n+,2,,,,,,,,", "SET1,7,1,1,1,1,1,1,1,,,,$,2\n,2", "SET1,7,1,2"):
            self.assertEqual(self.read(bulk.format(card)).node_sets["set_7"].tolist(), [0, 1])
        self.assertEqual(self.read(bulk.format("GRID*,7,,1.,2.,*A\n*A,3.")).positions[2].tolist(), [1.0, 2.0, 3.0])

    def test_a_mass_whose_position_is_in_the_basic_system(self):
        # Quick Reference Guide, CONM2: with CID = -1, X1 to X3 are the position of the mass in the basic system, and
        # its moments of inertia are about axes parallel to those of it. Node 3 is at (2, 90°) of a cylindrical system.
        nodes = "CORD2C,2,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,3,2,2.,90.,0.\n"
        inertia = "\n,1.,,2.,,,3."
        for mass, left_out in (
            ("CONM2,9,3,-1,10.,0.,2.,0.,", ""),
            (f"CONM2,9,3,-1,10.,0.,2.,0.,{inertia}", ""),
            ("CONM2,9,3,-1,10.,0.,0.,0.,", "it is away from its node by 0, -2, 0"),
            ("CONM2,9,1,-1,10.", ""),
            ("CONM2,9,3,,10.,0.,2.,0.,", "it is away from its node by 0, 2, 0"),
            (f"CONM2,9,3,2,10.,,,,{inertia}", "its moments of inertia are in coordinate system 2"),
        ):
            with self.subTest(mass):
                (one,) = self.read(NASTRAN.replace("ENDDATA", f"{nodes}{mass}\nENDDATA")).point_masses
                self.assertEqual(one.left_out, left_out)

    def read_shape(self, card):
        """The shape of a property."""
        return self.read(NASTRAN.replace("ENDDATA", f"{card}\nENDDATA")).sections[0].shape

    def assert_shape(self, card, area, hh, ww):
        shape = self.read_shape(card)
        np.testing.assert_allclose((shape.area, shape.hh, shape.ww), (area, hh, ww), rtol=1e-13)

    def test_shapes_of_pbarl(self):
        # Worked out as differences of rectangles, or by the parallel axis theorem.
        self.assert_shape("PBARL,1,1,,BAR\n,2.,3.", 6.0, 2 * 27 / 12, 3 * 8 / 12)
        self.assert_shape("PBARL,1,1,,BOX\n,4.,6.,1.,.5", 24 - 12, (4 * 216 - 3 * 64) / 12, (6 * 64 - 4 * 27) / 12)
        self.assert_shape("PBARL,1,1,,BOX1\n,4.,6.,1.,1.,.5,.5", 12.0, (4 * 216 - 3 * 64) / 12, (6 * 64 - 4 * 27) / 12)
        self.assert_shape("PBARL,1,1,,I\n,6.,4.,4.,1.,1.,1.", 12.0, (4 * 216 - 3 * 64) / 12, (2 * 64 + 4 * 1) / 12)
        self.assert_shape("PBARL,1,1,,I1\n,3.,1.,4.,6.", 12.0, (4 * 216 - 3 * 64) / 12, (2 * 64 + 4 * 1) / 12)
        self.assert_shape("PBARL,1,1,,H\n,3.,1.,4.,2.", 10.0, (1 * 64 + 3 * 8) / 12, (4 * 64 - 2 * 27) / 12)
        # A cross of an upright 1 × 5 and two arms 1 × 1: Nastran gives both arms' length together.
        self.assert_shape("PBARL,1,1,,CROSS\n,2.,1.,5.,1.", 7.0, (125 + 2) / 12, (4 * 1 + 1 * 27) / 12)
        self.assert_shape("PBARL,1,1,,TUBE\n,2.,1.", 3 * np.pi, 15 * np.pi / 4, 15 * np.pi / 4)
        self.assert_shape("PBARL,1,1,,TUBE2\n,2.,1.", 3 * np.pi, 15 * np.pi / 4, 15 * np.pi / 4)
        self.assert_shape("PBARL,1,1,,ROD\n,2.", 4 * np.pi, 4 * np.pi, 4 * np.pi)

    def test_shapes_without_a_horizontal_axis_of_symmetry(self):
        # A T of a flange 4 × 1 over a web 1 × 4: its centroid is 1.25 from either part's middle.
        tee = (8.0, (4 * 1 + 1 * 64) / 12 + 8 * 1.25**2, (1 * 64 + 4 * 1) / 12)
        self.assert_shape("PBARL,1,1,,T\n,4.,5.,1.,1.", *tee)
        self.assert_shape("PBARL,1,1,,T2\n,4.,5.,1.,1.", *tee)
        self.assert_shape("PBARL,1,1,,T1\n,4.,4.,1.,1.", tee[0], tee[2], tee[1])
        # A channel: web 1 × 6, two flanges 2 × 1 beside it; the middles are 1.5 apart.
        channel = (10.0, (3 * 216 - 2 * 64) / 12, (6 * 1 + 2 * 8) / 12 + 6 * 4 / 10 * 1.5**2)
        self.assert_shape("PBARL,1,1,,CHAN\n,3.,6.,1.,1.", *channel)
        self.assert_shape("PBARL,1,1,,CHAN1\n,2.,1.,4.,6.", *channel)
        self.assert_shape("PBARL,1,1,,CHAN2\n,1.,1.,3.,6.", channel[0], channel[2], channel[1])

    def test_shapes_against_integrals_over_their_outlines(self):
        # Corners (z, y) from the figures of the Quick Reference Guide, z to the right; our width is to the left.
        tee = [(-2, 5), (2, 5), (2, 4), (0.5, 4), (0.5, 0), (-0.5, 0), (-0.5, 4), (-2, 4)]
        turned = [(0, -2), (1, -2), (1, -0.5), (5, -0.5), (5, 0.5), (1, 0.5), (1, 2), (0, 2)]
        channel = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 5), (3, 5), (3, 6), (0, 6)]
        angle = [(0, 0), (5, 0), (5, 0.5), (0.7, 0.5), (0.7, 4), (0, 4)]
        zed = [(0, 2.5), (2, 2.5), (2, 0), (5, 0), (5, 0.5), (3, 0.5), (3, 3), (0, 3)]
        hat = [(0, 0), (2.5, 0), (2.5, 3.5), (5.5, 3.5), (5.5, 0), (8, 0), (8, 0.5), (6, 0.5), (6, 4), (2, 4), (2, 0.5),
               (0, 0.5)]  # fmt: skip
        closed_hat = [[(0, 0), (9, 0), (9, 0.8), (6.5, 0.8), (6.5, 3), (2.5, 3), (2.5, 0.8), (0, 0.8)],
                      box(2.8, 0.5, 6.2, 2.7, is_hole=True)]  # fmt: skip
        hexagon = [(0, 2), (1, 0), (5, 0), (6, 2), (5, 4), (1, 4)]
        holes = [box(0.4, 0.3, 3.7, 3.5, is_hole=True), box(4.3, 0.6, 8.5, 3.8, is_hole=True)]
        for card, outlines in (
            ("T\n,4.,5.,1.,1.", [tee[::-1]]),
            ("T1\n,4.,4.,1.,1.", [[(-z, y) for z, y in turned[::-1]]]),
            ("CHAN\n,3.,6.,1.,1.", [channel]),
            ("L\n,5.,4.,.5,.7", [angle]),
            ("Z\n,2.,1.,2.,3.", [zed]),
            ("HAT\n,4.,.5,4.,2.", [hat]),
            ("HAT1\n,9.,3.,4.,.3,.5", closed_hat),
            ("HEXA\n,1.,6.,4.", [hexagon]),
            ("DBOX\n,9.,4.,4.,.4,.6,.5,.5,.3\n,.2,.6", [box(0, 0, 9, 4), *holes]),
        ):
            with self.subTest(card):
                shape = self.read_shape(f"PBARL,1,1,,{card}")
                area, hh, ww, hw, _, _ = integrate(*outlines)
                np.testing.assert_allclose(shape[:4], (area, hh, ww, -hw), rtol=1e-12, atol=1e-12)
                mirrored = [[(-z, y) for z, y in outline] for outline in outlines]
                np.testing.assert_allclose(find_extremes(shape), find_farthest(mirrored), rtol=1e-12)

    def test_a_shape_whose_shear_centre_is_not_its_centroid_is_told(self):
        for card, is_told in (
            ("I\n,6.,4.,4.,1.,1.,1.", False), ("I\n,6.,4.,3.,1.,1.,1.", True), ("I\n,6.,4.,4.,1.,1.,.5", True),
            ("BOX1\n,4.,6.,1.,1.,.5,.5", False), ("BOX1\n,4.,6.,1.,1.,.5,.6", True),
            ("L\n,5.,4.,.5,.7", True), ("HAT\n,4.,.5,4.,2.", True), ("Z\n,2.,1.,2.,3.", False),
        ):  # fmt: skip
            with self.subTest(card):
                mesh = self.read(NASTRAN.replace("ENDDATA", f"PBARL,1,1,,{card}\nENDDATA"))
                found = [one for one in mesh.sections[0].left_out if one.startswith("the way from its shear centre")]
                self.assertEqual(bool(found), is_told)

    def test_a_mass_per_length_stands_behind_the_dimensions(self):
        for card, expected in (("DBOX\n,9.,4.,4.,.4,.6,.5,.5,.3\n,.2,.6,7.", 7.0), ("HEXA\n,1.,6.,4.,5.", 5.0)):
            mesh = self.read(NASTRAN.replace("ENDDATA", f"PBARL,1,1,,{card}\nENDDATA"))
            self.assertEqual(mesh.sections[0].extra_mass, expected)

    def test_a_continuation_belongs_to_the_line_before_it_by_its_mark(self):
        # Quick Reference Guide, "Format of Bulk Data Entries": field 10 of a line equals field 1 of its continuation.
        card = "PBARL   1       1               BAR{blanks}+A\n".format(blanks=" " * 37)
        bulk = NASTRAN.replace("ENDDATA", "{}{}ENDDATA")
        self.assertEqual(self.read(bulk.format(card, "+A      2.      3.\n")).sections[0].shape.area, 6.0)
        self.assertEqual(self.read(bulk.format(card, "+       2.      3.\n")).sections[0].shape.area, 6.0)
        self.assertEqual(self.read(bulk.format(card, "        2.      3.\n")).sections[0].shape.area, 6.0)
        self.assertEqual(self.read(bulk.format(card, "+a      2.      3.\n")).sections[0].shape.area, 6.0)
        self.assertEqual(self.read(bulk.format("PBARL,1,1,,BAR,,,,,+A\n", "+A,2.,3.\n")).sections[0].shape.area, 6.0)
        # What does not begin with + is no mark: sequence numbers, words.
        self.assertEqual(self.read(bulk.format(card.replace("+A", "KA"), "+B      2.\n")).sections[0].shape, None)
        for first, second in ((card, "+B      2.      3.\n"), ("PBARL,1,1,,BAR,,,,,+A\n", "+B,2.,3.\n")):
            (self.folder / "b.bdf").write_text(bulk.format(first, second), encoding="utf-8")
            process = self.run_tool("convert_mesh", "b.bdf", "a.msh")
            self.assert_refuses(process, "b.bdf:6: error: PBARL: continues by '+B', but the line before it")

    def test_general_properties(self):
        self.assertEqual(self.read_shape("PBAR,1,1,2.,3.,4.\n,\n,,,.5"), Shape(2.0, 3.0, 4.0, -0.5))
        self.assertEqual(self.read_shape("PBEAM,1,1,2.,3.,4.,.5"), Shape(2.0, 3.0, 4.0, -0.5))
        self.assertIsNone(self.read_shape("PBARL,1,1,,TUBE\n,1.,2."))


if __name__ == "__main__":
    unittest.main()
