"""tools/paper_report/markdown.py: writing between markers, and telling a table that no longer matches."""

import unittest

from markdown_tables import cells_agree, find_differences, parse_markdown, read_part

from sprung_tools.files.errors import InputError
from sprung_tools.paper_report.markdown import format_markdown, format_words, replace_part

TEXT = "before\n<!-- begin one -->\nold\n<!-- end one -->\nbetween\n<!-- begin two -->\n\n<!-- end two -->\nafter\n"
TABLE = (("", "mm", "holds?"), [("a", "12.3, -4.0", "yes"), ("b", "1.5", "no")])


class Parts(unittest.TestCase):
    def test_a_part_is_replaced_and_nothing_else(self):
        text = replace_part(TEXT, "one", "new\nlines")
        self.assertEqual(text, TEXT.replace("old", "new\nlines"))
        self.assertEqual(replace_part(text, "one", "old"), TEXT)
        self.assertEqual(read_part(replace_part(TEXT, "two", "x"), "two"), "x")

    def test_a_missing_or_repeated_part_is_refused(self):
        for text in ("no marker", TEXT + TEXT, TEXT.replace("end one", "end won")):
            with self.assertRaisesRegex(InputError, "no single part 'one'"):
                replace_part(text, "one", "new")

    def test_a_table_is_read_back_as_it_was_written(self):
        self.assertEqual(
            parse_markdown(format_markdown(*TABLE)), ([*TABLE[0]], [list(row) for row in TABLE[1]])
        )
        self.assertEqual(parse_markdown("no table"), ([], []))

    def test_words_are_quoted_line_by_line(self):
        self.assertEqual(format_words("warning: one\nand two"), "> warning: one\n> and two")
        self.assertEqual(format_words(""), "")


class Differences(unittest.TestCase):
    def find(self, made, relative=0.01):
        return find_differences(parse_markdown(format_markdown(*TABLE)), made, relative)

    def test_an_equal_table_and_one_with_fewer_rows_agree(self):
        self.assertEqual(self.find(TABLE), [])
        self.assertEqual(self.find((TABLE[0], TABLE[1][1:])), [])

    def test_each_number_each_word_and_each_row_counts(self):
        for row, complaint in (
            (("a", "12.6, -4.0", "yes"), "row 'a', column 'mm': '12.3, -4.0' is now '12.6, -4.0'"),
            (("a", "12.3, 4.0", "yes"), "'12.3, 4.0'"),
            (("a", "12.3", "yes"), "'12.3'"),
            (("a", "12.3, -4.0", "no"), "column 'holds?': 'yes' is now 'no'"),
            (("c", "1", "yes"), "no row 'c'"),
        ):
            found = self.find((TABLE[0], [row]))
            self.assertEqual(len(found), 1, row)
            self.assertIn(complaint, found[0])
        self.assertIn("headings", self.find((("", "m", "holds?"), []))[0])

    def test_numbers_may_differ_by_the_share_or_by_one_and_a_half_of_the_last_digit(self):
        self.assertTrue(cells_agree("139.7 m/s²", "140.9 m/s²", 0.01))
        self.assertFalse(cells_agree("139.7 m/s²", "141.2 m/s²", 0.01))
        self.assertTrue(cells_agree("0.2", "0.3", 0.01))
        self.assertFalse(cells_agree("0.2", "0.4", 0.01))
        self.assertTrue(cells_agree("1e-06", "1e-06", 0.0))
        self.assertFalse(cells_agree("1e-06", "5e-06", 0.01))

    def test_shares_alone_may_differ_by_points(self):
        self.assertTrue(cells_agree("180.4, +0.3 %", "180.4, -0.6 %", 0.01, points=1.0))
        self.assertTrue(cells_agree("180.4, +0.3 %", "180.4, +1.3 %", 0.01, points=1.0))
        self.assertFalse(cells_agree("180.4, +0.3 %", "180.4, +1.4 %", 0.01, points=1.0))
        self.assertFalse(cells_agree("0.30", "1.30", 0.01, points=1.0))
        self.assertFalse(cells_agree("180.4, +0.3 %", "180.4, +1.3 %", 0.01))


if __name__ == "__main__":
    unittest.main()
