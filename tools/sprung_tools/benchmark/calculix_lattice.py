"""A square lattice of bars as a deck of CalculiX, which expands each bar into a solid element."""

SIDE = 0.0206  # m, of a solid square with nearly the area of the box of the lattices


def make_deck(cells: int, spacing: float, middle: int, num_modes: int) -> str:
    """The lowest modes of the lattice in its plane, held at the node `middle` (from 1). The nodes' numbers go along the
    rows."""
    row = cells + 1
    nodes = row * row
    bars = [(n, n + 1) for n in range(1, nodes + 1) if n % row] + [(n, n + row) for n in range(1, nodes - row + 1)]
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{n}, {(n - 1) % row * spacing}, {(n - 1) // row * spacing}, 0" for n in range(1, nodes + 1)]
    lines += ["*ELEMENT, TYPE=B31, ELSET=BARS"]
    lines += [f"{number}, {first}, {second}" for number, (first, second) in enumerate(bars, 1)]
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "2.1e11, 0.3", "*DENSITY", "7850.0"]
    lines += ["*BEAM SECTION, ELSET=BARS, MATERIAL=STEEL, SECTION=RECT", f"{SIDE}, {SIDE}", "0., 0., 1."]
    lines += ["*BOUNDARY", "ALL, 3, 5", f"{middle}, 1, 2", f"{middle}, 6, 6"]
    return "\n".join([*lines, "*STEP", "*FREQUENCY", str(num_modes), "*END STEP", ""])
