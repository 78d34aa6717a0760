"""A study in parts on Slurm itself: its controller and one node on this machine, with the profile of tools/README.md.
Skipped where slurmctld, slurmd, munge and sbatch are not installed: `tools/setup` does not install them, because Debian
starts their services then. The services of this test have sockets, ports, a key and folders of their own."""

import getpass
import os
import re
import shutil
import socket
import subprocess
import time
import unittest
from pathlib import Path

from study_case import DYNAMICS, HEIGHT, StudyCase
from tool_test_case import TOOLS, run_program

FOLDERS = os.pathsep.join((os.environ["PATH"], "/usr/sbin"))
NAMES = {"slurmctld": "slurmctld-wlm", "slurmd": "slurmd-wlm", "slurmstepd": "slurmstepd-wlm", "munged": "munged",
         "munge": "munge", "sbatch": "sbatch", "sinfo": "sinfo"}  # fmt: skip
PROGRAMS = {name: shutil.which(name, path=FOLDERS) or shutil.which(debian, path=FOLDERS)
            for name, debian in NAMES.items()}  # fmt: skip
PAUSE = 0.1  # s, between two questions to a service that starts
README = (TOOLS / "README.md").read_text(encoding="utf-8")


def find_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


@unittest.skipUnless(all(PROGRAMS.values()), "slurmctld, slurmd, munge and slurm-client are not installed")
class Slurm(StudyCase):
    def setUp(self):
        super().setUp()
        self.home = self.folder / "slurm"
        for name in ("munge", "state", "spool"):
            (self.home / name).mkdir(parents=True, mode=0o700)
        self.socket = self.home / "munge/socket"
        key = self.home / "munge/key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        self.environment = {**os.environ, "SLURM_CONF": str(self.write_settings()),
                            "XDG_CACHE_HOME": str(self.folder / "cache")}  # fmt: skip

    def write_settings(self):
        host, user = socket.gethostname().partition(".")[0], getpass.getuser()
        plugins = sorted((Path(PROGRAMS["slurmd"]).resolve().parents[1] / "lib").glob("*/slurm-wlm"))
        settings = {
            "ClusterName": "test", "SlurmctldHost": f"{host}(127.0.0.1)", "SlurmctldPort": find_port(),
            "SlurmdPort": find_port(), "SlurmUser": user, "SlurmdUser": user, "AuthType": "auth/munge",
            "AuthInfo": f"socket={self.socket}", "ProctrackType": "proctrack/pgid", "MpiDefault": "none",
            "StateSaveLocation": self.home / "state", "SlurmdSpoolDir": self.home / "spool",
            "SlurmctldPidFile": self.home / "slurmctld.pid", "SlurmdPidFile": self.home / "slurmd.pid",
            "SelectType": "select/cons_tres", "SelectTypeParameters": "CR_CPU", "SlurmdParameters": "config_overrides",
        }  # fmt: skip
        if plugins:
            settings["PluginDir"] = plugins[0]
        lines = [f"{key}={value}" for key, value in settings.items()]
        lines += [f"NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=4000 State=UNKNOWN",
                  f"PartitionName=all Nodes={host} Default=YES State=UP", ""]  # fmt: skip
        path = self.home / "slurm.conf"
        path.write_text("\n".join(lines), encoding="utf-8")
        return path

    def start(self, name, *arguments):
        """Starts a service, which ends with the test."""
        log = self.enterContext(open(self.home / f"{name}.log", "w", encoding="utf-8"))
        process = subprocess.Popen([PROGRAMS[name], *arguments], stdout=log, stderr=log, env=self.environment)
        self.addCleanup(process.wait)
        self.addCleanup(process.terminate)
        self.services[name] = process

    def wait_for(self, name, answer, *arguments):
        """Asks until the answer is there; fails if a service has ended."""
        while True:
            done = subprocess.run([PROGRAMS[name], *arguments], env=self.environment, capture_output=True, text=True,
                                  check=False)  # fmt: skip
            if done.returncode == 0 and answer in done.stdout:
                return
            for service, process in self.services.items():
                said = (self.home / f"{service}.log").read_text(encoding="utf-8", errors="replace")
                self.assertIsNone(process.poll(), f"{service} has ended: {said}")
            time.sleep(PAUSE)

    def test_the_profile_of_the_readme_makes_the_study(self):
        self.services = {}
        munge = self.home / "munge"
        self.start("munged", "--foreground", "--force", f"--socket={self.socket}", f"--key-file={munge / 'key'}",
                   f"--pid-file={munge / 'pid'}", f"--log-file={munge / 'log'}", f"--seed-file={munge / 'seed'}")
        self.wait_for("munge", "MUNGE:", "--no-input", "--socket", self.socket)
        self.start("slurmctld", "-D")
        self.start("slurmd", "-D", "-d", PROGRAMS["slurmstepd"])
        self.wait_for("sinfo", "idle", "--noheader", "--format=%T")
        (profile,) = re.findall(r"```yaml\n(# slurm/config.yaml\n.*?)```", README, re.DOTALL)
        (self.folder / "profile").mkdir()
        (self.folder / "profile/config.yaml").write_text(profile, encoding="utf-8")

        settings = 'measures = ["program/steps"]\nset.duration = 0.5\n'
        self.write_study(f"{settings}{HEIGHT}values = [0.01, 0.02, 0.03, 0.04]")
        self.assert_succeeds(self.study("--workflow", "2"))
        self.environment |= {"SPRUNG_DYNAMICS": DYNAMICS, "PATH": f"{Path(PROGRAMS['sbatch']).parent}:{FOLDERS}"}
        process = run_program(["/usr/bin/snakemake", "--directory", "out", "--snakefile", "out/Snakefile", "--profile",
                               self.folder / "profile"], cwd=self.folder, env=self.environment)  # fmt: skip
        self.assertEqual(process.returncode, 0, process.stderr)
        jobs = sorted((self.folder / "out/parts").glob("slurm-*.out"))
        self.assertEqual(len(jobs), 3)  # two parts and the table
        self.assert_succeeds(self.run_tool("study", "study.toml", "-o", "whole"))
        self.assertEqual(*((self.folder / name / "table.csv").read_bytes() for name in ("out", "whole")))


if __name__ == "__main__":
    unittest.main()
