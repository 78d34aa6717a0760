"""A steel cantilever of 2 m: two flat bars, clamped at their foot."""

DESIGN = """
[materials.steel]
youngs_modulus = 2.1e11
density = 7850.0
[sections.bar]
material = "steel"
shape = "rectangle"
width = 0.05
height = 0.12
count = 2
[points]
foot = [0.0, 0.0]
tip = [2.0, 0.0]
[[lines]]
through = ["foot", "tip"]
section = "bar"
elements = 4
[reference]
point = "foot"
[modes]
all = true
damping_ratio = 0.02
"""
VEHICLE = """
name = "cantilever"
[bodies.beam]
superelement = "beam"
position = [0.0, 0.0]
[[joints]]
name = "wall"
type = "fixed"
a = "ground.origin"
b = "beam.foot"
"""
