"""What of a Nastran deck is not taken is told, field by field; what stands twice on a card is read twice."""

import unittest

from nastran_case import NastranCase
from small_decks import NASTRAN

BAR = "CBAR,1,1,1,2,0.,1.,0.\n"


class Fields(NastranCase):
    """Decks whose cards have more than a mesh and its starter design hold."""

    def test_a_shear_modulus_that_no_poisson_ratio_explains_is_listed(self):
        text = f"BEGIN BULK\nGRID,1\nGRID,2,,1.\n{BAR}MAT1,7,2.,{{}},,5.\nENDDATA\n"
        for shear, ratio in ((".8", 0.25), (".1", None)):
            with self.subTest(shear):
                mesh = self.read(text.format(shear))
                self.assertEqual(mesh.materials["7"].poissons_ratio, ratio)
                told = f"G = {float(shear):g} of MAT1 7" in "\n".join(mesh.left_behind)
                self.assertEqual(told, ratio is None)

    def test_the_taper_of_a_tube_is_listed(self):
        for taper, left_out in (
            ("", ()), (",.1", ()), (",.3", ("its taper to the diameter 0.3: the section at end A is taken",)),
        ):  # fmt: skip
            with self.subTest(taper):
                deck = NASTRAN.replace("CBAR,1,1,1,2,0.,1.,0.", f"CTUBE,1,8,1,2\nPTUBE,8,3,.1,.005,{taper}")
                self.assertEqual(self.read(deck).sections[0].left_out, left_out)

    def test_offsets_of_a_beam_s_mass_and_neutral_axis_are_listed(self):
        # Quick Reference Guide, PBEAM: they are the last line, after K1 … CW(B); a station with YES has stresses, too.
        beam = "PBEAM,1,1,.1,.2,.3,0.,.4,\n,,,,,,,,\n"
        shear, end = ",1.,1.,,,,,,\n", ",NO,1.,.1,.2,.3,0.,.4,\n"
        for lines, is_told in (
            (f"{end}{shear},,,,,.1,,.1,", True),
            (f",YES,1.,.1,.2,.3,0.,.4,\n,1.,1.,,,,,,\n{shear},.1,,,,,,,", True),
            (f"{end}{shear},0.,,,,,,,", False),
            (f"{end}{shear}", False),
            (f"{shear},,,,,,.2,,", True),
        ):
            with self.subTest(lines):
                mesh = self.read(NASTRAN.replace("ENDDATA", f"{beam}{lines}\nENDDATA"))
                told = [one for one in mesh.sections[0].left_out if "its neutral axis" in one]
                self.assertEqual(bool(told), is_told)

    def test_a_taper_of_the_non_structural_mass_alone_is_told(self):
        # Quick Reference Guide, PBEAM: a station's eighth field is its NSM; a blank field is that of end A.
        beam = "PBEAM,1,1,1.-3,2.-6,3.-6,,,{}\n{}"
        told = "its non-structural mass of 20 per length at a further station: that of end A, {}, is taken"
        taper = "its taper: the section at end A is taken"
        for here, lines, expected in (
            ("0.", ",YES,1.,1.-3,2.-6,3.-6,,,20.", [told.format(0)]),
            ("0.", ",,,,,,,,\n,YES,1.,1.-3,2.-6,3.-6,,,20.", [told.format(0)]),
            ("5.", ",YES,1.,,,,,,20.\n,NO,.5,,,,,,20.", [told.format(5)]),
            ("20.", ",NO,1.,.001,2.e-6,,,,2.+1", []),
            ("", ",NO,.5,2.-3\n,NO,1.,,,,,,20.", [taper, told.format(0)]),
        ):
            with self.subTest(lines):
                mesh = self.read(NASTRAN.replace("ENDDATA", f"{beam.format(here, lines)}\nENDDATA"))
                self.assertEqual(list(mesh.sections[0].left_out[:-1]), expected)

    def test_every_filled_field_that_is_not_taken_is_told(self):
        # Fields by the Quick Reference Guide; the last ones of CROD, CONM2 and PBARL do not exist there.
        nodes = "GRDSET,,,,,,,345\nGRID,3,,2.,0.,0.,,123456\nGRID,4,,3.,0.,0.,0,2,5\nGRID,5,,4.,0.,0.,,0,0\n"
        rods = "CROD,6,6,2,3\n,7\nCROD,7,6,3,4\nPROD,6,1,1.-3,1.-9,.1,.5\nCONROD,8,4,5,1,1.-3,1.-9\n"
        beam = "CBEAM,9,9,1,3,0.,1.,0.\n,\n,7,8\nPBEAM,9,1,1.-3,1.-6,1.-6,,1.-9,0.\n,.1\n,,,.1,,.2,,.3\n"
        cards = "PBAR,1,1,1.-3,1.-6,1.-6,1.-9\n,.1,0.,.2\nMAT1,1,2.1+11,,.3,7850.,1.-5,20.,.04\n"
        mass = "CONM2,5,2,,5.,,,,7.\n"
        mesh = self.read(NASTRAN.replace("ENDDATA", nodes + rods + beam + cards + mass + "ENDDATA"))
        for told in (
            "constraints (PS) of GRDSET", "constraints (PS) of GRID 3, 4", "superelements (SEID) of GRID 4",
            "torsion constants (J) of PBAR 1", "stress points (C1 to F2) of PBAR 1", "torsion constants (J) of PROD 6",
            "stress coefficients (C) of PROD 6", "torsion constants (J) of CONROD 8",
            "warping nodes (SA, SB) of CBEAM 9", "thermal expansion (A, TREF) of MAT1 1", "damping (GE) of MAT1 1",
            "field 2 of line 2, whose meaning is not known, of CROD 6",
            "field 9 of line 1, whose meaning is not known, of CONM2 5",
        ):  # fmt: skip
            self.assertIn(told, mesh.left_behind)
        told = next(one.left_out for one in mesh.sections if one.text == "PBEAM 9")
        self.assertEqual(told[:-1], (
            "its torsion constant (J)", "its stress points (C1 to F2)", "the relief of shear by its taper (S1, S2)",
            "the moment of inertia of its non-structural mass (NSI)", "its warping (CW)"))  # fmt: skip
        behind = self.read(NASTRAN.replace("ENDDATA", "PBARL,1,1,,BAR\n,2.,3.,.5,7.\nENDDATA"))
        self.assertEqual(behind.sections[0].left_out, ("what stands behind its mass per length",))

    def test_the_second_rod_of_a_card_is_read(self):
        # NASTRAN User's Manual, CROD and CTUBE: fields 6 to 9 give a second element.
        nodes = "GRID,3,,1.,1.,0.\n"
        rods = "CROD    6       6       1       2       7       6       2       3\nCTUBE,8,,3,1,9,6,1,3\n"
        mesh = self.read(NASTRAN.replace("ENDDATA", nodes + rods + "ENDDATA"))
        self.assertEqual(mesh.line_ids.tolist(), [1, 6, 7, 8, 9])
        self.assertEqual(mesh.lines[1:].tolist(), [[0, 1], [1, 2], [2, 0], [0, 2]])
        self.assertEqual(list(mesh.element_sets), ["property_1", "property_6", "property_8"])
        half = "CROD,6,6,1,2,7\nENDDATA"
        self.assert_refused(NASTRAN.replace("ENDDATA", half), "5: error: CROD: has no node: truncated?")
        springs = "CELAS3,11,1,1,2,12,1,2,3\nCELAS2,13,1.,1,1,14\nENDDATA"
        self.assertIn("CELAS3 11, 12", self.read(NASTRAN.replace("ENDDATA", springs)).left_behind)


if __name__ == "__main__":
    unittest.main()
