"""Running a command in a child process, so that a library that ends it by a signal leaves a message.

HDF5 trusts the structure of a file, and a damaged one may end the process with a segmentation fault or an abort.
"""

import ctypes
import os
import signal
import sys
from collections.abc import Callable
from typing import NoReturn

from sprung_tools.files.last_read import last_file
from sprung_tools.terminal.program import complain

FORWARDED = {signal.SIGINT, signal.SIGTERM, signal.SIGHUP}
FAULTS = {signal.SIGSEGV, signal.SIGABRT, signal.SIGBUS, signal.SIGFPE, signal.SIGILL}
SENT_BY_A_PROCESS = 0  # SI_USER; a signal of the terminal reaches the child by itself
PR_SET_PDEATHSIG = 1


def run_guarded(run: Callable[[], NoReturn]) -> NoReturn:
    """Runs a function that exits, in a child process; exits with its code. If a library ends the child by a fault, it
    prints a line with the file that was being read, and exits with code 2."""
    previous = signal.pthread_sigmask(signal.SIG_BLOCK, {*FORWARDED, signal.SIGCHLD})
    child = os.fork()
    if child == 0:
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)  # it does not outlive its parent
        signal.pthread_sigmask(signal.SIG_SETMASK, previous)
        run()
    code = wait_for(child)
    if code >= 0:
        sys.exit(code)
    fault = signal.Signals(-code)
    if fault in FAULTS and last_file():
        complain(f"{last_file()}: error: the file is damaged: HDF5 ended with {fault.name}")
        sys.exit(2)
    signal.signal(fault, signal.SIG_DFL)  # ends as the child did
    signal.pthread_sigmask(signal.SIG_SETMASK, previous)
    os.kill(os.getpid(), fault)
    sys.exit(128 + fault)


def wait_for(child: int) -> int:
    """Waits until a child ends, and passes on the signals that other processes send. Returns its exit code; less than
    zero: minus the signal that ended it."""
    while True:
        found = signal.sigwaitinfo({*FORWARDED, signal.SIGCHLD})
        if found.si_signo == signal.SIGCHLD:
            ended, status = os.waitpid(child, os.WNOHANG)
            if ended:
                return os.waitstatus_to_exitcode(status)
        elif found.si_code == SENT_BY_A_PROCESS:
            os.kill(child, found.si_signo)
