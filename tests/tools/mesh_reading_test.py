"""Reading the frame in other programs' mesh files: numbers, sets and names as they stand there."""

import unittest

import meshio
import numpy as np
from small_decks import ABAQUS, NASTRAN
from tool_test_case import ROOT, ToolTestCase

from sprung_tools.mesh_import.abaqus_deck import read_abaqus
from sprung_tools.mesh_import.plane_frame import make_plane_frame, rename_for_gmsh
from sprung_tools.mesh_import.meshio_reader import read_with_meshio
from sprung_tools.mesh_import.nastran_deck import read_nastran

DATA = ROOT / "tests/tools/data"
FEM_DATA = ROOT / "tests/fem/data"
TRUCK = ROOT / "meshes/truck"


class Reading(ToolTestCase):
    """Small things about decks."""

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return str(self.folder / name)

    def test_our_readers_agree_with_meshio_where_that_is_right(self):
        for reader, path in ((read_abaqus, TRUCK / "chassis.inp"), (read_nastran, TRUCK / "chassis.bdf"),
                             (read_abaqus, DATA / "gmsh_portal.inp")):  # fmt: skip
            with self.subTest(path.name):
                ours, theirs = reader(str(path)), read_with_meshio(str(path))
                np.testing.assert_array_equal(ours.positions, theirs.positions)
                np.testing.assert_array_equal(ours.lines, theirs.lines)

    def test_nodes_in_two_blocks_and_an_included_file_are_all_there(self):
        self.write("more.inp", "*NODE\n3, 2.0, 0.5\n")
        path = self.write("a.inp", "*NODE\n1, 0., 0.\n2, 1., 0.\n*INCLUDE, INPUT=more.inp\n"
                          "*ELEMENT, TYPE=b23\n1, 1, 2\n*Element, elset=A, type=B23\n2, 2, 3\n")  # fmt: skip
        mesh = read_abaqus(path)
        np.testing.assert_array_equal(mesh.positions[2], (2.0, 0.5, 0.0))
        self.assertEqual({name: list(lines) for name, lines in mesh.element_sets.items()}, {"A": [1]})
        self.assertEqual(list(make_plane_frame(mesh).curves), ["A", "lines"])

    def test_an_assembly_s_sets_are_its_own_and_name_nodes_by_the_instance(self):
        part = "*PART, NAME=P\n" + ABAQUS + "*NSET, NSET=Tip\n1\n*NSET, NSET=Ends, ELSET=a\n*END PART\n"
        instance = "*ASSEMBLY, NAME=Q\n*INSTANCE, NAME=P-1, PART=P\n*END INSTANCE\n*NSET, NSET=tip, INSTANCE=P-1\n3\n"
        sets = "*NSET, NSET=middle\nP-1.2\n*NSET, NSET=same\nTIP\n*NSET, NSET=part\np-1.tip\n*END ASSEMBLY\n"
        path = self.write("a.inp", part + instance + sets)
        mesh = read_abaqus(path)
        found = {name: mesh.node_ids[nodes].tolist() for name, nodes in mesh.node_sets.items()}
        expected = {"Tip": [1], "Ends": [1, 2, 3], "Assembly.tip": [3], "middle": [2], "same": [3], "part": [1]}
        self.assertEqual(found, expected)

    def test_numbers_may_have_fortran_s_exponent(self):
        mesh = read_abaqus(self.write("a.inp", ABAQUS.replace("2, 1., 0.", "2, 1.25d0, 0.")))
        self.assertEqual(mesh.positions[1, 0], 1.25)

    def test_nastran_sets_may_be_in_small_letters_and_a_deck_may_end_in_dat(self):
        self.write("a.dat", NASTRAN.replace("ENDDATA", "SET1,4,1,thru,2\nENDDATA"))
        self.assertEqual(self.run_tool("convert_mesh", "a.dat", "a.msh").returncode, 0)
        self.assertEqual(sorted(meshio.read(self.folder / "a.msh").field_data), ["property_1", "set_4_1", "set_4_2"])

    def test_names_that_gmsh_cannot_hold_are_changed_with_a_remark(self):
        long = "n" * 200
        names = {'a "b"': 0, "a 'b'": 1, " ": 2, "": 3, f"{long}1": 4, f"{long}2": 5, "as it was": 6}
        remarks = []
        renamed = rename_for_gmsh(names, "element set", remarks)
        cut = "n" * 120
        expected = {"a 'b'_2": 0, "a 'b'": 1, "unnamed": 2, "unnamed_2": 3, cut: 4, f"{cut}_2": 5, "as it was": 6}
        self.assertEqual(renamed, expected)
        self.assertEqual(len(remarks), 5)
        self.assertIn("""element set 'a "b"': now 'a 'b'_2'""", remarks[0])

    def test_a_set_of_many_nodes_is_told_in_few_lines(self):
        nodes = "".join(f"{n}, 0., {n}.\n" for n in range(1, 101))
        lines = "".join(f"{n}, {n}, {n + 1}\n" for n in range(1, 100))
        self.write("a.inp", f"*NODE, NSET=ALL\n{nodes}*ELEMENT, TYPE=B23, ELSET=A\n{lines}")
        told = self.run_tool("convert_mesh", "a.inp", "a.msh").stdout
        self.assertIn("76 more", told)
        self.assertNotIn("ALL_25 ", told)
        self.assertEqual(len(meshio.read(self.folder / "a.msh").field_data), 101)

    def test_the_vtk_of_gmsh_keeps_its_entities_as_groups_and_its_lines_directions(self):
        frame = make_plane_frame(read_with_meshio(str(DATA / "gmsh_portal.vtk")))
        sizes = {name: len(lines) for name, lines in frame.curves.items()}
        self.assertEqual(sizes, {"CellEntityIds_-2": 2, "CellEntityIds_1": 3, "CellEntityIds_2": 4})

    def test_a_group_that_turns_a_curve_round_turns_its_lines(self):
        mesh = read_with_meshio(str(FEM_DATA / "portal_41.msh"))
        turned = mesh.positions[mesh.lines[mesh.element_sets["post"][-1]]]
        np.testing.assert_allclose(turned[:, :2], [(1.2, -0.8), (0.75, -0.35)], atol=1e-11)  # Line 3 runs 1 → 3

    def test_gmsh_entities_without_a_group_are_read(self):
        # Curve 2 of the portal, elements 6 to 9, loses its group; gmsh writes such files by Mesh.SaveAll = 1.
        text = (FEM_DATA / "portal_41.msh").read_text(encoding="utf-8")
        whole = read_with_meshio(str(FEM_DATA / "portal_41.msh"))
        mesh = read_with_meshio(self.write("a.msh", text.replace(" 0.7 1 2 2 2 -3", " 0.7 0 2 2 -3")))
        np.testing.assert_array_equal(mesh.lines, whole.lines)
        self.assertEqual(mesh.element_sets["rail"].tolist(), whole.element_sets["rail"].tolist())
        self.assertEqual(list(mesh.element_sets["post"]), [n for n in whole.element_sets["post"] if not 3 <= n < 7])
        self.assertEqual(list(make_plane_frame(mesh).curves), ["rail", "post", "lines"])

    def test_a_gmsh_2_curve_in_two_groups_is_not_doubled(self):
        # The format repeats the elements of such a curve for each group; elements 4 and 5 close a circle.
        path = self.write("a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
                          '$PhysicalNames\n3\n1 1 "a"\n1 2 "b"\n1 3 "c"\n$EndPhysicalNames\n'
                          "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 2 0 0\n$EndNodes\n$Elements\n5\n"
                          "1 1 2 1 1 1 2\n2 1 2 2 1 1 2\n3 1 2 -3 1 2 1\n4 1 2 1 2 2 3\n5 1 2 1 2 3 2\n"
                          "$EndElements\n")  # fmt: skip
        mesh = read_with_meshio(path)
        self.assertEqual(mesh.lines.tolist(), [[0, 1], [1, 2], [2, 1]])
        self.assertEqual({name: lines.tolist() for name, lines in mesh.element_sets.items()},
                         {"a": [0, 1, 2], "b": [0], "c": [0]})  # fmt: skip
        refused = self.run_tool("convert_mesh", "a.msh", "out.msh")
        self.assert_refuses(refused, "element 1 is in the sets 'c' and 'a'", "--sections")

    def test_lines_with_middle_nodes_are_divided_at_these(self):
        points = np.array([[x, y, 0.0] for x, y in ((0, 0), (4, 0), (8, 2), (2, 0.5), (6, 1), (8, 6), (8, 5), (8, 4))])
        cells = [("line3", [[0, 1, 3], [1, 2, 4], [5, 7, 6]]), ("line", [[7, 2]])]
        numbers = [np.array([1, 2, 2]), np.array([3])]
        meshio.Mesh(points, cells, cell_data={"part": numbers}).write(self.folder / "a.vtk")
        families = meshio.Mesh(points, cells, cell_data={"cell_tags": [-one for one in numbers]})
        families.cell_tags = {-1: ["one"], -2: ["two"], -3: ["three"]}
        families.write(self.folder / "a.med")
        for name, sets in (("a.vtk", ("part_1", "part_2", "part_3")), ("a.med", ("one", "two", "three"))):
            with self.subTest(name):
                found = read_with_meshio(str(self.folder / name))
                ends = [[tuple(found.positions[node, :2].tolist()) for node in line] for line in found.lines]
                groups = [[ends[line] for line in found.element_sets[one]] for one in sets]
                self.assertEqual(groups[0], [[(0, 0), (2, 0.5)], [(2, 0.5), (4, 0)]])
                self.assertEqual(groups[1], [[(4, 0), (6, 1)], [(6, 1), (8, 2)], [(8, 6), (8, 5)], [(8, 5), (8, 4)]])
                self.assertEqual(groups[2], [[(8, 4), (8, 2)]])
                self.assertIn("middle nodes of 3 lines: each has become straight ones from node to node",
                              found.left_behind)  # fmt: skip
        thirds = points[[0, 1, 3, 3]] + np.array([[0, 0, 0], [2, 1.5, 0], [0, 0, 0], [2, 0.5, 0]])
        meshio.Mesh(thirds, [("line4", [[0, 1, 2, 3]])]).write(self.folder / "b.vtu")
        self.assertEqual(read_with_meshio(str(self.folder / "b.vtu")).lines.tolist(), [[0, 2], [2, 3], [3, 1]])

    def test_lengths_are_scaled_and_numbers_keep_their_last_digit(self):
        self.write("a.inp", "*NODE\n1, 0.1, 0.3\n2, 1234.5678901234567, 0.3\n*ELEMENT, TYPE=B23, ELSET=A\n1, 1, 2\n")
        self.run_tool("convert_mesh", "a.inp", "a.msh")
        points = meshio.read(self.folder / "a.msh").points
        self.assertEqual(points[1, 0], 1234.5678901234567)
        self.run_tool("convert_mesh", "a.inp", "a.msh", "--scale", "1e-3")
        self.assertEqual(meshio.read(self.folder / "a.msh").points[1, 0], 1e-3 * 1234.5678901234567)

    def test_overlapping_sets_are_told_apart_by_name(self):
        refused = self.run_tool("convert_mesh", DATA / "gmsh_portal.inp", "a.msh")
        self.assert_refuses(refused, "element 3 is in the sets 'Line1' and 'rail'", "--sections")
        chosen = self.run_tool("convert_mesh", DATA / "gmsh_portal.inp", "a.msh", "--sections", "rail", "post")
        self.assertEqual(chosen.returncode, 0, chosen.stderr)
        self.assertIn("element set 'Line1' (3 lines): not asked for", chosen.stdout)
        self.assertEqual(sorted(meshio.read(self.folder / "a.msh").field_data), ["post", "rail"])

    def test_nastran_sections_that_are_hinged_are_told(self):
        path = self.write("a.bdf", "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.5-1,0.,0.\n"
                          "CBAR,1,,1,2,0.,1.,0.\n,6,\nENDDATA\n")  # fmt: skip
        mesh = read_nastran(path)
        self.assertIn("hinges (pin flags) of elements 1", mesh.left_behind)
        self.assertEqual(mesh.positions[1, 0], 0.15)
        self.assertEqual(list(mesh.element_sets), ["property_1"])  # a bar's property is its own number if none is given


if __name__ == "__main__":
    unittest.main()
