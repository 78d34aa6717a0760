"""tools/whole_file.py: whatever stops the writing, the earlier file stays and nothing half-written is left."""

import os
import unittest
from pathlib import Path

from tool_test_case import ToolTestCase

from results_file import ResultsError
from whole_file import whole_file


class WholeFile(ToolTestCase):
    def setUp(self):
        super().setUp()
        self.path = self.folder / "a.txt"
        self.path.write_text("earlier", encoding="utf-8")

    def write(self, text, error=None):
        with whole_file(str(self.path), "table") as unfinished:
            Path(unfinished).write_text(text, encoding="utf-8")
            if error is not None:
                raise error

    def assert_left(self, text):
        self.assertEqual(os.listdir(self.folder), ["a.txt"])
        self.assertEqual(self.path.read_text(encoding="utf-8"), text)

    def test_a_file_is_replaced_when_all_is_written(self):
        self.write("new")
        self.assert_left("new")

    def test_faults_of_writing_name_file_and_kind(self):
        for error in (OSError(28, "No space left on device"), ValueError("format unknown")):
            with self.assertRaisesRegex(ResultsError, r"a\.txt: error: cannot write the table \(.*(space|unknown)"):
                self.write("half", error)
            self.assert_left("earlier")

    def test_interruption_and_other_errors_pass_through(self):
        for error in (KeyboardInterrupt(), ResultsError("b.h5: error: no such file")):
            with self.assertRaises(type(error)):
                self.write("half", error)
            self.assert_left("earlier")


if __name__ == "__main__":
    unittest.main()
