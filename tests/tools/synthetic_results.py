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
SETTINGS = {
    "speed": SPEED, "duration": 1.0, "output_step": 5e-3, "statistics_from": 0.0, "statistics_to": 1.0,
    "start": np.bytes_("equilibrium"),
}  # fmt: skip
INTEGRATOR = {"method": np.bytes_("adams"), "relative_tolerance": 1e-6, "largest_step": np.inf}
ADAPTIVITY = {"enabled": 0, "indicator": 1, "recall": 0.08, "drop": 0.002, "residence": 0.05}
ROAD = {"start": 1.0, "length": 0.4, "height": 0.2}


def write_series(file, name, columns, unit):
    """A dataset [n] or [n×k] with its unit."""
    dataset = file.create_dataset(name, data=np.stack(columns, axis=-1) if isinstance(columns, tuple) else columns)
    dataset.attrs["unit"] = unit


def write_texts(file, name, texts):
    file[name] = np.array([text.encode() for text in texts], dtype="S400")


def write_group(file, name, attributes):
    """A group with its attributes: numbers, or bytes."""
    group = file.require_group(name)
    group.attrs.update(attributes)
    return group


def write_element(file, name, kind, drawing, points, parameters):
    """A joint or force of /model/resolved. points: role → body.point; parameters: attributes."""
    texts = {"kind": np.bytes_(kind), "drawing": np.bytes_(drawing)}
    group = write_group(file, f"model/resolved/{name}", {**texts, "on_road": int(drawing == "wheel")})
    write_texts(group, "point_roles", list(points))
    write_texts(group, "points", list(points.values()))
    write_group(group, "parameters", parameters)


def write_settings(file, settings, integrator=INTEGRATOR, adaptivity=ADAPTIVITY):
    write_group(file, "model/resolved/settings", settings)
    write_group(file, "model/resolved/settings/integrator", integrator)
    write_group(file, "model/resolved/settings/adaptivity", adaptivity)


def write_results(
    path, num_modes=2, scale=1.0, start_offset=0.0, overrides=(), settings=(), integrator=(), adaptivity=()
):
    """A truck whose chassis heaves as scale · HEAVE · sin(CIRCULAR t) about its static height. Returns the path.

    num_modes: of the chassis, 0 = rigid; start_offset: m, offset of the whole motion above equilibrium;
    overrides: what the file says of --set; settings, integrator, adaptivity: of the resolved model, as dicts.
    """
    time = np.linspace(0.0, 1.0, NUM_SAMPLES)
    heave = scale * HEAVE * np.sin(CIRCULAR * time)
    with h5py.File(path, "w") as file:
        file.attrs.update({"format": np.bytes_("sprung-results"), "version": 2, "complete": 1, "title": "synthetic"})
        write_series(file, "time", time, "s")
        write_motion(file, time, heave, start_offset)
        write_tyre(file, time, heave)
        if num_modes > 0:
            write_modes(file, time, heave, num_modes)
        write_model(file, num_modes)
        write_resolved_model(file, num_modes)
        write_settings(file, SETTINGS | dict(settings), INTEGRATOR | dict(integrator), ADAPTIVITY | dict(adaptivity))
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
    roles = {"road_height": "road-height", "force": "force", "contact": "contact", "penetration": "deflection"}
    for name, role in roles.items():
        file[f"forces/front_tyre/{name}"].attrs["role"] = np.bytes_(role)


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
    write_texts(file, "model/run_text", ["speed = 3.0"])
    write_texts(file, "model/vehicle_text", ['name = "synthetic"'])
    chassis = file.create_group("model/bodies/chassis")
    chassis.attrs.update({"mass": 1e4, "inertia": 5e4, "superelement": np.bytes_("chassis" if num_modes else "")})
    write_texts(chassis, "point_names", ["chassis.origin", "chassis.front_end", "chassis.seat"])
    write_series(chassis, "point_positions", np.array([(0.0, 0.0), (FRONT, 0.0), (0.0, SEAT_HEIGHT)]), "m")
    if num_modes > 0:
        write_superelement_part(file, num_modes)


def write_resolved_model(file, num_modes):
    """The vehicle as run, towards -x: the chassis with its points, one tyre, the road."""
    write_group(file, "model/resolved", {"direction": -1.0})
    write_series(file, "model/resolved/gravity", np.array([0.0, -9.80665]), "m/s^2")
    points = {
        "origin": (0.0, 0.0),
        "center_of_mass": (0.0, 0.01),
        "front_end": (FRONT, 0.0),
        "seat": (0.0, SEAT_HEIGHT),
    }
    nodes = {"front_end": 0, "seat": 1} if num_modes else {}
    for name, place in points.items():
        attributes = {"body": np.bytes_("chassis"), "node": nodes.get(name, -1)}
        point = write_group(file, f"model/resolved/points/chassis.{name}", attributes)
        write_series(point, "position", np.array(place), "m")
        if num_modes:
            write_series(point, "shapes", np.zeros((3, num_modes)), "m, m, rad per unit amplitude")
    tyre = {"radius": RADIUS, "radius_unit": np.bytes_("m")}
    write_element(file, "forces/front_tyre", "tyre", "wheel", {"wheel": "chassis.front_end"}, tyre)
    file.require_group("model/resolved/joints")
    write_group(file, "model/resolved/road", {"shape": np.bytes_("half-sine"), "file": np.bytes_("")})
    write_group(file, "model/resolved/road/parameters", ROAD)


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


def write_superelement(path, name, frequencies, kinds=None):
    """As much of a superelement file (reduce/superelement/superelement.md) as the tools read: its name, hash,
    frequencies [Hz], kinds of vectors if they are given, and one check."""
    with h5py.File(path, "w") as file:
        file.attrs.update({"format": np.bytes_("sprung-superelement"), "version": 1, "name": np.bytes_(name)})
        file.attrs["content_hash"] = np.bytes_("0123")
        write_series(file, "modes/frequency", np.array(frequencies), "Hz")
        if kinds is not None:
            write_texts(file, "modes/kind", kinds)
        write_texts(file, "checks/name", ["residual of the modes"])
        write_series(file, "checks/value", np.array([1e-13]), "1")
        write_series(file, "checks/tolerance", np.array([1e-6]), "1")
