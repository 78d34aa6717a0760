"""The starter design of tools/convert_mesh: that it gives what a design written by hand gives, and says what it lacks.

Needs sprung-reduce, which SPRUNG_REDUCE names.
"""

import os
import tomllib
import unittest

import h5py
import numpy as np
from small_decks import ABAQUS, NASTRAN
from tool_test_case import ROOT, ToolTestCase, run_program

from sprung_tools.mesh_import.frame_properties import Shape
from sprung_tools.mesh_import.plane_section import calc_in_plane

DATA = ROOT / "tests/tools/data"
SAME = 1e-10  # relative, frequencies and mass

# The portal of data/, written by hand: its height lies in the plane.
POINTS = {
    "left_foot": (0.0, 0.0), "left": (0.1, 1.25), "left_top": (0.2, 2.5), "right_foot": (3.2, 0.1),
    "right": (3.1, 1.3), "right_top": (3.0, 2.6), "crown": (1.1, 2.7), "ridge": (2.0, 2.75),
}  # fmt: skip
LINES = {
    "post": (("left_foot", "left", "left_top"), ("right_foot", "right", "right_top")),
    "beam": (("left_top", "crown", "ridge", "right_top"),),
    "brace": (("left", "crown"),),
}
ROD = 4e-4  # m², a rod bends as a round bar of its area: I = A² / 4π, W = √(A³/π) / 4
ROUND_BAR = f"area = {ROD}\nsecond_moment = {ROD**2 / (4 * np.pi)!r}\nsection_modulus = {(ROD**3 / np.pi) ** 0.5 / 4!r}"


def write_portal(sections, crown_mass=0.0):
    """A portal's design. sections: name → keys of its table; crown_mass: kg."""
    points = "".join(f"{name} = [{x}, {y}]\n" for name, (x, y) in POINTS.items())
    tables = "".join(f'[sections.{name}]\nmaterial = "steel"\n{keys}\n' for name, keys in sections.items())
    lines = "".join(
        f'[[lines]]\nthrough = {list(row)}\nsection = "{name}"\nelements = 1\n'.replace("'", '"')
        for name, rows in LINES.items()
        for row in rows
    )
    mass = f'[[point_masses]]\npoint = "crown"\nmass = {crown_mass}\n' if crown_mass else ""
    steel = "[materials.steel]\nyoungs_modulus = 2.1e11\ndensity = 7850.0\npoissons_ratio = 0.3\n"
    return (
        f"{steel}{tables}[points]\n{points}"
        f'{lines}{mass}[reference]\npoint = "crown"\n[modes]\nall = true\ndamping_ratio = 0.01\n'
    )


class StarterCase(ToolTestCase):
    """Converting decks, and building designs."""

    def convert(self, source, *arguments):
        """Runs the tool, which must succeed. Returns (what it printed, the starter design's text)."""
        process = self.run_tool("convert_mesh", source, "frame.msh", *arguments)
        self.assertEqual(process.returncode, 0, process.stderr)
        return process.stdout, (self.folder / "frame.toml").read_text(encoding="utf-8")

    def convert_text(self, name, text, *arguments):
        """The same for a deck's text."""
        (self.folder / name).write_text(text, encoding="utf-8")
        return self.convert(name, *arguments)

    def build(self, name, text=None):
        """Builds a design of self.folder, which has the text if one is given. Returns the open file."""
        if text is not None:
            (self.folder / f"{name}.toml").write_text(text, encoding="utf-8")
        command = [os.environ["SPRUNG_REDUCE"], "build", f"{name}.toml", "--output-dir", "out", "--quiet"]
        process = run_program(command, cwd=self.folder)
        self.assertEqual(process.returncode, 0, process.stdout + process.stderr)
        file = h5py.File(self.folder / f"out/{name}.h5")
        self.addCleanup(file.close)
        return file

    def assert_same_body(self, found, expected):
        """Frequencies, mass and moment of inertia agree to SAME."""
        for name in ("modes/frequency", "inertia/mass", "inertia/second_moment", "inertia/first_moment"):
            scale = np.max(np.abs(expected[name][()]))
            np.testing.assert_allclose(found[name][()], expected[name][()], rtol=SAME, atol=SAME * scale, err_msg=name)

    def assert_same_moduli(self, found, expected):
        """The section moduli of all elements agree to SAME, in whatever order they are."""
        moduli = [np.sort(one["sections/modulus"][()]) for one in (found, expected)]
        np.testing.assert_allclose(*moduli, rtol=SAME)


class OfThePortal(StarterCase):
    """The starter design, built without a change, against the design written by hand."""

    def test_nastran_in_the_plane_of_x_and_z(self):
        self.convert(DATA / "portal.bdf", "--plane", "xz")
        hand = {  # bars with y of their elements normal to the plane: the width of PBARL lies in it
            "post": 'shape = "box"\nwidth = 0.12\nheight = 0.1\nwall = 0.005',
            "beam": 'shape = "rectangle"\nwidth = 0.1\nheight = 0.08',
            "brace": ROUND_BAR,
        }
        found, expected = self.build("frame"), self.build("hand", write_portal(hand, crown_mass=12.5))
        self.assert_same_body(found, expected)
        self.assert_same_moduli(found, expected)

    def test_abaqus_with_its_1_direction_normal_to_the_plane(self):
        deck = (DATA / "portal.inp").read_text(encoding="utf-8")
        _, text = self.convert_text("turned.inp", deck)  # two of the posts' lines have an orientation node in the plane
        self.assertRegex(text, "# of section 'POST': its second moment, from .* as its lines are turned: divide it")
        # The source does say its second moments.
        self.assertIn("# second_moment =   # m⁴, for bending in the plane: why not, is said at the end", text)
        (self.folder / "frame.toml").unlink()
        self.convert_text("a.inp", deck.replace("11, 99", "11").replace("10, 99", "10"))
        hand = {  # the second number of BOX and RECT lies along the 2-direction, in the plane
            "post": 'shape = "box"\nwidth = 0.1\nheight = 0.12\nwall = 0.005',
            "beam": 'shape = "rectangle"\nwidth = 0.08\nheight = 0.1',
            "brace": ROUND_BAR,
        }
        found, expected = self.build("frame"), self.build("hand", write_portal(hand))
        self.assert_same_body(found, expected)
        self.assert_same_moduli(found, expected)

    def test_two_instances_one_moved_and_turned(self):
        # A leg of 2 m along x from the origin; the second one goes up at the first one's end: turned by 90° about z.
        part = (
            "*PART, NAME=LEG\n*NODE\n1, 0., 0., 0.\n5, 2., 0., 0.\n*NGEN\n1, 5, 1\n*ELEMENT, TYPE=B23\n1, 1, 2\n"
            "*ELGEN, ELSET=ALL\n1, 4, 1, 1\n*BEAM SECTION, SECTION=I, ELSET=ALL, MATERIAL=Steel\n"
            "0.1, 0.2, 0.12, 0.12, 0.01, 0.01, 0.006\n0., 0., -1.\n*END PART\n"
        )
        assembly = (
            "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=L-1, PART=LEG\n*END INSTANCE\n*INSTANCE, NAME=L-2, PART=LEG\n"
            "2.5, 0., 0.\n2.5, 0., 0., 2.5, 0., 1., 90.\n*END INSTANCE\n*NODE\n1, 2.5, 2.5\n"
            "*ELEMENT, TYPE=B23, ELSET=TOP\n1, L-2.5, 1\n*ELEMENT, TYPE=B23, ELSET=FOOT\n2, L-1.5, L-2.1\n"
            "*ELEMENT, TYPE=MASS, ELSET=LUMP\n3, 1\n*MASS, ELSET=LUMP\n25.\n"
            "*ELEMENT, TYPE=MASS, ELSET=LUMPS\n4, L-1.1\n5, L-2.5\n*MASS, ELSET=LUMPS\n7.\n"
            "*ELSET, ELSET=REST\nTOP, FOOT\n"
            "*ELEMENT, TYPE=CONN3D2, ELSET=JOINT\n6, L-1.5, L-2.1\n*CONNECTOR SECTION, ELSET=JOINT\nHINGE\n"
            "*BEAM GENERAL SECTION, ELSET=REST, DENSITY=7850.\n0.002, 1e-6, 0., 3e-6, 1e-6\n0., 0., -1.\n2.1e11, 8e10\n"
            "*END ASSEMBLY\n*MATERIAL, NAME=STEEL\n*DENSITY\n7850.\n*ELASTIC\n2.1e11, 0.3\n"
        )
        _, text = self.convert_text("a.inp", part + assembly)
        self.assertIn("# connectors of type CONN3D2, which join nodes 5–1001\n", text)
        self.assertIn("# *CONNECTOR SECTION, ELSET=JOINT (line ", text)
        keys = 'shape = "i_section"\nheight = 0.2\nflange_width = 0.12\nflange_thickness = 0.01\nweb_thickness = 0.006'
        points = {"a": (0.0, 0.0), "b": (2.0, 0.0), "c": (2.5, 0.0), "d": (2.5, 2.0), "e": (2.5, 2.5)}
        reference = tomllib.loads((self.folder / "frame.toml").read_text(encoding="utf-8"))
        x, y = reference["points"][reference["reference"]["point"]]
        points["held"] = (x, y)
        lines = (("a", "b", "leg", 4), ("b", "c", "rest", 1), ("c", "d", "leg", 4), ("d", "e", "rest", 1))
        hand = (
            "[materials.steel]\nyoungs_modulus = 2.1e11\ndensity = 7850.0\n"
            f'[sections.leg]\nmaterial = "steel"\n{keys}\n'
            '[sections.rest]\nmaterial = "steel"\narea = 0.002\nsecond_moment = 1e-6\n[points]\n'
            + "".join(f"{name} = [{px}, {py}]\n" for name, (px, py) in points.items())
            + "".join(
                f'[[lines]]\nfrom = "{a}"\nto = "{b}"\nsection = "{section}"\nelements = {count}\n'
                for a, b, section, count in lines
            )
            + "".join(
                f'[[point_masses]]\npoint = "{point}"\nmass = {mass}\n'
                for point, mass in (("e", 25.0), ("a", 7.0), ("d", 7.0))
            )
            + '[reference]\npoint = "held"\n[modes]\nall = true\ndamping_ratio = 0.01\n'
        )
        self.assert_same_body(self.build("frame"), self.build("hand", hand))


class OfDecks(StarterCase):
    """Small decks: what is taken, what is said."""

    def read(self, text):
        return tomllib.loads(text)

    def test_units_of_millimetres_and_newtons_become_those_of_metres(self):
        deck = NASTRAN.replace("GRID,2,,1.", "GRID,2,,1000.").replace(
            "ENDDATA",
            "PBAR,1,1,100.,800.,900.,,1.-6\nMAT1,1,2.1+5,,.3,7.85-9\nCONM2,9,2,,.5,,,,\n,1.,,2.,,,3.\nENDDATA",
        )
        told, text = self.convert_text("a.bdf", deck, "--scale", "1e-3")
        design = self.read(text)
        self.assertNotIn("Remark", told)
        expected = {"youngs_modulus": 2.1e11, "density": 7850.0, "poissons_ratio": 0.3}
        for key, value in expected.items():
            self.assertAlmostEqual(design["materials"]["material_1"][key] / value, 1.0, places=12)
        section = design["sections"]["property_1"]
        # 1e-6 t/mm is 1 kg/m; the bar's plane 1 is that of x and y, so that I1 counts.
        for key, value in {"area": 1e-4, "second_moment": 8e-10, "mass_per_length": 7850e-4 + 1.0}.items():
            self.assertAlmostEqual(section[key] / value, 1.0, places=12)
        (mass,) = design["point_masses"]
        self.assertAlmostEqual(mass["mass"], 500.0)
        self.assertAlmostEqual(mass["inertia"], 3.0 * 1e3 * 1e-6)  # about z, t mm²

    def test_wtmass_multiplies_all_masses_and_a_weight_in_place_of_a_density_is_remarked(self):
        # A deck in inches and pounds: steel weighs 0.283 lbf/in³, and 1/g is 0.00259 s²/in. The unit of mass is
        # 1 lbf s²/in = 4.4482216 / 0.0254 kg. Nastran multiplies densities, masses per length and point masses.
        deck = NASTRAN.replace("GRID,2,,1.", "GRID,2,,100.").replace(
            "ENDDATA", "PBAR,1,1,2.,3.,4.,,5.\nMAT1,1,3.+7,,.3,.283\nCONM2,9,2,,50.,,,,\n,1.,,2.,,,3.\nENDDATA"
        )
        in_bulk = deck.replace("ENDDATA", "PARAM,WTMASS,.00259\nPARAM,POST,-1\nENDDATA")
        before = "CEND\nPARAM   WTMASS  2.59-3\n" + deck
        for place, text in enumerate((in_bulk, before)):
            with self.subTest(place):
                told, found = self.convert_text(f"{place}.bdf", text, "--scale", "0.0254", "--force", "4.4482216")
                (self.folder / "frame.toml").unlink()
                self.assertNotIn("Remark", told)
                self.assertNotIn("WTMASS", told)
                design = self.read(found)
                pound = 0.00259 * 4.4482216 / 0.0254  # kg
                for value, expected in (
                    (design["materials"]["material_1"]["density"], 0.283 * pound / 0.0254**3),
                    (design["sections"]["property_1"]["mass_per_length"], (0.283 * 2.0 + 5.0) * pound / 0.0254),
                    (design["point_masses"][0]["mass"], 50.0 * pound),
                    (design["point_masses"][0]["inertia"], 3.0 * pound * 0.0254**2),
                ):
                    self.assertAlmostEqual(value / expected, 1.0, places=12)
        told, _ = self.convert_text("weight.bdf", deck, "--scale", "0.0254", "--force", "4.4482216")
        self.assertIn("remark: the density of '1' is 3.02e+06 kg/m³: is it in units of mass, here of 175.127 kg", told)
        for bad, message in (
            ("PARAM,WTMASS,0.\n", "c.bdf:9: error: PARAM: WTMASS is 0, expected a factor > 0 of all masses"),
            ("PARAM,WTMASS,2.\nPARAM,WTMASS,3.\n", "c.bdf:10: error: PARAM: WTMASS is 3 here and 2 elsewhere"),
        ):
            (self.folder / "c.bdf").write_text(deck.replace("ENDDATA", f"{bad}ENDDATA"), encoding="utf-8")
            self.assert_refuses(self.run_tool("convert_mesh", "c.bdf", "c.msh"), message)

    def test_a_line_with_a_middle_node_becomes_two_and_keeps_its_bend(self):
        deck = "*NODE\n1, 0., 0.\n2, 1., 0.2\n3, 2., 0.\n4, 3., 0.\n5, 4., 0.\n"
        deck += "*ELEMENT, TYPE=B32R, ELSET=A\n1, 1, 2, 3\n"
        section = "*BEAM SECTION, ELSET=A, MATERIAL=M, SECTION=CIRC\n0.1, 0.1\n0., 0., 1.\n*MATERIAL, NAME=M\n"
        told, text = self.convert_text("a.inp", deck + "2, 3, 4, 5\n" + section)
        self.assertIn("middle nodes of 2 lines: each has become straight ones from node to node", told)
        self.assertRegex(told, r"curve +A +4 elements")
        # Two numbers are CalculiX's axes of an ellipse: A = π d²/4, I = π d⁴/64.
        self.assertAlmostEqual(self.read(text)["sections"]["A"]["area"], np.pi * 0.01 / 4, places=15)
        self.assertAlmostEqual(self.read(text)["sections"]["A"]["second_moment"], np.pi * 1e-4 / 64, places=18)

    def test_nodes_are_filled_in_between_two_sets(self):
        fill = "*NODE\n101, 4., 2.\n103, 5., 1.\n*NSET, NSET=P\n1, 3\n*NSET, NSET=Q\n101, 103\n"
        fill += "*NFILL, NSET=R\nP, Q, 4, 25\n"
        deck = ABAQUS[: ABAQUS.index("*ELEMENT")] + fill + ABAQUS[ABAQUS.index("*ELEMENT") :] + "3, 3, 28\n"
        told, _ = self.convert_text("a.inp", deck)
        self.assertIn("no line uses: 26, 51, 53, 76, 78, 101, 103", told)
        self.assertRegex(told, r"curve +A +3 elements")

    def test_a_size_or_a_modulus_of_other_units_is_remarked(self):
        told, _ = self.convert_text("a.bdf", NASTRAN.replace("GRID,2,,1.", "GRID,2,,1000."))
        self.assertIn("remark: the frame is 1000 m long: if its unit is the millimetre, give --scale 1e-3", told)
        (self.folder / "frame.toml").unlink()
        told, _ = self.convert_text("b.bdf", NASTRAN.replace("ENDDATA", "PBAR,1,1,.1,.1,.1\nMAT1,1,2.1+5\nENDDATA"))
        self.assertIn("remark: Young's modulus of '1' is 2.1e+05 Pa", told)

    def test_what_the_source_does_not_say_is_left_open_and_the_design_refused(self):
        _, text = self.convert_text("a.bdf", NASTRAN)
        self.assertIn("# area =   # m²: the source does not say", text)
        self.assertIn("# of section 'property_1': the source gives it none that is understood", text)
        process = run_program([os.environ["SPRUNG_REDUCE"], "build", "frame.toml"], cwd=self.folder)
        self.assertEqual(process.returncode, 2)
        self.assertIn("materials.unknown", process.stderr)

    def test_a_design_that_is_there_stays_as_it_is(self):
        (self.folder / "frame.toml").write_text("mine", encoding="utf-8")
        told, text = self.convert_text("a.bdf", NASTRAN)
        self.assertEqual(text, "mine")
        self.assertIn("Design: frame.toml is there already and stays as it is", told)

    def test_a_second_moment_in_the_plane_that_is_not_positive_is_told_with_its_value(self):
        _, text = self.convert_text("a.bdf", NASTRAN.replace("ENDDATA", "PBAR,1,1,1.,,2.\nENDDATA"))
        self.assertIn("# of section 'property_1': its second moment, which is 0\n", text)
        self.assertNotIn("second_moment", self.read(text)["sections"]["property_1"])

    def test_non_structural_mass_without_a_density_or_an_area_is_not_lost(self):
        # Nastran's RHO is 0 unless given, so that a bar without it weighs its non-structural mass: 250 kg/m.
        bar = "PBAR,1,1,2.-3,4.-6,1.-6,1.-6,250.\nMAT1,1,2.1+11,,.3{density}\nENDDATA"
        _, text = self.convert_text("a.bdf", NASTRAN.replace("ENDDATA", bar.format(density="")))
        self.assertIn("# the non-structural mass alone, since the source gives no density", text)
        self.assertEqual(self.read(text)["sections"]["property_1"]["mass_per_length"], 250.0)
        self.assertAlmostEqual(self.build("frame")["inertia/mass"][()], 250.0, places=9)  # the frame is 1 m long
        (self.folder / "frame.toml").unlink()
        no_area = bar.format(density=",7850.").replace("2.-3", "")
        _, text = self.convert_text("b.bdf", NASTRAN.replace("ENDDATA", no_area))
        self.assertIn("# mass_per_length =   # kg/m: density · area, and 250 of non-structural mass", text)

    def test_masses_that_cannot_be_taken_are_listed(self):
        masses = "CONM2,8,2,,5.,.1,,,\nCONM2,9,1,,7.\nGRID,3,,0.5,0.,0.\nCONM2,10,3,,6.\nENDDATA"
        told, text = self.convert_text("a.bdf", NASTRAN.replace("ENDDATA", masses))
        for left_out in ("CONM2 8 at node 2, 5 kg: it is away from its node by 0.1, 0, 0",
                         "CONM2 10 at node 3, 6 kg: its node has no line"):  # fmt: skip
            self.assertIn(f"# {left_out}\n", text)
            self.assertIn(f"  {left_out}\n", told)
        self.assertEqual([one["mass"] for one in self.read(text)["point_masses"]], [7.0])
        inertia = "*ELEMENT, TYPE=ROTARYI, ELSET=R\n8, 3\n*ROTARY INERTIA, ELSET=R, ORIENTATION=O\n1., 2., 3.\n"
        (self.folder / "frame.toml").unlink()
        _, text = self.convert_text("a.inp", ABAQUS + inertia, "--scale", "1e-3")  # N mm s² = 1000 kg mm² = 1e-3 kg m²
        self.assertIn("# *ROTARY INERTIA (line 10) at node 3, moments of inertia up to 0.003 kg m²: its axes are", text)

    def read_modulus(self, card, *arguments, name="a.bdf", deck=NASTRAN):
        """The section modulus of the starter design with a property of the bars, and the design's text. The bar lies
        along x, and y of its element along y."""
        (self.folder / "frame.toml").unlink(missing_ok=True)
        whole = deck.replace("ENDDATA", f"{card}\nENDDATA") if deck is NASTRAN else deck + card
        _, text = self.convert_text(name, whole, *arguments)
        return next(iter(self.read(text)["sections"].values())).get("section_modulus"), text

    def test_the_section_modulus_is_that_of_the_farther_fibre_in_the_plane(self):
        # A T of a flange 4 × 1 over a web 1 × 4, each 1.25 from the common centroid, which is 3.25 over the bottom.
        tee = (4 * 1 + 1 * 64) / 12 + 8 * 1.25**2
        for card, expected in (
            ("PBARL,1,1,,BAR\n,2.,3.", 2 * 9 / 6),
            ("PBEAML,1,1,,BAR\n,2.,3.", 2 * 9 / 6),
            ("PBARL,1,1,,BOX\n,4.,6.,1.,.5", (4 * 216 - 3 * 64) / 12 / 3),
            ("PBARL,1,1,,TUBE\n,2.,1.", 15 * np.pi / 4 / 2),
            ("PBARL,1,1,,ROD\n,2.", np.pi * 2**3 / 4),
            ("PBARL,1,1,,T\n,4.,5.,1.,1.", tee / 3.25),
            ("PBARL,1,1,,T2\n,4.,5.,1.,1.", tee / 3.25),
            ("PBARL,1,1,,HEXA\n,1.,6.,4.", 2**3 * (6 + 3 * 4) / 6 / 2),
        ):
            with self.subTest(card):
                modulus, text = self.read_modulus(card)
                self.assertAlmostEqual(modulus, expected, delta=1e-12 * expected)
                self.assertNotIn("its section modulus", text)
        start = "*BEAM SECTION, ELSET=A, MATERIAL=M, SECTION="  # the 1-direction is -z: the height lies in the plane
        for section, expected in (
            ("RECT\n2., 3.", 2 * 9 / 6), ("CIRC\n4., 2.", np.pi * 4 * 4 / 32), ("PIPE\n2., 1.", 15 * np.pi / 4 / 2),
            ("TRAPEZOID\n4., 3., 2., 1.", 27 * (16 + 32 + 4) / (36 * 6) / (3 - 3 * 8 / 18)),
            ("ARBITRARY\n1, 0., -2., 0., 2., .1", 0.1 * 64 / 12 / 2),
        ):
            with self.subTest(section):
                modulus, _ = self.read_modulus(f"{start}{section}\n", name="a.inp", deck=ABAQUS)
                self.assertAlmostEqual(modulus, expected, delta=1e-12 * expected)

    def test_the_section_modulus_has_the_design_s_unit(self):
        steel = "\nMAT1,1,2.1+5,,.3,7.85-9"
        modulus, _ = self.read_modulus(f"PBARL,1,1,,BOX\n,80.,120.,5.,5.{steel}", "--scale", "1e-3")
        expected = (0.08 * 0.12**3 - 0.07 * 0.11**3) / 12 / 0.06
        self.assertAlmostEqual(modulus, expected, delta=1e-12 * expected)

    def test_a_rod_has_the_section_modulus_of_a_round_bar(self):
        rod = NASTRAN.replace("CBAR,1,1,1,2,0.,1.,0.", "CROD,1,1,1,2")
        for card, expected in (("PROD,1,1,3.", np.pi * (3 / np.pi) ** 1.5 / 4), ("PTUBE,1,1,4.,1.", 15 * np.pi / 8)):
            (self.folder / "frame.toml").unlink(missing_ok=True)
            _, text = self.convert_text("a.bdf", rod.replace("ENDDATA", f"{card}\nENDDATA"))
            modulus = self.read(text)["sections"]["property_1"]["section_modulus"]
            self.assertAlmostEqual(modulus, expected, delta=1e-12 * expected)

    def test_a_section_modulus_that_is_not_known_is_listed(self):
        lost = "# of section 'property_1': its section modulus, which stresses need: "
        modulus, text = self.read_modulus("PBAR,1,1,2.,3.,4.")
        self.assertIsNone(modulus)
        self.assertIn(f"{lost}the source does not give its outline\n", text)
        # A square bar has one second moment however it is turned, but not one section modulus.
        no_way = NASTRAN.replace("2,0.,1.,0.", "2").replace("ENDDATA", "PBARL,1,1,,BAR\n,2.,2.\nENDDATA")
        (self.folder / "frame.toml").unlink()
        _, text = self.convert_text("b.bdf", no_way)
        self.assertEqual(self.read(text)["sections"]["property_1"].get("second_moment"), 16 / 12)
        self.assertIn(f"{lost}how it is turned about its axis is not said\n", text)
        more = "GRID,3,,2.,0.,0.\nCBAR,2,1,2,3,0.,1.,1.\nPBARL,1,1,,BAR\n,2.,2.\nENDDATA"
        (self.folder / "frame.toml").unlink()
        _, text = self.convert_text("c.bdf", NASTRAN.replace("ENDDATA", more))
        self.assertIn("it is from 0.942809 to 1.33333 as its lines are\n#   turned, divide it\n", text)

    def test_a_taper_and_a_shape_that_is_not_known_are_listed(self):
        beam = NASTRAN.replace("CBAR", "CBEAM")
        taper = "PBEAM,1,1,.1,.2,.3,0.,.4,\n,,,,,,,,\n,NO,1.,.2,.2,.3\nMAT1,1,2.1+11\nENDDATA"
        _, text = self.convert_text("a.bdf", beam.replace("ENDDATA", taper))
        self.assertIn("# of section 'property_1': its taper: the section at end A is taken", text)
        self.assertEqual(self.read(text)["sections"]["property_1"]["second_moment"], 0.2)
        (self.folder / "frame.toml").unlink()
        _, text = self.convert_text("b.bdf", NASTRAN.replace("ENDDATA", "PBARL,1,1,,HAT2\n,1.,1.,1.,1.,1.\nENDDATA"))
        self.assertIn("# of section 'property_1': the shape HAT2", text)


class Turning(unittest.TestCase):
    """The second moment in the plane of a section that is turned about its axis."""

    def test_a_flat_bar_is_stiff_upright_weak_lying_and_between_at_an_angle(self):
        bar = Shape(area=2.0, hh=8.0, ww=2.0)
        along = np.array([[1.0, 0.0, 0.0]] * 3)
        heights = np.array([[0.0, 3.0, 0.0], [0.0, 0.0, 1.0], [0.5, 1.0, 1.0]])
        moments, products = calc_in_plane(bar, along, heights, "xy")
        np.testing.assert_allclose(moments, [8.0, 2.0, 5.0], rtol=1e-15)
        np.testing.assert_allclose(products, [0.0, 0.0, 3.0], atol=1e-15)  # (8 − 2) sin 45° cos 45°

    def test_an_angle_bar_turned_to_its_main_axes_has_its_main_moments(self):
        # About its main axes at 45° its moments are 5 ± 3: Mohr's circle.
        angle = Shape(area=1.0, hh=5.0, ww=5.0, hw=3.0)
        for height, expected in (((0.0, 1.0, 1.0), 8.0), ((0.0, 1.0, -1.0), 2.0)):
            moments, products = calc_in_plane(angle, np.array([[1.0, 0.0, 0.0]]), np.array([height]), "xy")
            np.testing.assert_allclose(moments, [expected], rtol=1e-14)
            np.testing.assert_allclose(products, [0.0], atol=1e-14)

    def test_a_height_along_the_line_or_unknown_gives_nothing(self):
        bar, along = Shape(area=2.0, hh=8.0, ww=2.0), np.array([[1.0, 0.0, 0.0]])
        for height in ((2.0, 0.0, 0.0), (np.nan,) * 3):
            self.assertIsNone(calc_in_plane(bar, along, np.array([height]), "xy"))


if __name__ == "__main__":
    unittest.main()
