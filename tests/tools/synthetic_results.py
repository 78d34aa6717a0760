"""Small results files in the layout of dynamics/output/results.md, whose values are known formulas of time."""

import h5py
import numpy as np

NUM_SAMPLES = 201
HEAVE = 0.05  # m, amplitude of the chassis' motion
STATIC_HEIGHT = 0.975  # m
SEAT_HEIGHT, FRONT = 0.9, -2.0  # m, the seat above the chassis' origin, the front end before it
CIRCULAR = 2.0 * np.pi * 2.0  # rad/s, two periods in the run
SPEED = 3.0  # m/s, towards -x
STATIC_LOAD = 7e4  # N
RADIUS = 0.6  # m
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
VEHICLE_TEXT = """name = "synthetic"
heading = "-x"
[[forces]]
name = "front_tyre"
type = "tyre"
wheel = "chassis.front_end"
"""


def write_series(file, name, columns, unit):
    """A dataset [n] or [n×k] with its unit."""
    dataset = file.create_dataset(name, data=np.stack(columns, axis=-1) if isinstance(columns, tuple) else columns)
    dataset.attrs["unit"] = unit


def write_texts(file, name, texts):
    file[name] = np.array([text.encode() for text in texts], dtype="S400")


def write_results(path, num_modes=2, scale=1.0, start_offset=0.0, overrides=()):
    """A truck whose chassis heaves as scale · HEAVE · sin(CIRCULAR t) about its static height. Returns the path.

    num_modes: of the chassis, 0 = rigid; start_offset: m, how far above balance the whole motion lies;
    overrides: of the run file, as --set gives them.
    """
    time = np.linspace(0.0, 1.0, NUM_SAMPLES)
    heave = scale * HEAVE * np.sin(CIRCULAR * time)
    with h5py.File(path, "w") as file:
        file.attrs.update({"format": np.bytes_("sprung-results"), "version": 1, "complete": 1, "title": "synthetic"})
        write_series(file, "time", time, "s")
        write_motion(file, time, heave, start_offset)
        write_tyre(file, time, heave)
        if num_modes > 0:
            write_modes(file, time, heave, num_modes)
        write_model(file, num_modes)
        write_texts(file, "model/overrides", overrides)
    return str(path)


def write_motion(file, time, heave, start_offset):
    """Bodies and points: all move up and down together, the seat with twice the acceleration."""
    acceleration = -(CIRCULAR**2) * heave
    height = STATIC_HEIGHT + start_offset + heave
    forward, nothing = 3.675 - SPEED * time, np.zeros_like(time)
    rise = np.gradient(heave, time)
    body = "bodies/chassis"
    write_series(file, f"{body}/position", (forward, height, nothing), "m, m, rad")
    write_series(file, f"{body}/velocity", (nothing - SPEED, rise, nothing), "m/s, m/s, rad/s")
    write_series(file, f"{body}/acceleration", (nothing, acceleration, nothing), "m/s^2, m/s^2, rad/s^2")
    write_series(file, f"{body}/center_of_mass/position", (forward, height + 0.01), "m")
    write_series(file, f"{body}/center_of_mass/acceleration", (nothing, acceleration), "m/s^2")
    write_series(file, "points/chassis.seat/position", (forward, height + SEAT_HEIGHT), "m")
    write_series(file, "points/chassis.seat/acceleration", (nothing, 2.0 * acceleration), "m/s^2")
    write_series(file, "points/chassis.front_end/position", (forward + FRONT, height), "m")


def write_tyre(file, time, heave):
    """A tyre that is off the road while the chassis is more than half its amplitude up, on a road with a step."""
    road_height = np.where((time > 0.3) & (time < 0.4), 0.1, 0.0)
    off_road = heave > 0.5 * HEAVE
    write_series(file, "forces/front_tyre/road_height", road_height, "m")
    write_series(file, "forces/front_tyre/force", np.where(off_road, 0.0, STATIC_LOAD), "N")
    write_series(file, "forces/front_tyre/contact", np.where(off_road, 0.0, 1.0), "1")
    penetration = RADIUS - (STATIC_HEIGHT + heave - road_height)
    write_series(file, "forces/front_tyre/penetration", penetration, "m")
    file["forces/front_tyre"].attrs["kind"] = np.bytes_("tyre")


def write_modes(file, time, heave, num_modes):
    """The n-th amplitude is n times the heave."""
    numbers = np.arange(1, num_modes + 1)
    amplitudes = np.outer(heave, numbers)
    modal = "bodies/chassis/modal"
    write_series(file, f"{modal}/mode_number", numbers, "")
    write_series(file, f"{modal}/amplitude", amplitudes, "m√kg")
    write_series(file, f"{modal}/rate", np.gradient(amplitudes, time, axis=0), "m√kg/s")
    write_series(file, f"{modal}/acceleration", -(CIRCULAR**2) * amplitudes, "m√kg/s^2")
    write_series(file, "points/chassis.front_end/deflection", (np.zeros_like(time), 0.1 * heave), "m")


def write_model(file, num_modes):
    """What was run: one body, which has a superelement of three nodes where it is flexible."""
    for name, position in {
        "bodies/chassis": (3.675, STATIC_HEIGHT, 0.0),
        "points/chassis.center_of_mass": (3.675, STATIC_HEIGHT + 0.01),
        "points/chassis.seat": (3.675, STATIC_HEIGHT + SEAT_HEIGHT),
    }.items():
        write_series(file, f"model/equilibrium/{name}", np.array(position), "m")
    file["model/equilibrium"].attrs["is_static_equilibrium"] = 1
    file["model"].attrs["speed"] = SPEED
    write_texts(file, "model/run_text", [RUN_TEXT])
    write_texts(file, "model/vehicle_text", [VEHICLE_TEXT])
    chassis = file.create_group("model/bodies/chassis")
    chassis.attrs.update({"mass": 1e4, "inertia": 5e4, "superelement": np.bytes_("chassis" if num_modes else "")})
    write_texts(chassis, "point_names", ["chassis.origin", "chassis.front_end", "chassis.seat"])
    write_series(chassis, "point_positions", np.array([(0.0, 0.0), (FRONT, 0.0), (0.0, SEAT_HEIGHT)]), "m")
    if num_modes > 0:
        write_superelement_part(file, num_modes)


def write_superelement_part(file, num_modes):
    """Its n-th mode lifts the front end by 0.1 / n and turns it; the middle is clamped."""
    part = file.create_group("model/superelements/chassis")
    part.attrs.update({"content_hash": np.bytes_("0123"), "program_version": np.bytes_("1.2")})
    write_series(part, "node_positions", np.array([(FRONT, 0.0), (0.0, 0.0), (-FRONT, 0.0)]), "m")
    write_series(part, "elements", np.array([(0, 1), (1, 2)]), "")
    shapes = np.zeros((3, 3, num_modes))
    shapes[0, 1] = 0.1 / np.arange(1, num_modes + 1)
    shapes[0, 2] = -0.05
    write_series(part, "shapes", shapes, "")


def write_superelement(path, name, frequencies):
    """As much of a superelement file (reduce/superelement/superelement.md) as the tools read: its name, hash,
    frequencies [Hz] and one check."""
    with h5py.File(path, "w") as file:
        file.attrs.update({"format": np.bytes_("sprung-superelement"), "version": 1, "name": np.bytes_(name)})
        file.attrs["content_hash"] = np.bytes_("0123")
        write_series(file, "modes/frequency", np.array(frequencies), "Hz")
        write_texts(file, "checks/name", ["residual of the modes"])
        write_series(file, "checks/value", np.array([1e-13]), "1")
        write_series(file, "checks/tolerance", np.array([1e-6]), "1")
