"""Reading Abaqus and CalculiX decks: assemblies, nodes, elements and masses, against numbers worked out by hand."""

import unittest

import numpy as np
from abaqus_case import AbaqusCase
from small_decks import ABAQUS

from sprung_tools.mesh_import.plane_frame import make_plane_frame

# A leg of 2 m along x, of two lines; its second instance stands upright at x = 3: moved by (3, 0), then turned by 90°
# about the line through (3, 0) along z.
PART = (
    "*PART, NAME=LEG\n*NODE\n1, 0., 0.\n2, 1., 0.\n3, 2., 0.\n*ELEMENT, TYPE=B23, ELSET=ALL\n1, 1, 2\n2, 2, 3\n"
    "*NSET, NSET=TIP\n3\n*BEAM SECTION, SECTION=RECT, ELSET=ALL, MATERIAL=M\n0.1, 0.2\n*END PART\n"
)
ASSEMBLY = (
    "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=L-1, PART=LEG\n*END INSTANCE\n*INSTANCE, NAME=L-2, PART=LEG\n3., 0., 0.\n"
    "3., 0., 0., 3., 0., 1., 90.\n*END INSTANCE\n{sets}*END ASSEMBLY\n*MATERIAL, NAME=m\n*ELASTIC\n2.1e11, 0.3\n"
)


class AbaqusReading(AbaqusCase):
    """Where nodes, elements and masses are, and which sets hold them."""

    def test_a_moved_and_turned_instance_is_in_its_place_with_numbers_of_its_own(self):
        mesh = self.read(PART + ASSEMBLY.format(sets=""))
        self.assertEqual(mesh.node_ids.tolist(), [1, 2, 3, 1001, 1002, 1003])
        np.testing.assert_allclose(mesh.positions[3:], [[3.0, 0.0, 0.0], [3.0, 1.0, 0.0], [3.0, 2.0, 0.0]], atol=1e-15)
        self.assertEqual(mesh.line_ids.tolist(), [1, 2, 1001, 1002])
        both = (mesh.element_sets, mesh.node_sets)
        lines, nodes = ({name: one.tolist() for name, one in sets.items()} for sets in both)
        self.assertEqual(lines, {"L-1.ALL": [0, 1], "L-2.ALL": [2, 3]})
        self.assertEqual(nodes, {"L-1.TIP": [2], "L-2.TIP": [5]})
        # The height is normal to the line in the plane, since the 1-direction is the plane's normal.
        np.testing.assert_allclose(np.abs(mesh.heights), [[0, 1, 0]] * 2 + [[1, 0, 0]] * 2, atol=1e-15)
        self.assertIn("which are now larger (L-2: 1000 and 1000)", " ".join(mesh.left_behind))

    def test_a_mark_of_the_encoding_before_the_first_keyword_changes_nothing(self):
        text = PART + ASSEMBLY.format(sets="")
        np.testing.assert_array_equal(self.read("\ufeff" + text).positions, self.read(text).positions)

    def test_a_blank_field_or_line_of_an_instance_is_zero_and_keeps_its_place(self):
        up = [[0.0, 5.0, 0.0], [1.0, 5.0, 0.0], [2.0, 5.0, 0.0]]
        turned = [[3.0, -3.0, 0.0], [3.0, -2.0, 0.0], [3.0, -1.0, 0.0]]  # (x, y) → (3 - y, x - 3), by 90° about (3, 0)
        for data, expected in (
            (", 5.\n", up),
            (" , 5. ,\n\n , \n", up),
            ("\n3., , , 3., , 1., 90.\n", turned),
            ("0.,\n3., , , 3., , 1., 90.\n", turned),
        ):
            with self.subTest(data):
                placed = ASSEMBLY.format(sets="").replace("3., 0., 0.\n3., 0., 0., 3., 0., 1., 90.\n", data)
                np.testing.assert_allclose(self.read(PART + placed).positions[3:], expected, atol=1e-15)
        (self.folder / "b.inp").write_text(PART + ASSEMBLY.format(sets="").replace(" 90.\n", "\n"), encoding="utf-8")
        process = self.run_tool("convert_mesh", "b.inp", "a.msh")
        self.assertEqual(process.returncode, 0, process.stderr)  # a blank angle is one of 0°
        (self.folder / "c.inp").write_text(PART + ASSEMBLY.format(sets="").replace(", 90.\n", "\n"), encoding="utf-8")
        process = self.run_tool("convert_mesh", "c.inp", "a.msh")
        self.assert_refuses(process, "turns its part by two points and an angle, which are seven numbers")

    def test_an_assembly_names_nodes_and_sets_of_its_instances(self):
        sets = "*NSET, NSET=A\nL-1.3, L-2.1\n*NSET, NSET=B, INSTANCE=L-2\n2, TIP\n*NSET, NSET=C\nL-1.TIP, A\n"
        sets += "*ELSET, ELSET=D, INSTANCE=L-2, GENERATE\n1, 2\n"
        mesh = self.read(PART + ASSEMBLY.format(sets=sets))
        found = {name: mesh.node_ids[nodes].tolist() for name, nodes in mesh.node_sets.items()}
        self.assertEqual((found["A"], found["B"], found["C"]), ([3, 1001], [1002, 1003], [3, 1001]))
        self.assertEqual(mesh.element_sets["D"].tolist(), [2, 3])
        (self.folder / "b.inp").write_text(PART + ASSEMBLY.format(sets="*NSET, NSET=A\nL-3.1\n"), encoding="utf-8")
        process = self.run_tool("convert_mesh", "b.inp", "a.msh")
        self.assert_refuses(process, "names the instance 'L-3', which is not there")

    def test_an_instance_has_its_part_s_nodes_and_elements_alone(self):
        # L-2 has nodes 1001 to 1003: neither L-1.1001 nor L-2.-998 is one.
        joint = "*ELEMENT, TYPE=B23, ELSET=J\n1, L-1.3, {}\n"
        for data, message in (
            (joint.format("L-1.1001"), "22: error: *ELEMENT: L-1 has no node 1001"),
            (joint.format("L-2.-998"), "22: error: *ELEMENT: L-2 has no node -998"),
            ("*NSET, NSET=A\nL-2.-998\n", "22: error: *NSET: L-2 has no node -998"),
            ("*NSET, NSET=A, INSTANCE=L-1, GENERATE\n1002, 1003, 1\n", "22: error: *NSET: L-1 has no node 1002"),
            ("*NSET, NSET=A, INSTANCE=L-1, GENERATE\n1, 1002\n", "22: error: *NSET: L-1 has no node 1002"),
            ("*ELSET, ELSET=A\nL-2.2, L-1.1002\n", "22: error: *ELSET: L-1 has no element 1002"),
            ("*NSET, NSET=A\n1002\n*NSET, NSET=B, INSTANCE=L-3\nA\n", "24: error: *NSET: names the instance 'L-3'"),
        ):
            with self.subTest(data):
                self.assert_refused(PART + ASSEMBLY.format(sets=data), message)

    def test_a_set_s_name_beside_an_instance_is_the_instance_s(self):
        sets = "*NSET, NSET=TIP, INSTANCE=L-1\n1\n*NSET, NSET=A, INSTANCE=L-2\nTIP\n*NSET, NSET=B\nTIP, L-2.TIP\n"
        sets += "*NSET, NSET=OWN, INSTANCE=L-1\n2\n*NSET, NSET=C, INSTANCE=L-2\nOWN\n"
        mesh = self.read(PART + ASSEMBLY.format(sets=sets))
        found = {name: mesh.node_ids[nodes].tolist() for name, nodes in mesh.node_sets.items()}
        self.assertEqual((found["A"], found["B"], found["C"]), ([1003], [1, 1003], [2]))

    def test_surplus_numbers_of_an_instance_are_refused(self):
        for data, message in (
            ("0., 0., 0., 0., 0., 1., 90.\n", "18: error: *INSTANCE: has 7 numbers of its translation, expected 3 at"),
            ("0.\n3., 0., 0., 3., 0., 1., 90., 1.\n", "19: error: *INSTANCE: has 8 numbers of its rotation, expected"),
            ("0.\n3., 0., 0., 3., 0., 1., 90.\n1.\n", "20: error: *INSTANCE: has a further data line behind those o"),
        ):
            with self.subTest(data):
                placed = ASSEMBLY.format(sets="").replace("3., 0., 0.\n3., 0., 0., 3., 0., 1., 90.\n", data)
                self.assert_refused(PART + placed, message)

    def test_an_assembly_has_elements_of_its_own_on_nodes_of_its_instances(self):
        own = (
            "*ELEMENT, TYPE=B33, ELSET=JOINT\n1, L-1.3, 1\n2, l-2.1, 2, L-2.2\n*NODE\n1, 2.5, 0.\n2, 3., -1., 0.\n"
            "*ELEMENT, TYPE=MASS, ELSET=LUMP\n3, L-2.3\n4, L-1.2\n*MASS, ELSET=LUMP\n5.\n*ELSET, ELSET=E\n1, L-2.1\n"
            "*NSET, NSET=N\n1, L-2.1\n*ELEMENT, TYPE=CONN3D2\n5, L-1.1, L-2.1\n6, , 2\n"
            "*BEAM SECTION, SECTION=RECT, ELSET=JOINT, MATERIAL=M\n0.1, 0.2\n"
        )
        mesh = self.read(PART + ASSEMBLY.format(sets=own))
        place = {node: tuple(position) for node, position in zip(mesh.node_ids.tolist(), mesh.positions.tolist())}
        self.assertEqual(len(place), 8)  # its own node 1 is not the parts' node 1
        joints = mesh.node_ids[mesh.lines[mesh.element_sets["JOINT"]]]
        ends = [[place[node] for node in pair] for pair in joints.tolist()]
        np.testing.assert_allclose(ends, [[(2, 0, 0), (2.5, 0, 0)], [(3, 0, 0), (3, -1, 0)]], atol=1e-15)
        masses = [(one.mass, mesh.positions[one.node].tolist()) for one in mesh.point_masses]
        np.testing.assert_allclose([at for _, at in masses], [[3, 2, 0], [1, 0, 0]], atol=1e-15)
        self.assertEqual([mass for mass, _ in masses], [5.0, 5.0])
        np.testing.assert_allclose(mesh.positions[mesh.node_sets["N"]], [[2.5, 0, 0], [3, 0, 0]], atol=1e-15)
        self.assertEqual(mesh.line_ids[mesh.element_sets["E"]].tolist(), [1001, 2001])
        self.assertIn("connectors of type CONN3D2, which join nodes 1–1001, 2002", mesh.left_behind)
        self.assertIn("(L-2: 1000 and 1000, the assembly's own: 2000 and 2000)", " ".join(mesh.left_behind))
        for data, message in (
            ("*ELEMENT, TYPE=MASS\n1, L-3.1\n", "b.inp:22: error: *ELEMENT: names the instance 'L-3', which is not"),
            ("*ELEMENT, TYPE=B23\n1, L-1.1, L-1.4\n", "b.inp:22: error: *ELEMENT: L-1 has no node 4"),
            ("*ELEMENT, TYPE=B23\n1, L-1.1, L-1\n", "b.inp:22: error: *ELEMENT: 'L-1' is not a number"),
            ("*ELEMENT, TYPE=B23\n-1, L-1.1, L-1.2\n", "b.inp:22: error: *ELEMENT: numbers begin at 1"),
            ("*ELEMENT, TYPE=MASS\n1, L-1.1\n1, L-1.2\n", "b.inp:23: error: *ELEMENT: element 2001 is defined twice"),
            ("*ELGEN\n1, 3\n", "b.inp:21: error: *ELGEN: is not followed beside instances"),
        ):
            with self.subTest(data):
                (self.folder / "b.inp").write_text(PART + ASSEMBLY.format(sets=data), encoding="utf-8")
                self.assert_refuses(self.run_tool("convert_mesh", "b.inp", "a.msh"), message)

    def test_blanks_and_capitals_of_keyword_lines_are_ignored(self):
        # Analysis User's Guide, "Input syntax rules": "Blanks on a keyword line are ignored", but in quoted labels.
        line = "*ELEMENT, TYPE=B31, ELSET=MYSET\n1, 1, 2, 21\n*ELGEN, ELSET=MYSET, ALL NODES\n1, 4\n"
        section = "*BEAM GENERAL SECTION, ELSET=MYSET, SECTION=GENERAL, DENSITY=7.8\n1., 2., 0., 3., 4.\n\n2.6, 1.\n"
        nodes = "*NODE, NSET=ALL\n1, 0., 0., 0.\n5, 4., 0., 0.\n21, 0., 1., 0.\n25, 4., 0., 1.\n*NGEN\n1, 5\n21, 25\n"
        plain = self.read(nodes + line + section)
        self.assertEqual(plain.materials["SECTION OF MYSET"].density, 7.8)
        for old, new in (
            ("*BEAM GENERAL SECTION", "*BEAMGENERALSECTION"), ("*BEAM GENERAL SECTION", "* Beam\tgeneral   SECTION "),
            ("ALL NODES", "ALLNODES"), ("ALL NODES", "all\t nodes "), ("DENSITY=7.8", "density\t= 7.8 "),
            ("*ELGEN, ELSET=MYSET", "*EL GEN , EL SET = my set"), ("*NODE, NSET=ALL", "* N O D E"),
            ("ELSET=MYSET", "ELSET=\"MYSET\""), ("SECTION=GENERAL", "SEC TION = Gen eral"),
        ):  # fmt: skip
            with self.subTest((old, new)):
                text = nodes + line + section
                self.assertIn(old, text)
                mesh = self.read(text.replace(old, new))
                np.testing.assert_array_equal(mesh.lines, plain.lines)
                np.testing.assert_array_equal(mesh.heights, plain.heights)
                self.assertEqual(mesh.sections[0].shape, plain.sections[0].shape)
                self.assertEqual(list(mesh.materials.values()), list(plain.materials.values()))
        assembly = ASSEMBLY.format(sets="").replace("*END INSTANCE", "*ENDINSTANCE")
        whole = self.read(PART.replace("*END PART", "*ENDPART") + assembly)
        self.assertEqual(len(whole.lines), 4)
        quoted = '*NSET, NSET="A, b"\n1\n*NSET, NSET=Ab\n2\n*NSET, NSET=C\n"a, B", A b\n'
        sets = {name: found.tolist() for name, found in self.read(ABAQUS + quoted).node_sets.items()}
        self.assertEqual(sets, {"A, b": [0], "Ab": [1], "C": [0, 1]})

    def test_nodes_are_in_the_axes_of_a_system(self):
        # Keywords Reference, *SYSTEM: origin a, b on the x-axis, c in the x–y plane; without data the global axes.
        turned = "*SYSTEM\n1., 2., 3., 1., 4., 3.\n0., 2., 3.\n"  # x along the global y, y along the global −x
        nodes = "*NODE\n1, 4., 5., 6.\n*NODE, SYSTEM=C\n2, 2., 90., 7.\n*SYSTEM\n*NODE\n3, 7., 8., 9.\n"
        lines = "*SYSTEM\n1., 1.\n*NODE\n4, .5, .25\n*SYSTEM\n0., 0., 0., 3., 4., 0.\n*NODE\n5, 5., 0., 1.\n"
        mesh = self.read(turned + nodes + lines + "*ELEMENT, TYPE=B31\n1, 1, 2\n2, 3, 4\n")
        expected = [[-4, 6, 9], [-1, 2, 10], [7, 8, 9], [1.5, 1.25, 0], [3, 4, 1]]
        np.testing.assert_allclose(mesh.positions, expected, atol=1e-14)
        for origin in ("1.,,", "1.,,,", "1., 0., 0.,", "1.,,,,,,", "1.,,,\n,"):  # blank fields at the end do not count
            with self.subTest(origin):
                mesh = self.read(f"*SYSTEM\n{origin}\n*NODE\n1, 1., 2., 3.\n2, 0.\n*ELEMENT, TYPE=B31\n1, 1, 2\n")
                np.testing.assert_array_equal(mesh.positions, [[2, 2, 3], [1, 0, 0]])
        for data, message in (
            ("1., 2., 3., 4., 5., 6., 7.\n", "2: error: *SYSTEM: has 7 numbers of its origin and a point of"),
            ("1., 2., 3., 4., 5., 6.\n1., 2., 3., 4.\n", "3: error: *SYSTEM: has 4 numbers of a point, expected 3 at"),
            ("0., 0., 0., 1.\n0., 1.\n1.\n", "4: error: *SYSTEM: has a further data line behind those of its points"),
        ):
            with self.subTest(data):
                self.assert_refused(f"*SYSTEM\n{data}{nodes}", message)
        for data, where in (("0., 0., 0.,\n0., 1.\n", 3), ("1., 2., 3., 1., 2., 3.\n", 2),
                            ("0., 0., 0., 1., 0., 1.\n", 2),
                            ("0., 0., 0., 1., 0., 1.\n2., 0., 2.\n", 3)):  # fmt: skip
            (self.folder / "b.inp").write_text(f"*SYSTEM\n{data}{nodes}", encoding="utf-8")
            process = self.run_tool("convert_mesh", "b.inp", "a.msh")
            self.assert_refuses(process, f"b.inp:{where}: error: *SYSTEM: its points give no x-axis and no x–y plane")

    def test_nodes_and_elements_are_generated(self):
        nodes = "*NODE\n1, 0., 1.\n9, 8., 5.\n*NGEN, NSET=ALL\n1, 9, 2\n"
        mesh = self.read(nodes + "*ELEMENT, TYPE=B31\n1, 1, 3\n*ELGEN, ELSET=E\n1, 4, 2, 10\n")
        self.assertEqual(mesh.node_ids.tolist(), [1, 3, 5, 7, 9])
        np.testing.assert_allclose(mesh.positions[:, 0], [0, 2, 4, 6, 8])
        np.testing.assert_allclose(mesh.positions[:, 1], [1, 2, 3, 4, 5])
        self.assertEqual(mesh.line_ids.tolist(), [1, 11, 21, 31])
        self.assertEqual(mesh.lines.tolist(), [[0, 1], [1, 2], [2, 3], [3, 4]])
        self.assertEqual(mesh.element_sets["E"].tolist(), [0, 1, 2, 3])

    def test_blank_increments_of_generated_nodes_and_elements_are_1(self):
        # Keywords Reference: *NGEN, "The default is 1"; *ELGEN, both increments, "The default is one".
        nodes = "*NODE\n1, 0., 0.\n4, 3., 0.\n*NGEN\n1, 4, ,\n*ELEMENT, TYPE=B31\n1, 1, 2\n"
        mesh = self.read(nodes + "*ELGEN, ELSET=E\n1, 3, , 10\n*ELSET, ELSET=F, GENERATE\n1, 21, 10,\n")
        self.assertEqual(mesh.node_ids.tolist(), [1, 2, 3, 4])
        self.assertEqual(mesh.line_ids.tolist(), [1, 11, 21])
        self.assertEqual(mesh.lines.tolist(), [[0, 1], [1, 2], [2, 3]])
        self.assertEqual(mesh.element_sets["F"].tolist(), [0, 1, 2])
        rows = "*NODE\n1, 0., 0.\n11, 0., 1.\n2, 1., 0.\n12, 1., 1.\n*ELEMENT, TYPE=B31\n1, 1, 2\n"
        mesh = self.read(rows + "*ELGEN, ELSET=E\n1, , , , 2, 10, 10,\n")
        self.assertEqual(mesh.line_ids.tolist(), [1, 11])
        self.assertEqual(mesh.lines.tolist(), [[0, 1], [2, 3]])
        for data in ("*NGEN\n1, , 4\n", "*NSET, NSET=S, GENERATE\n1, , 4\n"):
            (self.folder / "b.inp").write_text(nodes + data, encoding="utf-8")
            process = self.run_tool("convert_mesh", "b.inp", "a.msh")
            self.assert_refuses(process, "b.inp:9: error: *N", ": expects a number, but the field is blank")

    def test_elements_that_would_be_generated_twice_or_without_a_number_are_refused(self):
        start = "*NODE\n1, 0., 0.\n9, 8., 0.\n*NGEN\n1, 9\n*ELEMENT, TYPE=B31\n1, 1, 2\n*ELGEN, ELSET=E\n"
        for data, message in (
            ("1, 3, 1, 0\n", "generates 3 elements by an increment of 0"),
            ("1, 3, 0, 1\n", "generates 3 elements by an increment of 0"),
            ("1, 3, 1, -1\n", "generates element -1, but numbers begin at 1"),
            ("1, 3, 1, 1, 2, 3, 2\n", "generates an element twice"),
            ("1, 0\n", "generates 0 elements in a row"),
        ):
            with self.subTest(data):
                self.assert_refused(start + data, f"9: error: *ELGEN: {message}")
        self.assertEqual(self.read(start + "1, 1, 0, 0, 2, 1, 1\n").line_ids.tolist(), [1, 2])

    def test_a_second_part_of_one_name_is_refused(self):
        again = PART.replace("NAME=LEG", "NAME=leg") + ASSEMBLY.format(sets="")
        self.assert_refused(PART + again, "14: error: *PART: a second part of the name 'leg'")

    def test_a_section_in_a_part_belongs_to_the_part_s_set(self):
        # The assembly has a set of that name, too, with lines of both instances or with the same ones.
        sets = "*ELSET, ELSET=ALL, INSTANCE={}\n1, 2\n"
        two = ASSEMBLY.format(sets=sets.format("L-1") + sets.format("L-2"))
        self.assertEqual(self.read(PART + two).section_sets, ("L-1.ALL", "L-2.ALL"))
        one = "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=L-1, PART=LEG\n*END INSTANCE\n{}*END ASSEMBLY\n"
        mesh = self.read(PART + one.format(sets.format("L-1")))
        self.assertEqual((list(mesh.element_sets), mesh.section_sets), (["ALL", "Assembly.ALL"], ("ALL",)))
        self.assertEqual(list(make_plane_frame(mesh).curves), ["ALL"])

    def test_an_orientation_node_is_counted_on_by_all_nodes_alone(self):
        # Keywords Reference, *ELGEN: nodes that give the first cross-section axis are incremented with ALL NODES.
        nodes = "*NODE\n1, 0., 0., 0.\n5, 4., 0., 0.\n21, 0., 1., 0.\n25, 4., 0., 1.\n*NGEN\n1, 5\n21, 25\n"
        section = "*BEAM SECTION, ELSET=E, SECTION=RECT, MATERIAL=M\n1., 2.\n"
        for option, towards in (("", [0.0, 1.0, 0.0]), (", ALL NODES", [0.0, 0.25, 0.75])):
            with self.subTest(option):
                line = f"*ELEMENT, TYPE=B31\n1, 1, 2, 21\n*ELGEN, ELSET=E{option}\n1, 4\n"
                mesh = self.read(nodes + line + section)
                expected = np.cross([1.0, 0.0, 0.0], np.add(towards, 0.0))
                if not option:  # node 21, seen from the beginning of the last line, at x = 3
                    expected = np.cross([1.0, 0.0, 0.0], [-3.0, 1.0, 0.0])
                np.testing.assert_allclose(mesh.heights[3], expected / np.linalg.norm(expected), atol=1e-15)

    def test_generated_nodes_that_would_get_lost_or_move_are_refused(self):
        nodes = "*NODE\n1, 0., 0.\n3, 2., 0.\n2, .5, 0.\n11, 0., 1.\n*NSET, NSET=P\n1, 3\n*NSET, NSET=Q\n11\n"
        for data, message in (
            ("*NGEN\n1, 3\n", "b.inp:11: error: *NGEN: would put node 2 at another place than it has"),
            ("*NFILL\nP, Q, 2, 5\n", "b.inp:11: error: *NFILL: joins a set of 2 nodes and one of 1"),
        ):
            (self.folder / "b.inp").write_text(nodes + data, encoding="utf-8")
            self.assert_refuses(self.run_tool("convert_mesh", "b.inp", "a.msh"), message)
        mesh = self.read(nodes.replace(".5, 0.", "1., 0.") + "*NGEN\n1, 3\n3, 1, -1\n")  # the same again
        self.assertEqual(mesh.node_ids.tolist(), [1, 2, 3, 11])

    def test_a_line_of_three_nodes_is_two_lines_in_each_of_its_sets(self):
        text = ABAQUS[: ABAQUS.index("*ELEMENT")] + "*ELEMENT, TYPE=B32, ELSET=A\n5, 1, 2, 3\n*ELSET, ELSET=B\n5\n"
        mesh = self.read(text)
        self.assertEqual(mesh.lines.tolist(), [[0, 1], [1, 2]])
        self.assertEqual(mesh.line_ids.tolist(), [5, 6])
        self.assertEqual([mesh.element_sets[name].tolist() for name in ("A", "B")], [[0, 1], [0, 1]])

    def test_an_orientation_node_that_is_not_there_is_refused(self):
        (self.folder / "b.inp").write_text(ABAQUS.replace("B21", "B31").replace("1, 1, 2", "1, 1, 2, 99"))
        process = self.run_tool("convert_mesh", "b.inp", "a.msh")
        self.assert_refuses(process, "b.inp:6: error: *ELEMENT: element 1 names the orientation node 99, which is not")

    def test_masses_and_moments_of_inertia_of_points(self):
        points = "*ELEMENT, TYPE=MASS, ELSET=P\n7, 3\n*ELEMENT, TYPE=ROTARYI, ELSET=R\n8, 3\n"
        gifts = "*MASS, ELSET=P\n5.,\n*ROTARY INERTIA, ELSET=R\n1., 2., 3., 4., 5., 6.\n"
        mass, inertia = self.read(ABAQUS + points + gifts).point_masses
        self.assertEqual((mass.node, mass.mass, inertia.node, inertia.mass), (2, 5.0, 2, 0.0))
        np.testing.assert_array_equal(inertia.inertia, [[1, 4, 5], [4, 2, 6], [5, 6, 3]])

    def test_a_set_holds_a_member_once_and_so_a_mass_is_taken_once(self):
        points = "*ELEMENT, TYPE=MASS, ELSET=P\n7, 3\n*ELEMENT, TYPE=MASS, ELSET=Q\n8, 1\n"
        for sets, nodes in (
            ("*ELSET, ELSET=P\n7\n", [2]),
            ("*ELSET, ELSET=P\n7, P\n", [2]),
            ("*ELSET, ELSET=P, GENERATE\n7, 7, 1\n", [2]),
            ("*ELSET, ELSET=R\nP, Q\n*ELSET, ELSET=P\nP, R, 8\n*ELSET, ELSET=Q\nR\n", [2, 0]),
        ):
            with self.subTest(sets):
                found = self.read(f"{ABAQUS}{points}{sets}*MASS, ELSET=P\n5.\n").point_masses
                self.assertEqual([(one.node, one.mass) for one in found], [(node, 5.0) for node in nodes])

    def test_a_mass_that_is_given_or_defined_twice_is_refused(self):
        points = "*ELEMENT, TYPE=MASS, ELSET=P\n7, 3\n*ELEMENT, TYPE=ROTARYI, ELSET=R\n8, 3\n"
        mass, inertia = "*MASS, ELSET=P\n5.\n", "*ROTARY INERTIA, ELSET=R\n1.\n"
        again = "*ELSET, ELSET=Q\n7, 8\n"
        for data, message in (
            (mass + mass, "14: error: *MASS: gives element 7 what *MASS, ELSET=P (line 12) has given it"),
            (again + mass + mass.replace("P", "Q"), "16: error: *MASS: gives element 7 what *MASS, ELSET=P (line 14)"),
            (inertia + inertia, "14: error: *ROTARY INERTIA: gives element 8 what *ROTARY INERTIA, ELSET=R (line 12)"),
            ("*ELEMENT, TYPE=MASS, ELSET=P\n7, 3\n", "13: error: *ELEMENT: element 7 is defined twice"),
        ):
            with self.subTest(data):
                self.assert_refused(ABAQUS + points + data, message)
        self.assertEqual(len(self.read(ABAQUS + points + mass + inertia).point_masses), 2)

    def test_a_mass_has_as_many_numbers_as_it_should_have(self):
        points = "*ELEMENT, TYPE=MASS, ELSET=P\n7, 3\n*ELEMENT, TYPE=ROTARYI, ELSET=R\n8, 3\n"
        for data, message in (
            ("*MASS, ELSET=P\n", "12: error: *MASS: has no number of its mass"),
            ("*MASS, ELSET=P\n\n,\n", "12: error: *MASS: has no number of its mass"),
            ("*MASS, ELSET=P\n5., 6.\n", "13: error: *MASS: has 2 numbers of its mass, expected 1 at most"),
            ("*MASS, ELSET=P\n5.\n6.\n", "14: error: *MASS: has a further data line behind those of its"),
            ("*ROTARY INERTIA, ELSET=R\n", "12: error: *ROTARY INERTIA: has no number of its moments of inertia"),
            ("*ROTARY INERTIA, ELSET=R\n1., 2., 3., 4., 5., 6., 7.\n", "13: error: *ROTARY INERTIA: has 7 numbers"),
        ):
            with self.subTest(data):
                self.assert_refused(ABAQUS + points + data, message)
        left_behind = self.read(f"{ABAQUS}{points}*MASS, ELSET=P\n5., , ,\n").left_behind
        self.assertIn("elements 8 of type ROTARYI, to which no *ROTARY INERTIA gives anything", left_behind)
        self.assertNotIn("no *MASS", " ".join(left_behind))

    def test_masses_that_have_no_axes_of_the_frame_are_left_out(self):
        points = "*ELEMENT, TYPE=MASS, ELSET=P\n7, 3\n*ELEMENT, TYPE=ROTARYI, ELSET=R\n8, 3\n"
        gifts = "*MASS, ELSET=P, TYPE=ANISOTROPIC\n5., 6., 7.\n*ROTARY INERTIA, ELSET=R, ORIENTATION=O\n1., 2., 3.\n"
        found = [one.left_out for one in self.read(ABAQUS + points + gifts).point_masses]
        self.assertEqual(found, ["its type is ANISOTROPIC", "its axes are those of the orientation O"])

    def test_moments_of_inertia_turn_with_their_instance(self):
        # Turned by 90° about x: the moment about the part's z is that about y then.
        inertia = "*ELEMENT, TYPE=ROTARYI, ELSET=R\n8, 3\n*ROTARY INERTIA, ELSET=R\n1., 2., 3.\n*END PART\n"
        place = "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=L-1, PART=LEG\n0.\n0., 0., 0., 1., 0., 0., 90.\n*END INSTANCE\n"
        mesh = self.read(PART.replace("*END PART\n", inertia) + place + "*END ASSEMBLY\n")
        np.testing.assert_allclose(np.diag(mesh.point_masses[0].inertia), [1.0, 3.0, 2.0], atol=1e-15)


if __name__ == "__main__":
    unittest.main()
