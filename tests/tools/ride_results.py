"""A results file of a vehicle with a suspension, a tyre and a flexible body, whose values are known formulas of
time."""

import h5py
import numpy as np
from synthetic_results import write_element, write_series, write_settings

STEP = 1e-3
DURATION = 4.0
SEAT_AMPLITUDE, SEAT_FREQUENCY = 2.0, 5.0  # m/s², Hz
STATIC_DEFLECTION, STOP = 0.06, 0.15  # m
STATIC_LOAD = 5e4  # N
BEAT = 1.0  # Hz, of suspension and tyre
AIRBORNE = -0.8  # of the sine, below which the tyre is off the ground; its load has gone below -2/3
SETTINGS = {
    "speed": 3.0, "duration": DURATION, "output_step": STEP, "statistics_from": 1.0, "statistics_to": 3.0,
    "start": np.bytes_("equilibrium"),
}  # fmt: skip
ENDS = {"a": "body.spring", "b": "axle.origin"}
STATIONS = np.array([(-1.0, 0.0), (0.25, 0.1), (0.25, 0.1), (1.0, 0.0)])  # of the body: two elements


def write_ride_results(path, with_moments=True, settings=(), stop=STOP, rebound_stop=None):
    """Writes the file. Deflection: static + 0.1 sin; load: static (1 + 1.5 sin), cut off at 0; moment: at
    two of four stations, greatest at 2 s: 3 kN·m. The link has no stop. settings: of the resolved
    model, as a dict; stop, rebound_stop: of the suspension [m], None for none. Returns the path."""
    time = STEP * np.arange(round(DURATION / STEP) + 1)
    beat = np.sin(2.0 * np.pi * BEAT * time)
    nothing = np.zeros_like(time)
    load = STATIC_LOAD * np.maximum(0.0, 1.0 + 1.5 * beat)
    with h5py.File(path, "w") as file:
        file.attrs.update(
            {"format": np.bytes_("sprung-results"), "version": 2, "complete": 1, "title": "synthetic"}
        )
        write_series(file, "time", time, "s")
        seat = SEAT_AMPLITUDE * np.sin(2.0 * np.pi * SEAT_FREQUENCY * time)
        for name, factor in (("points/body.seat", 1.0), ("bodies/body/center_of_mass", 0.5)):
            write_series(file, f"{name}/acceleration", (0.5 * factor * seat, factor * seat), "m/s^2")
        write_series(file, "bodies/body/acceleration", (nothing, nothing, 3.0 * seat), "m/s^2, m/s^2, rad/s^2")
        for name in ("suspension", "link"):
            write_series(file, f"forces/{name}/deflection", STATIC_DEFLECTION + 0.1 * beat, "m")
            write_series(file, f"forces/{name}/length", 0.5 - STATIC_DEFLECTION - 0.1 * beat, "m")
            for channel, role in (("deflection", "deflection"), ("length", "extent")):
                file[f"forces/{name}/{channel}"].attrs["role"] = np.bytes_(role)
            stops = {"compression_stop": stop, "rebound_stop": rebound_stop} if name == "suspension" else {}
            units = {f"{one}_unit": np.bytes_("m") for one in stops}
            stops = {one: value for one, value in (stops | units).items() if value is not None}
            write_element(file, f"forces/{name}", "spring-damper", "spring", ENDS, stops)
        write_series(file, "forces/tyre/force", load, "N")
        write_series(file, "forces/tyre/contact", (beat > AIRBORNE).astype(float), "1")
        for name in ("force", "contact"):
            file[f"forces/tyre/{name}"].attrs["role"] = np.bytes_(name)
        write_element(file, "forces/tyre", "tyre", "wheel", {"wheel": "axle.origin"}, {"radius": 0.5})
        if with_moments:
            moment = 3e3 * np.cos(0.5 * np.pi * (time - 2.0))
            write_series(file, "recovery/body/moment", (0.5 * moment, -moment, -moment, 0.2 * moment), "N m")
            write_series(file, "recovery/body/station", STATIONS, "m")
        write_series(file, "model/resolved/gravity", np.array([0.0, -9.80665]), "m/s^2")
        equilibrium = file.create_group("model/equilibrium")
        equilibrium.attrs["is_static_equilibrium"] = 1
        write_settings(file, SETTINGS | dict(settings))
    return str(path)
