"""Small results files of runs whose modes join and leave, on top of synthetic_results."""

import h5py
import numpy as np
from synthetic_results import NUM_SAMPLES, write_results, write_series, write_texts

FREQUENCIES = (6.11, 6.11, 38.3, 107.4)  # Hz, of the superelement; the run has modes 1, 3 and 4 where it says so
KINDS = ("free", "free", "free", "residual")


def write_adaptive_run(path, *, numbers=(1, 3, 4), is_adaptive=True):
    """Three modes over 1 s: the first active throughout, the second from 0.25 s on but for 0.5 to 0.75 s, the third
    never.

    numbers: of the modes in the superelement. Left out: superelement mode 3 misses 3 % of the deflection at 0.5 s, mode
    2 0.8 % of the acceleration at 0.2 s. is_adaptive: else a fixed set without an indicator. Returns the path.
    """
    adaptivity = {"enabled": 1, "recall": 0.01} if is_adaptive else {}
    write_results(path, num_modes=len(numbers), adaptivity=adaptivity)
    time = np.linspace(0.0, 1.0, NUM_SAMPLES)
    with h5py.File(path, "a") as file:
        modal = "bodies/chassis/modal"
        file[f"{modal}/mode_number"][:] = numbers
        part = file["model/superelements/chassis"]
        write_series(part, "frequency", np.array(FREQUENCIES), "Hz")
        write_texts(part, "kind", KINDS)
        del part["shapes"]
        write_series(part, "shapes", np.ones((3, 3, len(FREQUENCIES))), "")
        active = np.ones((NUM_SAMPLES, len(numbers)))
        if is_adaptive:
            active[:, 1] = (time >= 0.25) & ~((time >= 0.5) & (time < 0.75))
            active[:, 2] = 0.0
            neglected = np.zeros((NUM_SAMPLES, 3))
            neglected[time > 0.0] = (1e-4, 2e-4, 4)
            neglected[np.searchsorted(time, 0.5)] = (0.03, 2e-4, 3)
            neglected[np.searchsorted(time, 0.2)] = (1e-4, 0.008, 2)
            write_series(file, f"{modal}/neglected", neglected, "1")
            write_events(file)
        write_series(file, f"{modal}/active", active, "1")
    return str(path)


def write_events(file):
    """A wheel that lifts off, and the changes of the second mode: two of them, one told twice."""
    events = [
        (0.1, "contact", "front_tyre", "leaves the road"),
        (0.25, "modes", "chassis.mode 3", "joins"),
        (0.5, "modes", "chassis.mode 3", "leaves"),
        (0.5, "modes", "chassis.mode 4", "leaves"),
    ]
    times, *texts = zip(*events)
    write_series(file, "events/time", np.array(times), "s")
    for name, column in zip(("kind", "object", "text"), texts):
        write_texts(file, f"events/{name}", column)
