#!/usr/bin/python3
"""Springs whose length in static equilibrium is given: their free lengths, and the vehicle at its ride height."""

import json
import math
import re
import unittest

import h5py
from dynamics_test_case import ROOT, DynamicsTestCase

AXLES = ("front", "rear")
TEMPLATES = ROOT / "dynamics/models/templates"
FREE_LENGTH = 0.458  # of the truck's springs, m

# A truck of rigid bodies. Its front axle is on an arm, its rear axle in a vertical slot, and its springs are inclined.
HALF_TRUCK = """
name = "half-truck"
[bodies.frame]
mass = 11950.0
inertia = 58300.0
points = { front = [-2.175, 0.0], rear = [2.175, 0.0], pivot = [-3.034, 0.0] }
position = [0.0, 0.9]
[bodies.axle_f]
mass = 540.5601500061784
inertia = 12.290846040803618
position = [-2.175, 0.4]
points = { pivot = [-0.859, 0.5], seat = [-0.1095685835431302, 0.05] }
[bodies.axle_r]
mass = 245.36888786391043
inertia = 53.23890629544538
position = [2.175, 0.4]
points = { seat = [0.18767149383317444, 0.05] }
[[joints]]
name = "arm"
type = "revolute"
a = "frame.pivot"
b = "axle_f.pivot"
[[joints]]
name = "slot"
type = "translational"
a = "frame.rear"
b = "axle_r.origin"
axis = [0.0, 1.0]
[[forces]]
name = "spring_f"
type = "spring-damper"
a = "axle_f.seat"
b = "frame.front"
free_length = { static = "as-drawn" }
spring = { polynomial = [0.0, 493236.7933074339] }
[[forces]]
name = "spring_r"
type = "spring-damper"
a = "axle_r.seat"
b = "frame.rear"
free_length = { static = "as-drawn" }
spring = { polynomial = [0.0, 316242.2965869789] }
[[forces]]
name = "tyre_f"
type = "tyre"
wheel = "axle_f.origin"
radius = 0.45
multiplicity = 2
spring = { polynomial = [0.0, 1171157.724926968] }
[[forces]]
name = "tyre_r"
type = "tyre"
wheel = "axle_r.origin"
radius = 0.45
multiplicity = 2
spring = { polynomial = [0.0, 1093480.780339047] }
"""

# A mass that a spring carries in a vertical slot.
CARRIED = """
name = "carried"
[bodies.load]
mass = 100.0
inertia = 1.0
position = [0.0, 0.5]
[[joints]]
name = "slot"
type = "translational"
a = "ground.origin"
b = "load.origin"
axis = [0.0, 1.0]
[[forces]]
name = "spring"
type = "spring-damper"
a = "ground.origin"
b = "load.origin"
free_length = { static = "as-drawn" }
spring = { SPRING }
"""


class StaticLength(DynamicsTestCase):
    def read_lengths(self, *arguments):
        """Runs. Returns each suspension's length at the start and its free length."""
        process = self.run_to_results(*arguments)
        self.assertEqual(process.returncode, 0, process.stderr)
        with h5py.File(self.results) as file:
            return {
                axle: (file[f"forces/{axle}_suspension/length"][0],
                       file[f"model/resolved/forces/{axle}_suspension/parameters"].attrs["free_length"])
                for axle in AXLES
            }  # fmt: skip

    def ask_for(self, lengths, where="vehicle.toml"):
        """Gives the two springs static lengths in place of their free lengths."""
        for axle, length in zip(AXLES, lengths):
            self.edit(where, f"free_length = {FREE_LENGTH}", f"free_length = {{ static = {length} }}  # {axle}")

    def test_the_lengths_of_a_balance_give_back_its_free_lengths(self):
        for modes in ("0", "36"):
            before = self.read_lengths("--set", f"modes.chassis={modes}")
            text = (self.folder / "vehicle.toml").read_text(encoding="utf-8")
            self.ask_for([f"{before[axle][0]:.17g}" for axle in AXLES])
            after = self.read_lengths("--set", f"modes.chassis={modes}")
            (self.folder / "vehicle.toml").write_text(text, encoding="utf-8")
            for axle in AXLES:
                self.assertAlmostEqual(after[axle][0], before[axle][0], delta=1e-9)
                self.assertAlmostEqual(after[axle][1], FREE_LENGTH, delta=1e-8)

    def test_springs_have_the_lengths_asked_for_or_those_of_the_drawing(self):
        # As drawn, the points of a suspension are 0.4 m apart.
        self.ask_for([0.37, '"as-drawn"'])
        found = self.read_lengths()
        self.assertAlmostEqual(found["front"][0], 0.37, delta=1e-8)
        self.assertAlmostEqual(found["rear"][0], 0.4, delta=1e-8)
        said = self.run_program("--set", "duration=0.01").stdout
        free = float(re.search(r"rear_suspension: free length ([0-9.]+) m gives 0\.4 m in balance", said).group(1))
        self.assertAlmostEqual(free, found["rear"][1], delta=1e-6)

    def test_equilibrium_modes_and_the_choice_of_modes_know_them(self):
        self.ask_for([0.37, 0.39])
        found = json.loads(self.run_program("--json", verb="equilibrium").stdout)
        low = json.loads(self.run_program("--json", "--set", "speed=0", verb="equilibrium").stdout)
        self.assertEqual((low.pop("set"), low["parameters"].pop("speed")), (["speed=0"], 0.0))
        self.assertEqual((found.pop("set"), found["parameters"].pop("speed")), ([], 3.0))
        self.assertEqual(found, low)
        for axle, length in zip(AXLES, (0.37, 0.39)):
            spring, solved = (found[key][f"{axle}_suspension"] for key in ("forces", "static_lengths"))
            self.assertAlmostEqual(solved["length"], length, delta=1e-9)
            self.assertAlmostEqual(spring["length"] + spring["deflection"], solved["free_length"], delta=1e-9)
        for verb in ("modes", "select-modes"):
            process = self.run_program("--quiet", "--set", 'modes.chassis="auto"', verb=verb)
            self.assertEqual(process.returncode, 0, process.stderr)

    def find_free_lengths(self, vehicle):
        """Lengths and free lengths of its springs in a balance that has to be stable."""
        (self.folder / "vehicle.toml").write_text(vehicle, encoding="utf-8")
        (self.folder / "bump.toml").write_text('vehicle = "vehicle.toml"\nduration = 1.0\n', encoding="utf-8")
        process = self.run_program("--json", verb="equilibrium")
        self.assertEqual(process.returncode, 0, process.stderr)
        found = json.loads(process.stdout)
        self.assertTrue(found["stable"])
        springs = [force for force in found["forces"].values() if "length" in force]
        return [(spring["length"], spring["length"] + spring["deflection"]) for spring in springs]

    def test_a_vehicle_that_its_springs_as_drawn_would_not_carry(self):
        """Springs without load let it fall through, and it was refused as upside down. Free lengths: of balances with
        given ones, iterated until they gave the distances drawn."""
        (front, free_front), (rear, free_rear) = self.find_free_lengths(HALF_TRUCK)
        self.assertAlmostEqual(front, math.hypot(0.1095685835431302, 0.45), delta=1e-9)
        self.assertAlmostEqual(rear, math.hypot(0.18767149383317444, 0.45), delta=1e-9)
        self.assertAlmostEqual(free_front, 0.58540018, delta=1e-8)
        self.assertAlmostEqual(free_rear, 0.68832435, delta=1e-8)

    def test_a_spring_compressed_by_more_than_its_length(self):
        """Closed form: the deflections at which the laws give the weight, 980.665 N."""
        weight = 980.665
        for law, deflection in (("polynomial = [0.0, 1500.0]", weight / 1500.0),
                                ("polynomial = [-50.0, 0.0, 0.0, 8000.0]", ((weight + 50.0) / 8000.0) ** (1 / 3)),
                                ("table = [[-1.0, 0.0], [0.0, 0.0], [0.3, 400.0], [0.8, 1200.0]]",
                                 0.3 + (weight - 400.0) / 1600.0)):  # fmt: skip
            with self.subTest(law):
                ((length, free),) = self.find_free_lengths(CARRIED.replace("SPRING", law))
                self.assertAlmostEqual(length, 0.5, delta=1e-9)
                self.assertAlmostEqual(free, 0.5 + deflection, delta=1e-8)

    def test_lengths_that_contradict_each_other_are_refused(self):
        self.ask_for([0.37, 0.39])
        with open(self.folder / "vehicle.toml", "a", encoding="utf-8") as file:
            file.write("""
[[forces]]
name = "helper"
type = "spring-damper"
a = "front_axle.origin"
b = "chassis.front_spring"
free_length = { static = 0.36 }
spring = { polynomial = [0.0, 1e5] }
""")
        process = self.run_to_results()
        self.assert_refused(process, "vehicle.toml:", "cannot be reached together with the other static lengths")
        self.assertRegex(process.stderr, r"'forces\.(helper|front_suspension)\.free_length\.static'")

    def test_the_error_stands_at_the_spring_whose_length_is_mistaken(self):
        # A length of 3 m in place of 0.25 m lets the other spring of the half car turn upside down, or makes
        # a spring within one body push without end: the one that is named is the one that was changed.
        template = (TEMPLATES / "half_car.toml").read_text(encoding="utf-8")
        run = (TEMPLATES / "half_car_run.toml").read_text(encoding="utf-8")
        (self.folder / "bump.toml").write_text(run.replace("half_car.toml", "vehicle.toml"), encoding="utf-8")
        given = "free_length = { static = 0.25 }"
        front, rear = template.index(given), template.rindex(given)
        within = """
[[forces]]
name = "within"
type = "spring-damper"
a = "body.front"
b = "body.seat"
free_length = { static = 1.0 }
spring = { polynomial = [0.0, 2e5] }
damper = { coefficient = 1e3 }
"""
        for name, text in (
            ("front_suspension", template[:front] + given.replace("0.25", "10.0") + template[front + len(given) :]),
            ("rear_suspension", template[:rear] + given.replace("0.25", "3.0") + template[rear + len(given) :]),
            ("within", template + within),
        ):
            with self.subTest(name):
                (self.folder / "vehicle.toml").write_text(text, encoding="utf-8")
                lines = text.splitlines()
                line = next(k for k in range(lines.index(f'name = "{name}"'), len(lines)) if "static" in lines[k]) + 1
                process = self.run_program(verb="equilibrium")
                self.assert_refused(process, f"vehicle.toml:{line}:", f"'forces.{name}.free_length.static'")


if __name__ == "__main__":
    unittest.main()
