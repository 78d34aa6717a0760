"""What the report page shows of a run, as one dict for JSON: statistics from all samples, histories thinned for drawing.

Arrays of numbers are base64 of little-endian float32. Thinning keeps, in each of many short spans of time, the least and
the greatest value where they are, so that no peak is lost; everything that is computed is computed before it.
"""

import base64
import hashlib

import numpy as np

from results_file import read_numbers, text_of
from run_caption import describe_road, read_run_file
from spectra import calc_power_spectrum
from vehicle_shape import calc_motion, read_bodies, read_links, read_road, read_vehicle, read_wheels

MOST_FRAMES = 6000  # of the animation; it goes straight from one to the next
MOST_MODES = 12  # of a body whose amplitudes are drawn: the largest
SEGMENT = 4.0  # s, of the averaged spectra at most: lines 0.25 Hz apart
HIGHEST_FREQUENCY = 200.0  # Hz, of the spectra drawn


def encode(values):
    """Numbers as base64 text of float32."""
    return base64.b64encode(np.ascontiguousarray(values, dtype="<f4").tobytes()).decode("ascii")


def find_kept(values, most):
    """The samples of a history [n] to draw it by: at most about `most`, with the least and greatest of each span."""
    size = values.size
    if size <= most:
        return np.arange(size)
    edges = np.linspace(0, size, most // 2 + 1).astype(int)
    kept = [0, size - 1]
    for first, last in zip(edges[:-1], edges[1:]):
        span = values[first:last]
        kept += [first + int(np.argmin(span)), first + int(np.argmax(span))]
    return np.unique(kept)


def calc_hash(path):
    """SHA-256 of a file."""
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while part := file.read(1 << 20):
            digest.update(part)
    return digest.hexdigest()


class Channel:
    """A history: where it belongs in the page's menus, its name, values [n], unit."""

    def __init__(self, group, name, values, unit):
        self.group, self.name, self.values, self.unit = group, name, values, unit

    @property
    def key(self):
        return f"{self.group}: {self.name}"


def list_monitored(results):
    """The points that the run's summary is about; all bodies' origins if it is about none."""
    points = results.names("summary/points")
    return points or [f"{body}.origin" for body in results.names("bodies")]


def list_channels(results, bodies, wheels, extra):
    """All histories that the page offers. extra: list of Shown."""
    channels = []

    def add(group, name, quantity):
        if results.has(quantity):
            values, unit = results.series(quantity)
            channels.append(Channel(group, name, values, unit))

    for shown in extra:
        add("Asked for", shown.label, shown.quantity)
    balanced = results.file["model/equilibrium"].attrs.get("is_static_equilibrium", 0) == 1
    for point in list_monitored(results):
        add("Vertical motion", f"{point}, {'displacement' if balanced else 'position'}",
            f"points/{point}/{'displacement' if balanced else 'position'}.y")  # fmt: skip
        add("Vertical motion", f"{point}, acceleration", f"points/{point}/acceleration.y")
    for body in bodies:
        for point in find_most_bent(results, body):
            add("Deflection", f"{point}, in the body frame", f"points/{point}/deflection.y")
        channels.extend(calc_moment_envelope(results, body))
    for force in results.names("forces"):
        for what, name in (("force", "force"), ("deflection", "compression"), ("penetration", "penetration")):
            add("Forces", f"{force}, {name}", f"forces/{force}/{what}")
    for body in find_heavy(results):
        add("Whole vehicle", f"{body}, angle", f"bodies/{body}/position.angle")
        add("Whole vehicle", f"{body}, horizontal velocity", f"bodies/{body}/velocity.x")
    for name in results.names("energy"):
        add("Energy", name, f"energy/{name}")
    return channels


def find_heavy(results):
    """The heaviest body's name, in a list."""
    bodies = results.names("model/bodies")
    return sorted(bodies, key=lambda name: -float(results.file[f"model/bodies/{name}"].attrs["mass"]))[:1]


def find_most_bent(results, body):
    """The two named points of a body whose vertical deflection varies most; none on a rigid body."""
    found = []
    for point in body.points:
        quantity = f"points/{body.name}.{point}/deflection.y"
        if body.shapes.shape[2] > 0 and results.has(quantity):
            found.append((-float(np.ptp(results.series(quantity)[0])), f"{body.name}.{point}"))
    return [point for size, point in sorted(found)[:2] if size < 0.0]


def calc_moment_envelope(results, body):
    """The largest bending moment along a body at each time, and the largest axial force."""
    channels = []
    for what, name in (("moment", "largest bending moment along it"), ("axial", "largest axial force along it")):
        dataset = f"recovery/{body.name}/{what}"
        if dataset in results.file and results.file[dataset].shape[1] > 0:
            values, unit = read_numbers(results.file, dataset)
            channels.append(Channel("Deflection", f"{body.name}, {name}", np.max(np.abs(values), axis=1), unit))
    return channels


def pack_channel(channel, time, most):
    kept = find_kept(channel.values, most)
    return {
        "group": channel.group, "name": channel.name, "unit": channel.unit, "t": encode(time[kept]),
        "v": encode(channel.values[kept]),
    }  # fmt: skip


def calc_statistics(results, channels):
    """Rows of the summary: (group, quantity, unit, value, what it is of)."""
    rows = []
    for point in results.names("summary/points"):
        attributes = results.file[f"summary/points/{point}"].attrs
        for what, unit in (("displacement", "m"), ("acceleration", "m/s^2")):
            for part, name in (("max", "highest"), ("min", "lowest"), ("rms", "r.m.s.")):
                if f"{what}_{part}" in attributes:
                    rows.append((point, f"{what}, {name}", unit, float(attributes[f"{what}_{part}"])))
    step = float(np.median(np.diff(results.time)))
    for force in results.names("forces"):
        kind = text_of(results.file[f"forces/{force}"].attrs.get("kind", ""))
        rows.append((force, "force, largest", "N", float(np.max(results.series(f"forces/{force}/force")[0]))))
        if kind == "tyre":
            contact = results.series(f"forces/{force}/contact")[0] > 0.5
            rows.append((force, "time off the road", "s", step * float(np.count_nonzero(~contact))))
        elif results.has(f"forces/{force}/deflection"):
            values = results.series(f"forces/{force}/deflection")[0]
            rows.append((force, "compression, largest", "m", float(np.max(values))))
    for channel in channels:
        if channel.group == "Deflection":
            point, _, what = channel.name.partition(", ")
            largest = what if what.startswith("largest") else "deflection, largest"
            rows.append((point, largest, channel.unit, float(np.max(np.abs(channel.values)))))
    attributes = results.file["summary"].attrs if "summary" in results.file else {}
    for key, name in (("steps", "steps"), ("evaluations", "evaluations"), ("switches", "switches located"),
                      ("energy_closure", "energy balance, relative error"),
                      ("constraint_violation", "joints, largest violation")):  # fmt: skip
        if key in attributes:
            rows.append(("computation", name, "", float(attributes[key])))
    return [{"of": of, "name": name, "unit": unit, "value": value} for of, name, unit, value in rows]


def list_facts(results, sha256):
    """What was run: (name, text) in order."""
    run = read_run_file(results)
    attributes = results.file["model"].attrs
    facts = [("vehicle", results.title)]
    if "road" in run:
        facts.append(("road", describe_road(run["road"]).removeprefix("road: ")))
    elif "model/road" in results.file:
        facts.append(("road", text_of(results.file["model/road"].attrs.get("shape", ""))))
    if "speed" in attributes:
        facts.append(("initial speed", f"{float(attributes['speed']):g} m/s"))
    step = float(np.median(np.diff(results.time)))
    facts.append(("duration", f"{results.time[-1] - results.time[0]:g} s, a sample every {1e3 * step:g} ms"))
    flexible = []
    for body in results.names("bodies"):
        if results.num_modes(body):
            numbers = read_numbers(results.file, f"bodies/{body}/modal/mode_number")[0].astype(int)
            flexible.append(f"{body}: modes {shorten_numbers(numbers)}")
    facts.append(("flexible bodies", "; ".join(flexible) or "none"))
    integrator = [f"{key.replace('_', ' ')} {value}" for key, value in run.get("integrator", {}).items()]
    if integrator:
        facts.append(("integrator", ", ".join(integrator)))
    changed = [text_of(one) for one in results.file.get("model/overrides", ())]
    facts.append(("changed by --set", ", ".join(changed) or "nothing"))
    balanced = results.file["model/equilibrium"].attrs.get("is_static_equilibrium", 0) == 1
    facts.append(("starts from", "static balance" if balanced else "the positions given"))
    for name in results.names("model/superelements"):
        attributes = results.file[f"model/superelements/{name}"].attrs
        version, content = text_of(attributes["program_version"]), text_of(attributes["content_hash"])
        facts.append((f"superelement {name}", f"sprung-reduce {version}, content {content}"))
    version = results.file.attrs.get("program_version", results.file["model"].attrs.get("program_version", None))
    if version is not None:
        facts.append(("sprung-dynamics", text_of(version)))
    for name, dataset in (("vehicle file", "vehicle_text"), ("run file", "run_text")):
        if f"model/{dataset}" in results.file:
            text = text_of(results.file[f"model/{dataset}"][()])
            facts.append((f"{name}, SHA-256", hashlib.sha256(text.encode()).hexdigest()))
    facts.append(("results file, SHA-256", sha256))
    return facts


def shorten_numbers(numbers):
    """1, 2, 3, 7 → "1–3, 7"."""
    parts, first = [], None
    for number, after in zip(numbers, [*numbers[1:], None]):
        first = number if first is None else first
        if after != number + 1:
            parts.append(f"{first}" if first == number else f"{first}–{number}")
            first = None
    return ", ".join(parts)


def calc_spectra(results):
    """Power spectral densities of the monitored points' vertical accelerations; drawn up to HIGHEST_FREQUENCY."""
    step = float(np.median(np.diff(results.time)))
    even = np.arange(results.time[0], results.time[-1], step)
    spectra = []
    for point in list_monitored(results):
        if not results.has(f"points/{point}/acceleration.y"):
            continue
        values = np.interp(even, results.time, results.series(f"points/{point}/acceleration.y")[0])
        duration = min(SEGMENT, step * (values.size // 2) if step * values.size > 2.0 * SEGMENT else step * values.size)
        if round(duration / step) < 8:
            continue
        frequency, density = calc_power_spectrum(values, step, duration)
        shown = (frequency > 0.0) & (frequency <= HIGHEST_FREQUENCY)
        spectra.append({"name": point, "f": encode(frequency[shown]), "p": encode(density[shown])})
    return spectra


def list_frequencies(results):
    """The vehicle's modes about its equilibrium: undamped frequency, damping ratio, who takes part."""
    if "model/modes/undamped_frequency" not in results.file:
        return []
    frequency, _ = read_numbers(results.file, "model/modes/undamped_frequency")
    damping, _ = read_numbers(results.file, "model/modes/damping_ratio")
    taking_part = [text_of(one) for one in results.file["model/modes/participants"][()]]
    return [
        {"f": float(f), "damping": float(d), "who": who} for f, d, who in zip(frequency, damping, taking_part) if f > 0.0
    ]


def pack_modes(results, bodies, most):
    """For each flexible body its largest modes' contributions, as the largest displacement along the body [m], and
    when they take part."""
    packed = []
    for body in bodies:
        if body.shapes.shape[2] == 0:
            continue
        where = f"bodies/{body.name}/modal"
        numbers = read_numbers(results.file, f"{where}/mode_number")[0].astype(int)
        amplitude, _ = read_numbers(results.file, f"{where}/amplitude")
        active = np.ones_like(amplitude)
        if f"{where}/active" in results.file:
            active, _ = read_numbers(results.file, f"{where}/active")
        size = np.max(np.linalg.norm(body.shapes, axis=1), axis=0)  # m per unit amplitude
        largest = np.argsort(-np.max(np.abs(amplitude * size), axis=0), kind="stable")[:MOST_MODES]
        modes = []
        for place in np.sort(largest):
            values = amplitude[:, place] * size[place]
            kept = find_kept(values, most)
            changes = np.flatnonzero(np.diff(active[:, place] > 0.5)) + 1
            modes.append({
                "number": int(numbers[place]), "t": encode(results.time[kept]), "v": encode(values[kept]),
                "active": bool(active[0, place] > 0.5), "switches": encode(results.time[changes]),
            })  # fmt: skip
        packed.append({"body": body.name, "total": int(numbers.size), "modes": modes})
    return packed


def pack_frames(results, bodies, wheels):
    """What the animation is drawn from: each body's place and amplitudes, and each tyre's contact, at even times."""
    count = min(results.time.size, MOST_FRAMES)
    time = np.linspace(results.time[0], results.time[-1], count)

    def at(values):
        return encode(np.interp(time, results.time, values))

    places, amplitudes, tyres = {}, {}, {}
    for body in bodies:
        position, _ = read_numbers(results.file, f"bodies/{body.name}/position")
        places[body.name] = [at(column) for column in position.T]
        if body.shapes.shape[2]:
            values, _ = read_numbers(results.file, f"bodies/{body.name}/modal/amplitude")
            amplitudes[body.name] = [at(column) for column in values.T]
    nearest = np.clip(np.searchsorted(results.time, time), 0, results.time.size - 1)
    for wheel in wheels:
        contact = results.series(f"forces/{wheel.name}/contact")[0]
        tyres[wheel.name] = {"contact": encode(contact[nearest]), "force": at(results.series(f"forces/{wheel.name}/force")[0])}
    return {
        "first": float(time[0]), "last": float(time[-1]), "count": count, "places": places,
        "amplitudes": amplitudes, "tyres": tyres,
    }  # fmt: skip


def pack_vehicle(results, bodies, wheels):
    """How the vehicle looks, and its box [m] at the start."""
    boxes = [calc_motion(results, body, [0]).position[0] for body in bodies]
    corners = np.concatenate(boxes)
    low, high = corners.min(axis=0), corners.max(axis=0)
    for wheel in wheels:
        centre = boxes[[body.name for body in bodies].index(wheel.body)][wheel.node]
        low, high = np.minimum(low, centre - wheel.radius), np.maximum(high, centre + wheel.radius)
    heavy = find_heavy(results)
    monitored = {point for point in list_monitored(results) if not point.endswith((".origin", ".center_of_mass"))}
    marks = [
        {"body": body.name, "node": node, "name": f"{body.name}.{point}"}
        for body in bodies for point, node in body.points.items() if f"{body.name}.{point}" in monitored
    ]  # fmt: skip
    return {
        "bodies": [
            {"name": body.name, "places": body.places.tolist(), "lines": body.lines.tolist(),
             "shapes": np.round(body.shapes, 9).tolist(), "elements": body.num_elements}
            for body in bodies
        ],
        "wheels": [wheel._asdict() for wheel in wheels],
        "links": [link._asdict() for link in read_links(results, bodies)],
        "marks": marks, "main": heavy[0] if heavy else bodies[0].name,
        "heading": read_vehicle(results).get("heading", "+x"),
        "box": [*low.tolist(), *high.tolist()],
    }  # fmt: skip


def pack_events(results):
    """The run's events: time, object, text."""
    if "events/time" not in results.file:
        return []
    time, _ = read_numbers(results.file, "events/time")
    texts = [[text_of(one) for one in results.file[f"events/{name}"][()]] for name in ("object", "text")]
    return [{"t": float(t), "of": of, "text": text} for t, of, text in zip(time, *texts)]


def pack_run(run, extra, most):
    """Everything of one run. run: runs.Run; extra: quantities asked for; most: samples to draw a history by."""
    results = run.results
    bodies = read_bodies(results)
    wheels = read_wheels(results, bodies)
    channels = list_channels(results, bodies, wheels, extra)
    road = read_road(results)
    return {
        "label": run.label,
        "facts": list_facts(results, calc_hash(results.path)),
        "samples": int(results.time.size),
        "statistics": calc_statistics(results, channels),
        "frequencies": list_frequencies(results),
        "channels": [pack_channel(channel, results.time, most) for channel in channels],
        "spectra": calc_spectra(results),
        "modes": pack_modes(results, bodies, most),
        "frames": pack_frames(results, bodies, wheels),
        "vehicle": pack_vehicle(results, bodies, wheels),
        "road": None if road is None else pack_road(results, *road),
        "events": pack_events(results),
    }


def pack_road(results, x, height, most=20000):
    """The road as (x, height), thinned like the histories, and how distance along it is counted."""
    kept = find_kept(height, most)
    attributes = results.file["model/road"].attrs
    return {
        "x": encode(x[kept]), "h": encode(height[kept]),
        "direction": float(attributes["direction"]), "origin": float(attributes["origin"]),
    }  # fmt: skip
