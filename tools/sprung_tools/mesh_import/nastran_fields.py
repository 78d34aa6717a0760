"""The fields of Nastran cards that are not taken, so that each filled one is told.

Sources: MSC Nastran, Quick Reference Guide, "Bulk Data Entries"; NASTRAN User's Manual (NASA SP-222), section 2.4.
"""

from collections.abc import Collection, Iterator

from sprung_tools.mesh_import.nastran_cards import Card

CONSTRAINTS = {6: "constraints (PS)", 7: "superelements (SEID)"}
TORSION = "torsion constants (J)"

# Card → places of its fields that are taken, or told of elsewhere; 0 is the first field after the name.
TAKEN: dict[str, Collection[int]] = {
    "GRID": range(6), "GRDSET": (1, 5),
    "BAROR": (1, *range(4, 8)), "BEAMOR": (1, *range(4, 8)),
    "CBAR": range(16), "CBEAM": range(16), "CROD": range(4), "CTUBE": range(4), "CONROD": (*range(5), 7),
    "PBAR": (*range(5), 6, *range(16, 19)), "PROD": (0, 1, 2, 5), "PTUBE": range(6),
    "MAT1": range(5),
    "CONM2": (*range(7), *range(8, 14)),
    "CORD1R": range(8), "CORD1C": range(8), "CORD1S": range(8),
    "CORD2R": range(11), "CORD2C": range(11), "CORD2S": range(11),
}  # fmt: skip

# Card → place → what stands there.
MEANINGS: dict[str, dict[int, str]] = {
    "GRID": CONSTRAINTS,
    "GRDSET": CONSTRAINTS,
    "CBEAM": {16: "warping nodes (SA, SB)", 17: "warping nodes (SA, SB)"},
    "CONROD": {5: TORSION, 6: "stress coefficients (C)"},
    "PROD": {3: TORSION, 4: "stress coefficients (C)"},
    "PBAR": {5: TORSION, **dict.fromkeys(range(8, 16), "stress points (C1 to F2)")},
    "MAT1": {
        **dict.fromkeys((5, 6), "thermal expansion (A, TREF)"), 7: "damping (GE)",
        **dict.fromkeys((8, 9, 10), "stress limits (ST, SC, SS)"), 11: "coordinate systems (MCSID)",
    },
}  # fmt: skip


def find_not_taken(card: Card) -> Iterator[str]:
    """Yields what stands in each filled field of a card that is not taken. Cards that are not in TAKEN give none."""
    if card.name not in TAKEN:
        return
    for place in range(len(card.fields)):
        if place not in TAKEN[card.name] and card.is_filled(place):
            unknown = f"field {place % 8 + 2} of line {place // 8 + 1}, whose meaning is not known,"
            yield MEANINGS.get(card.name, {}).get(place, unknown)
