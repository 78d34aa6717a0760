"""The error of bad input, which a command turns into a line on stderr and exit code 2."""


class InputError(Exception):
    """Bad input: a file that cannot be used, a quantity that it does not hold, or an argument out of range.

    The text is `path: error: …` or `--option: error: …`.
    """


class WrongFormatError(InputError):
    """A readable HDF5 file is of another format than the one wanted.

    found: the format that the file names, None if it names none.
    """

    def __init__(self, text: str, found: str | None) -> None:
        super().__init__(text)
        self.found = found
