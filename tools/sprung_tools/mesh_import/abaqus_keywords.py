"""The keywords and parameters of Abaqus and CalculiX decks that are read, and their abbreviations.

Keywords, parameters and most of their values may be cut short, as long as what is left is the beginning of one alone.
Source: Abaqus 2016, Analysis User's Guide, "Input syntax rules"; Keywords Reference Guide; CalculiX 2.20,
User's Manual.
"""

from collections.abc import Iterable

LEAST = 3  # letters of a keyword that is abbreviated

# Keyword that is read → its parameters, those that stand in NOT_TAKEN included.
PARAMETERS: dict[str, tuple[str, ...]] = {
    "BEAM GENERAL SECTION": (
        "DENSITY", "DEPENDENCIES", "ELSET", "LUMPED", "MATERIAL", "OFFSET1", "OFFSET2", "ORIENTATION", "POISSON",
        "ROTARY INERTIA", "SECTION", "TAPER", "ZERO",
    ),
    "BEAM SECTION": (
        "ELSET", "LUMPED", "MATERIAL", "NODAL THICKNESS", "OFFSET1", "OFFSET2", "ORIENTATION", "POISSON",
        "ROTARY INERTIA", "SECTION", "TEMPERATURE",
    ),
    "DENSITY": ("DEPENDENCIES", "PORE FLUID"),
    "ELASTIC": ("COMPRESSION FACTOR", "DEPENDENCIES", "MODULI", "NO COMPRESSION", "NO TENSION", "TYPE"),
    "ELEMENT": ("DLOAD", "ELSET", "INPUT", "PARENT", "TYPE"),
    "ELGEN": ("ALL NODES", "ELSET"),
    "ELSET": ("ELSET", "GENERATE", "INPUT", "INSTANCE", "INTERNAL", "UNSORTED"),
    "INCLUDE": ("INPUT", "PASSWORD"),
    "INSTANCE": ("NAME", "PART"),
    "MASS": ("ALPHA", "COMPOSITE", "ELSET", "ORIENTATION", "TYPE"),
    "MATERIAL": ("NAME", "RTOL", "SRATE FACTOR", "STRAIN RATE REGULARIZATION"),
    "NFILL": ("BIAS", "NSET", "SINGULAR", "TWO STEP"),
    "NGEN": ("LINE", "NSET", "SYSTEM"),
    "NODE": ("INPUT", "NSET", "SYSTEM"),
    "NORMAL": ("TYPE",),
    "NSET": ("ELSET", "GENERATE", "INPUT", "INSTANCE", "INTERNAL", "NSET", "UNSORTED"),
    "PART": ("NAME",),
    "ROTARY INERTIA": ("ALPHA", "COMPOSITE", "ELSET", "ORIENTATION", "TYPE"),
    "SOLID SECTION": (
        "COMPOSITE", "CONTROLS", "ELSET", "LAYUP", "MATERIAL", "NODAL THICKNESS", "OFFSET", "ORDER", "ORIENTATION",
        "REF NODE", "STACK DIRECTION", "SYMMETRIC",
    ),
    "SYSTEM": (),
}  # fmt: skip
# Keyword → parameters that change the model and are told, but not taken.
NOT_TAKEN = {
    "BEAM GENERAL SECTION": ("LUMPED", "ORIENTATION", "ROTARY INERTIA", "ZERO"),
    "BEAM SECTION": ("LUMPED", "ORIENTATION", "ROTARY INERTIA"),
    "ELASTIC": ("COMPRESSION FACTOR", "MODULI", "NO COMPRESSION", "NO TENSION"),
    "MASS": ("ALPHA", "COMPOSITE"),
    "ROTARY INERTIA": ("ALPHA", "COMPOSITE"),
}
BARE = (  # keywords that are read without their parameters
    "ASSEMBLY", "ELCOPY", "END ASSEMBLY", "END INSTANCE", "END PART", "END STEP", "HEADING", "NCOPY", "NMAP", "STEP",
    "USER ELEMENT",
)  # fmt: skip
# Keywords that are not read, and begin as those that are. One that only goes on behind such a keyword, as ELEMENT
# OUTPUT does behind ELEMENT, is not meant by an abbreviation.
OTHERS = (
    "BEAM ADDED INERTIA", "BEAM FLUID INERTIA", "ELECTRICAL CONDUCTIVITY", "HEAT GENERATION", "HEAT TRANSFER",
    "HEATCAP", "INCIDENT WAVE", "INCREMENTATION OUTPUT", "NODAL THICKNESS", "PARAMETER", "SOLUBILITY",
    "SOLUTION TECHNIQUE", "SOLVER CONTROLS", "STEADY STATE DYNAMICS", "USER MATERIAL", "USER OUTPUT VARIABLES",
)  # fmt: skip


def make_plain(text: str) -> str:
    """A word in capitals and without blanks."""
    return "".join(text.upper().split())


def find_words(text: str, known: Iterable[str]) -> list[str]:
    """The known words that a text may stand for, whatever blanks it has: itself, or those that begin with it."""
    bare = make_plain(text)
    begun = [word for word in known if bare and make_plain(word).startswith(bare)]
    return [word for word in begun if make_plain(word) == bare] or begun


def find_keyword(text: str) -> str:
    """The keyword that a text stands for; the text in capitals and without blanks if it is none that is read.
    ValueError if it may stand for several, or is an abbreviation of less than LEAST letters."""
    found = find_words(text, (*PARAMETERS, *BARE, *OTHERS))
    bare = make_plain(text)
    if set(found) <= set(OTHERS):
        return bare
    if len(found) > 1 or (len(bare) < LEAST and make_plain(found[0]) != bare):
        raise ValueError(f"may stand for {' or '.join(found)}; write it out")
    return found[0]


def find_parameter(keyword: str, text: str) -> str:
    """The parameter of a keyword that a text stands for. ValueError if it is none that is known, or may be several."""
    if keyword not in PARAMETERS:
        return make_plain(text)
    known = PARAMETERS[keyword]
    found = find_words(text, known)
    if not found:
        raise ValueError(f"'{text}' is no parameter that is known, expected {', '.join(known) or 'none'}")
    if len(found) > 1:
        raise ValueError(f"'{text}' may stand for {' or '.join(found)}; write it out")
    return found[0]
