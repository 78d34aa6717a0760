"""What the tests of Nastran decks share."""

from tool_test_case import ToolTestCase

from sprung_tools.files.errors import InputError
from sprung_tools.mesh_import.nastran_deck import read_nastran


class NastranCase(ToolTestCase):
    """Decks that are written to a file and read."""

    def read(self, text, name="a.bdf"):
        (self.folder / name).write_text(text, encoding="utf-8")
        return read_nastran(str(self.folder / name))

    def assert_refused(self, text, message):
        """Asserts that a deck is refused with a message that begins with the line."""
        with self.assertRaises(InputError) as caught:
            self.read(text, "b.bdf")
        self.assertIn(f"b.bdf:{message}", str(caught.exception))
