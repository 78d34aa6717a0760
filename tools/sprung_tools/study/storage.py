"""What the runs of a study need not store: the histories that none of its measures is taken from."""

from collections.abc import Iterable, Sequence

# The first part of a measure's name, or of a quantity after `histories/` → the groups of [output.store] that it needs
# besides the motion of bodies, which that of all points follows from, and the channels of forces.
NEEDED = {
    "loads": ("recovery",), "stresses": ("recovery",), "fatigue": ("recovery",), "recovery": ("recovery",),
    "joints": ("joints",),
    "forces": ("wrenches",),
}  # fmt: skip
SPARED = ("recovery", "joints", "wrenches")
CHOICE = "output."  # what the keys of [output] begin with


def choose_storage(measures: Iterable[str], overrides: Sequence[str]) -> list[str]:
    """The overrides with which a run stores no more than its measures need; none where the study itself chooses, or
    where a pattern stands for the kind of a measure."""
    if any(override.startswith(CHOICE) for override in overrides):
        return []
    needed: set[str] = set()
    for name in measures:
        first = name.removeprefix("histories/").partition("/")[0]
        if "*" in first:
            return []
        needed.update(NEEDED.get(first, ()))
    return ["output.store.points=reported", *(f"output.store.{one}=none" for one in SPARED if one not in needed)]
