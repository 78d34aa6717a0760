"""The runs of the report's section on the certified chassis, whose vectors are chosen by what the loads need."""

from pathlib import Path

from sprung_tools.files.project import ROOT
from sprung_tools.files.whole_file import write_whole
from sprung_tools.paper_report.paper_runs import ADAMS, LINKS, NOT_WATCHED, ROADS, UNDAMPED, PaperRun

CERTIFIED_DESIGN = "meshes/truck/chassis_certified.toml"
BAND = "highest_frequency = 60.0"  # of that design
CERTIFIED = ("vehicle.bodies.chassis.superelement=chassis_certified", 'modes.chassis="certified"')
# The same frame with all its free modes: the truth for the certified one, whose damping it has.
FREE = ("vehicle.bodies.chassis.superelement=chassis_free",)
ADAPTIVE = ("modes.chassis=2", "adaptivity.enabled=true")
CHOSEN = ('modes.chassis="auto"',)
METHODS = {"exponential": ((), ""), "Adams": (ADAMS, "_adams")}  # what --set changes, suffix of the runs' names
MODELS = {
    "free_all": FREE + ('modes.chassis="all"',),
    "free_12": FREE + ("modes.chassis=12",),
    "free_auto": FREE + CHOSEN,
    "free_adaptive": FREE + ADAPTIVE,
    "certified": CERTIFIED,
    "certified_auto": CERTIFIED[:1] + CHOSEN,
    "certified_adaptive": CERTIFIED[:1] + ADAPTIVE,
}
TRUTH = "free_all"
FREE_RATIO = 0.0156  # of the first free mode, where each clamped mode has 1 % (sprung-reduce info chassis.h5)


def write_free_design(folder: Path) -> Path:
    """Writes the design of the chassis with all its free modes into a folder. Returns its path."""
    text = (ROOT / CERTIFIED_DESIGN).read_text(encoding="utf-8")
    if text.count(BAND) != 1:
        raise ValueError(f"{CERTIFIED_DESIGN} has no single '{BAND}'")
    path = folder / "chassis_free.toml"
    write_whole(path, text.replace(BAND, "highest_frequency = 1e5"))
    return path


def list_certified_runs() -> list[PaperRun]:
    """All runs of this section: the paper's cases with the certified chassis, and what choosing and changing vectors
    saves."""
    runs = [
        PaperRun("bump_certified_undamped", "bump.toml", CERTIFIED + UNDAMPED, is_coarse_elsewhere=True),
        PaperRun("terrain_certified_damped", "terrain.toml", CERTIFIED + (f"modal_damping.chassis={FREE_RATIO:g}",)),
        PaperRun("terrain_certified_links", "terrain.toml", CERTIFIED + LINKS),
    ]
    return runs + [
        PaperRun(f"{road}_{model}{suffix}", f"{road}.toml", overrides + method, is_coarse_elsewhere=bool(suffix))
        for road in ROADS
        for method, suffix in METHODS.values()
        for model, overrides in MODELS.items()
        if road == "bump" or not suffix  # over the terrain Adams' method takes long
    ]


def list_timed_certified_runs() -> list[PaperRun]:
    """The timed runs, fixed sets without the indicator of what is left out."""
    names = {f"{road}_{model}{suffix}" for road in ROADS for model in MODELS for _, suffix in METHODS.values()}
    return [
        run if "adaptive" in run.name else run._replace(overrides=run.overrides + NOT_WATCHED)
        for run in list_certified_runs()
        if run.name in names
    ]
