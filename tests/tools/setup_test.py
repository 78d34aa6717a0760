"""tools/setup, with stand-ins for dpkg-query, apt-get, id and sudo that write down how they were called."""

import re
import unittest

from tool_test_case import ToolTestCase, run_program

# What the script itself needs of the system; PATH holds nothing else, so that no real apt-get can be reached.
NEEDED = ("bash", "cat", "dirname", "env", "mktemp", "paste", "readlink", "rm", "sed")

# What apt-get prints when it is asked and told not to go on.
ANSWER = """Reading package lists...
The following NEW packages will be installed:
  catch2 libgmsh-dev
1 upgraded, 9 newly installed, 0 to remove and 126 not upgraded.
Need to get 59.5 MB/60.2 MB of archives.
After this operation, 277 MB of additional disk space will be used.
Do you want to continue? [Y/n] N
Abort."""
ASKED = f"case \"$*\" in *--assume-no*) echo '{ANSWER}'; exit 1;; esac"


class Setup(ToolTestCase):
    def setUp(self):
        super().setUp()
        self.programs = self.folder / "bin"
        self.programs.mkdir()
        self.log = self.folder / "log"
        self.log.touch()
        for name in NEEDED:
            found = run_program(["/bin/sh", "-c", f"command -v {name}"], check=True)
            (self.programs / name).symlink_to(found.stdout.strip())

    def stand_in(self, name, body):
        path = self.programs / name
        path.write_text(f"#!/bin/bash\n{body}\n", encoding="utf-8")
        path.chmod(0o755)

    def make_debian(self, missing=(), user=0):
        """A system with dpkg on which these packages are missing, for a user of this number."""
        absent = "|".join(missing) or "none-at-all"
        self.stand_in("dpkg-query", f'case "${{@: -1}}" in {absent}) exit 1;; *) echo -n installed;; esac')
        self.stand_in("apt-get", f'echo "${{DEBIAN_FRONTEND-}} apt-get $*" >>"{self.log}"; {ASKED}')
        self.stand_in("id", f"echo {user}")

    def setup_tool(self, *arguments):
        return self.run_tool("setup", *arguments, PATH=str(self.programs), DEBIAN_FRONTEND="")

    def calls(self):
        return self.log.read_text(encoding="utf-8").splitlines()

    def test_nothing_is_done_when_nothing_is_missing(self):
        self.make_debian()
        process = self.setup_tool()
        self.assertEqual((process.returncode, process.stderr), (0, ""))
        self.assertIn("all packages are installed", process.stdout)
        self.assertEqual(self.calls(), [])

    def test_only_missing_packages_are_installed_after_an_update_without_questions(self):
        self.make_debian(missing=("catch2", "libgmsh-dev"))
        process = self.setup_tool()
        self.assertEqual(process.returncode, 0, process.stderr)
        update, question, install = self.calls()
        self.assertRegex(update, r"^noninteractive apt-get .*\bupdate$")
        self.assertRegex(question, r"\binstall --assume-no --no-install-recommends libgmsh-dev catch2$")
        self.assertRegex(
            install, r"^noninteractive apt-get .*\binstall -y --no-install-recommends libgmsh-dev catch2$"
        )

    def test_the_number_and_size_of_packages_are_printed_before(self):
        self.make_debian(missing=("catch2", "libgmsh-dev"))
        # The installation prints a line of its own, which must come after.
        self.stand_in("apt-get", f"{ASKED}; echo doing $*")
        lines = self.setup_tool().stdout.splitlines()
        told = (
            "tools/setup: 9 packages, with those that they need. 60.2 MB to download. "
            "After this operation, 277 MB of additional disk space will be used."
        )
        self.assertIn(told, lines)
        installation = next(line for line in lines if line.startswith("doing") and "install -y" in line)
        self.assertLess(lines.index(told), lines.index(installation))

    def test_minimal_installs_no_packages_for_pictures(self):
        drawing = ("python3-matplotlib", "python3-meshio", "libjs-dygraphs")
        self.make_debian(missing=drawing)
        self.assertIn("all packages are installed", self.setup_tool("--minimal").stdout)
        self.assertEqual(self.calls(), [])
        self.assertEqual(self.setup_tool().returncode, 0)
        self.assertTrue(self.calls()[-1].endswith(" ".join(drawing)), self.calls())
        self.make_debian(missing=("libgmsh-dev",))
        self.assertEqual(self.setup_tool("--minimal").returncode, 0)
        self.assertTrue(self.calls()[-1].endswith(" libgmsh-dev"), self.calls())

    def test_the_programs_that_check_the_sources_are_for_the_tests(self):
        checkers = ("flake8", "mypy", "shellcheck", "clang-format", "snakemake")
        self.make_debian(missing=checkers)
        self.assertIn("all packages are installed", self.setup_tool().stdout)
        self.assertEqual(self.setup_tool("--for-tests").returncode, 0)
        self.assertTrue(self.calls()[-1].endswith(" ".join(checkers)), self.calls())

    def test_a_browser_is_installed_for_the_tests_alone_and_only_where_there_is_none(self):
        self.make_debian(missing=("chromium",))
        self.assertIn("all packages are installed", self.setup_tool().stdout)
        self.assertEqual(self.calls(), [])
        process = self.setup_tool("--for-tests")
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertRegex(self.calls()[-1], r"install -y --no-install-recommends chromium$")
        self.stand_in("google-chrome", "")
        self.assertIn("all packages are installed", self.setup_tool("--for-tests").stdout)

    def test_other_arguments_are_refused(self):
        for arguments in (("--tests",), ("--for-tests", "twice"), ("--minimal", "--for-tests")):
            process = self.setup_tool(*arguments)
            self.assertEqual(process.returncode, 2)
            self.assertIn(f"unknown argument '{arguments[-1]}'", process.stderr)

    def test_a_removed_package_of_which_only_settings_are_left_is_missing(self):
        self.make_debian()
        self.stand_in("dpkg-query", '[[ "${@: -1}" == g++ ]] && echo -n config-files || echo -n installed')
        self.assertEqual(self.setup_tool().returncode, 0)
        self.assertRegex(self.calls()[-1], r" g\+\+$")

    def test_an_update_that_fails_does_not_stop_the_installation_but_a_failing_installation_does(self):
        self.make_debian(missing=("catch2",))
        self.stand_in("apt-get", f'echo "$*" >>"{self.log}"; {ASKED}; [[ "$*" != *update ]]')
        self.assertEqual(self.setup_tool().returncode, 0)
        self.stand_in("apt-get", "exit 100")
        process = self.setup_tool()
        self.assertEqual(process.returncode, 2)
        self.assertIn("tools/setup: error: apt-get could not install: catch2", process.stderr)

    def test_other_users_go_through_sudo(self):
        self.make_debian(missing=("catch2",), user=1000)
        self.stand_in("sudo", f'echo -n "sudo: " >>"{self.log}"; exec "$@"')
        self.assertEqual(self.setup_tool().returncode, 0)
        self.assertTrue(
            all(re.match(r"sudo: noninteractive apt-get ", call) for call in self.calls()), self.calls()
        )

    def test_without_root_and_sudo_the_command_is_named(self):
        self.make_debian(missing=("catch2",), user=1000)
        process = self.setup_tool()
        self.assertEqual(process.returncode, 2)
        self.assertIn("run as root: apt-get install -y --no-install-recommends catch2", process.stderr)
        self.assertEqual(self.calls(), [])

    def test_elsewhere_the_packages_are_named(self):
        process = self.setup_tool()
        self.assertEqual(process.returncode, 2)
        self.assertIn("no apt-get here and something is missing", process.stderr)
        self.assertIn("libsundials-dev", process.stderr)


if __name__ == "__main__":
    unittest.main()
