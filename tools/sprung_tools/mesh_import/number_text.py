"""Numbers in the text of mesh files. Python's own int() and float() take digits with underscores and those of other
scripts, too, which no mesh file means."""


def parse_whole(text: str) -> int:
    """A whole number. ValueError if the text is none."""
    return int(check_digits(text))


def parse_real(text: str) -> float:
    """A number with an exponent as Fortran (1.0D0) or C writes it. ValueError if the text is none."""
    return float(check_digits(text).upper().replace("D", "E"))


def check_digits(text: str) -> str:
    """The text. ValueError if it has letters or digits that a number cannot have."""
    if not text.isascii() or "_" in text:
        raise ValueError(text)
    return text
