"""files/toml_file.py: the place of every key of a TOML file in the message of an error; files/toml_text.py: values as
TOML read back as they were."""

import tomllib
import unittest

from tool_test_case import ToolTestCase

from sprung_tools.files.errors import InputError
from sprung_tools.files.toml_file import TomlFile
from sprung_tools.files.toml_text import format_document, format_value

TEXT = """\
# A comment.
title = "a [b]"
list = [
  "first",  # ]
  "second",
]
text = '''
[not.a.table]
key = 1
'''

[road]
  shape = "flat"
[road."two words"]
a.b = 1

[[parameters]]
key = "speed"
[parameters.more]
deep = 1
[[parameters]]
  range = { from = 1, to = 2 }
"""


class Places(ToolTestCase):
    def read(self, text):
        path = self.folder / "a.toml"
        path.write_text(text, encoding="utf-8")
        return TomlFile(path)

    def test_every_key_is_found_where_it_stands(self):
        file = self.read(TEXT)
        for place, where in (
            (("title",), "2:1"), (("list",), "3:1"), (("text",), "7:1"), (("road",), "12:1"),
            (("road", "shape"), "13:3"), (("road", "two words", "a", "b"), "15:1"),
            (("parameters", 0), "17:1"), (("parameters", 0, "key"), "18:1"),
            (("parameters", 0, "more", "deep"), "20:1"), (("parameters", 1), "21:1"),
            (("parameters", 1, "range", "to"), "22:3"),
        ):  # fmt: skip
            with self.subTest(place):
                self.assertEqual(str(file.fail(place, "wrong")), f"{file.path}:{where}: error: wrong")

    def test_a_mark_of_the_encoding_before_the_text_changes_nothing(self):
        self.assertEqual(self.read("\ufeff" + TEXT).data, self.read(TEXT).data)

    def test_a_part_of_a_value_is_found_in_its_line(self):
        file = self.read(TEXT)
        self.assertIn("a.toml:5:4: error: no", str(file.fail(("list",), "no", fragment="second")))
        self.assertIn("a.toml:3:1: error: no", str(file.fail(("list",), "no", fragment="third")))

    def test_a_key_that_is_missing_is_told_at_its_table_and_one_of_the_root_at_the_beginning(self):
        file = self.read(TEXT)
        self.assertIn("a.toml:21:1: error: no", str(file.fail(("parameters", 1, "key"), "no")))
        self.assertIn("a.toml:1:1: error: no", str(file.fail(("run",), "no")))

    def test_lines_that_end_as_on_windows_count_the_same(self):
        file = self.read(TEXT.replace("\n", "\r\n"))
        self.assertIn("a.toml:18:1: error: no", str(file.fail(("parameters", 0, "key"), "no")))

    def test_wrong_syntax_is_refused_with_its_place(self):
        for text, where in (("a = 1\nb = = 2\n", "2:5"), ("a = 1\na = 2\n", "2:6"), ("a = [1,", "1:8")):
            with self.subTest(text), self.assertRaisesRegex(InputError, rf"a\.toml:{where}: error: \S"):
                self.read(text)

    def test_a_file_that_is_missing_or_no_text_is_refused(self):
        with self.assertRaisesRegex(InputError, "none.toml: error: cannot read the file"):
            TomlFile(self.folder / "none.toml")
        (self.folder / "b.toml").write_bytes(b"a = '\xff'")
        with self.assertRaisesRegex(InputError, r"b.toml: error: is not UTF-8 text \(byte 5\)"):
            TomlFile(self.folder / "b.toml")


class Text(unittest.TestCase):
    def test_values_read_back_as_they_were(self):
        table = {
            "whole": 3, "real": 0.1, "small": 1e-9, "large": 2.1e11, "yes": True, "text": 'a "b"\\ \n\t\x7f é',
            "list": [1, [2.5, "x"]], "table": {"two words": {"a": 1}, "": 2},
        }  # fmt: skip
        self.assertEqual(tomllib.loads(format_document(table)), table)
        self.assertIs(tomllib.loads(format_document(table))["yes"], True)

    def test_what_toml_does_not_hold_is_refused(self):
        with self.assertRaisesRegex(InputError, "error: NoneType 'None' is no value of a parameter"):
            format_value(None)


if __name__ == "__main__":
    unittest.main()
