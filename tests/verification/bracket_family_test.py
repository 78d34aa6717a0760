#!/usr/bin/python3
"""Brackets of the frequencies of random conservative vehicles hold those of the full finite element model.

A random plane frame on springs, with rigid bodies on pins and springs, without weight and under it. By hand with more
vehicles: SPRUNG_FAMILY=1000 bracket_family_test.py
"""

import json
import math
import os
import random
import re
import unittest
from typing import NamedTuple

import h5py
import numpy as np

from verification_case import VerificationCase, run_program

COUNT = int(os.environ.get("SPRUNG_FAMILY", "100"))
GRAVITY = 9.81  # m/s²
# Under weight, frames with nearly all motions: the stiffest modes would leave no digits to the equilibrium.
MOST, MISSED = 3.0, 1e-6  # of the end of the band, of the flexibility there
END = (0.2, 0.1)  # of a rigid body, where its spring is
ROUNDING = 2e-7  # of differences of the forces, by which the vehicle's stiffness is found

FRAME = """
[materials.steel]
youngs_modulus = 2.1e11
density = 7850.0
[sections.wide]
material = "steel"
area = {area:.6g}
second_moment = {second_moment:.6g}
[sections.slender]
material = "steel"
area = {area_2:.6g}
second_moment = {second_moment_2:.6g}
[points]
{points}
{lines}
{masses}
[reference]
point = "p{reference}"
[interface]
{interface}
[reduction]
basis = "free"
highest_frequency = {highest}
tolerance = {tolerance:.6g}
[modes]
damping_ratio = 0.0
"""
BODY = """
[bodies.{name}]
mass = {mass!r}
inertia = {inertia!r}
position = [{x!r}, {y!r}]
points = {{ pin = [{pin_x!r}, {pin_y!r}], end = [{end_x}, {end_y}] }}
[[joints]]
name = "pin_{name}"
type = "revolute"
a = "frame.p{point}"
b = "{name}.pin"
"""
SPRING = """
[[forces]]
name = "{name}"
type = "spring-damper"
a = "{a}"
b = "{b}"
free_length = {length!r}
spring = {{ polynomial = [0.0, {stiffness!r}] }}
"""


class Spring(NamedTuple):
    """Between two points, each by the name of its body and its place in the drawing."""

    a: str
    place_a: tuple
    b: str
    place_b: tuple
    stiffness: float

    @property
    def length(self):
        return math.dist(self.place_a, self.place_b)


class Carried(NamedTuple):
    """A rigid body on a pin at a point of the frame."""

    point: int
    place: tuple
    mass: float
    inertia: float


class RandomVehicle:
    """A frame and what it carries. Without gravity it is in balance as it is drawn."""

    def __init__(self, seed):
        draw = self.draw = random.Random(seed)
        self.highest = 10.0 ** draw.uniform(1.3, 2.5)
        self.places = self.place_points()
        count = len(self.places)
        self.loaded = draw.sample(range(count), draw.randint(3, count - 1))
        self.reference = draw.randrange(count)
        self.design = self.write_design()
        self.bodies = [self.carry(point) for point in self.loaded[-2:]]
        self.springs = self.support() + self.join_bodies()

    def place_points(self):
        x, places = 0.0, []
        for _ in range(self.draw.randint(5, 8)):
            places.append((round(x, 3), round(self.draw.uniform(-0.4, 0.4), 3)))
            x += self.draw.uniform(0.5, 1.5)
        return places

    def carry(self, point):
        x, y = self.places[point]
        place = (round(x + self.draw.uniform(-0.5, 0.5), 3), round(y + self.draw.uniform(0.2, 0.6), 3))
        return Carried(point, place, self.draw.uniform(20.0, 500.0), self.draw.uniform(1.0, 50.0))

    def support(self):
        """Two springs from the ground to each of some points."""
        springs = []
        for point in self.loaded[: self.draw.randint(2, 3)]:
            x, y = self.places[point]
            for dx, dy in ((0.3, -1.0), (-0.8, -0.6)):
                ground = (round(x + dx, 3), round(y + dy, 3))
                stiffness = 10.0 ** self.draw.uniform(4.5, 7.5)
                springs.append(Spring("ground", ground, f"frame.p{point}", (x, y), stiffness))
        return springs

    def join_bodies(self):
        """A spring from each rigid body to a point of the frame, so that it does not turn freely."""
        springs = []
        for number, body in enumerate(self.bodies):
            end = (round(body.place[0] + END[0], 3), round(body.place[1] + END[1], 3))
            point, stiffness = self.loaded[number], 10.0 ** self.draw.uniform(4.5, 7.0)
            springs.append(Spring(f"frame.p{point}", self.places[point], f"b{number}.end", end, stiffness))
        return springs

    def write_design(self):
        """The design of the frame, without the end of its band."""
        draw, last = self.draw, len(self.places) - 1
        lines = [(i, i + 1, "wide") for i in range(last)]
        lines += [(i, i + 2, "slender") for i in range(last - 1) if draw.random() < 0.4]  # closed parts
        line = '[[lines]]\nfrom = "p{}"\nto = "p{}"\nsection = "{}"\nelements = 2\n'
        mass = '[[point_masses]]\npoint = "p{}"\nmass = {:.6g}\ninertia = 1.0\n'
        return FRAME.format(
            area=draw.uniform(2e-3, 2e-2), second_moment=draw.uniform(2e-6, 2e-4),
            area_2=draw.uniform(5e-4, 2e-3), second_moment_2=draw.uniform(1e-7, 1e-6),
            points="\n".join(f"p{i} = [{x}, {y}]" for i, (x, y) in enumerate(self.places)),
            lines="".join(line.format(*one) for one in lines),
            masses="".join(mass.format(i, draw.uniform(10.0, 200.0)) for i in draw.sample(range(last + 1), 2)),
            reference=self.reference, interface="\n".join(f'p{i} = "xy"' for i in sorted(self.loaded)),
            tolerance=draw.choice((0.3, 0.1, 0.03)), highest="HIGHEST",
        )  # fmt: skip

    def write_vehicle(self, superelement, gravity=0.0):
        """The vehicle file."""
        x, y = self.places[self.reference]
        text = f'name = "random"\ngravity = [0.0, {-gravity}]\n[bodies.frame]\nsuperelement = "{superelement}"\n'
        text += f"position = [{x}, {y}]\n[ground.points]\n"
        for number, spring in enumerate(self.springs):
            text += f"g{number} = [{spring.place_a[0]}, {spring.place_a[1]}]\n"
        for number, body in enumerate(self.bodies):
            at = self.places[body.point]
            pin = (at[0] - body.place[0], at[1] - body.place[1])
            text += BODY.format(
                name=f"b{number}", mass=body.mass, inertia=body.inertia, x=body.place[0], y=body.place[1],
                pin_x=pin[0], pin_y=pin[1], end_x=END[0], end_y=END[1], point=body.point,
            )  # fmt: skip
        for number, spring in enumerate(self.springs):
            a = f"ground.g{number}" if spring.a == "ground" else spring.a
            text += SPRING.format(name=f"s{number}", a=a, b=spring.b, length=spring.length, stiffness=spring.stiffness)
        return text

    def calc_frequencies(self, path):
        """All frequencies [Hz], from mass and stiffness of the frame with all its motions in a superelement file, by a
        method that is exact for low ones: largest eigenvalues of K⁻¹M. Coordinates: frame, modes, angle of each body;
        the pins are closed."""
        with h5py.File(path) as file:
            inertia = {name: file[f"inertia/{name}"][:] for name in ("mass", "first_moment", "second_moment", "P", "c")}
            modal_mass, modal_stiffness = file["inertia/M_ff"][:], file["matrices/stiffness"][:]
            shapes = file["modes/shape"][:]
            nodes = dict(zip(file["points/name"].asstr()[:], file["points/node"][:]))
        num_modes = len(modal_mass)
        size = 3 + num_modes + len(self.bodies)
        m, (sx, sy) = float(inertia["mass"].item()), inertia["first_moment"]
        mass, stiffness = np.zeros((size, size)), np.zeros((size, size))
        modal = slice(3, 3 + num_modes)
        mass[:3, :3] = [[m, 0.0, -sy], [0.0, m, sx], [-sy, sx, inertia["second_moment"].item()]]
        mass[:3, modal] = np.vstack([inertia["P"], inertia["c"].reshape(1, -1)])
        mass[modal, :3] = mass[:3, modal].T
        mass[modal, modal], stiffness[modal, modal] = modal_mass, modal_stiffness

        def move(point):
            """Displacement x, y of a point of the frame by the coordinates."""
            rows = np.zeros((2, size))
            x, y = np.subtract(self.places[point], self.places[self.reference])
            rows[:, :3] = [[1.0, 0.0, -y], [0.0, 1.0, x]]
            rows[:, modal] = shapes[nodes[f"p{point}"], :2]
            return rows

        def move_body(number, place):
            """Displacement of a point of a rigid body, which turns about its pin."""
            body = self.bodies[number]
            rows = move(body.point)
            x, y = np.subtract(place, self.places[body.point])
            rows[:, 3 + num_modes + number] += (-y, x)
            return rows

        def move_end(name, place):
            if name == "ground":
                return np.zeros((2, size))
            if name.startswith("frame.p"):
                return move(int(name.removeprefix("frame.p")))
            return move_body(int(name[1 : name.index(".")]), place)

        for number, body in enumerate(self.bodies):
            rows = move_body(number, body.place)
            mass += body.mass * rows.T @ rows
            mass[3 + num_modes + number, 3 + num_modes + number] += body.inertia
        for spring in self.springs:
            along = np.subtract(spring.place_b, spring.place_a) / spring.length
            row = along @ (move_end(spring.b, spring.place_b) - move_end(spring.a, spring.place_a))
            stiffness += spring.stiffness * np.outer(row, row)
        factor = np.linalg.inv(np.linalg.cholesky(stiffness))
        return 1.0 / (2.0 * np.pi * np.sqrt(np.linalg.eigvalsh(factor @ mass @ factor.T)[::-1]))


class Brackets(VerificationCase):
    def build(self, vehicles):
        """Builds the frame of each vehicle up to some frequency, with all its motions and with nearly all of them."""
        for seed, vehicle in vehicles.items():
            for name, highest in (("all", 1e7), ("most", MOST * vehicle.highest), ("band", vehicle.highest)):
                design = vehicle.design.replace("HIGHEST", f"{highest:.6g}")
                if name == "most":
                    design = re.sub("tolerance = .*", f"tolerance = {MISSED}", design)
                (self.folder / f"{name}_{seed}.toml").write_text(design, encoding="utf-8")
        designs = sorted(path.name for path in self.folder.glob("*.toml"))
        run_program([os.environ["SPRUNG_REDUCE"], "build", *designs, "--output-dir", "."], cwd=self.folder, check=True)

    def find_modes(self, vehicle, superelement, gravity, *options):
        """The modes of a vehicle, or none where its equilibrium is not found."""
        run = self.write_model(vehicle.write_vehicle(superelement, gravity), 'duration = 1.0\n[modes]\nframe = "all"\n')
        command = [os.environ["SPRUNG_DYNAMICS"], "modes", run, "--superelements", self.folder, "--json", "--quiet"]
        process = run_program([*command, *options], cwd=self.folder)
        if gravity and "no static equilibrium" in process.stderr:
            return None
        self.assertEqual(process.returncode, 0, process.stderr)
        return json.loads(process.stdout)["modes"]

    def check(self, vehicle, modes, truth, exact):
        """Whether the brackets hold the frequencies, to what these are exact to. @return their relative widths"""
        brackets = np.array([mode["bracket"] for mode in modes if "bracket" in mode])
        expected = truth[: len(brackets)]
        # What is below the end of the band has a bracket, but for what the bracket itself leaves open.
        self.assertGreaterEqual(len(brackets), np.sum(truth < 0.98 * vehicle.highest))
        self.assertTrue(np.all(brackets[:, 0] <= (1.0 + exact) * expected), (brackets, expected))
        self.assertTrue(np.all((1.0 - exact) * expected <= brackets[:, 1]), (brackets, expected))
        return list(brackets[:, 1] / brackets[:, 0] - 1.0)

    def test_they_hold_the_frequencies_of_the_full_model(self):
        vehicles = {seed: RandomVehicle(seed) for seed in range(COUNT)}
        self.build(vehicles)
        widths, num_found = {0.0: [], GRAVITY: []}, 0
        for seed, vehicle in vehicles.items():
            with self.subTest(seed=seed):
                truth = vehicle.calc_frequencies(self.folder / f"all_{seed}.h5")
                modes = self.find_modes(vehicle, f"band_{seed}", 0.0, "--bracket")
                widths[0.0] += self.check(vehicle, modes, truth, ROUNDING)
            with self.subTest(seed=seed, gravity=GRAVITY):
                full = self.find_modes(vehicle, f"most_{seed}", GRAVITY)
                modes = self.find_modes(vehicle, f"band_{seed}", GRAVITY, "--bracket")
                if full is None or modes is None:
                    continue  # stiff modes beside a soft reference node leave too few digits
                num_found += 1
                frequencies = np.array([mode["undamped_frequency"] for mode in full])
                widths[GRAVITY] += self.check(vehicle, modes, frequencies, MISSED)
        self.assertGreater(num_found, 0.9 * COUNT)
        for gravity, some in widths.items():
            if "SPRUNG_FAMILY" in os.environ:
                print(f"{gravity} m/s²: {len(some)} brackets, median {np.median(some):.1e}, widest {np.max(some):.1e}")
            self.assertGreater(len(some), 3 * COUNT)
            self.assertGreater(np.max(some), 1e-4)  # of bases that miss something


if __name__ == "__main__":
    unittest.main()
