"""Processes that make many runs, each by a kept process of its own (kept_process.py). None outlives this one."""

import multiprocessing
import os
import signal
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from types import FrameType
from typing import NoReturn

from sprung_tools.programs.calls import end_with_parent


def count_processors() -> int:
    """The processors that this process may use."""
    return len(os.sched_getaffinity(0))


@contextmanager
def open_pool(jobs: int) -> Iterator[ProcessPoolExecutor]:
    """A pool of processes that end, with the programs they run, when this process ends or the block is left by an
    error."""
    pool = ProcessPoolExecutor(jobs, multiprocessing.get_context("fork"), prepare_process)
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:  # else it is ignored, as under nohup
        signal.signal(signal.SIGINT, interrupt_once)
    try:
        yield pool
    except BaseException:
        for child in multiprocessing.active_children():
            child.kill()
        raise
    finally:
        pool.shutdown(cancel_futures=True)


def interrupt_once(_signal: int, _frame: FrameType | None) -> NoReturn:
    """Interrupts this process, which ignores further interruptions: one that came while it ends its processes would
    leave them at work."""
    signal.signal(signal.SIGINT, lambda *_: None)
    raise KeyboardInterrupt


def prepare_process() -> None:
    """In each process of the pool: an interruption is the business of the parent, which ends this process."""
    end_with_parent()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
