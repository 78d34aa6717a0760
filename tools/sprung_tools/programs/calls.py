"""Starting a program and taking what it says."""

import ctypes
import os
import re
import signal
import subprocess
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from sprung_tools.files.errors import InputError
from sprung_tools.files.toml_text import format_value

GOOD, CHECK_FAILED, BAD_INPUT, NO_CONVERGENCE, INTERRUPTED = 0, 1, 2, 3, 130  # exit codes (dynamics/README.md)
PR_SET_PDEATHSIG = 1
_libc = ctypes.CDLL(None)


class Outcome(NamedTuple):
    """How a program ended. exit_code: less than zero is minus the signal that ended it."""

    exit_code: int
    printed: str
    complaints: str  # on stderr

    @property
    def error(self) -> str:
        """Why it failed, in the program's words; empty if it did not."""
        if self.exit_code == GOOD:
            return ""
        if self.exit_code < 0:
            return f"ended by {signal.Signals(-self.exit_code).name}"
        lines = [line for line in self.complaints.splitlines() if line.strip() and not line.startswith("warning: ")]
        if self.exit_code == CHECK_FAILED and not lines:
            lines = self.complaints.splitlines() or ["a check failed: do not trust the results"]
        return "\n".join(lines) or f"exit code {self.exit_code}"


def end_with_parent() -> None:
    """Has the system end this process when its parent ends, however that happens."""
    _libc.prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def list_words(command: Sequence[str | Path]) -> list[str]:
    """The words of a command line. InputError for one with a NUL character, at which a program would cut it off."""
    words = [os.fspath(word) for word in command]
    for word in words:
        if "\0" in word:
            raise InputError(f"{word!r}: error: holds a NUL character, expected a path or a key without one")
    return words


def call(command: Sequence[str | Path], *, is_tied: bool = False) -> Outcome:
    """Runs a program to its end. is_tied: it ends with this process, which must have one thread only."""
    words = list_words(command)
    try:
        done = subprocess.run(
            words, stdin=subprocess.DEVNULL, capture_output=True, encoding="utf-8", errors="replace",
            preexec_fn=end_with_parent if is_tied else None, check=False,
        )  # fmt: skip
    except OSError as error:
        raise InputError(f"{words[0]}: error: cannot be started ({error.strerror})") from error
    return Outcome(done.returncode, done.stdout, done.stderr)


def format_overrides(values: Mapping[str, Any]) -> list[str]:
    """Keys and values as `--set` takes them: {"road.height": 0.1} → ["road.height=0.1"]. InputError, with the key, for
    a value that TOML does not hold."""
    settings = []
    for key, value in values.items():
        try:
            settings.append(f"{key}={format_value(value)}")
        except InputError as error:
            raise InputError(f"{key}: {error}") from error
    return settings


def name_override(error: str, overrides: Sequence[str]) -> str:
    """An error of sprung-dynamics with a setting itself in place of its number on a command line that the user has not
    written: `--set 5: error: …` → `speed=x: error: …`."""
    found = re.match(r"--set (\d+)(?=:)", error)
    if not found or int(found[1]) > len(overrides):
        return error
    return overrides[int(found[1]) - 1] + error[found.end() :]


def as_path(path: str | Path) -> str | Path:
    """A path that no program takes for an option."""
    return os.path.join(".", path) if str(path).startswith("-") else path


def make_command(
    program: Path, verb: str, run: Path, superelements: Path | None = None, overrides: Iterable[str] = (),
    output: Path | None = None,
) -> list[str | Path]:  # fmt: skip
    """The command line of sprung-dynamics, which prints JSON."""
    command: list[str | Path] = [program, verb, as_path(run), "--json", "--quiet"]
    if superelements is not None:
        command += ["--superelements", as_path(superelements)]
    if output is not None:
        command += ["-o", as_path(output)]
    return command + [word for override in overrides for word in ("--set", override)]
