"""Every equation, section, reference and test that is cited exists, and every README numbers its equations 1, 2, 3 …"""

import unittest

from equations import find_mistakes, read_readmes
from tool_test_case import ROOT, ToolTestCase


class TheProject(unittest.TestCase):
    def test_every_citation_is_right(self):
        self.assertEqual(find_mistakes(ROOT), [])

    def test_the_rooms_with_theory_are_read(self):
        readmes = read_readmes(ROOT)
        for room in ("fem", "reduce", "bodies", "system", "integration/exponential", "adaptivity"):
            self.assertGreater(len(readmes[room].numbers), 5, room)
        self.assertIn("One basis", readmes["reduce"].headings)
        self.assertIn("Shabana 2013", readmes["bodies"].references)
        self.assertIn("models/truck", readmes)


README = """# Bodies

    r = R + A u,   (not a number)                                    (1)
    ṙ = …                                                            (2)

From (1) and (fem, eq. 1), see [Miller & Smith 1999, ch. 2].

## Motion

## References

- [Miller & Smith 1999] A. Miller, B. Smith, A title, Journal 3 (1999) 1–2.
"""


class TheCheck(ToolTestCase):
    """On a small tree with one fault."""

    def setUp(self):
        super().setUp()
        self.write("dynamics/bodies/README.md", README)
        self.write("fem/README.md", "    K = …  (1)\n")
        self.write("tests/fem/a_test.py", "class Good:\n    def test_good_b_d(self):\n        pass\n")
        self.write(
            "dynamics/bodies/body.h", "/// Position (bodies, eq. 1), velocity (bodies,\n/// eqs. 1, 2).\nint a[2];\n"
        )

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def test_right_citations_pass_also_across_lines(self):
        self.write("tools/plot.py", '"""Draws (fem, eq. 1;\nbodies, eqs. 1–2)."""\npair = (bodies, "Nothing")\n')
        self.write("fem/beam.cpp", '// (bodies, "Motion") \n')
        self.assertEqual(find_mistakes(self.folder), [])

    def test_each_wrong_citation_is_found_at_its_line(self):
        for name, text, expected in (
            (
                "fem/a.h",
                "\n// (bodies, eq. 3)\n",
                "fem/a.h:2: error: dynamics/bodies/README.md has 2 equations, none of number 3",
            ),
            ("fem/a.h", "// (bodies, eqs. 1–3)\n", "none of number 3"),
            ("fem/a.h", "// (wheels, eq. 1)\n", "no room 'wheels' has a README"),
            ("fem/a.h", "// (bodies, eqs. 1)\n", "eq. is for one, eqs. for several"),
            ("fem/a.h", "// (bodies, eq. 1, 2)\n", "eq. is for one, eqs. for several"),
            ("fem/a.h", "// (dynamics/README.md, eq. 1)\n", "not of the form (ROOM, eq. N)"),
            ("fem/a.h", "// by eq. 1\n", "not of the form (ROOM, eq. N)"),
            ("fem/a.h", "int x;  // equation (1)\n", "not of the form (ROOM, eq. N)"),
            ("tests/a.py", "# x\n# (bodies, eq. 56a)\n", "tests/a.py:2: error: not of the form"),
            ("fem/a.h", '// (bodies, "Rest")\n', "room 'bodies' has no section 'Rest'"),
            (
                "dynamics/bodies/a.h",
                "// [Jones 2001]\n",
                "[Jones 2001] is not among the references of dynamics/bodies/README.md",
            ),
            (
                "tests/a.h",
                "// [Jones 2001], [Miller & Smith 1999]\n",
                "[Jones 2001] is not among the references of any README",
            ),
            (
                "dynamics/bodies/a.h",
                "// [Miller & Smith 1999; Jones 2001, §2]\n",
                "[Jones 2001] is not among the references of dynamics/bodies/README.md",
            ),
            ("fem/a.h", "// Checked by tests/fem/a_test.cpp\n", "fem/a.h:1: error: there is no tests/fem/a_test.cpp"),
            ("fem/a.h", "// see above — checked by\n// tests/fem/a_tset.cpp\n", "there is no tests/fem/a_tset.cpp"),
            ("tools/README.md", "tests/tools/plot_test.py draws\n", "there is no tests/tools/plot_test.py"),
            ("tests/README.md", '| "good", "b d" in [a_test.py](fem/a_test.py) |\n', "'b d' is not in [a_test.py]"),
            ("tests/README.md", "| `Bad` in [a_test.py](fem/a_test.py) |\n", "'Bad' is not in [a_test.py]"),
        ):
            with self.subTest(text):
                self.write(name, text)
                found = find_mistakes(self.folder)
                self.assertEqual(len(found), 1, found)
                self.assertIn(expected, found[0])
                (self.folder / name).unlink()

    def assert_readme(self, old, new, expected):
        self.write("dynamics/bodies/README.md", README.replace(old, new))
        self.assertEqual([line.partition("error: ")[2] for line in find_mistakes(self.folder)], expected)

    def test_gaps_repeats_and_letters_in_the_numbers_are_found(self):
        hint = "; new equations go to the end, or those behind them get new numbers"
        wrong = ("equation ({}) stands where ({}) should" + hint).format
        self.assert_readme("… " + " " * 59 + "(2)", "…  (2)\n    a = b  (4)", [wrong(4, 3)])
        self.assert_readme("… " + " " * 59 + "(2)", "…  (2)\n    a = b  (2)", [wrong(2, 3)])
        self.assert_readme("… " + " " * 59 + "(2)", "…  (2)\n    a = b  (2a)", [wrong("2a", 3)])

    def test_a_readme_s_own_numbers_and_references_are_checked(self):
        self.assert_readme("From (1)", "From (1, 3)", ["there is no equation (3)"])
        self.assert_readme(", see [Miller & Smith 1999, ch. 2]", "", ["nothing cites [Miller & Smith 1999]"])


if __name__ == "__main__":
    unittest.main()
