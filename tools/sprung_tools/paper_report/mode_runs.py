"""The runs of the report's section on modes that are chosen from the forcing, or join and leave during the run."""

from sprung_tools.paper_report.paper_runs import ADAMS, NOT_WATCHED, ROADS, PaperRun, chassis_modes, name_modes

TOLERANCES = (0.01, 0.1)  # of the choice; the first is the program's default
RECALLS = (0.32, 0.16, 0.08, 0.04, 0.02, 0.01, 0.005)  # thresholds, among them the program's default
DROP_OF_RECALL = 0.025  # as for the program's defaults
FIXED_COUNTS = (2, 6, 12, 36)  # of chassis modes, with which adaptive runs over the bump are compared
ALL = 36
FEW = 6  # modes that are available where few are
CHOSEN = ('modes.chassis="auto"',)
ADAPTIVE = chassis_modes(2) + ("adaptivity.enabled=true",)
OF_FEW = (f"adaptivity.available.chassis={FEW}",)
METHODS = {"exponential": ((), ""), "Adams": (ADAMS, "_adams")}  # what --set changes, suffix of the runs' names


def name_chosen(road: str, tolerance: float) -> str:
    return f"{road}_auto" if tolerance == TOLERANCES[0] else f"{road}_auto_{100.0 * tolerance:g}"


def name_recall(recall: float) -> str:
    return f"bump_recall_{100.0 * recall:g}"


def list_chosen_runs() -> list[PaperRun]:
    """Runs whose modes are chosen before the run, by the program's default tolerance and by a looser one."""
    return [
        PaperRun(name_chosen(road, one), f"{road}.toml", CHOSEN + (f"mode_choice.tolerance={one:g}",))
        for road in ROADS
        for one in TOLERANCES
    ]


def list_adaptive_runs() -> list[PaperRun]:
    """Adaptive runs over both roads; over the bump also with few modes available, and by each method."""
    runs = [PaperRun("terrain_adaptive", "terrain.toml", ADAPTIVE)]
    for change, suffix in METHODS.values():
        runs += [
            PaperRun(f"bump_adaptive{suffix}", "bump.toml", ADAPTIVE + change),
            PaperRun(f"bump_adaptive_of_{FEW}{suffix}", "bump.toml", ADAPTIVE + OF_FEW + change),
        ]
    return runs


def list_recall_runs() -> list[PaperRun]:
    """Adaptive runs over the bump with looser and tighter thresholds, in proportion."""
    return [
        PaperRun(
            name_recall(one), "bump.toml",
            ADAPTIVE + (f"adaptivity.recall={one:g}", f"adaptivity.drop={DROP_OF_RECALL * one:g}"),
        )
        for one in RECALLS
    ]  # fmt: skip


def list_fixed_runs() -> list[PaperRun]:
    """Fixed sets over the bump by Adams' method, without those of paper_runs.list_adams_runs()."""
    return [
        PaperRun(f"bump_{name_modes(n)}_adams", "bump.toml", chassis_modes(n) + ADAMS) for n in FIXED_COUNTS if n > 4
    ]


def list_mode_runs() -> list[PaperRun]:
    """All runs of this section."""
    return [*list_chosen_runs(), *list_adaptive_runs(), *list_recall_runs(), *list_fixed_runs()]


def name_watched(name: str) -> str:
    """The name of a timed run of a fixed set with the indicator of the modes left out."""
    return f"{name}_watched"


def list_timed_mode_runs() -> list[PaperRun]:
    """The timed runs: fixed sets without the indicator, all modes also with it, and modes chosen and changing."""
    runs = [one for one in list_chosen_runs() if one.name in ("bump_auto", "terrain_auto")]
    runs = [one._replace(overrides=one.overrides + NOT_WATCHED) for one in runs] + list_adaptive_runs()
    cases = [("bump", n, *method) for method in METHODS.values() for n in FIXED_COUNTS] + [("terrain", ALL, (), "")]
    for road, count, change, suffix in cases:
        run = PaperRun(f"{road}_{name_modes(count)}{suffix}", f"{road}.toml", chassis_modes(count) + change)
        runs.append(run._replace(overrides=run.overrides + NOT_WATCHED))
        if count == ALL:
            runs.append(run._replace(name=name_watched(run.name)))
    return runs
