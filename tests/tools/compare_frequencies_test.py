"""tools/compare_frequencies: the differences in its table."""

import unittest

from synthetic_results import write_superelement
from tool_test_case import ToolTestCase


class CompareFrequencies(ToolTestCase):
    def setUp(self):
        super().setUp()
        write_superelement(self.folder / "arm.h5", "arm", [6.1149, 6.1151, 40.0])

    def test_each_mode_stands_beside_its_printed_value(self):
        process = self.run_tool("compare_frequencies", "arm.h5", "--printed", "6.11", "6.11", "50.0")
        self.assertEqual(process.returncode, 0, process.stderr)
        rows = [line.split() for line in process.stdout.splitlines()[2:]]
        self.assertEqual(rows[0], ["arm", "1", "6.11490", "6.11", "+0.00490", "+0.0802", "yes"])
        self.assertEqual(rows[1], ["2", "6.11510", "6.11", "+0.00510", "+0.0835", "NO"])  # rounds to 6.12
        self.assertEqual(rows[2], ["3", "40.00000", "50.0", "-10.00000", "-20.0000", "NO"])

    def test_vectors_without_a_frequency_of_the_body_are_left_out_and_told(self):
        kinds = ["free", "residual", "free", "constraint", "residual"]
        write_superelement(self.folder / "arm.h5", "arm", [6.11, 7.0, 38.3, 50.0, 60.0], kinds)
        process = self.run_tool("compare_frequencies", "arm.h5", "--printed", "6.11", "38.3")
        self.assertEqual(process.returncode, 0, process.stderr)
        note, _, *table = process.stdout.splitlines()
        left_out = "left out are vectors without a frequency of the body: 2 residual, 1 constraint"
        self.assertEqual(note, f"remark: {left_out}")
        rows = [line.split() for line in table[2:]]
        self.assertEqual([(row[-6], row[-1]) for row in rows], [("1", "yes"), ("3", "yes")])
        process = self.run_tool("compare_frequencies", "arm.h5", "--printed", "6.11", "38.3", "50.0")
        self.assert_refuses(process, f"arm.h5: error: has 2 modes, 3 to compare were given; {left_out}")

    def test_an_option_that_takes_the_file_says_so(self):
        for words, taken in ((("--printed", "6.11", "arm.h5"), True), (("--printed=6.11",), False), ((), False)):
            process = self.run_tool("compare_frequencies", *words)
            self.assertEqual(process.returncode, 2)
            self.assertIn("arguments are required: SUPERELEMENT", process.stderr)
            hint = "; --printed takes all values behind it: put the files first, or -- before them"
            self.assertEqual(hint in process.stderr, taken, process.stderr)
        self.assert_succeeds(self.run_tool("compare_frequencies", "--printed", "6.11", "--", "arm.h5"))

    def test_bad_input_is_refused(self):
        for arguments, expected in (
            (
                ("arm.h5", "--printed", "1", "2", "3", "4"),
                "arm.h5: error: has 3 modes, 4 to compare were given",
            ),
            (("arm.h5", "--printed", "6.11", "six"), "--printed 2: error: 'six' is not a frequency > 0 Hz"),
            (("arm.h5", "--printed", "nan"), "--printed 1: error: 'nan' is not a frequency > 0 Hz"),
            (("leg.h5", "--printed", "6.11"), "leg.h5: error: no such file"),
        ):
            with self.subTest(expected):
                self.assert_refuses(self.run_tool("compare_frequencies", *arguments), expected)


if __name__ == "__main__":
    unittest.main()
