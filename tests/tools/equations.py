"""Equations and references of the READMEs, and where they are cited.

A README numbers its equations 1, 2, 3 … in reading order: a line of an indented block that ends with `  (N)`. Comments,
docstrings and other READMEs cite an equation as `(ROOM, eq. 3)` or `(ROOM, eqs. 3–5, 7; OTHER, eq. 1)` and a section as
`(ROOM, "Section")`, ROOM being the README's folder, counted from dynamics/ if it lies there: `system`, `fem`. A key
such as [Shabana 2013] stands in the list of references of the README itself or, for a source file, of the nearest
folder above that has a README; for a test, of any README.

A test that a comment or a README names, `tests/fem/beam_test.cpp`, is a file. In tests/README.md "a name" or `Name`
that stands before `in [a_test.py](…)` is in that file."""

import re
from pathlib import Path
from typing import NamedTuple

TOP_FOLDERS = ("dynamics", "fem", "meshes", "reduce", "tests", "tools")
SUFFIXES = (".cpp", ".h", ".md", ".py", ".toml")
INNER = "dynamics/"  # left out of the names of the rooms in it
THESE = ("tests/tools/equations.py", "tests/tools/equations_test.py")  # which show what is wrong

NUMBERED_LINE = re.compile(r"^ {4}.* {2}\(([^()]+)\)$")
HEADING = re.compile(r"^#+ (.+)$", re.MULTILINE)
COMMENT = re.compile(r"//[/!]?<?\s?(.*)$")
ROOM = r"[a-z_]+(?:/[a-z_]+)*"
NUMBERS = r"\d+(?:–\d+)?(?:, \d+(?:–\d+)?)*"
EQUATIONS = re.compile(rf"(?<=[(; ])({ROOM}), (eqs?)\. ({NUMBERS})(?=[);])")
ANY_CITATION = re.compile(r"\b[Ee]q(?:s?\.|uations?) \(?\d")
SECTION = re.compile(rf'(?<=[(; ])({ROOM}), "([^"]+)"(?=[);])')
OWN_NUMBERS = re.compile(r"(?<![\w)])\((\d{1,3}(?:(?:–|, )\d{1,3})*)\)")
KEY = r"[^\W\d_]{2}[^\[\];<>−]*? (?:\d{4}|\d+(?:\.\d+)?)"
KEYS = re.compile(rf"\[({KEY}(?:, [^\[\];]*)?(?:; {KEY}(?:, [^\[\];]*)?)*)\](?!\()")
REFERENCE = re.compile(rf"^- \[({KEY})\]", re.MULTILINE)

TEST = re.compile(r"(?<=hecked by )tests/[\w/.]*\w|\btests/[a-z\d_/]+_test\.(?:cpp|py)\b")
TESTS = "tests/README.md"
NAME, LINK = r'"[^"]+"|`[^`]+`', r"\[[^\]]+\]\([^)]+\)"
QUOTED = re.compile(rf"((?:(?:{NAME})(?:, | and )?)+) in ((?:{LINK}(?:, | and )?)+)")


class Readme(NamedTuple):
    """A README: its file from the root, the numbers of its equations as they stand, its headings and references."""

    file: str
    numbers: tuple
    headings: frozenset
    references: tuple


class Prose(NamedTuple):
    """Running text of a file without line breaks and comment signs, and the line that each place of it stands in."""

    text: str
    starts: tuple  # (place in the text, line number), ascending

    def line(self, place):
        return next(line for start, line in reversed(self.starts) if start <= place)


def find_files(root):
    """All files that may cite, from the root, ascending."""
    root = Path(root)
    files = [*root.glob("*.md")]
    for folder in TOP_FOLDERS:
        files += [path for path in (root / folder).rglob("*") if path.suffix in SUFFIXES]
    return sorted({path.relative_to(root).as_posix() for path in files}.difference(THESE))


def read_readmes(root):
    """All READMEs by the name of their room."""
    readmes = {}
    for file in find_files(root):
        if not file.endswith("/README.md"):
            continue
        text = (Path(root) / file).read_text(encoding="utf-8")
        numbers = tuple(match[1] for match in map(NUMBERED_LINE.match, text.splitlines()) if match)
        folder = file.removesuffix("/README.md")
        readmes[folder.removeprefix(INNER)] = Readme(
            file, numbers, frozenset(HEADING.findall(text)), tuple(REFERENCE.findall(text))
        )
    return readmes


def read_prose(root, file):
    """The running text of a file: of C++ its comments, else all but indented blocks of Markdown."""
    pieces, starts, place = [], [], 0
    for number, line in enumerate((Path(root) / file).read_text(encoding="utf-8").splitlines(), start=1):
        piece = _strip(line, Path(file).suffix)
        starts.append((place, number))
        pieces.append(piece)
        place += len(piece) + 1
    return Prose(" ".join(pieces), tuple(starts))


def _strip(line, suffix):
    if suffix in (".cpp", ".h"):
        match = COMMENT.search(line)
        return match[1].strip() if match else "\0"
    if suffix == ".md" and line.startswith("    "):
        return "\0"
    return line.strip().removeprefix("#").strip() if suffix in (".py", ".toml") else line.strip()


def find_mistakes(root):
    """Every wrong number, citation and key, as `file:line: error: …`."""
    readmes = read_readmes(root)
    mistakes = []
    for readme in readmes.values():
        mistakes += _find_wrong_numbers(readme)
    cited = {readme.file: set() for readme in readmes.values()}  # keys
    for file in find_files(root):
        prose = read_prose(root, file)
        mistakes += _find_wrong_citations(file, prose, readmes)
        home = _find_home(file, readmes)
        if home is not None and home.file == file:
            mistakes += _find_wrong_own_numbers(file, prose, home)
        mistakes += _find_missing_tests(root, file, prose)
        lists = list(readmes.values()) if file.startswith("tests/") else [home] if home else []
        mistakes += _find_unknown_keys(file, prose, lists, cited)
    for readme in readmes.values():
        for key in readme.references:
            if key not in cited[readme.file]:
                mistakes.append(f"{readme.file}:1: error: nothing cites [{key}]")
    return mistakes


def _find_home(file, readmes):
    by_folder = {readme.file.removesuffix("/README.md"): readme for readme in readmes.values()}
    for parent in Path(file).parents:
        if parent.as_posix() in by_folder:
            return by_folder[parent.as_posix()]
    return None


def _find_wrong_numbers(readme):
    for expected, number in enumerate(readme.numbers, start=1):
        if number != str(expected):
            hint = "new equations go to the end, or those behind them get new numbers"
            yield f"{readme.file}:1: error: equation ({number}) stands where ({expected}) should; {hint}"
            return


def _find_wrong_citations(file, prose, readmes):
    good = set()
    for match in EQUATIONS.finditer(prose.text):
        where = f"{file}:{prose.line(match.start())}: error: "
        room, word, numbers = match.groups()
        good.add(match.start(2))
        if room not in readmes:
            yield f"{where}no room '{room}' has a README"
            continue
        count = len(readmes[room].numbers)
        for number in map(int, re.findall(r"\d+", numbers)):
            if not 1 <= number <= count:
                yield f"{where}{readmes[room].file} has {count} equations, none of number {number}"
        if (word == "eq") != numbers.isdigit():
            yield f"{where}'{word}. {numbers}': eq. is for one, eqs. for several"
    for match in ANY_CITATION.finditer(prose.text):
        if match.start() not in good:
            around = prose.text[max(0, match.start() - 20) : match.end() + 20]
            yield f"{file}:{prose.line(match.start())}: error: not of the form (ROOM, eq. N): '{around}'"
    if Path(file).suffix == ".py":
        return  # pairs of a name and a text look like citations of sections
    for match in SECTION.finditer(prose.text):
        room, section = match.groups()
        if room not in readmes or section not in readmes[room].headings:
            yield f"{file}:{prose.line(match.start())}: error: room '{room}' has no section '{section}'"


def _find_missing_tests(root, file, prose):
    for match in TEST.finditer(prose.text):
        if not (Path(root) / match[0]).is_file():
            yield f"{file}:{prose.line(match.start())}: error: there is no {match[0]}"
    for match in QUOTED.finditer(prose.text) if file == TESTS else ():
        tests = [Path(root) / "tests" / name for name in re.findall(r"\]\(([^)]+)\)", match[2])]
        text = "".join(test.read_text(encoding="utf-8") for test in tests if test.is_file())
        for name in re.findall(r'["`]([^"`]+)["`]', match[1]):
            if name not in text:
                yield f"{file}:{prose.line(match.start())}: error: '{name}' is not in {match[2]}"


def _find_wrong_own_numbers(file, prose, readme):
    if not readme.numbers:
        return
    for match in OWN_NUMBERS.finditer(prose.text):
        for number in map(int, re.findall(r"\d+", match[1])):
            if not 1 <= number <= len(readme.numbers):
                yield f"{file}:{prose.line(match.start())}: error: there is no equation ({number})"


def _find_unknown_keys(file, prose, lists, cited):
    if Path(file).suffix == ".py":
        return  # lists look like keys
    for match in KEYS.finditer(prose.text):
        if prose.text[max(0, match.start() - 2) : match.start()] == "- ":
            continue  # the list of references itself
        for part in match[1].split("; "):
            key = re.match(KEY, part)[0]
            having = [readme.file for readme in lists if key in readme.references]
            for readme in having:
                cited[readme].add(key)
            if not having:
                where = lists[0].file if len(lists) == 1 else "any README"
                yield f"{file}:{prose.line(match.start())}: error: [{key}] is not among the references of {where}"
