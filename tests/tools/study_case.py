"""What tests of `study` with the programs share. Needs both programs (SPRUNG_REDUCE, SPRUNG_DYNAMICS)."""

import csv
import os

from tool_test_case import ROOT, ToolTestCase

EXAMPLES = ROOT / "dynamics/models/examples"
DYNAMICS, REDUCE = os.environ["SPRUNG_DYNAMICS"], os.environ["SPRUNG_REDUCE"]
HEIGHT = '[[parameters]]\nname = "height"\nkey = "road.height"\n'


class StudyCase(ToolTestCase):
    def write_study(self, text, run=EXAMPLES / "quarter_car_run.toml"):
        (self.folder / "study.toml").write_text(f'run = "{run}"\n{text}', encoding="utf-8")

    def study(self, *arguments, **environment):
        return self.run_tool("study", "study.toml", "-o", "out", *arguments, **environment)

    def read_table(self, folder="out"):
        """The rows of the CSV file: column → text."""
        return read_csv(self.folder / folder / "table.csv")


def read_csv(path):
    """The rows of a CSV file: column → text."""
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))
