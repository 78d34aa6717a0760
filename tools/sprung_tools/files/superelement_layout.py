"""The layouts of superelement files (reduce/superelement/superelement.md) and of response files
(dynamics/output/response.md), as far as the tools read them."""

from sprung_tools.files.layout import Layout, Numbers, Texts

MODES = "modes/frequency"
SUPERELEMENT_LAYOUT = Layout({
    "nodes/position": Numbers((None, 2)),
    "points/node": Numbers((None,), within="nodes/position"),
    "elements/node": Numbers((None, 2), within="nodes/position"),
    "elements/section": Texts("elements/node"),
    MODES: Numbers((None,)),
    "modes/kind": Texts(MODES),
    "modes/shape": Numbers(("nodes/position", 3, MODES)),
    "matrices/stiffness": Numbers((MODES, MODES)),
    "resultants": Numbers(("elements/node", 6, MODES)),
    "inertia/mass": Numbers((1,)),
    "inertia/P": Numbers((2, MODES)),
    "inertia/c": Numbers((MODES,)),
    "inertia/d": Numbers((MODES,)),
    "section_loads/point_load": Numbers(("elements/node", 6, None)),
    "section_loads/acceleration": Numbers(("elements/node", 6, 4)),
    "checks/name": Texts(),
    "checks/value": Numbers(("checks/name",)),
    "checks/tolerance": Numbers(("checks/name",)),
})  # fmt: skip
RESPONSE_LAYOUT = Layout({
    "frequency": Numbers((None,)),
    "outputs/**/response": Numbers(("frequency", 2)),
    "outputs/**/spectrum": Numbers(("frequency",)),
    "warnings/concerns": Texts("warnings/text"),
    "warnings/of": Texts("warnings/text"),
    "warnings/text": Texts(),
    "remarks": Texts(),
})  # fmt: skip
