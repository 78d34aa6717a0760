#!/usr/bin/python3
"""Response where it is not that of the vehicle: stops, springs that bend, modes that are missing, no waves."""

import os
import re
import unittest
from pathlib import Path

import h5py
from response_case import ResponseCase, overrides
from scipy.stats import norm
from verification_case import EXAMPLES

QUARTER_CAR = EXAMPLES / "quarter_car_run.toml"
AT_REST = 0.14715  # deflection of the suspension [m]
STIFFNESS = 2e4
SPRING = "spring = { polynomial = [0.0, 2.0e4] }"
ON_ROAD = overrides(speed=20, vehicle__motions__way__function__polynomial="[0.0, 20.0]", response__road__class="C")
TRUCK = Path(__file__).resolve().parents[2] / "dynamics/models/truck/bump.toml"


class QuarterCar(ResponseCase):
    """On class C at 20 m/s the deflection of the suspension varies by 10.7 mm r.m.s."""

    def write(self, old, new):
        vehicle = (EXAMPLES / "quarter_car.toml").read_text(encoding="utf-8")
        self.assertIn(old, vehicle)
        return self.write_model(vehicle.replace(old, new, 1), "speed = 20.0\nduration = 1.0\n")

    def list_texts(self, run, *arguments):
        return [one["text"] for one in self.response(run, *ON_ROAD, *arguments).report["warnings"]]

    def test_stops_within_three_deviations_are_named(self):
        for stop, distance, is_reached in (
            ("compression", 0.030, True), ("compression", 0.035, False),
            ("rebound", -0.030, True), ("rebound", -0.035, False),
        ):  # fmt: skip
            with self.subTest(stop=stop, distance=distance):
                run = self.write(SPRING, f"{SPRING}\n{stop}_stop = {{ deflection = {AT_REST + distance}, rate = 2e5 }}")
                path = self.folder / "stop.h5"
                texts = self.list_texts(run, "-o", path)
                if not is_reached:
                    self.assertEqual(texts, [])
                    continue
                (text,) = texts
                self.assertTrue(text.startswith(f"'suspension' reaches its {stop} stop now and then"), text)
                self.assertIn("0.0107 m r.m.s. about 0.1472 m at rest", text)
                self.assertIn(f"the stop begins at {AT_REST + distance:.4g} m", text)
                with h5py.File(path, "r") as file:
                    self.assertEqual(list(file["warnings/text"].asstr()), [text])
                printed = self.attempt(run, *ON_ROAD)
                self.assertIn(f"warning: {text}\n", printed.stdout)

    def test_a_hydraulic_stop_is_named(self):
        run = self.write("[[forces]]", '''[[forces]]
name = "catch"
type = "hydraulic-stop"
a = "unsprung.origin"
b = "sprung.origin"
contact_length = 0.28
spring = { polynomial = [0.0, 1e5] }
[[forces]]''')
        (text,) = self.list_texts(run)
        self.assertTrue(text.startswith("'catch' reaches its stop now and then"), text)

    def test_a_spring_that_bends_within_its_motion_is_named(self):
        # Three times as stiff beyond a kink: E[F′] = k (1 + 2 P(x > kink)) for a normal x.
        rms = self.response(QUARTER_CAR, *ON_ROAD).rms("forces/suspension/deflection")
        for deviations, is_bent in ((1.0, True), (2.5, False)):
            with self.subTest(deviations=deviations):
                kink = AT_REST + deviations * rms
                points = [[0.0, 0.0], [kink, STIFFNESS * kink], [kink + 0.1, STIFFNESS * (kink + 0.3)]]
                texts = self.list_texts(self.write(SPRING, f"spring = {{ table = {points} }}"))
                mean = STIFFNESS * (1.0 + 2.0 * norm.sf(deviations))
                self.assertEqual([f": {mean:.4g} N/m in the mean" in text for text in texts], [True] * is_bent)

    def test_a_road_without_waves_in_the_range_is_told(self):
        # Waves of 1 to 2 per metre at 20 m/s: 20 to 40 Hz.
        band = overrides(response__road__band="[1.0, 2.0]")
        self.assertEqual(self.list_texts(QUARTER_CAR, *band), [])
        self.assertEqual(
            self.list_texts(QUARTER_CAR, *band, *overrides(response__to=19)),
            ["at 20 m/s no wave of the road in response.road lies between 0.1 and 19 Hz: all r.m.s. values are 0"],
        )


class Modes(ResponseCase):
    FLEXIBLE = ("chassis", "front_long_arm", "rear_long_arm")
    NARROW = overrides(response__number=2, response__to=30, response__road__class="C")

    def respond(self, *arguments, run=TRUCK):
        return self.response(run, *arguments, superelements=os.environ["SPRUNG_TRUCK_SUPERELEMENTS"]).report

    def list_missing(self, *arguments):
        report = self.respond(*arguments)
        return report, [one for one in report["warnings"] if "modes are missing" in one["text"]]

    def test_the_output_that_misses_most_is_named(self):
        all_modes = overrides(**{f"modes__{body}": '"all"' for body in self.FLEXIBLE})
        full, none = self.list_missing(*self.NARROW, *all_modes)
        self.assertEqual(none, [])
        report, (warning,) = self.list_missing(*self.NARROW, *overrides(modes__chassis=2))
        (name,) = warning["of"]
        self.assertIn("chassis (2 of ", warning["text"])
        # Expected: the responses of both vehicles, about their own equilibria and by the adaptive integral.
        change = report["outputs"][name]["rms"] / full["outputs"][name]["rms"] - 1.0
        words = re.search(r"the r.m.s. value of (\S+) is (\S+) % too (large|small)", warning["text"])
        self.assertEqual((words[1], words[3]), (name, "large" if change > 0.0 else "small"))
        self.assert_close(float(words[2]), 100.0 * abs(change), relative=0.02, absolute=0.2)
        self.assertGreater(abs(change), 0.05)

    def test_without_a_road_the_transfer_functions_are_compared(self):
        _, (warning,) = self.list_missing(*overrides(response__number=2, response__to=30, modes__chassis=2))
        self.assertIn("the transfer function of ", warning["text"])

    def test_modes_auto_are_chosen_from_the_road_of_the_response(self):
        automatic = overrides(modes__chassis='"auto"')
        flat = overrides(road='{ shape = "flat" }')
        first, second = (self.respond(*self.NARROW, *automatic, *road) for road in ((), flat))
        line = first["remarks"][0]
        self.assertTrue(line.startswith("Modes chosen from the road of [response.road], "), line)
        self.assertEqual(second["remarks"][0], line)
        numbers = [mode["number"] for mode in first["mode_choice"]["modes"] if mode["kept"]]
        self.assertGreater(len(numbers), 0)
        self.assertTrue(line.endswith(": " + ", ".join(f"chassis {number}" for number in numbers)), line)
        other = self.respond(*overrides(response__number=2, response__to=30), *automatic, *flat)["remarks"]
        self.assertTrue(other[0].startswith("Modes chosen from the road of [road], "), other)
        still = "neither road nor forces in time move the vehicle"
        self.assertEqual([any(still in one for one in remarks) for remarks in (other, first["remarks"])],
                         [True, False])

    def test_forces_in_time_have_no_part_in_the_choice_for_a_response(self):
        vehicle = (TRUCK.parent / "vehicle.toml").read_text(encoding="utf-8")
        force = '\n[[forces]]\nname = "engine"\ntype = "applied"\npoint = "chassis.seat"\nforce = [0.0, {}]\n'
        run = TRUCK.read_text(encoding="utf-8").replace('vehicle = "vehicle.toml"', "")
        choices = []
        for value in ("0.0", "{ harmonic = { amplitude = 1e5, frequency = 3.0 } }"):
            path = self.write_model(vehicle + force.format(value), run)
            report = self.respond(*self.NARROW, *overrides(modes__chassis='"auto"'), run=path)
            choices.append(report["mode_choice"])
        self.assertEqual(*choices)


if __name__ == "__main__":
    unittest.main()
