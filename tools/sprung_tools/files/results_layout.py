"""The layout of results files (dynamics/output/results.md) and of files of select-modes, as far as the tools read
them."""

from sprung_tools.files.layout import Layout, Numbers, Rule, Texts

SUPERELEMENTS, MODES, CHOICE = "model/superelements/*", "model/modes", "model/mode_choice"
RESOLVED = "model/resolved"
NUM_MODES = (f"{SUPERELEMENTS}/shapes", 2)  # of a superelement
OF_A_MODE = Numbers((f"{CHOICE}/mode_frequency",))

DATASETS: dict[str, Rule] = {
    "time": Numbers((None,)),
    "points/*/*": Numbers(("time", 2)),
    "bodies/*/position": Numbers(("time", 3)),
    "bodies/*/velocity": Numbers(("time", 3)),
    "bodies/*/acceleration": Numbers(("time", 3)),
    "bodies/*/center_of_mass/*": Numbers(("time", 2)),
    "bodies/*/modal/mode_number": Numbers((None,)),
    "bodies/*/modal/neglected": Numbers(("time", 3)),
    "bodies/*/modal/*": Numbers(("time", "bodies/*/modal/mode_number")),
    "joints/*/reaction": Numbers(("time", 3)),
    "joints/*/reaction_b": Numbers(("time", 3)),
    "joints/*/*": Numbers(("time",)),
    "forces/*/on_*": Numbers(("time", 3)),
    "forces/*/state": Numbers(("time", None)),
    "forces/*/*": Numbers(("time",)),
    "recovery/*/station": Numbers((None, 2)),
    "recovery/*/*": Numbers(("time", "recovery/*/station")),
    "energy/*": Numbers(("time",)),
    "events/time": Numbers((None,)),
    "events/*": Texts("events/time"),
    "warnings/concerns": Texts("warnings/text"),
    "warnings/of": Texts("warnings/text"),
    "warnings/text": Texts(),
    "last_state/*": Numbers((None,)),
    "model/run_text": Texts(1),
    "model/vehicle_text": Texts(1),
    "model/overrides": Texts(),
    f"{SUPERELEMENTS}/node_positions": Numbers((None, 2)),
    f"{SUPERELEMENTS}/elements": Numbers((None, 2), within=f"{SUPERELEMENTS}/node_positions"),
    f"{SUPERELEMENTS}/shapes": Numbers((f"{SUPERELEMENTS}/node_positions", 3, None)),
    f"{SUPERELEMENTS}/frequency": Numbers((NUM_MODES,)),
    f"{SUPERELEMENTS}/damping_ratio": Numbers((NUM_MODES,)),
    "model/road/distance": Numbers((None,)),
    "model/road/height": Numbers(("model/road/distance",)),
    "model/equilibrium/bodies/*": Numbers((3,)),
    "model/equilibrium/points/*": Numbers((2,)),
    "model/equilibrium/modal/*": Numbers(("bodies/*/modal/mode_number",)),
    f"{MODES}/participants": Texts(f"{MODES}/undamped_frequency"),
    f"{MODES}/coordinates": Texts(),
    f"{MODES}/shapes": Numbers((f"{MODES}/coordinates", f"{MODES}/undamped_frequency")),
    f"{MODES}/undamped_frequency": Numbers((None,)),
    f"{MODES}/damped_frequency": Numbers((f"{MODES}/undamped_frequency",)),
    f"{MODES}/damping_ratio": Numbers((f"{MODES}/undamped_frequency",)),
    f"{CHOICE}/mode_frequency": Numbers((None,)),
    f"{CHOICE}/kept": OF_A_MODE,
    f"{CHOICE}/mode_number": OF_A_MODE,
    f"{CHOICE}/share/*": OF_A_MODE,
    f"{CHOICE}/frequency": Numbers((None,)),
    f"{CHOICE}/road": Numbers((f"{CHOICE}/frequency",)),
    f"{CHOICE}/transfer/*": Numbers((f"{CHOICE}/frequency",)),
    f"{CHOICE}/remarks": Texts(),
    f"{RESOLVED}/gravity": Numbers((2,)),
    f"{RESOLVED}/settings/output_points": Texts(),
    f"{RESOLVED}/bodies/*/center_of_mass": Numbers((2,)),
    f"{RESOLVED}/points/*/position": Numbers((2,)),
    f"{RESOLVED}/points/*/shapes": Numbers((3, None)),
    f"{RESOLVED}/*/*/points": Texts(),
    f"{RESOLVED}/*/*/point_roles": Texts(f"{RESOLVED}/*/*/points"),
}
ELEMENT = {"kind": str, "drawing": str, "on_road": int}
RESULTS_LAYOUT = Layout(
    DATASETS,
    attributes={
        RESOLVED: {"direction": float},
        f"{RESOLVED}/settings": {
            "speed": float, "duration": float, "output_step": float, "statistics_from": float, "statistics_to": float,
            "start": str,
        },
        f"{RESOLVED}/settings/integrator": {"method": str, "relative_tolerance": float, "largest_step": float},
        f"{RESOLVED}/settings/adaptivity": {"enabled": int},
        f"{RESOLVED}/bodies/*": {"mass": float, "inertia": float},
        f"{RESOLVED}/points/*": {"body": str, "node": int},
        f"{RESOLVED}/joints/*": ELEMENT,
        f"{RESOLVED}/forces/*": ELEMENT,
        f"{RESOLVED}/road": {"shape": str, "file": str},
    },
    chosen=("points", "bodies", "joints", "forces", "wrenches", "recovery"),
)  # fmt: skip
