"""Writing a file whole or not at all: under another name beside its place, then renamed."""

import os
from pathlib import Path

from sprung_tools.files.results_file import ResultsError


def write_whole(path, content):
    """Writes text (as UTF-8) or bytes. An interrupted or failed write leaves an earlier file as it was.

    ResultsError if the file cannot be written.
    """
    path = Path(path)
    data = content.encode("utf-8") if isinstance(content, str) else content
    unfinished = path.with_name(f".unfinished-{os.getpid()}-{path.name}") if path.name else path
    try:
        try:
            unfinished.write_bytes(data)
            os.replace(unfinished, path)
        except BaseException:
            if unfinished.is_file():
                unfinished.unlink()
            raise
    except OSError as error:
        raise ResultsError(f"{path}: error: cannot write the file ({error.strerror})") from error
