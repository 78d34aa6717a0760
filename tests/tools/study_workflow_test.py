"""A study in parts by Snakemake (tools/setup --for-tests installs it): on two cores, killed half-way, and handed to the
command of a cluster."""

import os
import re
import select
import shlex
import signal
import subprocess
import unittest

from study_case import DYNAMICS, EXAMPLES, HEIGHT, StudyCase
from tool_test_case import ROOT, TOOLS, run_program

from sprung_tools.study.kept_rows import KeptRows, Row, keep_row
from sprung_tools.study.workflow import collect_rows

SNAKEMAKE = ("/usr/bin/snakemake", "--directory", "out", "--snakefile", "out/Snakefile")
README = (TOOLS / "README.md").read_text(encoding="utf-8")


class Workflow(StudyCase):
    """With a stand-in that runs the program, writes down each call, and at the third and fourth height of the bump
    stays for ever while a file called hold is there."""

    def setUp(self):
        super().setUp()
        settings = 'measures = ["program/steps"]\nset.duration = 0.5\n'
        self.write_study(f"{settings}{HEIGHT}values = [0.01, 0.02, 0.03, 0.04]")
        os.mkfifo(self.folder / "arrived")
        stand_in = self.folder / "stand_in"
        stand_in.write_text(
            '#!/bin/bash\n[[ "$*" == *--dry-run* ]] && exit 0\n'
            f'echo "$*" >>"{self.folder}/calls"\n'
            f'if [[ "$*" == *height=0.0[34]* && -e "{self.folder}/hold" ]]; then\n'
            f'  echo $$ >"{self.folder}/arrived"\n  exec sleep infinity\nfi\nexec "{DYNAMICS}" "$@"\n',
            encoding="utf-8",
        )
        stand_in.chmod(0o755)
        self.environment = {"SPRUNG_DYNAMICS": str(stand_in), "XDG_CACHE_HOME": str(self.folder / "cache")}
        self.assert_succeeds(self.study("--workflow", "2", **self.environment))

    def snakemake(self, *arguments, **environment):
        """Runs Snakemake, which writes its progress on stderr, to a good end."""
        environment = {**os.environ, **self.environment, **environment}
        process = run_program([*SNAKEMAKE, *arguments], cwd=self.folder, env=environment)
        self.assertEqual(process.returncode, 0, process.stderr)

    def count_calls(self):
        calls = (self.folder / "calls").read_text(encoding="utf-8").splitlines()
        return sorted(line.split("road.height=")[1] for line in calls)

    def check_table(self):
        """The table is that of a study in one part."""
        self.assert_succeeds(self.run_tool("study", "study.toml", "-o", "whole", **self.environment))
        for name in ("table.csv", "table.h5"):
            self.assertEqual((self.folder / "out" / name).read_bytes(), (self.folder / "whole" / name).read_bytes())

    def test_two_parts_on_two_cores_make_the_table_of_the_study(self):
        self.snakemake("--cores", "2")
        self.assertEqual(self.count_calls(), ["0.01", "0.02", "0.03", "0.04"])
        for part in ("1", "2"):
            rows = (self.folder / "out/parts" / part / "rows.jsonl").read_text(encoding="utf-8").splitlines()
            self.assertEqual(len(rows), 2)
        self.check_table()

    def test_the_table_is_kept_where_no_run_has_one_of_the_measures(self):
        measures = 'measures = ["program/steps", "program/nothing"]\nset.duration = 0.5\n'
        self.write_study(f"{measures}{HEIGHT}values = [0.01, 0.02]")
        self.assert_succeeds(self.study("--workflow", "2", **self.environment))
        self.snakemake("--cores", "2")
        self.assertTrue((self.folder / "out/table.csv").exists())

    def test_more_values_or_a_changed_vehicle_are_made_and_what_is_done_is_not(self):
        self.snakemake("--cores", "2")
        self.snakemake("--cores", "2")
        self.assertEqual(self.count_calls(), ["0.01", "0.02", "0.03", "0.04"])
        study = self.folder / "study.toml"
        changed = study.read_text(encoding="utf-8").replace("0.04]", "0.04, 0.05, 0.06]")
        study.write_text(changed, encoding="utf-8")
        os.utime(study, (1e9, 1e9))  # as a file that is copied with its time
        self.assert_succeeds(self.study("--workflow", "2", **self.environment))
        self.snakemake("--cores", "2")
        self.assertEqual(self.count_calls(), ["0.01", "0.02", "0.03", "0.04", "0.05", "0.06"])
        self.check_table()
        for name in ("quarter_car.toml", "quarter_car_run.toml"):
            text = (EXAMPLES / name).read_text(encoding="utf-8")
            (self.folder / name).write_text(text, encoding="utf-8")
        self.write_study(changed.partition("\n")[2], run="quarter_car_run.toml")
        self.assert_succeeds(self.study("--workflow", "2", **self.environment))
        self.snakemake("--cores", "2")
        vehicle = self.folder / "quarter_car.toml"
        vehicle.write_text(vehicle.read_text(encoding="utf-8").replace("300.0", "310.0"), encoding="utf-8")
        (self.folder / "calls").unlink()
        self.snakemake("--cores", "2")  # without --workflow again
        self.assertEqual(self.count_calls(), ["0.01", "0.02", "0.03", "0.04", "0.05", "0.06"])
        self.check_table()

    def test_a_workflow_that_is_killed_goes_on_where_it_was(self):
        (self.folder / "hold").touch()
        process = subprocess.Popen(
            [*SNAKEMAKE, "--cores", "2"], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL, env={**os.environ, **self.environment}, start_new_session=True,
        )  # fmt: skip
        held = []
        while len(held) < 2:  # both parts have made their first run, and are in their second
            held += map(int, (self.folder / "arrived").read_text(encoding="utf-8").split())
        ends = [os.pidfd_open(one) for one in held]
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        for end in ends:
            select.select([end], [], [])  # of a process that has ended
            os.close(end)
        (self.folder / "hold").unlink()
        self.snakemake("--unlock")
        self.snakemake("--cores", "2", "--rerun-incomplete")
        self.assertEqual(self.count_calls(), ["0.01", "0.02", "0.03", "0.03", "0.04", "0.04"])
        self.check_table()

    def test_the_profile_of_the_readme_hands_the_parts_to_a_cluster(self):
        """With a stand-in for sbatch: it writes down its arguments, runs the job, and prints its number."""
        # Without the folder of --output, Slurm itself ends a job at once, and Snakemake waits for ever.
        self.assertTrue((self.folder / "out/parts").is_dir())
        (profile,) = re.findall(r"```yaml\n(# slurm/config.yaml\n.*?)```", README, re.DOTALL)
        (self.folder / "slurm").mkdir()
        (self.folder / "slurm/config.yaml").write_text(profile, encoding="utf-8")
        sbatch = self.folder / "bin/sbatch"
        sbatch.parent.mkdir()
        sbatch.write_text(
            f'#!/bin/bash\necho "$*" >>"{self.folder}/submitted"\nbash "${{@: -1}}" >/dev/null 2>&1\necho 17\n',
            encoding="utf-8",
        )
        sbatch.chmod(0o755)
        path = f"{sbatch.parent}:{os.environ['PATH']}"
        self.snakemake("--profile", self.folder / "slurm", PATH=path)
        submitted = (self.folder / "submitted").read_text(encoding="utf-8").splitlines()
        self.assertEqual(len(submitted), 3)  # two parts and the table
        self.assertTrue(all("--cpus-per-task=1" in line for line in submitted), submitted)
        self.check_table()


class Parts(StudyCase):
    def test_parts_share_the_runs_and_another_number_of_parts_needs_no_run_twice(self):
        self.write_study(f'measures = ["program/steps"]\nset.duration = 0.2\n{HEIGHT}values = [0.01, 0.02, 0.03]')
        self.assertIn("2 runs: 2 made", self.study("--part", "1/2").stdout)
        self.assertIn("1 runs: 1 made", self.study("--part", "2/2").stdout)
        self.assertFalse((self.folder / "out/table.csv").exists())
        self.assertIn("3 runs: 0 made, 3 kept from before", self.study("--collect").stdout)

    def test_a_part_of_which_all_runs_fail_has_their_rows_unless_the_whole_study_fails(self):
        measures = 'measures = ["program/steps"]\nset.duration = 0.2\n'
        self.write_study(f'{measures}[[parameters]]\nkey = "speed"\nvalues = [2.0, 3.0]\n'
                         '[[parameters]]\nkey = "integrator.relative_tolerance"\nvalues = [1e-6, 5]')  # fmt: skip
        self.assertIn("2 runs: 2 made, 0 kept from before, 0 failed", self.study("--part", "1/2").stdout)
        process = self.study("--part", "2/2")
        self.assertIn("2 runs: 2 made, 0 kept from before, 2 failed", process.stdout)
        self.assertEqual(process.returncode, 0)
        self.assertIn("4 runs: 0 made, 4 kept from before, 2 failed", self.study("--collect").stdout)
        self.write_study(f'{measures}[[parameters]]\nkey = "integrator.relative_tolerance"\nvalues = [5]\n'
                         '[[parameters]]\nkey = "speed"\nvalues = [2.0, 4.0]')  # fmt: skip
        for part in ("1/2", "2/2"):
            self.assert_refuses(self.study("--part", part), "study.toml:5:8: error: ")

    def test_a_part_of_which_no_design_can_be_reduced_has_the_rows_of_its_runs(self):
        models = ROOT / "tests/verification/models"
        self.write_study(
            f'command = "modes"\ndesigns = ["{models / "beam_inside.toml"}"]\n'
            'measures = ["program/modes/2/undamped_frequency"]\n[[parameters]]\nname = "modulus"\n'
            'key = "design.beam_inside.materials.steel.youngs_modulus"\nvalues = [1e11, -1.0]\n',
            run=models / "pinned_beam_run.toml",
        )
        for part, failed in (("1/2", 0), ("2/2", 1)):
            process = self.study("--part", part)
            self.assertIn(f"1 runs: 1 made, 0 kept from before, {failed} failed", process.stdout)

    def test_a_good_row_of_a_part_takes_the_place_of_a_failed_one(self):
        bad = Row("abc", 3, "no convergence", False, (), {}, 0.1)
        good = bad._replace(exit_code=0, error="", converged=True)
        for number, steps in enumerate((  # what the parts hold, each time they are collected; the row then
            [([[bad, good]], good)], [([[bad], [good]], good)], [([[good], [bad]], good)],
            [([[bad]], bad), ([[bad, good]], good)], [([[good]], good), ([[good, bad]], good)],
        )):  # fmt: skip
            study = self.folder / str(number)
            for parts, expected in steps:
                for part, rows in enumerate(parts, start=1):
                    path = study / "parts" / str(part) / "rows.jsonl"
                    path.parent.mkdir(parents=True, exist_ok=True)
                    path.write_text("", encoding="utf-8")
                    for row in rows:
                        keep_row(path, row)
                with self.subTest(number), KeptRows(study) as kept:
                    collect_rows(kept, study)
                    self.assertEqual(kept.rows, {"abc": expected})
                with KeptRows(study) as kept:  # from its file
                    self.assertEqual(kept.rows, {"abc": expected})

    def test_the_command_that_is_printed_is_one_for_a_shell(self):
        self.write_study(f'measures = ["program/steps"]\n{HEIGHT}values = [0.01, 0.02]')
        process = self.run_tool("study", "study.toml", "-o", "my study", "--workflow", "2")
        *_, line = process.stdout.splitlines()
        words = ["snakemake", "--directory", "my study", "--snakefile", "my study/Snakefile", "--cores", "all"]
        self.assertEqual(shlex.split(line), [*words, "--rerun-incomplete"])

    def test_a_study_has_no_more_parts_than_runs(self):
        self.write_study(f'measures = ["program/steps"]\n{HEIGHT}values = [0.01, 0.02]')
        process = self.study("--workflow", "9")
        self.assertIn("2 runs in 2 parts", process.stdout)
        self.assertIn("PARTS = 2\n", (self.folder / "out/Snakefile").read_text(encoding="utf-8"))

    def test_what_is_no_part_is_refused(self):
        self.write_study(f'measures = ["program/steps"]\n{HEIGHT}values = [0.01, 0.02]')
        for part in ("0/2", "3/2", "1", "one/2"):
            self.assert_refuses(self.study("--part", part), f"--part: error: got '{part}', expected K/N")
        self.assertEqual(self.study("--workflow", "0").returncode, 2)
        self.assertIn("keeps no results files", self.study("--part", "1/2", "--keep-results").stderr)


if __name__ == "__main__":
    unittest.main()
