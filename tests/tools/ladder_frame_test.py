"""tools/convert_mesh --unite-rails: a three-dimensional ladder frame in its middle plane, and what is no such frame.

Needs sprung-reduce, which SPRUNG_REDUCE names.
"""

import tomllib
import unittest

import numpy as np
from starter_design_test import StarterCase

from sprung_tools.mesh_import.carried_masses import merge_masses
from sprung_tools.mesh_import.frame_properties import PointMass

RAIL_X = (0.0, 1.0, 2.1, 3.0, 4.2)  # m
RAIL_Z = (0.5, 0.6, 0.55, 0.5, 0.5)
HALF_WIDTH = 0.4
ACROSS = (0, 2, 4)  # the places of crossmembers; each has a node in the middle
SPINE = ((0, 2), (2, 4))  # lines in the middle plane, between the middles of crossmembers
TUBE = (0.05, 0.04)  # m, radii of the crossmembers
DENSITY = 7850.0


def write_ladder(change=lambda text: text):
    """The frame as a Nastran deck: left rail nodes 1 …, right rail 101 …, middles 201 …. change: spoils it."""
    lines = ["BEGIN BULK"]
    for first, y in ((1, HALF_WIDTH), (101, -HALF_WIDTH)):
        lines += [f"GRID,{first + k},,{x},{y},{z}" for k, (x, z) in enumerate(zip(RAIL_X, RAIL_Z))]
        lines += [f"CBAR,{first + k},1,{first + k},{first + k + 1},0.,0.,1." for k in range(len(RAIL_X) - 1)]
    for k in ACROSS:
        lines.append(f"GRID,{201 + k},,{RAIL_X[k]},0.,{RAIL_Z[k]}")
        lines += [f"CBAR,{201 + k},2,{1 + k},{201 + k},0.,0.,1.", f"CBAR,{301 + k},2,{201 + k},{101 + k},0.,0.,1."]
    lines += [f"CBAR,{401 + n},1,{201 + a},{201 + b},0.,0.,1." for n, (a, b) in enumerate(SPINE)]
    lines += ["PBARL,1,7,,BOX", ",.06,.16,.005,.005", "PBARL,2,7,,TUBE", f",{TUBE[0]},{TUBE[1]}"]
    lines += [f"MAT1,7,2.1+11,,.3,{DENSITY}", "CONM2,501,3,,40.", "CONM2,502,103,,40.", "ENDDATA"]
    return change("\n".join(lines) + "\n")


def write_plane_design():
    """The united frame by hand: two rails, the spine, and the crossmembers' masses and inertias, each of two halves."""
    area = np.pi * (TUBE[0] ** 2 - TUBE[1] ** 2)
    polar = np.pi * (TUBE[0] ** 4 - TUBE[1] ** 4) / 2.0
    points = {f"p{k}": place for k, place in enumerate(zip(RAIL_X, RAIL_Z))}
    box = 'material = "steel"\nshape = "box"\nwidth = 0.06\nheight = 0.16\nwall = 0.005\n'
    lines = [("rail", f"p{k}", f"p{k + 1}") for k in range(len(RAIL_X) - 1)]
    lines += [("spine", f"p{a}", f"p{b}") for a, b in SPINE]
    width = 2 * HALF_WIDTH
    masses = [(k, width * DENSITY * area, width * DENSITY * polar) for k in ACROSS] + [(2, 80.0, 0.0)]
    return (
        f"[materials.steel]\nyoungs_modulus = 2.1e11\ndensity = {DENSITY}\n[sections.rail]\n{box}count = 2\n"
        f"[sections.spine]\n{box}[points]\n"
        + "".join(f"{name} = [{x}, {z}]\n" for name, (x, z) in points.items())
        + "".join(f'[[lines]]\nfrom = "{a}"\nto = "{b}"\nsection = "{s}"\nelements = 1\n' for s, a, b in lines)
        + "".join(
            f'[[point_masses]]\npoint = "p{k}"\nmass = {float(mass)!r}\ninertia = {float(inertia)!r}\n'
            for k, mass, inertia in masses
        )
        + '[reference]\npoint = "p2"\n[modes]\nall = true\ndamping_ratio = 0.01\n'
    )


class Masses(unittest.TestCase):
    def test_masses_of_one_node_add_up_also_without_moments_of_inertia(self):
        turning = np.diag([1.0, 2.0, 3.0])
        for inertias, expected in (((turning, turning), 2 * turning), ((None, turning), turning),
                                   ((turning, None), turning), ((None, None), None)):  # fmt: skip
            (one,) = merge_masses([PointMass("", 4, 2.0 + k, inertia) for k, inertia in enumerate(inertias)])
            self.assertEqual((one.node, one.mass), (4, 5.0))
            np.testing.assert_array_equal(one.inertia, expected)


class Ladder(StarterCase):
    """Two rails, three crossmembers, a spine in the middle."""

    def test_it_gives_what_the_plane_frame_written_by_hand_gives(self):
        told, text = self.convert_text("a.bdf", write_ladder(), "--plane", "xz", "--unite-rails")
        for fragment in (
            "two rails about y = 0 united: 4 pairs of lines are one line of two members each; 2 lines in the middle",
            "bending and torsion of 6 lines straight across",
            "element set 'property_1': its lines in the middle plane are now in 'property_1_middle'",
            "element set 'property_2': all its lines run across",
        ):
            self.assertIn(fragment, told)
        design = tomllib.loads(text)
        self.assertEqual(design["sections"]["property_1"]["count"], 2)
        self.assertNotIn("count", design["sections"]["property_1_middle"])
        self.assertEqual(design["points"][design["reference"]["point"]], [RAIL_X[2], RAIL_Z[2]])
        self.assert_same_body(self.build("frame"), self.build("hand", write_plane_design()))

    def test_members_at_an_angle_are_masses_alone(self):
        def brace(text):
            diagonals = "CROD,601,3,2,104\nCROD,602,3,102,4\nPROD,3,7,1.-3\nENDDATA"
            return text.replace("ENDDATA", diagonals)

        told, text = self.convert_text("a.bdf", write_ladder(brace), "--plane", "xz", "--unite-rails")
        self.assertIn("the stiffness of lines across at an angle: 601, 602; half of their mass is at each end", told)
        total = sum(mass["mass"] for mass in tomllib.loads(text)["point_masses"])
        area = np.pi * (TUBE[0] ** 2 - TUBE[1] ** 2)
        rods = 2 * 1e-3 * np.linalg.norm((RAIL_X[3] - RAIL_X[1], 2 * HALF_WIDTH, RAIL_Z[3] - RAIL_Z[1]))
        expected = 80.0 + DENSITY * (3 * 2 * HALF_WIDTH * area + rods)
        self.assertAlmostEqual(total / expected, 1.0, places=12)

    def test_masses_where_members_across_meet_go_to_the_rails_by_the_lever_rule(self):
        # Rods from the second and the fourth place of both rails meet in the middle plane, nearer to the second one,
        # with a mass; so do bars over the second place. A straight rod's centroid is in its middle.
        def brace(text):
            rods = "CROD,601,3,2,601\nCROD,602,3,601,104\nCROD,603,3,102,601\nCROD,604,3,601,4\nPROD,3,7,1.-3\n"
            arch = "GRID,701,,1.,0.,.9\nCBAR,701,2,2,701,1.,0.,0.\nCBAR,702,2,701,102,1.,0.,0.\n"
            masses = "CONM2,801,601,,100.\nCONM2,802,701,,50.,,,,\n,1.,,2.\nENDDATA"
            return text.replace("ENDDATA", f"GRID,601,,1.5,0.,.7\n{rods}{arch}{masses}")

        told, text = self.convert_text("a.bdf", write_ladder(brace), "--plane", "xz", "--unite-rails")
        self.assertIn("joints of members across at an angle alone, 601, 701: their masses are at the nearest", told)
        self.assertIn("by the lever rule along x, up to 0.3 away along z", told)  # 701 over node 2, at z = 0.6
        self.assertIn("CONM2 801 at node 601, 0.75 of it", text)
        design = tomllib.loads(text)
        found = np.array([(one["mass"], *design["points"][one["point"]]) for one in design["point_masses"]])
        area = np.pi * (TUBE[0] ** 2 - TUBE[1] ** 2)
        expected = [(80.0, RAIL_X[2]), (100.0, 1.5), (50.0, 1.0)]
        expected += [(DENSITY * 2 * HALF_WIDTH * area, RAIL_X[k]) for k in ACROSS]
        expected += [(2 * DENSITY * area * np.hypot(HALF_WIDTH, 0.3), 1.0)]
        for k in (1, 3):
            length = np.linalg.norm((RAIL_X[k] - 1.5, HALF_WIDTH, RAIL_Z[k] - 0.7))
            expected.append((2 * DENSITY * 1e-3 * length, (RAIL_X[k] + 1.5) / 2.0))
        mass, place = np.array(expected).T
        np.testing.assert_allclose(found[:, 0].sum(), mass.sum(), rtol=1e-12)
        np.testing.assert_allclose(found[:, 0] @ found[:, 1], mass @ place, rtol=1e-12)
        self.assertEqual(sorted(set(found[:, 1])), list(RAIL_X))
        polar = np.pi * (TUBE[0] ** 4 - TUBE[1] ** 4) / 2.0
        inertia = sum(one["inertia"] for one in design["point_masses"])
        self.assertAlmostEqual(inertia, 2.0 + 3 * 2 * HALF_WIDTH * DENSITY * polar, places=12)

    def test_a_mass_that_rails_cannot_carry_is_refused(self):
        hitch = "GRID,801,,-1.,0.,.5\nCBAR,801,2,1,801,0.,0.,1.\nCBAR,802,2,801,101,0.,0.,1.\nENDDATA"
        loose = "GRID,801,,1.5,.1,.5\nGRID,802,,1.5,-.1,.5\nCBAR,801,2,801,802,0.,0.,1.\nENDDATA"
        for members, place in ((hitch, "-1"), (loose, "1.5")):
            with self.subTest(place):
                deck = write_ladder(lambda text, new=members: text.replace("ENDDATA", new))
                (self.folder / "a.bdf").write_text(deck, encoding="utf-8")
                process = self.run_tool("convert_mesh", "a.bdf", "frame.msh", "--plane", "xz", "--unite-rails")
                self.assert_refuses(process, f"a.bdf: error: node 801 at x = {place} has a mass, but only members")
        weightless = write_ladder(lambda text: text.replace("ENDDATA", hitch).replace(f",{DENSITY}", ""))
        self.convert_text("a.bdf", weightless, "--plane", "xz", "--unite-rails")  # no mass, nothing to carry

    def test_masses_on_one_side_are_told(self):
        for changed, node in (("", "3"), ("CONM2,502,103,,41.\n", "3, 103")):
            with self.subTest(changed):
                deck = write_ladder(lambda text, new=changed: text.replace("CONM2,502,103,,40.\n", new))
                told, _ = self.convert_text("a.bdf", deck, "--plane", "xz", "--unite-rails")
                self.assertIn(f"masses cause that have no equal one on the other side: nodes {node}", told)
        told, _ = self.convert_text("a.bdf", write_ladder(), "--plane", "xz", "--unite-rails")
        self.assertNotIn("rolling", told)

    def test_rails_that_come_nearer_are_projected_and_the_angle_is_said(self):
        def narrow(text):
            old, new = "GRID,105,,4.2,-0.4", "GRID,105,,4.2,-0.3"
            return text.replace("GRID,5,,4.2,0.4", "GRID,5,,4.2,0.3").replace(old, new)

        told, _ = self.convert_text("a.bdf", write_ladder(narrow), "--plane", "xz", "--unite-rails")
        self.assertIn("the angle of rails to the plane, up to 4.8°", told)  # atan(0.1 / 1.2) = 4.76°

    def test_what_is_not_symmetric_is_refused(self):
        for old, new, fragment in (
            ("GRID,103,,2.1", "GRID,103,,2.11", "node 3 at (2.1, 0.4, 0.55) has no mirror image"),
            ("CBAR,103,1,103,104,0.,0.,1.\n", "", "element 3 has no mirror image"),
            ("CBAR,103,1,", "CBAR,103,2,", "element 3 and its mirror image 103 have different sections"),
            ("CBAR,103,1,103,104,0.,0.,1.", "CBAR,103,1,103,104,0.,1.,0.", "are turned in different ways"),
        ):
            with self.subTest(fragment):
                deck = write_ladder(lambda text, old=old, new=new: text.replace(old, new))
                self.assertNotEqual(deck, write_ladder())
                (self.folder / "a.bdf").write_text(deck, encoding="utf-8")
                process = self.run_tool("convert_mesh", "a.bdf", "frame.msh", "--plane", "xz", "--unite-rails")
                self.assert_refuses(process, "a.bdf: error: ", fragment)

    def test_a_plane_frame_has_no_rails(self):
        (self.folder / "a.bdf").write_text(write_ladder(), encoding="utf-8")
        process = self.run_tool("convert_mesh", "a.bdf", "frame.msh", "--plane", "xz")
        self.assert_refuses(process, "the lines do not lie in a plane parallel to x–z", "--unite-rails")
        flat = "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nCBAR,1,1,1,2,0.,1.,0.\nENDDATA\n"
        (self.folder / "a.bdf").write_text(flat, encoding="utf-8")
        process = self.run_tool("convert_mesh", "a.bdf", "frame.msh", "--plane", "xz", "--unite-rails")
        self.assert_refuses(process, "no lines on both sides of y = 0")


if __name__ == "__main__":
    unittest.main()
