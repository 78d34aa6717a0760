"""The runs of the report's section on modes that are chosen from the forcing, and join and leave during the run."""

from sprung_tools.paper_report.paper_runs import ADAMS, NOT_WATCHED, ROADS, PaperRun, chassis_modes, name_modes

TOLERANCES = (0.01, 0.1)  # of the choice; the first is the program's own
RECALLS = (0.32, 0.16, 0.08, 0.04, 0.02, 0.01, 0.005)  # among them the program's own
DROP_OF_RECALL = 0.025  # as of the program's own thresholds
FIXED_COUNTS = (2, 6, 12, 36)  # of chassis modes, beside which adaptive runs over the bump stand
ALL = 36
FEW = 6  # modes available, where few are
CHOSEN = ('modes.chassis="auto"',)
ADAPTIVE = chassis_modes(2) + ("adaptivity.enabled=true",)
OF_FEW = (f"adaptivity.available.chassis={FEW}",)
METHODS = {"exponential": ((), ""), "Adams": (ADAMS, "_adams")}  # what --set changes, and the end of the runs' names


def name_chosen(road, tolerance):
    return f"{road}_auto" if tolerance == TOLERANCES[0] else f"{road}_auto_{100.0 * tolerance:g}"


def name_recall(recall):
    return f"bump_recall_{100.0 * recall:g}"


def list_chosen_runs():
    """Modes chosen before the run, by the program's own tolerance and by a looser one."""
    return [
        PaperRun(name_chosen(road, one), f"{road}.toml", CHOSEN + (f"mode_choice.tolerance={one:g}",))
        for road in ROADS
        for one in TOLERANCES
    ]


def list_adaptive_runs():
    """Over both roads; over the bump with few modes available, too, and by each method."""
    runs = [PaperRun("terrain_adaptive", "terrain.toml", ADAPTIVE)]
    for change, suffix in METHODS.values():
        runs += [
            PaperRun(f"bump_adaptive{suffix}", "bump.toml", ADAPTIVE + change),
            PaperRun(f"bump_adaptive_of_{FEW}{suffix}", "bump.toml", ADAPTIVE + OF_FEW + change),
        ]
    return runs


def list_recall_runs():
    """Over the bump with looser and tighter thresholds, in proportion."""
    return [
        PaperRun(
            name_recall(one), "bump.toml",
            ADAPTIVE + (f"adaptivity.recall={one:g}", f"adaptivity.drop={DROP_OF_RECALL * one:g}"),
        )
        for one in RECALLS
    ]  # fmt: skip


def list_fixed_runs():
    """Fixed sets over the bump by Adams' method, but those of paper_runs.list_adams_runs()."""
    return [
        PaperRun(f"bump_{name_modes(n)}_adams", "bump.toml", chassis_modes(n) + ADAMS) for n in FIXED_COUNTS if n > 4
    ]


def list_mode_runs():
    """All of them."""
    return [*list_chosen_runs(), *list_adaptive_runs(), *list_recall_runs(), *list_fixed_runs()]


def name_watched(name):
    """A timed run of a fixed set that is told what it misses, as runs are unless asked not to be."""
    return f"{name}_watched"


def list_timed_mode_runs():
    """What is timed: fixed sets without the indicator, all modes with it too, and modes chosen and changing."""
    runs = [one for one in list_chosen_runs() if one.name in ("bump_auto", "terrain_auto")]
    runs = [one._replace(overrides=one.overrides + NOT_WATCHED) for one in runs] + list_adaptive_runs()
    cases = [("bump", n, *method) for method in METHODS.values() for n in FIXED_COUNTS] + [("terrain", ALL, (), "")]
    for road, count, change, suffix in cases:
        run = PaperRun(f"{road}_{name_modes(count)}{suffix}", f"{road}.toml", chassis_modes(count) + change)
        runs.append(run._replace(overrides=run.overrides + NOT_WATCHED))
        if count == ALL:
            runs.append(run._replace(name=name_watched(run.name)))
    return runs
