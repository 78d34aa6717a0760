"""What the top level holds, which rooms include which, and with what sprung-dynamics is linked."""

import os
import re
import unittest
from pathlib import Path

from tool_test_case import ROOT, ToolTestCase, list_git_files, run_program
from walls import find_crossings, read_includes, read_rooms


class TheProject(unittest.TestCase):
    def test_no_include_crosses_a_wall(self):
        self.assertEqual(find_crossings(ROOT), [])

    def test_every_room_is_read(self):
        rooms = read_rooms(ROOT)
        self.assertGreater(len(rooms), 25)
        for name, room in rooms.items():
            self.assertTrue(room.sources, name)
            self.assertTrue(read_includes(ROOT, name), name)

    def test_the_top_level_holds_the_rooms_and_nothing_else(self):
        names = {file.parts[0] for file in list_git_files()}
        if not names:
            self.skipTest("a copy without git")
        rooms = {"fem", "reduce", "dynamics", "meshes", "tools", "tests"}
        files = {"CMakeLists.txt", "CMakePresets.json", "LICENSE", "README.md"}
        self.assertEqual({name for name in names if not name.startswith(".")}, rooms | files)

    def test_sprung_dynamics_is_not_linked_with_gmsh(self):
        self.assertIn("libc.so", self.list_libraries())  # that the list is one
        self.assertNotIn("gmsh", self.list_libraries())

    def test_sprung_dynamics_is_linked_with_no_shared_library_but_the_system_s_where_there_is_a_static_one(self):
        cache = (Path(os.environ["SPRUNG_DYNAMICS"]).parents[1] / "CMakeCache.txt").read_text("utf-8")
        compiler = re.search(r"(?m)^CMAKE_CXX_COMPILER:\w+=(.*)$", cache)[1]
        linked = run_program(["objdump", "-p", os.environ["SPRUNG_DYNAMICS"]], check=True).stdout
        libraries = set(re.findall(r"(?m)^\s+NEEDED\s+(lib\S+)\.so", linked))
        self.assertIn("libc", libraries)
        if "libsundials_core" in libraries:  # SUNDIALS 7 and HDF5 1.14, whose static libraries need many shared ones
            libraries -= {"libsundials_core", "libmpi", "libcurl", "libcrypto"}
        self.assertFalse({"libfmt", "libtomlplusplus", "libcurl"} & libraries)
        for name in libraries - {"libc", "libm", "libstdc++", "libgcc_s"}:  # a debug build needs the last two
            found = run_program([compiler, f"-print-file-name={name}.a"], check=True).stdout.strip()
            self.assertFalse(os.path.isabs(found), f"{name}: there is {found}")

    @staticmethod
    def list_libraries():
        return run_program(["ldd", os.environ["SPRUNG_DYNAMICS"]], check=True).stdout


class TheCheck(ToolTestCase):
    """On small trees, each with one fault."""

    def setUp(self):
        super().setUp()
        self.declare("tools/support", rooms=("toml",))
        self.declare("tools/support/toml", sources=("toml",))
        self.declare("fem", sources=("mesh",), rooms=("gmsh",), uses=("tools/support/toml",))
        self.declare("fem/gmsh", sources=("gmsh_mesher",))
        self.declare("reduce", rooms=("superelement", "design"))
        self.declare("reduce/superelement", sources=("superelement",))
        self.declare("reduce/design", sources=("design",), uses=("fem", "reduce/superelement"))
        self.declare("dynamics", rooms=("bodies", "system"))
        self.declare("dynamics/bodies", sources=("body",), uses=("reduce/superelement",))
        self.declare("dynamics/system", sources=("model",), uses=("dynamics/bodies",))
        self.write("fem/mesh.cpp", '#include "fem/mesh.h"\n#include "tools/support/toml/toml.h"\n')
        self.write("fem/gmsh/gmsh_mesher.cpp", "#include <gmsh.h>\n")
        self.write(
            "reduce/design/design.cpp",
            '#include "fem/mesh.h"\n#include "reduce/superelement/superelement.h"\n',
        )
        self.write(
            "dynamics/bodies/body.cpp",
            '#include "reduce/superelement/superelement.h"\n#include "dynamics/bodies/body.h"\n',
        )
        self.write("dynamics/system/model.cpp", '#include "dynamics/bodies/body.h"\n')

    def declare(self, room, sources=(), uses=(), rooms=()):
        text = ""
        if sources:
            text += "sprung_room(  # its sources\n" + "".join(f"  {name}.cpp\n" for name in sources)
            if uses:
                text += "  USES " + " ".join(uses)
            text += "\n  LINKS fmt::fmt)\n"
        text += "".join(f"add_subdirectory({name})\n" for name in rooms)
        self.write(f"{room}/CMakeLists.txt", text)
        for name in sources:
            self.write(f"{room}/{name}.h", "#include <vector>\n")
            self.write(f"{room}/{name}.cpp", f'#include "{room}/{name}.h"\n')

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def test_includes_of_rooms_that_are_named_pass(self):
        self.assertEqual(find_crossings(self.folder), [])

    def test_each_crossing_is_found_at_its_line(self):
        for name, text, expected in (
            (
                "dynamics/bodies/body",
                '\n#include "fem/mesh.h"',
                "dynamics/bodies/body.cpp:2: error: 'fem/mesh.h' is not for dynamics/bodies, which may include "
                "from dynamics/bodies, reduce/superelement",
            ),
            (
                "dynamics/bodies/body",
                '  #  include "reduce/design/design.h"',
                "dynamics/bodies/body.cpp:1: error: 'reduce/design/design.h'",
            ),
            (
                "dynamics/bodies/body",
                '#include "dynamics/system/model.h"',
                "'dynamics/system/model.h' is not for dynamics/bodies",
            ),
            ("dynamics/bodies/body", "#include <fem/mesh.h>", "'fem/mesh.h' is not for dynamics/bodies"),
            (
                "dynamics/system/model",
                '#include "reduce/superelement/superelement.h"',
                "'reduce/superelement/superelement.h' is not for dynamics/system",
            ),
            ("reduce/design/design", '#include "dynamics/bodies/body.h"', "is not for reduce/design"),
            ("reduce/superelement/superelement", '#include "fem/mesh.h"', "is not for reduce/superelement"),
            ("tools/support/toml/toml", '#include "fem/mesh.h"', "is not for tools/support/toml"),
            ("fem/mesh", '#include "../fem/mesh.h"', "'../fem/mesh.h' is not for fem"),
            ("fem/mesh", '#include "fem/none.h"', "'fem/none.h' is not a file"),
            ("reduce/design/design", "#include <gmsh.h>", "'gmsh.h' may be included in fem/gmsh only"),
        ):
            with self.subTest(text.strip()):
                path = self.folder / f"{name}.cpp"
                before = path.read_text(encoding="utf-8")
                path.write_text(text + "\n" + before, encoding="utf-8")
                found = find_crossings(self.folder)
                self.assertEqual(len(found), 1, found)
                self.assertIn(expected, found[0])
                path.write_text(before, encoding="utf-8")

    def assert_found(self, expected):
        found = find_crossings(self.folder)
        self.assertTrue(any(expected in line for line in found), found)

    def test_an_arrow_that_runs_up_is_found(self):
        self.declare("dynamics/bodies", sources=("body",), uses=("dynamics/system",))
        self.assert_found("'dynamics/system' is declared after dynamics/bodies")

    def test_stage_two_may_use_the_door_alone(self):
        self.declare("dynamics/bodies", sources=("body",), uses=("reduce/design",))
        self.assert_found("stage two may use reduce/superelement alone, not 'reduce/design'")

    def test_a_room_that_is_named_and_not_used_is_found(self):
        self.declare("dynamics/system", sources=("model",), uses=("dynamics/bodies",))
        self.assert_found("it may use 'dynamics/bodies', but no file includes from there")

    def test_a_room_that_there_is_not_is_found(self):
        self.declare("dynamics/system", sources=("model",), uses=("dynamics/nowhere",))
        self.assert_found("'dynamics/nowhere' is no room")

    def test_a_file_outside_the_rooms_is_found(self):
        self.write("dynamics/stray.cpp", "")
        self.assert_found("dynamics/stray.cpp:1: error: its folder is no room")


if __name__ == "__main__":
    unittest.main()
