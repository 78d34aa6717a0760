"""tools/convert_mesh --unite-rails with rails that are equal under two names, or each other's mirror image."""

import tomllib
import unittest

import numpy as np
from starter_design_test import StarterCase

NODES = "*NODE\n" + "".join(
    f"{first + k}, {k}., {y}, 0.\n" for first, y in ((1, -0.4), (11, 0.4)) for k in range(3)
)
RAILS = "*ELEMENT, TYPE=B33, ELSET=LEFT\n1, 1, 2\n2, 2, 3\n*ELEMENT, TYPE=B33, ELSET=RIGHT\n11, 11, 12\n12, 12, 13\n"
ACROSS = "*ELEMENT, TYPE=B33, ELSET=ACROSS\n21, 1, 11\n22, 3, 13\n"
ACROSS += "*BEAM SECTION, ELSET=ACROSS, SECTION=PIPE, MATERIAL=S\n.04, .004\n1., 0., 0.\n"
STEEL = "*MATERIAL, NAME={}\n*ELASTIC\n{}, .3\n*DENSITY\n7850.\n"
OWN = "*BEAM GENERAL SECTION, ELSET={}, SECTION=RECT, DENSITY=7850.\n.05, .1\n{}\n{}, 8.08e10\n"
RECTANGLE = "*BEAM SECTION, ELSET={}, SECTION=RECT, MATERIAL={}\n.05, {}\n0., 1., 0.\n"
CHANNEL = "*BEAM SECTION, ELSET={0}, SECTION=ARBITRARY, MATERIAL=S\n3, {1}.06, -.1, 0., -.1, .008\n0., .1, .006\n"
CHANNEL += "{1}.06, .1, .008\n{2}\n"


class UnitedRails(StarterCase):
    """Two rails of 2 m along x, at y = ±0.4."""

    def unite(self, sections, materials=STEEL.format("S", 2.1e11)):
        deck = NODES + RAILS + ACROSS + sections + materials
        return self.convert_text("a.inp", deck, "--plane", "xz", "--unite-rails")

    def test_rails_whose_sections_have_equal_numbers_are_one_under_one_name(self):
        box, two = 0.05 * 0.1**3 / 12, STEEL.format("S", 2.1e11) + STEEL.format("T", 2.1e11)
        tall, flange = 0.2**3 / 12 * 0.006, 2 * 0.06 * 0.008
        channel = tall + flange * 0.1**2  # thin walls
        for sections, materials, moment in (
            (OWN.format("LEFT", "0., 1., 0.", 2.1e11) + OWN.format("RIGHT", "0., 1., 0.", 2.1e11), two, box),
            (RECTANGLE.format("LEFT", "S", 0.1) + RECTANGLE.format("RIGHT", "T", 0.1), two, box),
            (CHANNEL.format("LEFT", "", "0., 1., 0.") + CHANNEL.format("RIGHT", "-", "0., 1., 0."), two, channel),
            (CHANNEL.format("LEFT", "", "0., 1., 0.") + CHANNEL.format("RIGHT", "", "0., -1., 0."), two, channel),
        ):
            with self.subTest(sections):
                told, text = self.unite(sections, materials)
                (self.folder / "frame.toml").unlink()
                self.assertIn("element set 'LEFT' (2 lines): overlaps 'RIGHT', which has the section", told)
                self.assertNotIn("nodes that no line uses", told)
                design = tomllib.loads(text)
                (section,) = design["sections"].values()
                self.assertEqual(section["count"], 2)
                np.testing.assert_allclose(section["second_moment"], moment, rtol=1e-12)

    def test_rails_whose_sections_have_other_numbers_are_refused(self):
        for sections, materials, message in (
            (OWN.format("LEFT", "0., 1., 0.", 2.1e11) + OWN.format("RIGHT", "0., 1., 0.", 7e10), "", "different sect"),
            (OWN.format("LEFT", "0., 1., 0.", 2.1e11) + OWN.format("RIGHT", "0., 0., 1.", 2.1e11), "", "turned in dif"),
            (RECTANGLE.format("LEFT", "S", 0.1) + RECTANGLE.format("RIGHT", "S", 0.11), "", "have different sections"),
            (RECTANGLE.format("LEFT", "S", 0.1) + RECTANGLE.format("RIGHT", "T", 0.1), STEEL.format("T", 7e10),
             "element 1 and its mirror image 11 have different sections"),
            (CHANNEL.format("LEFT", "", "0., 1., 0.") + RECTANGLE.format("RIGHT", "S", 0.1), "", "different sections"),
        ):  # fmt: skip
            with self.subTest(sections):
                deck = NODES + RAILS + ACROSS + sections + STEEL.format("S", 2.1e11) + materials
                (self.folder / "a.inp").write_text(deck, encoding="utf-8")
                process = self.run_tool("convert_mesh", "a.inp", "frame.msh", "--plane", "xz", "--unite-rails")
                self.assert_refuses(process, "a.inp: error: element ", message)

    def test_a_set_that_covers_several_of_the_other_side_has_their_section(self):
        parts = "*ELSET, ELSET=FRONT\n1\n*ELSET, ELSET=REAR\n2\n"
        sections = parts + "".join(RECTANGLE.format(name, "S", 0.1) for name in ("FRONT", "REAR", "RIGHT"))
        told, text = self.unite(sections)
        self.assertEqual(list(tomllib.loads(text)["sections"]), ["RIGHT"])
        for name in ("FRONT", "REAR"):
            self.assertIn(f"element set '{name}' (1 lines): overlaps 'RIGHT', which has the section", told)


if __name__ == "__main__":
    unittest.main()
