"""The report's tables: functions from Numbers to (headings, rows). Rows of runs that were not made are left out, so
that a test can make the cheap runs alone."""

from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np

from sprung_tools.files.hdf5_file import read_real
from sprung_tools.files.results_file import ResultsFile
from sprung_tools.model.rigid_body_loads import calc_rigid_moments, read_superelement
from sprung_tools.paper_report.certified_tables import list_certified_tables
from sprung_tools.paper_report.claims import Claim, format_holds
from sprung_tools.paper_report.mode_claims import list_mode_claims
from sprung_tools.paper_report.mode_tables import list_mode_tables
from sprung_tools.paper_report.paper_claims import list_claims
from sprung_tools.paper_report.paper_runs import MODE_COUNTS, ROADS, name_modes
from sprung_tools.paper_report.run_numbers import CENTRE, MIDDLE, SEAT, Numbers, chassis_frequencies
from sprung_tools.paper_report.sensitivity_tables import make_sensitivity_table, make_speed_table
from sprung_tools.runs.largest_loads import MOMENT, Peak, calc_peak, find_peak
from sprung_tools.runs.ride_measures import calc_comfort, calc_contact, calc_travel, read_window
from sprung_tools.runs.section_stress import FROM_MODES
from sprung_tools.signals.spectra import calc_rms
from sprung_tools.terminal.text_table import Rows, Table, format_cell

PLACES = {"middle": MIDDLE, "centre of mass": CENTRE, "seat": SEAT}
MODELS = {0: "rigid", 2: "2 modes", 4: "4 modes", 36: "36 modes"}


def has_modes(numbers: Numbers, road: str, count: int) -> bool:
    """Whether the run over a road with a number of chassis modes was made."""
    return numbers.has(f"{road}_{name_modes(count)}")


def make_claims_table(numbers: Numbers) -> Table:
    """The paper's claims, with criterion, finding and verdict."""
    return ("", "paper", "paper says", "criterion", "we find", "holds?"), list_judged(numbers, list_claims())


def make_mode_claims_table(numbers: Numbers) -> Table:
    """The claims about modes that the program chooses, with criterion, finding and verdict."""
    return ("", "run", "what", "criterion", "we find", "holds?"), list_judged(numbers, list_mode_claims())


def list_judged(numbers: Numbers, claims: Iterable[Claim]) -> Rows:
    """A row for each claim whose runs were made."""
    rows = []
    for claim in claims:
        if not all(map(numbers.has, claim.needs)) or (claim.timed and numbers.costs is None):
            continue
        finding = claim.judge(numbers)
        holds = format_holds(finding.holds)
        rows.append((claim.number, claim.source, claim.says, claim.criterion, finding.found, holds))
    return rows


def make_peaks_table(numbers: Numbers) -> Table:
    """Over the bump: the extremes of displacement and acceleration of three points."""
    rows = []
    for count, model in MODELS.items():
        if not has_modes(numbers, "bump", count):
            continue
        run = numbers.modes("bump", count)
        for name, point in PLACES.items():
            displacement, acceleration = run.displacement(point), run.acceleration(point)
            rows.append(
                (
                    f"{name}, {model}",
                    f"{1e3 * displacement.max():.1f}",
                    f"{1e3 * displacement.min():.1f}",
                    f"{acceleration.max():.1f}",
                    f"{acceleration.min():.1f}",
                    f"{calc_rms(acceleration):.2f}",
                )
            )
    headings = ("bump", "highest mm", "lowest mm", "acceleration up m/s²", "down m/s²", "r.m.s. m/s²")
    return headings, sort_by_place(rows)


def make_bands_table(numbers: Numbers) -> Table:
    """Over terrain: the r.m.s. acceleration by band of frequency."""
    rows = []
    for count, model in MODELS.items():
        if not has_modes(numbers, "terrain", count):
            continue
        run = numbers.modes("terrain", count)
        for name, point in PLACES.items():
            bands = run.band_rms(point)
            rows.append(
                (
                    f"{name}, {model}",
                    *(f"{value:.2f}" for value in (*bands, calc_rms(run.acceleration(point)))),
                )
            )
    return ("terrain, m/s²", "0 to 4 Hz", "4 to 8 Hz", "8 to 16 Hz", "above 16 Hz", "all"), sort_by_place(rows)


def sort_by_place(rows: Rows) -> Rows:
    """Sorts rows by the point at the begin of their first cell."""
    places = list(PLACES)
    return sorted(rows, key=lambda row: places.index(row[0].partition(",")[0]))


def make_convergence_table(numbers: Numbers) -> Table:
    """Against the number of chassis modes: frequencies, bump peaks, terrain accelerations, front end, moment."""
    rows = []
    for count in MODE_COUNTS:
        if not all(has_modes(numbers, road, count) for road in ROADS):
            continue
        bump, terrain = (numbers.modes(road, count) for road in ROADS)
        bending = calc_peak(terrain.results, "chassis", MOMENT, FROM_MODES, terrain.window)
        end = terrain.front_end if count else None
        rows.append(
            (
                str(count),
                ", ".join(f"{value:.2f}" for value in chassis_frequencies(bump, 3)) or "–",
                f"{1e3 * bump.displacement(MIDDLE).max():.1f}",
                f"{bump.peak_acceleration(MIDDLE):.1f}",
                f"{bump.peak_acceleration(CENTRE):.1f}",
                f"{bump.peak_acceleration(SEAT):.1f}",
                f"{terrain.rms_acceleration(MIDDLE):.3f}",
                f"{terrain.rms_acceleration(CENTRE):.3f}",
                f"{terrain.rms_acceleration(SEAT):.3f}",
                f"{end.ratio:.1f}" if end else "–",
                f"{1e-3 * abs(bending.value):.1f}" if bending else "–",
            )
        )
    headings = (
        "modes", "bending of the assembled truck Hz", "bump: highest middle mm", "peak middle m/s²",
        "peak centre of mass m/s²", "peak seat m/s²", "terrain: r.m.s. middle m/s²", "r.m.s. centre of mass m/s²",
        "r.m.s. seat m/s²", "front end peak/static", "largest moment kN·m",
    )  # fmt: skip
    return headings, rows


EFFORT = ("modes", "bump: evaluations", "over rigid", "terrain: evaluations", "over rigid")


def make_effort_table(numbers: Numbers) -> Table:
    """The integrator's evaluations of the equations of motion in both runs, also over those of the rigid model."""
    return EFFORT, list_efforts(numbers, MODE_COUNTS, "")


def make_adams_table(numbers: Numbers) -> Table:
    """The same by Adams' method."""
    return EFFORT, list_efforts(numbers, (0, 2, 4), "_adams")


def list_efforts(numbers: Numbers, counts: Iterable[int], suffix: str) -> Rows:
    """The rows for some numbers of modes. suffix: of the runs' names."""
    rows = []
    for count in counts:
        names = [(f"{road}_{name_modes(count)}{suffix}", f"{road}_rigid{suffix}") for road in ROADS]
        if not all(numbers.has(name) for name, _ in names):
            continue
        cells = []
        for name, rigid in names:
            evaluations = numbers.run(name).evaluations
            cells += [f"{evaluations}", f"{evaluations / numbers.run(rigid).evaluations:.2f}"]
        rows.append((str(count), *cells))
    return rows


def make_cost_table(numbers: Numbers) -> Table:
    """Processor times of the whole program without a results file; no rows if nothing was timed."""
    rows = []
    for road in ROADS if numbers.costs else ():
        rigid = numbers.cost(f"{road}_rigid")
        for count in (0, 2, 4):
            time = numbers.cost(f"{road}_{name_modes(count)}")
            rows.append((f"{road}, {MODELS[count]}", f"{time:.2f}", f"{time / rigid:.2f}"))
    return ("", "processor time s", "over rigid"), rows


def make_ride_table(numbers: Numbers) -> Table:
    """The measures of the ride: a row for each measure, a column for each model and road."""
    columns = [(road, count) for road in ROADS for count in MODELS if has_modes(numbers, road, count)]
    cells = [make_ride_column(numbers.modes(road, count).results, numbers.folder, count) for road, count in columns]
    rows = [(name, *(column[name] for column in cells)) for name in cells[0]]
    return ("", *(f"{road}, {MODELS[count]}" for road, count in columns)), rows


def make_ride_column(results: ResultsFile, superelements: Path, count: int) -> dict[str, str]:
    """One model's column of make_ride_table(): measure → text."""
    window = read_window(results)
    column = {}
    for name, point in PLACES.items():
        comfort = calc_comfort(results, point, window)
        column[f"{name}: r.m.s. m/s²"] = f"{comfort.rms:.2f}"
        column[f"{name}: Wk-weighted r.m.s. m/s²"] = f"{comfort.weighted_rms:.2f}"
        column[f"{name}: vibration dose value m/s^1.75"] = f"{comfort.dose:.1f}"
    for axle in ("front", "rear"):
        travel = calc_travel(results, f"{axle}_suspension", window)
        extremes = ", ".join(format_cell(value, 0, 1e3) for value in (travel.compression, travel.rebound))
        column[f"{axle} suspension: compression, rebound mm"] = extremes
        column[f"{axle} bump stops: hits, time on them s"] = (
            f"{format_cell(travel.hits, 0)}, {format_cell(travel.stopped, 2)}"
        )
    for axle in ("front", "rear"):
        contact = calc_contact(results, f"{axle}_tyre", window)
        variation = contact.over_static(contact.dynamic_rms)
        column[f"{axle} tyres: r.m.s. dynamic load over static"] = format_cell(variation, 2)
        column[f"{axle} tyres: greatest load over static"] = format_cell(contact.over_static(contact.greatest), 1)
        column[f"{axle} wheels: off the ground s"] = f"{contact.off_ground:.2f}"
        column[f"{axle} tyres: without load s"] = f"{contact.unloaded:.2f}"
    if count == 0:
        moments, stations = calc_rigid_moments(results, "chassis", read_superelement(superelements / "chassis.h5"))
        bending: Peak | None = find_peak(results, moments, stations, window)
    else:
        bending = calc_peak(results, "chassis", MOMENT, FROM_MODES, window)
    moment = f"{1e-3 * bending.value:.0f}, {bending.x:.2f}" if bending else "–"
    column["largest bending moment kN·m, at x m"] = moment
    return column


def make_tyres_table(numbers: Numbers) -> Table:
    """Point contact compared with distributed contact: the chassis, the front tyres, and the speed at the end."""
    rows = []
    for road in ROADS:
        for count in (0, 2, 4):
            for contact, suffix in (("point", ""), ("distributed", "_distributed")):
                name = f"{road}_{name_modes(count)}{suffix}"
                if not numbers.has(name):
                    continue
                run = numbers.run(name)
                load = calc_contact(run.results, "front_tyre", run.window)
                speed = np.abs(run.series("bodies/chassis/velocity.x"))
                rows.append(
                    (
                        f"{road}, {MODELS[count]}, {contact}",
                        f"{1e3 * run.displacement(MIDDLE).max():.1f}",
                        f"{run.peak_acceleration(MIDDLE):.1f}",
                        f"{run.rms_acceleration(MIDDLE):.2f}",
                        f"{run.rms_acceleration(SEAT):.2f}",
                        format_cell(load.over_static(load.greatest), 1),
                        f"{load.off_ground:.2f}",
                        f"{speed[-1]:.2f}",
                    )
                )
    headings = (
        "", "highest middle mm", "peak middle m/s²", "r.m.s. middle m/s²", "r.m.s. seat m/s²",
        "greatest front load over static", "front wheels off the ground s", "speed at the end m/s",
    )  # fmt: skip
    return headings, rows


def make_accuracy_table(numbers: Numbers) -> Table:
    """The paper's cases with 4 modes at the runs' tolerance and at a hundredth of it."""
    rows = []
    for road in ROADS:
        if not numbers.has(f"{road}_4modes_finer"):
            continue
        for name, run in (
            (road, numbers.modes(road, 4)),
            (f"{road}, finer", numbers.run(f"{road}_4modes_finer")),
        ):
            rows.append(
                (
                    name,
                    f"{read_real(run.results.file, 'model', 'relative_tolerance'):g}",
                    *(f"{run.peak_acceleration(point):.4f}" for point in (MIDDLE, SEAT)),
                    *(f"{run.rms_acceleration(point):.5f}" for point in (MIDDLE, SEAT)),
                    f"{np.max(np.abs(run.displacement(MIDDLE))) * 1e3:.4f}",
                )
            )
    headings = (
        "4 modes", "tolerance", "peak middle m/s²", "peak seat m/s²", "r.m.s. middle m/s²", "r.m.s. seat m/s²",
        "largest displacement mm",
    )  # fmt: skip
    return headings, rows


def list_tables() -> dict[str, Callable[[Numbers], Table]]:
    """All tables of the report: name of the marker → function that makes the table."""
    return {
        "claims": make_claims_table,
        "bump peaks": make_peaks_table,
        "terrain bands": make_bands_table,
        "convergence": make_convergence_table,
        "effort": make_effort_table,
        "effort of Adams": make_adams_table,
        "sensitivity": make_sensitivity_table,
        "speed": make_speed_table,
        "ride": make_ride_table,
        "tyres": make_tyres_table,
        "accuracy": make_accuracy_table,
        "cost": make_cost_table,
        "mode claims": make_mode_claims_table,
        **list_mode_tables(),
        **list_certified_tables(),
    }


def list_texts() -> dict[str, Callable[[Numbers], str]]:
    """The parts of the report that quote a program: name of the marker → function that makes the text."""
    return {"warning": lambda numbers: "\n".join(numbers.run("bump_2modes").warnings)}
