"""Small results files in the layout of dynamics/output/results.md, whose values are known formulas of time."""

import h5py
import numpy as np

NUM_SAMPLES = 201
HEAVE = 0.05  # m, amplitude of the chassis' motion
STATIC_HEIGHT = 0.975  # m
CIRCULAR = 2.0 * np.pi * 2.0  # rad/s, two periods in the run
RUN_TEXT = """title = "synthetic"
speed = 3.0
[road]
shape = "half-sine"
height = 0.2
length = 0.4
[integrator]
method = "adams"
relative_tolerance = 1e-6
"""


def write_series(file, name, columns, unit):
    """A dataset [n] or [n×k] with its unit."""
    dataset = file.create_dataset(
        name, data=np.stack(columns, axis=-1) if isinstance(columns, tuple) else columns
    )
    dataset.attrs["unit"] = unit


def write_results(path, num_modes=2, scale=1.0, start_offset=0.0, overrides=()):
    """A truck whose chassis heaves as scale · HEAVE · sin(CIRCULAR t) about its static height. Returns the path.

    num_modes: of the chassis, 0 = rigid; start_offset: m, how far above balance the whole motion lies;
    overrides: of the run file, as --set gives them.
    """
    time = np.linspace(0.0, 1.0, NUM_SAMPLES)
    heave = scale * HEAVE * np.sin(CIRCULAR * time)
    acceleration = -(CIRCULAR**2) * heave
    height = STATIC_HEIGHT + start_offset + heave
    forward, nothing = 3.675 - 3.0 * time, np.zeros_like(time)
    with h5py.File(path, "w") as file:
        file.attrs.update(
            {"format": np.bytes_("sprung-results"), "version": 1, "complete": 1, "title": "synthetic"}
        )
        write_series(file, "time", time, "s")
        write_series(file, "bodies/chassis/position", (forward, height, nothing), "m, m, rad")
        write_series(
            file, "bodies/chassis/acceleration", (nothing, acceleration, nothing), "m/s^2, m/s^2, rad/s^2"
        )
        write_series(file, "bodies/chassis/center_of_mass/position", (forward, height + 0.01), "m")
        write_series(file, "bodies/chassis/center_of_mass/acceleration", (nothing, acceleration), "m/s^2")
        write_series(file, "points/chassis.seat/position", (forward, height + 0.9), "m")
        write_series(file, "points/chassis.seat/acceleration", (nothing, 2.0 * acceleration), "m/s^2")
        write_series(
            file, "forces/front_tyre/road_height", np.where((time > 0.3) & (time < 0.4), 0.1, 0.0), "m"
        )
        if num_modes > 0:
            write_series(file, "bodies/chassis/modal/mode_number", np.arange(1, num_modes + 1), "")
            write_series(
                file,
                "bodies/chassis/modal/amplitude",
                tuple(n * heave for n in range(1, num_modes + 1)),
                "m√kg",
            )
            write_series(file, "points/chassis.front_end/deflection", (nothing, 0.1 * heave), "m")
        for name, position in {
            "bodies/chassis": (3.675, STATIC_HEIGHT, 0.0),
            "points/chassis.center_of_mass": (3.675, STATIC_HEIGHT + 0.01),
            "points/chassis.seat": (3.675, STATIC_HEIGHT + 0.9),
        }.items():
            write_series(file, f"model/equilibrium/{name}", np.array(position), "m")
        file["model/equilibrium"].attrs["is_static_equilibrium"] = 1
        file["model"].attrs["speed"] = 3.0
        file["model/run_text"] = np.array([RUN_TEXT.encode()])
        file["model/overrides"] = np.array([text.encode() for text in overrides], dtype="S40")
    return str(path)


def write_superelement(path, name, frequencies):
    """As much of a superelement file (reduce/superelement.md) as the tools read: its name and frequencies [Hz]."""
    with h5py.File(path, "w") as file:
        file.attrs.update({"format": np.bytes_("sprung-superelement"), "version": 1, "name": np.bytes_(name)})
        write_series(file, "modes/frequency", np.array(frequencies), "Hz")
