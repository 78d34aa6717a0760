"""The data of one run on the page, as a dict for JSON."""

from collections.abc import Sequence

from sprung_tools.model.vehicle_shape import read_bodies, read_wheels
from sprung_tools.report.histories import calc_spectra, list_channels, pack_channel, pack_modes
from sprung_tools.report.packing import Packed
from sprung_tools.report.scene import pack_frames, pack_road, pack_vehicle
from sprung_tools.report.summary import calc_hash, calc_statistics, list_facts, list_frequencies
from sprung_tools.runs.labelled_runs import Run, Shown
from sprung_tools.runs.run_warnings import list_warnings


def pack_run(run: Run, extra: Sequence[Shown], most: int, frames: int) -> Packed:
    """All data of one run. extra: quantities asked for; most: samples of a history at most; frames: instants of the
    animation at most."""
    results = run.results
    bodies = read_bodies(results)
    wheels = read_wheels(results, bodies)
    channels = list_channels(results, bodies, extra)
    return {
        "label": run.label,
        "facts": list_facts(results, bool(wheels), calc_hash(results.path)),
        "samples": int(results.time.size),
        "balanced": results.is_from_balance,
        "warnings": [one._asdict() for one in list_warnings(results)],
        "statistics": calc_statistics(results, channels),
        "frequencies": list_frequencies(results),
        "channels": [pack_channel(channel, results.time, most) for channel in channels],
        "spectra": calc_spectra(results),
        "modes": pack_modes(results, bodies, most),
        "frames": pack_frames(results, bodies, wheels, frames),
        "vehicle": pack_vehicle(results, bodies, wheels),
        "road": pack_road(results),
    }
