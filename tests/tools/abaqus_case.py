"""What the tests of Abaqus and CalculiX decks share."""

from tool_test_case import ToolTestCase

from sprung_tools.files.errors import InputError
from sprung_tools.mesh_import.abaqus_deck import read_abaqus


class AbaqusCase(ToolTestCase):
    """Decks that are written to a file and read."""

    def read(self, text, name="a.inp"):
        (self.folder / name).write_text(text, encoding="utf-8")
        return read_abaqus(str(self.folder / name))

    def assert_refused(self, text, message, name="b.inp:"):
        """Asserts that a deck is refused with a message that begins with the line. name: of the file, with a colon."""
        with self.assertRaises(InputError) as caught:
            self.read(text, "b.inp")
        self.assertIn(f"{name}{message}", str(caught.exception))
