"""Reading meshes of Code_Aster in its text format."""

import unittest

import numpy as np
from tool_test_case import ToolTestCase

from sprung_tools.files.errors import InputError
from sprung_tools.mesh_import.aster_mesh import read_aster_mesh

PORTAL = """TITRE
a portal, with % signs of comments
FINSF
%
COOR_2D NOM=NODES
 A  0.0     0.0
 B  0.0     2.0D0   % the knee
 C  3.0E+00 2.0
 D  3.0     0.0
FINSF
SEG2 NOM = BARS
 NBOBJ=3
 S1 A B  S2 B C
 S3 C D
FINSF
TRIA3
 T1 A B C
FINSF
GROUP_MA
 POSTS
 S1 S3
FINSF
GROUP_MA NOM=ALL
 S1 S2 S3 T1
FINSF
GROUP_NO
 FEET A D
FINSF
FIN
"""


class AsterMeshTest(ToolTestCase):
    def write(self, text, name="a.mail"):
        (self.folder / name).write_text(text, encoding="utf-8")
        return str(self.folder / name)

    def test_the_help_of_the_tool_names_the_format(self):
        self.assertIn("Code_Aster's .mail", self.run_tool("convert_mesh", "--help").stdout)

    def test_a_group_may_have_its_name_in_the_line_after_its_keyword(self):
        mesh = read_aster_mesh(self.write(PORTAL.replace("GROUP_MA\n POSTS\n", "GROUP_MA\n NOM = POSTS  NBOBJ=2\n")))
        self.assertEqual(mesh.element_sets["POSTS"].tolist(), [0, 2])

    def test_nodes_lines_and_groups_are_those_of_the_file(self):
        mesh = read_aster_mesh(self.write(PORTAL))
        np.testing.assert_array_equal(mesh.positions, [[0, 0, 0], [0, 2, 0], [3, 2, 0], [3, 0, 0]])
        np.testing.assert_array_equal(mesh.lines, [[0, 1], [1, 2], [2, 3]])
        self.assertEqual({name: list(lines) for name, lines in mesh.element_sets.items()},
                         {"POSTS": [0, 2], "ALL": [0, 1, 2]})  # fmt: skip
        self.assertEqual({name: list(nodes) for name, nodes in mesh.node_sets.items()}, {"FEET": [0, 3]})
        self.assertIn("elements TRIA3, which are not lines", mesh.left_behind)

    def test_a_line_with_middle_nodes_is_lines_from_node_to_node_in_each_of_its_groups(self):
        # Both ends stand before the middle nodes: of SEG4 at one third and at two thirds.
        mesh = read_aster_mesh(self.write(PORTAL.replace("S1 A B  S2 B C\n S3 C D", "S1 A B\nFINSF\nSEG4\n S2 A C B D\n"
                                                         "FINSF\nSEG3\n S3 B D C")))  # fmt: skip
        self.assertEqual(mesh.lines.tolist(), [[0, 1], [0, 1], [1, 3], [3, 2], [1, 2], [2, 3]])
        self.assertEqual({name: lines.tolist() for name, lines in mesh.element_sets.items()},
                         {"POSTS": [0, 4, 5], "ALL": [0, 1, 2, 3, 4, 5]})  # fmt: skip
        self.assertIn("middle nodes of 2 lines: each has become straight ones from node to node", mesh.left_behind)

    def test_a_mesh_is_converted_and_its_design_leaves_open_what_the_command_file_has(self):
        self.write(PORTAL.replace("GROUP_MA NOM=ALL\n S1 S2 S3 T1", "GROUP_MA NOM=BEAM\n S2"), "portal.mail")
        result = self.run_tool("convert_mesh", "portal.mail", "portal.msh")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("Code_Aster mesh, 4 nodes and 3 lines in the x–y plane, 3 m by 2 m", result.stdout)
        design = (self.folder / "portal.toml").read_text(encoding="utf-8")
        self.assertIn('[sections."POSTS"]', design)
        self.assertIn("# youngs_modulus =", design)
        self.assertIn("command file", design)

    def test_a_shuffled_mesh_is_the_same(self):
        blocks = [block + "FINSF\n" for block in PORTAL.removesuffix("FIN\n").split("FINSF\n") if block.strip()]
        shuffled = read_aster_mesh(self.write("".join(reversed(blocks)) + "FIN\n"))
        mesh = read_aster_mesh(self.write(PORTAL, "b.mail"))
        np.testing.assert_array_equal(shuffled.positions, mesh.positions)
        np.testing.assert_array_equal(shuffled.lines, mesh.lines)

    def test_a_mark_of_the_encoding_and_commas_change_nothing(self):
        mesh = read_aster_mesh(self.write(PORTAL))
        marked = PORTAL.replace("TITRE", "SEG2\n S4 A,C\nFINSF\nTITRE", 1)
        read = read_aster_mesh(self.write("\ufeff" + marked))
        self.assertEqual(len(read.lines), len(mesh.lines) + 1)

    def test_damaged_meshes_are_refused_with_their_place(self):
        for old, new, message in (
            ("FIN\n", "", "the file is truncated"),
            ("FINSF\nFIN\n", "", "GROUP_NO of line 26 has no FINSF: the file is truncated"),
            ("3.0     0.0\n", "3.0\n", "a.mail:9: error: COOR_2D: node 'D' has 1 coordinates, expected 2"),
            ("3.0E+00", "three", "a.mail:8: error: COOR_2D: 'three' is not a number"),
            ("3.0E+00", "3_0.", "a.mail:8: error: COOR_2D: '3_0.' is not a number"),
            ("3.0E+00", "1e999", "a.mail:8: error: COOR_2D: '1e999' is not finite"),
            (" C  3.0", " B  3.0", "a.mail:8: error: COOR_2D: node 'B' is defined twice"),
            ("S3 C D", "S3 C X", "names the node 'X', which is not there"),
            ("S3 C D", "S1 C D", "element 'S1' is defined twice"),
            ("S3 C D", "S3 C", "element 'S3' has 1 nodes, expected 2"),
            ("FEET A D", "FEET A X", "the group 'FEET' names 'X', which is not there"),
            ("S3 C D", "S3 C D\nFINSF\nSEG3\n S4 A D", "a.mail:17: error: SEG3: element 'S4' has 2 nodes, expected 3"),
            ("COOR_2D", "COORDS", "0 tables of coordinates"),
            ("SEG2", "seg2", "a.mail:11: error: seg2: a block of a kind that is not known"),
        ):
            with self.subTest(new):
                position = PORTAL.rindex(old) if old.startswith("FIN") else PORTAL.index(old)
                with self.assertRaises(InputError) as caught:
                    read_aster_mesh(self.write(PORTAL[:position] + new + PORTAL[position + len(old) :]))
                self.assertIn(message, str(caught.exception))


if __name__ == "__main__":
    unittest.main()
