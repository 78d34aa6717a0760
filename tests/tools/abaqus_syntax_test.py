"""How Abaqus and CalculiX decks may be written: abbreviations, included files, lines that go on."""

import unittest

import numpy as np
from abaqus_case import AbaqusCase
from small_decks import ABAQUS

NODES = "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 2., 0., 0.\n4, 3., 0., 0.\n"
BEAMS = "*ELEMENT, TYPE=B31, ELSET=A\n1, 1, 2\n2, 2, 3\n"
SECTION = "*BEAM SECTION, ELSET=A, SECTION=RECT, MATERIAL=M\n2., 3.\n"


class Abbreviations(AbaqusCase):
    """Input syntax rules: "Keywords, parameters, and, in most cases, parameter values need not be spelled out"."""

    def test_what_is_abbreviated_is_read_as_what_is_written_out(self):
        box = "*BEAM SECTION, ELSET=A, SECTION=BOX, MATERIAL=M\n4., 6., .5, 1., .5, 1.\n"
        sets = "*NSET, NSET=N, GENERATE\n1, 3, 1\n*ELSET, ELSET=E, GENERATE\n1, 2, 1\n"
        lump = "*ELEMENT, TYPE=MASS, ELSET=P\n9, 4\n*MASS, ELSET=P, TYPE=ISOTROPIC\n5.\n"
        steel = "*MATERIAL, NAME=M\n*ELASTIC, TYPE=ISOTROPIC\n2.1e11, .3\n*DENSITY\n7850.\n"
        whole = NODES + "*NODE, SYSTEM=C\n5, 2., 90., 7.\n" + BEAMS + box + sets + lump + steel
        plain = self.read(whole)
        self.assertEqual(plain.sections[0].shape.area, 12.0)
        for old, new in (
            ("SECTION=BOX", "SECT=BOX"), ("SECTION=BOX", "SEC=BO"), ("GENERATE", "GEN"), ("GENERATE", "g"),
            ("SYSTEM=C", "SYS=C"), ("*ELEMENT", "*ELEM"), ("*MATERIAL", "*MAT"), ("*NSET", "*NSE"),
            ("*BEAM SECTION", "*BEAM SECT"), ("*DENSITY", "*Dens"), ("MATERIAL=M", "MAT=M"), ("TYPE=", "TY ="),
            ("TYPE=ISOTROPIC", "TYPE=ISO"), ("*ELASTIC", "*ELAS"), ("*MASS", "*MAS"), ("ELSET=A", "ELS=A"),
        ):  # fmt: skip
            with self.subTest((old, new)):
                self.assertIn(old, whole)
                mesh = self.read(whole.replace(old, new))
                self.assertEqual(mesh.sections[0].shape, plain.sections[0].shape)
                np.testing.assert_array_equal(mesh.positions, plain.positions)
                np.testing.assert_array_equal(mesh.lines, plain.lines)
                self.assertEqual(mesh.materials, plain.materials)
                self.assertEqual(mesh.point_masses[0].mass, 5.0)
                for found, expected in ((mesh.node_sets, plain.node_sets), (mesh.element_sets, plain.element_sets)):
                    self.assertEqual({name: one.tolist() for name, one in found.items()},
                                     {name: one.tolist() for name, one in expected.items()})  # fmt: skip

    def test_longer_keywords_are_not_taken_for_those_that_they_begin_with(self):
        others = "*ELEMENT OUTPUT\nS\n*NODE PRINT, NSET=A\nU\n*NODE FILE\nU\n*EL PRINT\nS\n*MATRIX INPUT, NAME=K\n"
        mesh = self.read(NODES + BEAMS + SECTION + others)
        self.assertEqual((len(mesh.lines), len(mesh.node_ids)), (2, 4))

    def test_what_is_not_clear_or_not_known_is_refused(self):
        for data, line, message in (
            ("*BEAM SECTION, ELSET=A, MATERIAL=M\n1., 2., 0., 3., 4.\n", 9, "*BEAM SECTION: has no SECTION"),
            ("*BEAM SECTION, ELSET=A, SECTON=RECT\n2., 3.\n", 9, "*BEAM SECTION: 'SECTON' is no parameter that is"),
            ("*NSET, NSET=B, GENRATE\n1, 3, 1\n", 9, "*NSET: 'GENRATE' is no parameter that is known, expected ELSET"),
            ("*NSET, N=B\n1\n*ELSET, E=C, I\n1\n", 11, "*ELSET: 'I' may stand for INPUT or INSTANCE or INTERNAL"),
            ("*BEAM SECTION, ELSET=A, SECT=BOX, SECTION=RECT\n", 9, "*BEAM SECTION: has SECTION twice"),
            ("*EL, TYPE=B31\n7, 3, 4\n", 9, "*EL: may stand for"),
            ("*BEAM, ELSET=A, SECT=RECT\n2., 3.\n", 9, "*BEAM: may stand for BEAM GENERAL SECTION or BEAM SECTION"),
            ("*NODE, FILE=a.txt\n", 9, "*NODE: 'FILE' is no parameter"),
        ):
            with self.subTest(data):
                self.assert_refused(NODES + BEAMS + data, f"{line}: error: {message}")

    def test_a_general_section_is_the_default_of_beam_general_section(self):
        mesh = self.read(NODES + BEAMS + "*BEAM GENERAL SECTION, ELSET=A\n2., 3., 0., 4., 1.\n")
        self.assertEqual(mesh.sections[0].shape[:3], (2.0, 3.0, 4.0))


class Included(AbaqusCase):
    """The lines of an included file stand in the place of the *INCLUDE."""

    def write(self, name, text):
        (self.folder / name).parent.mkdir(exist_ok=True)
        (self.folder / name).write_text(text, encoding="utf-8")

    def test_data_lines_before_in_and_behind_an_include_belong_to_one_block(self):
        expected = self.read(NODES + BEAMS + SECTION)
        for text, included in (
            ("*NODE\n*INCLUDE, INPUT=c.inp\n3, 2., 0., 0.\n4, 3., 0., 0.\n" + BEAMS, "1, 0., 0.\n2, 1., 0.\n"),
            (NODES + "*INCLUDE, INPUT=c.inp\n2, 2, 3\n", "*ELEMENT, TYPE=B31, ELSET=A\n1, 1, 2\n"),
            (NODES + "*INCLUDE, INPUT=c.inp\n3\n", BEAMS.replace("2, 2, 3", "2, 2,")),
        ):
            with self.subTest(text):
                self.write("c.inp", included)
                mesh = self.read(text + SECTION)
                np.testing.assert_array_equal(mesh.positions, expected.positions)
                np.testing.assert_array_equal(mesh.lines, expected.lines)
                self.assertEqual(mesh.element_sets["A"].tolist(), [0, 1])
        self.write("c.inp", "1, 0., x\n")
        self.assert_refused("*NODE\n*INCLUDE, INPUT=c.inp\n", "1: error: *NODE: 'x' is not a number", "c.inp:")

    def test_a_file_is_looked_for_from_the_deck_s_folder_then_beside_the_file_that_names_it(self):
        self.write("sub/a.inp", "*INCLUDE, INPUT=sub/b.inp\n*INCLUDE, INPUT=c.inp\n")
        self.write("sub/b.inp", NODES)
        self.write("sub/c.inp", "9, 9., 0., 0.\n")
        text = "*INCLUDE, INPUT=sub/a.inp\n" + BEAMS
        self.assertEqual(self.read(text).node_ids.tolist(), [1, 2, 3, 4, 9])
        self.write("c.inp", "8, 8., 0., 0.\n")
        self.assertEqual(self.read(text).node_ids.tolist(), [1, 2, 3, 4, 8])
        self.write("sub/a.inp", "** comment\n*INCLUDE, INPUT=d.inp\n")
        self.assert_refused(text, "2: error: *INCLUDE: there is no file ", "sub/a.inp:")
        self.write("sub/a.inp", "*INCLUDE, INPUT=sub/a.inp\n")
        self.assert_refused(text, "1: error: *INCLUDE: 'sub/a.inp' includes itself", "sub/a.inp:")


class Commas(AbaqusCase):
    """Lines that end with a comma."""

    def test_an_element_that_has_all_its_nodes_ends_with_its_line(self):
        for kind, rows in (
            ("CONN3D2", ((7, [3, 4]), (8, [1, 4]))), ("SPRINGA", ((7, [3, 4]), (8, [1, 4]))),
            ("MASS", ((7, [3]), (8, [4]))), ("C3D4", ((7, [1, 2, 3, 4]), (8, [4, 3, 2, 1]))),
        ):  # fmt: skip
            with self.subTest(kind):
                data = "".join(f"{number}, {', '.join(map(str, nodes))},\n" for number, nodes in rows)
                sets = "*ELSET, ELSET=B\n7, 8\n*NSET, NSET=B, ELSET=B\n"
                mesh = self.read(NODES + BEAMS + f"*ELEMENT, TYPE={kind}\n{data}{sets}")
                found = sorted({node for _, nodes in rows for node in nodes})
                self.assertEqual(sorted(mesh.node_ids[mesh.node_sets["B"]].tolist()), found)
                self.assertTrue(any(f"2 elements of type {kind}" in text or kind in text for text in mesh.left_behind))
        masses = "*ELEMENT, TYPE=MASS, ELSET=P\n7, 3,\n8, 4,\n*MASS, ELSET=P\n5.\n"
        self.assertEqual([one.node for one in self.read(NODES + BEAMS + masses).point_masses], [2, 3])

    def test_an_element_that_needs_more_nodes_goes_on_in_the_next_line(self):
        mesh = self.read(NODES + "*ELEMENT, TYPE=B32, ELSET=A\n1, 1, 2,\n3\n" + SECTION)
        self.assertEqual(mesh.lines.tolist(), [[0, 1], [1, 2]])
        self.assert_refused(NODES + "*ELEMENT, TYPE=B31\n1, 1, , 4\n", "7: error: *ELEMENT: expects a number, but the")

    def test_a_keyword_line_that_ends_with_a_comma_takes_no_numbers_from_the_next_line(self):
        mesh = self.read(NODES + BEAMS + "*NSET, NSET=B,\n1, 3\n*MATERIAL, NAME=M\n*ELASTIC,\n2.1e11, .3\n")
        self.assertEqual(mesh.node_sets["B"].tolist(), [0, 2])
        self.assertEqual(mesh.materials["M"].youngs_modulus, 2.1e11)
        mesh = self.read(NODES + BEAMS + "*NSET,\nNSET=B, GENERATE\n1, 3, 2\n")
        self.assertEqual(mesh.node_sets["B"].tolist(), [0, 2])

    def test_a_node_with_a_comma_and_no_coordinates_is_the_origin(self):
        self.assertEqual(self.read(ABAQUS.replace("1, 0., 0., 0.", "1,")).positions[0].tolist(), [0.0, 0.0, 0.0])
        self.assert_refused(ABAQUS.replace("1, 0., 0., 0.", "1"), "2: error: *NODE: node 1 has no coordinates")


if __name__ == "__main__":
    unittest.main()
