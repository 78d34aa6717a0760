#!/usr/bin/python3
"""Response of small vehicles to the road: against closed forms and a run in time, and what is refused."""

import unittest

import h5py
import numpy as np

from response_case import ResponseCase, overrides
from verification_case import EXAMPLES, MODELS

QUARTER_CAR = EXAMPLES / "quarter_car_run.toml"
HALF_CAR = MODELS / "half_car_run.toml"

# A wheel on a massless arm under a body that slides up and down.
ARM = """
name = "massless arm"
[bodies.body]
mass = 300.0
inertia = 100.0
position = [0.0, 1.0]
points = { pivot = [0.5, -0.5], top = [0.0, -0.4] }
[bodies.arm]
mass = 0.0
inertia = 0.0
position = [0.25, 0.4]
points = { a = [0.25, 0.1], b = [-0.25, -0.1] }
[bodies.wheel]
mass = 40.0
inertia = 1.0
position = [0.0, 0.3]
[[joints]]
name = "slide"
type = "translational"
a = "ground.origin"
b = "body.origin"
axis = [0.0, 1.0]
[[joints]]
name = "pivot"
type = "revolute"
a = "body.pivot"
b = "arm.a"
[[joints]]
name = "hub"
type = "fixed"
a = "arm.b"
b = "wheel.origin"
[[forces]]
name = "spring"
type = "spring-damper"
a = "wheel.origin"
b = "body.top"
free_length = { static = 0.3 }
spring = { polynomial = [0.0, 2e4] }
damper = { coefficient = 1500.0 }
[[forces]]
name = "tyre"
type = "tyre"
wheel = "wheel.origin"
radius = 0.32
spring = { polynomial = [0.0, 2e5] }
[[forces]]
name = "rubber"
type = "bushing"
a = "body.top"
b = "wheel.origin"
free_position = [0.0, -0.3]
y = { relaxation = { stiffness = 2e4, time = 0.02 } }
"""


class QuarterCar(ResponseCase):
    """300 kg on 20 kN/m and 1500 N·s/m on 40 kg on 200 kN/m."""

    AT_20 = overrides(speed=20, vehicle__motions__way__function__polynomial="[0.0, 20.0]")

    def test_frequency_response_against_closed_form(self):
        response = self.response(QUARTER_CAR, *overrides(response__from=0.01, response__to=100))
        self.assertEqual(len(response.frequency), 1000)
        ms, mu, ks, cs, kt = 300.0, 40.0, 2e4, 1500.0, 2e5
        s = 1j * response.omega
        spring = ks + cs * s
        determinant = (ms * s**2 + spring) * (mu * s**2 + spring + kt) - spring**2
        body, wheel = spring * kt / determinant, (ms * s**2 + spring) * kt / determinant
        for name, expected in {
            "points/sprung.origin/displacement.y": body,
            "points/sprung.origin/velocity.y": s * body,
            "points/sprung.origin/acceleration.y": s**2 * body,
            "points/unsprung.origin/displacement.y": wheel,
            "forces/suspension/deflection": wheel - body,
            "forces/suspension/rate": s * (wheel - body),
            "forces/suspension/force": spring * (wheel - body),
            "forces/tyre/penetration": 1.0 - wheel,
            "forces/tyre/rate": s * (1.0 - wheel),
            "forces/tyre/force": kt * (1.0 - wheel),
        }.items():
            self.assert_close(np.abs(response[name] / expected - 1.0), 0.0, absolute=1e-7)

    def test_inertias_that_joints_hold_may_be_zero(self):
        # The carriage moves uniformly and nothing turns, so that these masses have no part in the motion.
        expected = self.response(QUARTER_CAR)
        massless = self.response(
            QUARTER_CAR,
            *overrides(
                vehicle__bodies__carriage__mass=0, vehicle__bodies__carriage__inertia=0,
                vehicle__bodies__sprung__inertia=0, vehicle__bodies__unsprung__inertia=0,
            ),
        )  # fmt: skip
        self.assertEqual(massless.report["outputs"].keys(), expected.report["outputs"].keys())
        for name in expected.report["outputs"]:
            size = np.max(np.abs(expected[name]))
            self.assert_close(massless[name], expected[name], absolute=1e-8 * size + 1e-6)

    def test_a_massless_arm_beside_a_part_that_relaxes(self):
        # A wheel on an arm under a body that slides. Expected: reactions and all else of a light arm.
        arm, light = "mass = 0.0\ninertia = 0.0\n", "mass = 1e-6\ninertia = 1e-8\n"
        self.assertIn(arm, ARM)
        run = "duration = 1.0\nspeed = 5.0\n[response]\nnumber = 3\n"
        found, expected = (self.response_text(ARM.replace(arm, given), run) for given in (arm, light))
        names = list(expected.report["outputs"])
        self.assertIn("joints/pivot/reaction.x", names)
        self.assertGreater(np.max(np.abs(expected["joints/pivot/reaction.x"])), 1e3)
        for name in names:
            with self.subTest(name):
                unit = expected.report["outputs"][name]["unit"]
                largest = max(np.max(np.abs(expected[one])) for one in names
                              if expected.report["outputs"][one]["unit"] == unit)
                self.assert_close(found[name], expected[name], absolute=1e-6 * largest)

    def test_known_transmissibilities(self):
        # Independent values, given to six digits.
        for frequency, expected in ((1.0, 1.977366), (2.0, 0.804666), (10.0, 0.148341)):
            response = self.response(QUARTER_CAR, *overrides(
                response__from=frequency, response__to=2.0 * frequency, response__number=2))
            self.assert_close(abs(response["points/sprung.origin/displacement.y"][0]), expected, absolute=6e-7)

    def test_random_road_against_the_exact_covariance(self):
        # ISO class C at 20 m/s over all frequencies, from the Lyapunov equation; the range holds all but 2e-4 of it.
        response = self.response(QUARTER_CAR, *self.AT_20, *overrides(
            response__road__class="C", response__from=1e-3, response__to=1e4))
        self.assertEqual(response.report["remarks"], [])
        self.assert_close(response.rms("points/sprung.origin/acceleration.y"), 1.4810400, relative=1e-5)
        self.assert_close(response.rms("forces/suspension/deflection"), 0.010702338, relative=1e-5)
        self.assert_close(response.rms("forces/tyre/force"), 818.7809, relative=1e-3)

    def test_spectrum_is_gain_squared_times_road(self):
        # A table of two points on the straight line of class C, cut at 1 1/m, that is 20 Hz.
        response = self.response(QUARTER_CAR, *self.AT_20, *overrides(
            response__road__table="[[0.001, 2.56], [10.0, 2.56e-8]]", response__road__band="[0.0, 1.0]"))
        name = "points/sprung.origin/acceleration.y"
        n = response.frequency / 20.0
        road = np.where(n <= 1.0, 256e-6 * (n / 0.1) ** -2.0 / 20.0, 0.0)
        self.assert_close(response.spectrum(name), np.abs(response[name]) ** 2 * road, relative=1e-9)
        inside = response.frequency <= 20.0
        self.assert_close(response.rms(name) ** 2,
                          np.trapz(response.spectrum(name)[inside], response.frequency[inside]), relative=5e-3)
        self.assert_close(np.array(response.report["road_spectrum"]), road, relative=1e-12)
        # The road's own mean square: G n₀² V (1/f₁ − 1/f₂) with the range from 0.1 Hz to where the band ends, 20 Hz.
        self.assert_close(response.report["road_rms"] ** 2, 256e-8 * 20.0 * (1.0 / 0.1 - 1.0 / 20.0), relative=1e-7)

    def test_a_random_road_of_the_run_file_is_that_of_make_road(self):
        # Both go through points of the same waves, at other distances: six and ten or more to the shortest wave. A
        # spline misses 1.6 % of that wave at most.
        eased = "class = 'C', length = 400.0, ease = 5.0, seed = 4, band = [0.011, 2.0]"
        for random, recipe in (
            (f"shape = 'random', {eased}", ("--iso-class", "C", "--length", "400", "--spacing", "0.05", "--ease", "5",
                                            "--seed", "4", "--band", "0.011", "2.0")),
            ("class = 'E', length = 150.0", ("--iso-class", "E", "--length", "150", "--spacing", "0.02")),
            ("class = 'B', length = 90.0, seed = 12345678901",
             ("--iso-class", "B", "--length", "90", "--spacing", "0.02", "--seed", "12345678901")),
            ("shape = 'random', rms = 0.02, exponent = 2.5, band = [0.05, 3.0], length = 100.0, seed = 2",
             ("--rms", "0.02", "--exponent", "2.5", "--band", "0.05", "3", "--length", "100", "--spacing", "0.02",
              "--seed", "2")),
        ):  # fmt: skip
            with self.subTest(random):
                table = self.make_road(*recipe)
                heights = [
                    self.run_to_results(QUARTER_CAR, *self.AT_20, *overrides(
                        duration=10.0, output_step=0.005, road="{ start = 1.0, " + road + " }"))
                    ["forces/tyre/road_height"] for road in (f"shape = 'table', file = '{table}'", random)
                ]  # fmt: skip
                self.assertGreater(np.std(heights[0]), 1e-3)
                self.assertLess(np.std(heights[1] - heights[0]), 1e-3 * np.std(heights[0]))

    def test_warns_where_the_wheel_does_not_roll_at_the_speed(self):
        response = self.response(QUARTER_CAR, *overrides(speed=7))
        (warning,) = response.report["warnings"]
        self.assertEqual((warning["concerns"], warning["of"]), ("response", ["tyre"]))
        self.assertIn("'tyre' rolls at 5 m/s", warning["text"])

    def test_run_over_a_random_road(self):
        # The road's components have the amplitudes of its spectrum exactly; the seed decides their phases alone.
        road = self.make_road("--iso-class", "C", "--length", "1600", "--spacing", "0.05", "--ease", "5", "--seed", "4",
                              "--band", "0.011", "2.0")
        results = self.run_to_results(QUARTER_CAR, *self.AT_20, *overrides(
            duration=80.0, output_step=0.005, road="{ shape = 'table', start = 1.0, file = '" + str(road) + "' }"))
        response = self.response(QUARTER_CAR, *self.AT_20, *overrides(
            response__road__class="C", response__road__band="[0.011, 2.0]", response__from=0.1, response__to=60))
        for name, series in {
            "points/sprung.origin/acceleration.y": results["bodies/sprung/acceleration"][:, 1],
            "points/sprung.origin/displacement.y": results["bodies/sprung/position"][:, 1] - 0.6,
            "forces/suspension/deflection": results["forces/suspension/deflection"] - 0.14715,
            "forces/tyre/force": results["forces/tyre/force"] - 340.0 * 9.81,
        }.items():
            self.assert_close(np.sqrt(np.mean(series**2)), response.rms(name), relative=0.03)


class HalfCar(ResponseCase):
    def test_wheelbase_filters_heave_and_pitch(self):
        # Wheels 2.8 m apart at 14 m/s: 0.2 s. Half a wave between them, 2.5 Hz and every 5 Hz on: no heave. A whole
        # wave, every 5 Hz: no pitch. Elsewhere both follow from one wheel's half of a quarter car.
        response = self.response(HALF_CAR, *overrides(
            response__from=0.25, response__to=25.25, response__number=101, response__spacing="linear"))
        heave, pitch = (response[f"points/beam.origin/displacement.{c}"] for c in ("y", "angle"))
        s = 1j * response.omega
        spring, tyre, mu, half = 2e4 + 1400.0 * s, 2e5 + 150.0 * s, 45.0, 1.4
        front, rear = 1.0, np.exp(-0.2 * s)

        def filtered(inertia):  # of half the beam as one wheel sees it
            return spring * tyre / ((inertia * s**2 + spring) * (mu * s**2 + spring + tyre) - spring**2)

        self.assert_close(np.abs(heave - filtered(450.0) * (front + rear) / 2.0), 0.0, absolute=1e-7)
        # The front is at −x: when it rises, the beam turns clockwise.
        self.assert_close(np.abs(pitch - filtered(1200.0 / (2.0 * half**2)) * (rear - front) / (2.0 * half)), 0.0,
                          absolute=1e-7)
        for zero in range(5):
            self.assertLess(abs(heave[np.argmin(np.abs(response.frequency - 2.5 - 5.0 * zero))]), 1e-9)
            self.assertLess(abs(pitch[np.argmin(np.abs(response.frequency - 5.0 - 5.0 * zero))]), 1e-9)
        self.assertGreater(np.max(np.abs(pitch)), 0.3)

    def test_a_lifted_wheel_is_no_input_and_is_named(self):
        spare = '''
[[forces]]
name = "spare"
type = "tyre"
wheel = "beam.origin"
radius = 0.2
spring = { polynomial = [0.0, 1.0e5] }
'''
        text = (MODELS / "half_car.toml").read_text(encoding="utf-8")
        response = self.response_text(text + spare, "speed = 14.0\nduration = 1.0\n")
        self.assertEqual(response.report["remarks"], [])
        self.assertEqual([one["text"] for one in response.report["warnings"]],
                         ["'spare' is off the ground in static equilibrium: the road does not act on it"])
        self.assert_close(response["forces/spare/force"], 0.0)
        name = "points/beam.origin/displacement.y"
        self.assert_close(np.abs(response[name] - self.response(HALF_CAR)[name]), 0.0, absolute=1e-9)


class Limits(ResponseCase):
    """Cases without a valid linear response are reported."""

    def test_a_kink_in_the_spring_at_rest_is_named(self):
        # The suspension's equilibrium is at 0.14715 m, where the stiffness is smaller on one side.
        text = (EXAMPLES / "quarter_car.toml").read_text(encoding="utf-8")
        spring = "spring = { polynomial = [0.0, 2.0e4] }"
        self.assertIn(spring, text)
        kinked = text.replace(spring, "spring = { table = [[0.0, 0.0], [0.14715, 2943.0], [0.24715, 5943.0]] }")
        response = self.response_text(kinked, "speed = 5.0\nduration = 1.0\n")
        (warning,) = response.report["warnings"]
        self.assertIn("'suspension' changes its law", warning["text"])

    def test_no_mean_square_without_damping(self):
        undamped = overrides(vehicle__forces__suspension__damper__coefficient=0, response__road__class="A")
        process = self.attempt(QUARTER_CAR, *undamped)
        self.assertEqual(process.returncode, 3, process.stdout)
        for words in ("does not converge near", "of critical damping"):
            self.assertIn(words, process.stderr)
        # Between its resonances at 1.24 and 11.8 Hz there is one.
        self.response(QUARTER_CAR, *undamped, *overrides(response__from=2, response__to=10))

    def test_refusals_say_where_and_why(self):
        cases = (
            (QUARTER_CAR, overrides(speed=0), 2, "needs a 'speed' above 0 m/s, got 0"),
            (QUARTER_CAR, overrides(start="steady"), 2, "--set 1"),
            (EXAMPLES / "pendulum_run.toml", overrides(speed=1), 2, 'of type "tyre"'),
            (HALF_CAR, overrides(vehicle__gravity="[0.0, 0.0]", vehicle__forces__front_tyre__radius=0.1,
                                 vehicle__forces__rear_tyre__radius=0.1), 3, "no wheel is on the ground"),
        )
        for run_file, arguments, code, words in cases:
            process = self.attempt(run_file, *arguments)
            self.assertEqual((process.returncode, process.stdout), (code, ""), process.stderr)
            self.assertIn(words, process.stderr)

    def test_leaves_other_files_alone(self):
        other = self.folder / "notes.txt"
        other.write_text("mine", encoding="utf-8")
        process = self.attempt(QUARTER_CAR, "-o", str(other))
        self.assertEqual(process.returncode, 2, process.stderr)
        self.assertIn("is no response file", process.stderr)
        self.assertEqual(other.read_text(encoding="utf-8"), "mine")


class ResponseFile(ResponseCase):
    def test_output_has_the_printed_values(self):
        path = self.folder / "response.h5"
        arguments = overrides(response__road__class="B", response__number=50)
        response = self.response(HALF_CAR, *arguments, "-o", str(path))
        first = path.read_bytes()
        self.response(HALF_CAR, *arguments, "-o", str(path))
        self.assertEqual(path.read_bytes(), first)
        with h5py.File(path, "r") as file:
            self.assertEqual((file.attrs["format"], file.attrs["version"]), (b"sprung-response", 1))
            self.assert_close(file["frequency"][:], response.frequency)
            self.assertEqual(list(file["inputs/name"].asstr()), ["front_tyre", "rear_tyre"])
            self.assert_close(np.diff(file["inputs/distance"][:]), [-2.8], absolute=1e-12)
            delays = np.exp(-1j * response.omega[:, None] * np.array([0.0, 0.2]))
            for name in response.report["outputs"]:
                group = file[f"outputs/{name}"]
                self.assert_close(group["response"][:] @ [1.0, 1j], response[name])
                by_wheel = group["transfer"][:] @ [1.0, 1j]
                self.assert_close(
                    np.sum(by_wheel * delays, axis=1), response[name], absolute=1e-9 * np.max(np.abs(by_wheel))
                )
                self.assert_close(group["spectrum"][:], response.spectrum(name))
                self.assertEqual(group.attrs["rms"], response.rms(name))
                for dataset in group.values():
                    self.assertIn("unit", dataset.attrs)


if __name__ == "__main__":
    unittest.main()
