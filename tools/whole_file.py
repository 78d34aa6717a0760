"""Writing a file whole or not at all: to another name beside it, which becomes its own when all is written."""

import contextlib
import os

from results_file import ResultsError


@contextlib.contextmanager
def whole_file(path, what):
    """with whole_file("a.csv", "table") as unfinished: … write to the path `unfinished` …

    ResultsError, naming `what`, if it cannot be written (OSError, or ValueError of whoever writes). Whatever stops the
    writing, interruption as well, an earlier file stays as it was and nothing half-written is left.
    """
    folder, name = os.path.split(path)
    unfinished = os.path.join(folder, f".unfinished-{os.getpid()}-{name}")
    try:
        yield unfinished
        os.replace(unfinished, path)
    except (OSError, ValueError) as error:
        raise ResultsError(f"{path}: error: cannot write the {what} ({error})") from error
    finally:
        with contextlib.suppress(OSError):
            os.remove(unfinished)
