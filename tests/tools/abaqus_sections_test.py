"""Reading the sections and materials of Abaqus and CalculiX decks, against closed forms and integrals."""

import unittest

import numpy as np
from abaqus_case import AbaqusCase
from polygons import find_extremes, find_farthest, integrate
from small_decks import ABAQUS

IN_SPACE = ABAQUS.replace("B21", "B31")


class AbaqusSections(AbaqusCase):
    """Sections of elements, and the materials that they name or give themselves."""

    def find_shape(self, section):
        """The shape of a section that all elements have."""
        return self.read(f"{ABAQUS}{section}").sections[0].shape

    def test_shapes_of_beam_section(self):
        for section, expected in (
            # The width lies along the 1-direction; hh is I11.
            ("RECT\n2., 3.", (6.0, 2 * 27 / 12, 3 * 8 / 12)),
            ("BOX\n4., 6., .5, 1., .5, 1.", (12.0, (4 * 216 - 3 * 64) / 12, (6 * 64 - 4 * 27) / 12)),
            ("PIPE\n2., 1.", (3 * np.pi, 15 * np.pi / 4, 15 * np.pi / 4)),
            ("CIRC\n2.", (4 * np.pi, 4 * np.pi, 4 * np.pi)),
            ("CIRC\n4., 2.", (2 * np.pi, np.pi * 4 * 8 / 64, np.pi * 2 * 64 / 64)),
            ("I\n3., 6., 4., 4., 1., 1., 1.", (12.0, (4 * 216 - 3 * 64) / 12, (2 * 64 + 4 * 1) / 12)),
            ("GENERAL\n2., 3., 0.5, 4., 1.", (2.0, 3.0, 4.0)),
        ):
            with self.subTest(section):
                shape = self.find_shape(f"*BEAM SECTION, ELSET=A, MATERIAL=M, SECTION={section}\n")
                np.testing.assert_allclose((shape.area, shape.hh, shape.ww), expected, rtol=1e-13)

    def test_shapes_against_integrals_over_their_outlines(self):
        # Analysis User's Guide, "Beam cross-section library". Corners (1, 2).
        ring = [(np.cos(k * np.pi / 3), np.sin(k * np.pi / 3)) for k in range(6)]
        inner = 2.0 - 0.3 * 2 / np.sqrt(3)  # a wall of 0.3 between the flats
        hexagon = [np.multiply(2.0, ring), np.multiply(inner, ring[::-1])]
        for section, outlines in (
            ("TRAPEZOID\n4., 3., 2., 1.", [[(-2, 0), (2, 0), (1, 3), (-1, 3)]]),
            ("L\n5., 4., .5, .7", [[(0, 0), (5, 0), (5, 0.5), (0.7, 0.5), (0.7, 4), (0, 4)]]),
            ("HEX\n2., .3", hexagon),
            ("I\n1., 6., 4., 0., 1., 0., 1.", [[(-2, 0), (2, 0), (2, 1), (0.5, 1), (0.5, 6), (-0.5, 6), (-0.5, 1),
                                               (-2, 1)]]),
        ):  # fmt: skip
            with self.subTest(section):
                shape = self.find_shape(f"*BEAM SECTION, ELSET=A, MATERIAL=M, SECTION={section}\n")
                np.testing.assert_allclose(shape[:4], integrate(*outlines)[:4], rtol=1e-12, atol=1e-12)
                if section.startswith("HEX"):
                    self.assertIsNone(find_extremes(shape))  # where its corners lie is not read
                else:
                    np.testing.assert_allclose(find_extremes(shape), find_farthest(outlines), rtol=1e-12)

    def test_the_centroid_away_from_the_nodes_is_told(self):
        # By l (I) and d (trapezoid), the height of the nodes over the bottom, they may be anywhere.
        for section, is_told in (
            ("I\n3., 6., 4., 4., 1., 1., 1.", False), ("I\n0., 6., 4., 4., 1., 1., 1.", True),
            ("I\n3., 6., 4., 3., 1., 1., 1.", True), ("TRAPEZOID\n2., 3., 2., 1.5", False),
            ("TRAPEZOID\n4., 3., 1., 1.2", False), ("TRAPEZOID\n4., 3., 1., 0.", True),
            ("BOX\n4., 6., .5, 1., .5, 1.", False), ("BOX\n4., 6., .5, 1., .6, 1.", True),
            ("L\n5., 4., .5, .7", True), ("RECT\n2., 3.", False),
        ):  # fmt: skip
            with self.subTest(section):
                mesh = self.read(f"{ABAQUS}*BEAM SECTION, ELSET=A, MATERIAL=M, SECTION={section}\n")
                self.assertEqual("the way from its nodes to its centroid" in mesh.sections[0].left_out, is_told)

    def integrate_walls(self, points, walls, parts=20_000):
        """(area, ∫h², ∫w², ∫hw about the centroid) of thin walls, each cut into short pieces."""
        place = (np.arange(parts) + 0.5) / parts
        pieces = [
            (np.outer(1 - place, a) + np.outer(place, b), np.full(parts, t * np.hypot(*np.subtract(b, a)) / parts))
            for a, b, t in zip(points, points[1:], walls)
        ]
        (w, h), areas = np.concatenate([one for one, _ in pieces]).T, np.concatenate([one for _, one in pieces])
        w, h = w - areas @ w / areas.sum(), h - areas @ h / areas.sum()
        return areas.sum(), areas @ h**2, areas @ w**2, areas @ (h * w)

    def test_walls_of_an_arbitrary_section(self):
        # "For each individual segment of an arbitrary section there is no bending stiffness about the line joining the
        # end points of the segment." First line: number of segments, first and second point, thickness; then the rest.
        channel = [(3, 0), (0, 0.5), (0, 6), (3, 6)]
        closed = [(-2, -3), (2, -3), (2.5, 3), (-2, 3), (-2, -3)]
        branched = [(-2, 0), (0, 0), (0, 5), (0, 0), (2, 0)]  # an inverted T: the way back has no thickness
        profiles = ((channel, (0.2, 0.1, 0.3)), (closed, (0.1, 0.2, 0.3, 0.4)), (branched, (0.2, 0.1, 0, 0.2)))
        for points, walls in profiles:
            numbers = [(len(walls), *points[0], *points[1], walls[0])]
            numbers += [(*point, wall) for point, wall in zip(points[2:], walls[1:])]
            rows = "".join(f"{', '.join(map(str, row))}\n" for row in numbers)
            for keyword, behind in (("BEAM SECTION, MATERIAL=M", "0., -1., 0.\n3, 3\n"),
                                    ("BEAM GENERAL SECTION, DENSITY=7.8", "0., -1., 0.\n2.6, 1.\n"),
                                    ("BEAM GENERAL SECTION, DENSITY=7.8", "\n2.6, 1.\n")):  # fmt: skip
                with self.subTest((points, keyword, behind)):
                    mesh = self.read(f"{IN_SPACE}*{keyword}, ELSET=A, SECTION=ARBITRARY\n{rows}{behind}")
                    shape = mesh.sections[0].shape
                    np.testing.assert_allclose(shape[:4], self.integrate_walls(points, walls), rtol=1e-8, atol=1e-7)
                    height = [0, 1, 0] if behind.startswith("\n") else [0, 0, 1]
                    np.testing.assert_allclose(np.abs(mesh.heights[0]), height, atol=1e-15)
                    if "GENERAL" in keyword:
                        self.assertEqual([one.youngs_modulus for one in mesh.materials.values()], [2.6])

    def test_an_arbitrary_section_that_is_not_whole_is_refused(self):
        start = f"{ABAQUS}*BEAM SECTION, ELSET=A, MATERIAL=M, SECTION=ARBITRARY\n"
        for data, where, message in (
            ("3, 3., 0., 0., 0., .2\n0., 6., .1\n", 10, "has no coordinates and thickness of segment 3 of 3"),
            ("2, 3., 0., 0., 0., .2\n0., 6.\n", 10, "has no coordinates and thickness of segment 2 of 2"),
            ("2, 3., 0., 0., 0.\n0., 6., .1\n", 9, "has no coordinates and thickness of segment 1 of 2"),
            ("2.5, 3., 0., 0., 0., .2\n", 9, "ARBITRARY has 2.5 segments, expected a whole number from 1"),
            ("", 8, "ARBITRARY has 0 segments"),
        ):
            with self.subTest(data):
                (self.folder / "b.inp").write_text(start + data, encoding="utf-8")
                process = self.run_tool("convert_mesh", "b.inp", "a.msh")
                self.assert_refuses(process, f"b.inp:{where}: error: *BEAM SECTION", message)

    def test_more_data_lines_than_a_section_has_are_refused(self):
        start = f"{ABAQUS}*{{}}, ELSET=A, MATERIAL=M, SECTION=ARBITRARY\n"
        walls = "2, 3., 0., 0., 0., .2\n0., 6., .1\n3., 6., .1\n"  # three where two are announced
        for keyword, data, where, message in (
            ("BEAM SECTION", f"{walls}0., 0., -1.\n", 12, "has numbers of integration points, expected"),
            ("BEAM SECTION", f"{walls}3, 3\n0., 0., -1.\n", 13, "has a further data line; behind 2 with the"),
            ("BEAM SECTION", "1, 0., 0., 1., 0., .2\n1., 2., 0., .1\n", 10, "its 1-direction has 4 numbers, expecte"),
            ("BEAM GENERAL SECTION", f"{walls}0., 0., -1.\n2.6, 1.\n", 12, "its Young's modulus is 0., expected >"),
        ):
            with self.subTest((keyword, data)):
                (self.folder / "b.inp").write_text(start.format(keyword) + data, encoding="utf-8")
                process = self.run_tool("convert_mesh", "b.inp", "a.msh")
                self.assert_refuses(process, f"b.inp:{where}: error: *{keyword}", message)

    def test_more_numbers_than_a_shape_has_are_refused(self):
        start = "*BEAM SECTION, ELSET=A, MATERIAL=M, SECTION="
        for section, found in (
            ("RECT\n.1, .2, .3\n", "RECT has 3 numbers, expected 2"),
            ("CIRC\n.1, .2, .3\n", "CIRC has 3 numbers, expected 2"),
            ("BOX\n4., 6., .5, 1., .5, 1., 2.\n", "BOX has 7 numbers, expected 6"),
        ):
            with self.subTest(section):
                self.assert_refused(ABAQUS + start + section, f"9: error: *BEAM SECTION: its shape {found} at most")
        self.assertAlmostEqual(self.find_shape(f"{start}RECT\n.1, .2,, 0.\n").area, 0.02)

    def test_parameters_and_moments_that_are_none_are_refused(self):
        mass = "*ELEMENT, TYPE=MASS, ELSET=P\n7, 3\n*MASS, ELSET=P, ALPHA=abc\n5.\n"
        for data, where, message in (
            ("*BEAM SECTION, ELSET=A, SECTION=RECT, POISSON=abc\n.1, .2\n", 8, "*BEAM SECTION: POISSON='abc' is not"),
            ("*BEAM SECTION, ELSET=A, SECTION=RECT, OFFSET1=\n.1, .2\n", 8, "*BEAM SECTION: OFFSET1='' is not a"),
            ("*BEAM GENERAL SECTION, ELSET=A, DENSITY=1.x\n1., 1., 0., 1., 1.\n", 8, "DENSITY='1.x' is not a number"),
            ("*BEAM GENERAL SECTION, ELSET=A\n1., -2., 0., 1., 1.\n", 9, "its I11 is -2, expected ≥ 0"),
            ("*BEAM GENERAL SECTION, ELSET=A\n1., .2, -.25, .3, 1.\n", 9, "its I12 is -0.25, but I12² ≤ I11·I22"),
            (mass, 10, "*MASS: ALPHA='abc' is not a number"),
        ):
            with self.subTest(data):
                (self.folder / "b.inp").write_text(ABAQUS + data, encoding="utf-8")
                process = self.run_tool("convert_mesh", "b.inp", "a.msh")
                self.assert_refuses(process, f"b.inp:{where}: error: *", message)

    def test_parameters_that_are_not_taken_are_told(self):
        points = "*ELEMENT, TYPE=MASS, ELSET=P\n7, 3\n*ELEMENT, TYPE=ROTARYI, ELSET=R\n8, 3\n"
        section = "*BEAM SECTION, ELSET=A, SECTION=RECT, MATERIAL=M{}\n2., 3.\n"
        for data, told in (
            ("*MASS, ELSET=P, ALPHA=.1\n5.\n", "ALPHA of *MASS, ELSET=P, ALPHA=.1 (line 12)"),
            ("*ROTARY INERTIA, ELSET=R, COMP=.1\n5.\n", "COMPOSITE of *ROTARY INERTIA, ELSET=R, COMPOSITE=.1 (line"),
            (section.format(", ROTARY INERTIA=ISOTROPIC, LUMPED=NO"), "LUMPED, ROTARY INERTIA of *BEAM SECTION, "),
        ):
            with self.subTest(data):
                self.assertIn(told, "\n".join(self.read(ABAQUS + points + data).left_behind))
        thick = self.read(ABAQUS + section.format(", NODAL THICKNESS")).sections[0]
        self.assertEqual((thick.shape, thick.left_out), (None, ("its dimensions at the nodes, by *NODAL THICKNESS",)))
        pores = self.read(f"{ABAQUS}*MATERIAL, NAME=M\n*DENSITY, PORE FLUID\n1000.\n")
        self.assertIsNone(pores.materials["M"].density)

    def test_the_shear_coefficient_of_a_user_beam_is_told(self):
        # CalculiX User's Manual, "General": area, I11, I12, I22 and the shear coefficient of U1.
        text = "*USER ELEMENT, TYPE=U1\n" + ABAQUS + "*BEAM SECTION, ELSET=A, SECTION=GENERAL, MATERIAL=M\n"
        for kind, told in (("U1", ["the shear coefficient of its elements U1, 0.85"]), ("B31", [])):
            section = self.read(text.replace("B21", kind) + "2., 3., 0., 4., .85\n0., 0., 1.\n").sections[0]
            self.assertEqual(list(section.left_out), told)

    def test_digits_that_no_deck_means_are_refused(self):
        # Python's float() and int() take 0.0_5, and digits of other scripts.
        section = "*BEAM SECTION, ELSET=A, SECTION=RECT\n{}, .2\n"
        for text, message in (
            (ABAQUS + section.format("0.0_5"), "9: error: *BEAM SECTION: '0.0_5' is not a number"),
            (ABAQUS + section.format("٠.٥"), "9: error: *BEAM SECTION: '٠.٥' is not a number"),
            (ABAQUS.replace("3, 1., 1.", "1_0, 1., 1."), "4: error: *NODE: '1_0' is not a number"),
            (ABAQUS.replace("2, 2, 3", "2, 2, ٣"), "7: error: *ELEMENT: '٣' is not a number"),
        ):
            with self.subTest(message):
                self.assert_refused(text, message)

    def test_a_tapered_section_has_its_direction_and_moduli_behind_both_ends(self):
        # Keywords Reference, *BEAM GENERAL SECTION with TAPER: the second line has the dimensions at node B.
        text = "*BEAM GENERAL SECTION, ELSET=A, SECTION=RECT, TAPER\n.1, .2\n.1, .3\n0., -1., 0.\n2.6, 1.\n"
        mesh = self.read(IN_SPACE + text)
        np.testing.assert_allclose(np.abs(mesh.heights[0]), [0, 0, 1], atol=1e-15)
        self.assertEqual([one.youngs_modulus for one in mesh.materials.values()], [2.6])
        self.assertIn("its taper: the section at the first end is taken", mesh.sections[0].left_out)

    def test_poisson_of_a_section_is_not_the_material_s(self):
        # Keywords Reference, *BEAM GENERAL SECTION: POISSON is "the effective Poisson's ratio for the section", by
        # which its area changes in large-displacement analyses; the material's is E / 2G − 1.
        for moduli, ratio, told in (
            ("2.6, 1.", 0.3, []),
            ("2.6", None, []),
            ("2.6, .5", None, ["its shear modulus, 0.5, with which Poisson's ratio would be 1.6"]),
            (", 1.", None, []),
            ("2.6, 1., , 20.\n2.5, 1., , 100.", 0.3, ["its moduli at further temperatures"]),
        ):
            with self.subTest(moduli):
                text = f"*BEAM GENERAL SECTION, ELSET=A, POISSON=.1, SECTION=RECT\n2., 3.\n0., 0., 1.\n{moduli}\n"
                mesh = self.read(ABAQUS + text)
                (material,) = mesh.materials.values()
                self.assertEqual(material.youngs_modulus, None if moduli.startswith(",") else 2.6)
                self.assertEqual(material.poissons_ratio and round(material.poissons_ratio, 12), ratio)
                poisson = "its POISSON, by which its area changes under large strains"
                self.assertEqual(list(mesh.sections[0].left_out), [poisson, *told])

    def test_a_general_section_has_its_own_material(self):
        text = "*BEAM GENERAL SECTION, ELSET=A, DENSITY=7.8, SECTION=RECT\n2., 3.\n0., 0., 1.\n2.6, 1.\n"
        (material,) = self.read(ABAQUS + text).materials.values()
        self.assertEqual((material.youngs_modulus, material.density), (2.6, 7.8))
        self.assertAlmostEqual(material.poissons_ratio, 0.3)  # 2.6 / (2 · 1) − 1

    def test_parts_with_a_set_of_one_name_keep_their_own_materials(self):
        part = "*PART, NAME={0}\n*NODE\n1, 0, {1}\n2, 1, {1}\n*ELEMENT, TYPE=B21, ELSET=RAIL\n1, 1, 2\n" \
               "*BEAM GENERAL SECTION, SECTION=RECT, ELSET=RAIL\n.05, .1\n\n{2}\n*END PART\n"  # fmt: skip
        instance = "*INSTANCE, NAME={0}-1, PART={0}\n*END INSTANCE\n"
        moduli = ("2.1e11, 8e10", "7e10, 2.7e10", "7e10, 2.7e10")
        text = "".join(part.format(name, place, moduli[place]) for place, name in enumerate("PQR"))
        text += f"*ASSEMBLY, NAME=A\n{''.join(instance.format(name) for name in 'PQR')}*END ASSEMBLY\n"
        mesh = self.read(text)
        found = [mesh.materials[mesh.sections[place].material].youngs_modulus for place in mesh.section_of]
        self.assertEqual(found, [2.1e11, 7e10, 7e10])
        self.assertEqual(list(mesh.materials), ["SECTION OF RAIL", "SECTION OF RAIL (2)"])

    def test_sections_and_materials_that_are_given_twice_are_told(self):
        section = "*BEAM SECTION, ELSET=A, SECTION=RECT, MATERIAL=S\n{}, .2\n"
        material = "*MATERIAL, NAME=S\n*ELASTIC\n{}, .3\n"
        sections = section.format(".05") + section.format(".04")
        mesh = self.read(ABAQUS + sections + material.format("2e11") + material.format("7e10"))
        self.assertEqual(mesh.materials["S"].youngs_modulus, 7e10)
        told = "\n".join(mesh.left_behind)
        self.assertIn("RECT: 0.05 × 0.2 of elements that *BEAM SECTION", told)
        self.assertIn("the material S before *MATERIAL, NAME=S (line ", told)

    def test_a_blank_line_of_a_section_stands_for_the_default_1_direction(self):
        # Keywords Reference, *BEAM SECTION and *BEAM GENERAL SECTION: "Second line (optional; enter a blank line if the
        # default values are to be used)". The default is (0, 0, -1); t × n₁ along y and along x is the height.
        for section in (
            "*BEAM SECTION, ELSET=A, SECTION=RECT, MATERIAL=S\n0.05, 0.2\n\n5, 5\n",
            "*BEAM GENERAL SECTION, ELSET=A, SECTION=RECT\n0.05, 0.2\n\n2.1e11, 8.0e10\n",
            "*BEAM GENERAL SECTION, ELSET=A, SECTION=RECT\n0.05, 0.2\n , ,\n** E, G\n2.1e11, 8.0e10\n\n\n",
            "*BEAM GENERAL SECTION, ELSET=A, SECTION=RECT\n\n0.05, 0.2\n0., 0., -1.\n2.1e11, 8.0e10\n",
        ):
            with self.subTest(section):
                mesh = self.read(ABAQUS.replace("\n2, 1.", "\n\n2, 1.") + section)
                self.assertEqual(mesh.node_ids.tolist(), [1, 2, 3])
                np.testing.assert_allclose(np.abs(mesh.heights), [[0, 1, 0], [1, 0, 0]], atol=1e-15)
                self.assertAlmostEqual(mesh.sections[0].shape.hh, 0.05 * 0.2**3 / 12, places=15)
                if "GENERAL" in section:
                    self.assertEqual([one.youngs_modulus for one in mesh.materials.values()], [2.1e11])
                else:
                    self.assertIn("that CalculiX passes over its blank line", " ".join(mesh.sections[0].left_out))

    def test_a_general_section_may_name_its_material(self):
        # Keywords Reference 2024, *BEAM GENERAL SECTION: a DENSITY beside MATERIAL stands in place of the material's.
        steel = "*MATERIAL, NAME=Steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850.\n"
        for density, expected in (("", 7850.0), (", DENSITY=8100.", 8100.0)):
            with self.subTest(density):
                section = f"*BEAM GENERAL SECTION, ELSET=A, SECTION=RECT, MATERIAL=steel{density}\n2., 3.\n0., 0., 1.\n"
                mesh = self.read(ABAQUS + section + steel)
                material = mesh.materials[mesh.sections[0].material]
                self.assertEqual((material.youngs_modulus, material.poissons_ratio, material.density),
                                 (2.1e11, 0.3, expected))  # fmt: skip


if __name__ == "__main__":
    unittest.main()
