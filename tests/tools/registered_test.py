"""Every file of tests is named in a CMakeLists.txt of its folder or of one above, so that ctest runs it."""

import re
import unittest

from tool_test_case import ROOT

TESTS = ROOT / "tests"


def is_named(path):
    for folder in path.parents:
        listed = folder / "CMakeLists.txt"
        if listed.exists():
            name = path.relative_to(folder).as_posix().removesuffix(".py")
            if name in re.findall(r"[\w./-]+", re.sub(r"#.*", "", listed.read_text(encoding="utf-8"))):
                return True
        if folder == TESTS:
            return False
    return False


class Registered(unittest.TestCase):
    maxDiff = None

    def test_every_test_is_run_by_ctest(self):
        for ending in ("py", "cpp"):
            paths = sorted(TESTS.rglob(f"*_test.{ending}"))
            self.assertGreater(len(paths), 80)
            self.assertEqual([path.relative_to(ROOT).as_posix() for path in paths if not is_named(path)], [])


if __name__ == "__main__":
    unittest.main()
