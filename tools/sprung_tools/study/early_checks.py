"""Mistakes that every run of a study would have, told at their place in the study file before the runs are made.

What fails for the first run may be a value that only this run has. So other runs are tried as well, from the first to
the last, and of a study in parts also those of other parts: it is a mistake of all where they fail for the same reason,
in the same words, or where a key is not known."""

import re
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Executor
from typing import TypeVar

from sprung_tools.files.errors import InputError
from sprung_tools.files.toml_text import cut_key, flatten_settings, split_key, strip_quotes
from sprung_tools.programs.calls import BAD_INPUT, Outcome, call, make_command
from sprung_tools.programs.finding import Programs
from sprung_tools.study.description import DESIGN, Study, fail_at_key
from sprung_tools.study.designs import Variant, reduce_variant
from sprung_tools.study.kept_rows import Row
from sprung_tools.study.measure_names import SLIP
from sprung_tools.study.one_run import ERROR, Setting, Task
from sprung_tools.study.plan import Draft

MOST_TRIED = 8
UNKNOWN = "unknown key"
Item = TypeVar("Item")


def choose_some(items: Sequence[Item]) -> list[Item]:
    """Some items, evenly spaced from the first to the last."""
    count = min(len(items), MOST_TRIED)
    return [items[number * (len(items) - 1) // max(count - 1, 1)] for number in range(count)]


def find_common(problems: Iterable[str]) -> str:
    """The problem that all have in the same words, or a key that is not known; empty if some have another or none."""
    common = ""
    for problem in problems:
        if problem.startswith(UNKNOWN):
            return problem
        if not problem or common not in ("", problem):
            return ""
        common = problem
    return common


def check_designs(
    study: Study, drafts: Sequence[Draft], others: Sequence[Draft], programs: Programs, pool: Executor
) -> None:  # fmt: skip
    """Reduces the designs of the first run. InputError where all runs need one that cannot be reduced. others: of runs
    that are not made here."""
    for name in study.designs:
        variants = [*choose_some(list_variants(drafts, name)), *list_variants(others, name)]
        tried = (pool.submit(reduce_variant, programs.reduce, one) for one in variants)
        problem = find_common(one.result().partition(ERROR)[2] for one in tried)
        if problem:
            raise fail_at_design(study, name, problem)


def list_variants(drafts: Iterable[Draft], name: str) -> list[Variant]:
    """The distinct variants of a design."""
    return list({one.folder: one for draft in drafts for one in draft.variants.values() if one.name == name}.values())


def fail_at_design(study: Study, name: str, what: str) -> InputError:
    """The error of a design, at the key of the study file that it names, else where the design stands."""
    words = {word.rpartition(".")[2] for word in re.findall(r"'([^']+)'", what)[:1]}
    keys = [key for parameter in study.parameters for key in parameter.keys]
    for key in (*keys, *flatten_settings(study.overrides)):
        if cut_key(key, DESIGN, name) and words & set(map(strip_quotes, split_key(key))):
            return fail_at_key(study, key, what)
    return study.file.fail(("designs",), f"{study.designs[name].name}: {what}", fragment=study.designs[name].name)


def check_first(study: Study, setting: Setting, tasks: Sequence[Task], others: Sequence[Task]) -> None:
    """Tries the first run that can be made, without making it. InputError for a key or value of --set that is wrong in
    all runs. others: runs that are not made here."""
    keys: dict[str, str] = {}  # by the problem

    def find_problems() -> Iterator[str]:
        tried = choose_some([task for task in tasks if not task.problem])
        for number, task in enumerate([*tried, *(task for task in others if not task.problem)]):
            outcome = try_run(setting, task, f"try_{number}")
            before, _, what = outcome.error.partition(ERROR)
            is_of_set = outcome.exit_code == BAD_INPUT and before.startswith("--set ")
            keys[what] = find_key(task, before) if is_of_set else ""
            yield what if is_of_set else ""

    problem = find_common(find_problems())
    if problem:
        raise fail_at_key(study, keys[problem], problem)


def try_run(setting: Setting, task: Task, name: str) -> Outcome:
    """Has the program read all input of a run."""
    folder = setting.scratch / name
    folder.mkdir()
    for file in task.superelements:
        (folder / file.name).symlink_to(file.resolve())
    return call([*make_command(setting.program, "run", setting.run, folder, task.overrides), "--dry-run"])


def find_key(task: Task, before: str) -> str:
    """The key that `--set N` sets; empty if there is none."""
    number = before.removeprefix("--set ")
    return task.overrides[int(number) - 1].partition("=")[0] if number.isdecimal() else ""


def check_measures(study: Study, row: Row) -> None:
    """InputError, at its place, for a measure that no run of the vehicle has. row: of the first run."""
    if row.error.startswith(SLIP):
        what = row.error.removeprefix(SLIP)
        raise study.file.fail(("measures",), what, fragment=what.split("'")[1])
