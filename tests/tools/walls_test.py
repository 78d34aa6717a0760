"""No include crosses a wall between the rooms, and sprung-dynamics is free of gmsh."""

import os
import subprocess
import unittest

from tool_test_case import ROOT, ToolTestCase
from walls import ALLOWED, find_crossings, read_includes


class TheProject(unittest.TestCase):
    def test_no_include_crosses_a_wall(self):
        self.assertEqual(find_crossings(ROOT), [])

    def test_every_room_has_been_looked_at(self):
        for room in ALLOWED:
            self.assertGreater(len(read_includes(ROOT, room)), 10, room)

    def test_sprung_dynamics_is_not_linked_with_gmsh(self):
        libraries = subprocess.run(
            ["ldd", os.environ["SPRUNG_DYNAMICS"]], capture_output=True, text=True, check=True
        ).stdout
        self.assertIn("libhdf5", libraries)  # that the list is one
        self.assertNotIn("gmsh", libraries)


class TheCheck(ToolTestCase):
    """On small trees, each with one fault."""

    def crossings(self, **files):
        for name in (
            "tools/support/toml.h",
            "fem/mesh.h",
            "reduce/design.h",
            "reduce/superelement.h",
            "dynamics/body.h",
        ):
            self.write(name, "#include <vector>\n")
        for name, text in files.items():
            self.write(name.replace("__", "/") + ".cpp", text)
        return find_crossings(self.folder)

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def test_includes_through_the_doors_pass(self):
        self.assertEqual(
            self.crossings(
                fem__mesh='#include "fem/mesh.h"\n#include "tools/support/toml.h"\n#include <gmsh.h>\n',
                reduce__design='#include "fem/mesh.h"\n#include "reduce/superelement.h"\n',
                reduce__superelement='#include "reduce/superelement.h"\n#include "tools/support/toml.h"\n',
                dynamics__body='#include "reduce/superelement.h"\n#include "dynamics/body.h"\n',
            ),
            [],
        )

    def test_each_crossing_is_found_at_its_line(self):
        for name, text, expected in (
            (
                "dynamics__body",
                '\n#include "fem/mesh.h"',
                "dynamics/body.cpp:2: error: 'fem/mesh.h' is not for this file of dynamics/",
            ),
            (
                "dynamics__body",
                '  #  include "reduce/design.h"',
                "dynamics/body.cpp:1: error: 'reduce/design.h'",
            ),
            ("dynamics__body", "#include <fem/mesh.h>", "'fem/mesh.h' is not for this file of dynamics/"),
            (
                "fem__mesh",
                '#include "reduce/superelement.h"',
                "'reduce/superelement.h' is not for this file of fem/",
            ),
            (
                "reduce__design",
                '#include "dynamics/body.h"',
                "'dynamics/body.h' is not for this file of reduce/",
            ),
            ("reduce__superelement", '#include "fem/mesh.h"', "'fem/mesh.h' is not for this file of reduce/"),
            (
                "tools__support__toml",
                '#include "fem/mesh.h"',
                "'fem/mesh.h' is not for this file of tools/support/",
            ),
            ("fem__mesh", '#include "../fem/mesh.h"', "'../fem/mesh.h' is not for this file of fem/"),
            ("fem__mesh", '#include "fem/none.h"', "'fem/none.h' is not a file"),
            ("reduce__design", "#include <gmsh.h>", "'gmsh.h' may be included in fem/ only"),
        ):
            with self.subTest(text.strip()):
                found = self.crossings(**{name: text + "\n"})
                self.assertEqual(len(found), 1, found)
                self.assertIn(expected, found[0])
                (self.folder / (name.replace("__", "/") + ".cpp")).unlink()


if __name__ == "__main__":
    unittest.main()
