"""The data of one run on the page, as a dict for JSON."""

from collections.abc import Sequence

from sprung_tools.files.errors import InputError
from sprung_tools.model.vehicle_shape import read_bodies, read_wheels
from sprung_tools.report.frame_loads import list_load_warnings, pack_frame_loads
from sprung_tools.report.histories import calc_spectra, list_channels, pack_channel, pack_modes
from sprung_tools.report.packing import Packed
from sprung_tools.report.ride import calc_vibrations, list_ride_channels, pack_ride
from sprung_tools.report.scene import list_unknown, pack_frames, pack_road, pack_vehicle
from sprung_tools.report.shown_motion import ShownMotion
from sprung_tools.report.summary import calc_hash, calc_statistics, list_facts
from sprung_tools.report.vehicle_modes import pack_vehicle_modes
from sprung_tools.runs.labelled_runs import Run, Shown
from sprung_tools.runs.ride_assessment import Vibration
from sprung_tools.runs.ride_measures import read_window
from sprung_tools.runs.run_warnings import list_warnings
from sprung_tools.runs.stored_histories import list_coarse

FRAMES_OF_LOADS = 6  # the animation's instants for each one at which the loads along a body are drawn


def pack_run(run: Run, extra: Sequence[Shown], motion: ShownMotion, most: int, frames: int) -> Packed:
    """All data of one run. extra: quantities asked for; most: samples of a history at most; frames: instants of the
    animation at most."""
    results = run.results
    bodies = read_bodies(results)
    wheels = read_wheels(results, bodies)
    vibrations: dict[str, Vibration] = {}
    problem = ""
    try:
        vibrations = calc_vibrations(results)
    except InputError as error:  # too few samples, or unequally spaced ones; the rest of the page does not need them
        problem = str(error)
    ride = pack_ride(results, vibrations, problem)
    loads = pack_frame_loads(results, bodies, frames // FRAMES_OF_LOADS)
    warnings = list_warnings(results)
    warnings += list_load_warnings(warnings, [one["body"] for one in loads])
    channels = list_channels(results, bodies, extra, motion) + (list_ride_channels(vibrations) if ride else [])
    return {
        "label": run.label,
        "facts": list_facts(results, bool(wheels), calc_hash(results.path)),
        "samples": int(results.time.size),
        "coarse": list(list_coarse(results)),
        "balanced": results.is_from_balance,
        "warnings": [one._asdict() for one in warnings],
        "window": read_window(results),
        "statistics": calc_statistics(results, channels, motion),
        "vehicleModes": pack_vehicle_modes(results, bodies),
        "channels": [pack_channel(channel, results.time, most) for channel in channels],
        "ride": ride,
        "loads": loads,
        "spectra": calc_spectra(results, motion),
        "modes": pack_modes(results, bodies, most),
        "span": [float(results.time[0]), float(results.time[-1])],
        "unknown": list_unknown(results, bodies),
        "frames": pack_frames(results, bodies, wheels, frames),
        "vehicle": pack_vehicle(results, bodies, wheels),
        "road": pack_road(results),
    }
