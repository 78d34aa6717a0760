"""files/whole_file.py: a file is written whole or stays as it was."""

import os
import unittest
from unittest import mock

from tool_test_case import ToolTestCase

from sprung_tools.files.errors import InputError
from sprung_tools.files.whole_file import write_whole


class WholeFile(ToolTestCase):
    def test_text_and_bytes_replace_an_earlier_file(self):
        path = self.folder / "a.txt"
        for content, expected in (("ε\n", "ε\n".encode()), (b"\x00\xff", b"\x00\xff")):
            write_whole(path, content)
            self.assertEqual(path.read_bytes(), expected)
        self.assertEqual(os.listdir(self.folder), ["a.txt"])

    def test_an_interruption_leaves_the_earlier_file_and_nothing_else(self):
        path = self.folder / "a.txt"
        path.write_text("earlier", encoding="utf-8")
        with mock.patch("os.replace", side_effect=KeyboardInterrupt), self.assertRaises(KeyboardInterrupt):
            write_whole(path, "later")
        self.assertEqual(path.read_text(encoding="utf-8"), "earlier")
        self.assertEqual(os.listdir(self.folder), ["a.txt"])

    def test_a_place_that_cannot_be_written_is_named(self):
        (self.folder / "taken").mkdir()
        for place in ("none/a.txt", "taken", "."):
            with self.assertRaisesRegex(InputError, f"{place}: error: cannot write the file"):
                write_whole(self.folder / place if place != "." else place, "text")
        self.assertEqual(os.listdir(self.folder), ["taken"])

    def test_what_is_no_regular_file_is_not_replaced(self):
        pipe = self.folder / "pipe"
        os.mkfifo(pipe)
        with self.assertRaisesRegex(InputError, "pipe: error: cannot write the file .it is not a regular file"):
            write_whole(pipe, "text")
        self.assertTrue(pipe.is_fifo())

    def test_a_link_to_an_open_file_of_a_process_is_not_replaced(self):
        # As /dev/stdout, where the output goes to a file.
        link = self.folder / "link"
        with open(self.folder / "output", "w", encoding="utf-8") as file:
            link.symlink_to(f"/proc/self/fd/{file.fileno()}")
            self.assertTrue(link.is_file())
            with self.assertRaisesRegex(InputError, "link: error: cannot write the file .it is not a regular file"):
                write_whole(link, "text")
        self.assertTrue(link.is_symlink())


if __name__ == "__main__":
    unittest.main()
