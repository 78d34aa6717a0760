"""Making the runs of a study on all processors, and keeping each row as its run ends."""

import shutil
from collections.abc import Collection, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from fnmatch import fnmatchcase
from pathlib import Path
from typing import NamedTuple

from sprung_tools.files.errors import InputError
from sprung_tools.programs.calls import INTERRUPTED
from sprung_tools.programs.finding import Programs
from sprung_tools.programs.process_pool import open_pool
from sprung_tools.study.description import Study
from sprung_tools.study.early_checks import check_designs, check_first, check_measures, choose_some
from sprung_tools.study.kept_rows import KeptRows, Row
from sprung_tools.study.one_run import Setting, Task, make_and_keep
from sprung_tools.study.machine_faults import is_of_machine
from sprung_tools.study.plan import Planner, reduce_variants
from sprung_tools.study.sampling import Point, make_points
from sprung_tools.study.workflow import Part, collect_rows
from sprung_tools.terminal.progress_bar import Progress

QUEUED = 4  # tasks that wait for each process
SCRATCH = "under_way"  # folder of what the runs under way write


class Finished(NamedTuple):
    """A study whose runs are made: its points, their tasks and rows; how many runs were made now, and how many rows
    were there before, and how many of these have failed. Of points that are the same one run is made."""

    study: Study
    points: list[Point]
    tasks: list[Task]
    rows: list[Row]
    made: int
    kept: int
    kept_failed: int = 0


class Options(NamedTuple):
    """How a study is made. folder: of the study, or of its part; retry: whether rows of failed runs are made again;
    part: of the study that is made, None: all of it; collect: whether the rows of its parts are taken over."""

    folder: Path
    jobs: int
    retry: bool = False
    keep_results: bool = False
    part: Part | None = None
    collect: bool = False

    def choose(self, points: list[Point]) -> list[Point]:
        """The points whose runs are made."""
        return points if self.part is None else self.part.choose(points)


def run_study(study: Study, programs: Programs, options: Options) -> Finished:
    """Makes the runs of a study whose rows are not in its folder. InputError for a fault of the study itself; a run
    that fails is a row."""
    points = options.choose(make_points(study))
    with KeptRows(options.folder) as kept, make_scratch(options.folder), open_pool(options.jobs) as pool:
        tasks, others = make_tasks(study, programs, options, points, pool)
        results = options.folder / "results" if options.keep_results else None
        setting = Setting(kept.path, programs.dynamics, study.command, study.run, tuple(study.measures),
                          options.folder / SCRATCH, results, study.has_one_vehicle, study.strength)  # fmt: skip
        if setting.results is not None:
            setting.results.mkdir(exist_ok=True)
        if options.collect:
            collect_rows(kept, options.folder)
        there = {task.hash: kept.rows[task.hash] for task in tasks if task.hash in kept.rows}
        again = {one for one, row in there.items() if options.retry and row.has_failed}
        missing = {
            task.hash: task for task in tasks
            if task.hash not in there or task.hash in again or not has_results(there[task.hash], setting)
        }  # fmt: skip
        if missing:
            check_first(study, setting, tasks, others)
            with Progress("runs", len(missing)) as progress:
                make_runs(study, list(missing.values()), setting, pool, options.jobs, kept, progress)
        rows = [kept.rows[task.hash] for task in tasks]
    before = [row for row in rows if row.hash not in missing]
    return Finished(study, points, tasks, rows, len(missing), len(before), sum(row.has_failed for row in before))


def make_tasks(
    study: Study, programs: Programs, options: Options, points: list[Point], pool: ProcessPoolExecutor
) -> tuple[list[Task], list[Task]]:
    """The tasks of all points, after stage one; of a part also some of the whole study, whose designs are not reduced,
    to try whether all runs fail."""
    planner = Planner(study, options.folder, programs)
    drafts = [planner.draft(point) for point in points]
    others = [] if options.part is None else [planner.draft(point) for point in choose_some(make_points(study))]
    check_designs(study, drafts, others, programs, pool)
    count = len({one.folder for draft in drafts for one in draft.variants.values()})
    with Progress("designs", count) as progress:
        failures = reduce_variants(programs, drafts, pool, progress.step)
    tasks, some = ([planner.finish(draft, failures) for draft in some] for some in (drafts, others))
    return tasks, some


def has_results(row: Row, setting: Setting) -> bool:
    """Whether the results file of a row is there, if it is wanted."""
    return setting.results is None or row.has_failed or (setting.results / f"{row.hash[:16]}.h5").is_file()


def make_runs(
    study: Study, tasks: list[Task], setting: Setting, pool: ProcessPoolExecutor, jobs: int, kept: KeptRows,
    progress: Progress,
) -> None:  # fmt: skip
    """Makes the runs: one, and if it shows no mistake that all would have, the others. An interrupted run leaves no
    row."""
    waiting: set[Future[Row]] = set()
    failures = 0
    has_good = is_tried = any(not row.has_failed for row in kept.rows.values())
    left = iter(tasks)
    try:
        while True:
            for task in left:
                waiting.add(pool.submit(make_and_keep, task, setting))
                if len(waiting) >= (QUEUED * jobs if is_tried else 1):
                    break
            if not waiting:
                return
            done, waiting = wait(waiting, return_when=FIRST_COMPLETED)
            for row in (one.result() for one in done):
                if row.exit_code == INTERRUPTED:
                    raise KeyboardInterrupt
                if is_of_machine(row.error):
                    what = f"a run could not be made; then the same command goes on ({row.error})"
                    raise InputError(f"{kept.path}: error: {what}")
                kept.rows[row.hash] = row
                check_measures(study, row)
                is_tried = True
                failures += row.has_failed
                if not (row.has_failed or has_good):
                    has_good = True
                    for name in find_missing(setting.measures, row.measures):
                        why = "".join(f" ({one})" for one in row.warnings if is_about(one, name))
                        what = f"the first run has no measure {name}{why}; the others are made all the same"
                        progress.report(f"warning: {what}")
                progress.step(note=f", {failures} failed" if failures else "")
    except BrokenProcessPool as error:
        what = "a process of the study was ended from outside; started again, the study goes on"
        raise InputError(f"{kept.path}: error: {what}") from error


def is_about(problem: str, measure: str) -> bool:
    """Whether a warning of a run says why the object of a measure cannot be computed."""
    return fnmatchcase(problem.partition(": ")[0], measure.rpartition("/")[0])


def find_missing(wanted: Iterable[str], there: Collection[str]) -> list[str]:
    """The names, and the patterns for names, of measures that are wanted and not there."""
    return [one for one in wanted if not any(fnmatchcase(name, one) for name in there)]


@contextmanager
def make_scratch(folder: Path) -> Iterator[None]:
    """An empty folder in the study's, for what the runs under way write."""
    scratch = folder / SCRATCH
    shutil.rmtree(scratch, ignore_errors=True)  # of a study that was killed
    scratch.mkdir()
    try:
        yield
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
