#!/usr/bin/python3
"""Forces and moments along the beams of a body: exact where they follow from the loads, for any number of modes."""

import os
import unittest

import h5py
import numpy as np

from verification_case import ROOT, SUPERELEMENTS, VerificationCase, run_program

BUMP = ROOT / "dynamics/models/truck/bump.toml"
TRUCK_SUPERELEMENTS = os.environ["SPRUNG_TRUCK_SUPERELEMENTS"]

PUSHED = """
name = "pushed beam"
gravity = [1.5, -9.81]
[bodies.beam]
superelement = "beam_inside"
position = [3.0, -1.0]
angle = 0.4
[[forces]]
name = "push"
type = "applied"
point = "beam.left"
axes = "following"
force = [-30.0, 50.0]
"""
SWUNG = """
name = "swung beam"
gravity = [0.0, -9.81]
[bodies.beam]
superelement = "spin_up_beam"
position = [0.0, 0.0]
[[joints]]
name = "shaft"
type = "revolute"
a = "ground.origin"
b = "beam.root"
[[motions]]
name = "speed"
joint = "shaft"
function = {{ harmonic = {{ amplitude = {amplitude}, frequency = 0.8 }} }}
"""
SUPPORTED = """
name = "chassis on two supports"
[bodies.chassis]
superelement = "chassis"
position = [0.0, 0.0]
[ground.points]
front = [-2.175, 0.0]
rear = [2.175, 0.0]
[[joints]]
name = "pin"
type = "revolute"
a = "ground.front"
b = "chassis.front_spring"
[[joints]]
name = "slot"
type = "pin-in-slot"
axis = [1.0, 0.0]
a = "ground.rear"
b = "chassis.rear_spring"
"""
CANTILEVER = """
name = "cantilever"
gravity = [0.0, 0.0]
[bodies.beam]
superelement = "beam_at_end"
position = [0.0, 0.0]
[ground.points]
wall = [2.0, 0.0]
[[joints]]
name = "wall"
type = "fixed"
a = "ground.{wall}"
b = "beam.{held}"
[[forces]]
name = "load"
type = "applied"
point = "beam.{loaded}"
force = [0.0, -10.0]
"""
RUN = """
start = "as-given"
duration = 0.5
output_step = 0.01
[integrator]
relative_tolerance = 1e-8
[modes]
beam = {modes}
"""


def place_gauss_points():
    """Places and weights of a quadrature on 0 … 1, exact to degree 9."""
    places, weights = np.polynomial.legendre.leggauss(5)
    return 0.5 * (places + 1.0), 0.5 * weights


def interpolate(ends, xi, length):
    """A displacement (u, w) in an element along x from (x, y, rotation) of both ends [6×…] at xi: linear, cubic."""
    u = (1.0 - xi) * ends[0] + xi * ends[3]
    w = (
        (1.0 - 3.0 * xi**2 + 2.0 * xi**3) * ends[1] + length * (xi - 2.0 * xi**2 + xi**3) * ends[2]
        + (3.0 * xi**2 - 2.0 * xi**3) * ends[4] + length * (xi**3 - xi**2) * ends[5]
    )  # fmt: skip
    return u, w


class FromLoads(VerificationCase):
    def test_a_free_rigid_beam_pushed_at_its_end_has_the_exact_distribution(self):
        # A force F across and H along at s = 0 accelerates it by F/m (4 − 6 s/L) and H/m relative to free fall:
        # M = F s (1 − s/L)², Q = −M′, N = −H (1 − s/L). Weight causes nothing, and the angular velocity ω adds
        # N = m/L ω² s (L − s)/2, the tension between two ends that fly apart.
        results = self.run_text(PUSHED, RUN.format(modes=0))
        length, mass, push, pull = 2.0, 20.0, 50.0, -30.0
        station = results["recovery/beam/station"][:, 0] + 0.625
        x = station / length
        omega = results["bodies/beam/velocity"][:, 2][:, np.newaxis]
        self.assertGreater(np.max(np.abs(omega)), 3.0)
        axial = -pull * (1.0 - x) + 0.5 * mass / length * omega**2 * station * (length - station)
        self.assert_close(results["recovery/beam/axial_from_loads"], axial, absolute=1e-7 * np.max(np.abs(axial)))
        shear, moment = -push * (1.0 - x) * (1.0 - 3.0 * x), push * length * x * (1.0 - x) ** 2
        for name, expected in (("shear", shear), ("moment", moment)):
            found = results[f"recovery/beam/{name}_from_loads"]
            self.assert_close(found, np.tile(expected, (len(found), 1)), absolute=1e-6 * np.max(np.abs(expected)))
        self.assertNotIn("recovery/beam/moment", results.file)
        summary = results.summary["sections"]["beam"]["moment"]["from_loads"]
        self.assertAlmostEqual(summary["value"], push * length * 4.0 / 27.0, delta=0.02)  # near L/3
        self.assertAlmostEqual(summary["position"][0] + 0.625, length / 3.0, delta=0.05)
        self.assertEqual(set(results.summary["sections"]["beam"]["moment"]), {"from_loads"})

    def test_every_cut_is_in_equilibrium_with_the_motion_beyond_it_whatever_the_modes(self):
        # The accelerations of all points beyond a cut, from frame, modes and their rates; masses times these are
        # summed along the beam by quadrature. Nothing of the superelement but its shapes is used.
        with h5py.File(f"{SUPERELEMENTS}/spin_up_beam.h5") as file:
            shapes = file["modes/shape"][:]
            x = file["nodes/position"][:, 0]
            elements = file["elements/node"][:]
        per_length = 2766.67 * 7.2968e-5
        xi, weights = place_gauss_points()
        for modes in (1, 4):
            results = self.run_text(SWUNG.format(amplitude=0.3), RUN.format(modes=modes))
            frame, rate, turning = (results[f"bodies/beam/{name}"] for name in ("position", "velocity", "acceleration"))
            eta, eta_dot, eta_ddot = (
                np.einsum("nik,tk->nit", shapes[:, :, :modes], results[f"bodies/beam/modal/{name}"])
                for name in ("amplitude", "rate", "acceleration")
            )
            omega, alpha = rate[:, 2], turning[:, 2]
            cos, sin = np.cos(frame[:, 2]), np.sin(frame[:, 2])
            a_x = cos * turning[:, 0] + sin * (turning[:, 1] + 9.81)
            a_y = cos * (turning[:, 1] + 9.81) - sin * turning[:, 0]
            force = np.zeros((2, len(results.time)))  # of everything beyond the cut, and its moment about the cut
            moment = np.zeros(len(results.time))
            worst = 0.0
            for element in range(len(elements) - 1, -1, -1):
                first, last = elements[element]
                length = x[last] - x[first]
                moment += length * force[1]
                for place, weight in zip(xi, weights):
                    (u, w), (u1, w1), (u2, w2) = (
                        interpolate(np.concatenate([nodal[first], nodal[last]]), place, length)
                        for nodal in (eta, eta_dot, eta_ddot)
                    )
                    at = x[first] + place * length
                    dm = weight * length * per_length
                    load = -dm * np.array([
                        a_x - alpha * w - omega**2 * (at + u) - 2.0 * omega * w1 + u2,
                        a_y + alpha * (at + u) - omega**2 * w + 2.0 * omega * u1 + w2,
                    ])  # fmt: skip
                    force += load
                    moment += place * length * load[1]
                found = {
                    name: results[f"recovery/beam/{name}_from_loads"][:, 2 * element]
                    for name in ("axial", "shear", "moment")
                }
                worst = max(worst, np.max(np.abs(found["moment"] - moment)))
                self.assert_close(found["axial"], force[0], absolute=1e-6 * np.max(np.abs(force[0])))
                self.assert_close(found["shear"], force[1], absolute=1e-6 * np.max(np.abs(force[1])))
            self.assertLess(worst, 1e-6 * np.max(np.abs(moment)))

    def test_a_beam_on_two_supports_under_its_weight_has_the_textbook_moments_both_ways(self):
        # The truck's chassis, half length h, supports at ±a: M = −w (h − |x|)²/2, and w h (a − |x|) more between them.
        # All modes together are the finite element solution, whose resultants lack the load on one element, w l²/12.
        results = self.run_to_results(
            self.write_model(SUPPORTED, 'duration = 0.002\n[modes]\nchassis = "all"\n'),
            superelements=TRUCK_SUPERELEMENTS,
        )
        x = results["recovery/chassis/station"][:, 0]
        half, weight, support = 3.8257, 1561.8057 * 9.80665, 2.175
        moment = -0.5 * weight * (half - np.abs(x)) ** 2 + weight * half * np.maximum(support - np.abs(x), 0.0)
        lengths = np.repeat(np.abs(np.diff(x)[::2]), 2)
        size = np.max(np.abs(moment))
        self.assert_close(results["recovery/chassis/moment_from_loads"][0], moment, absolute=1e-5 * size)
        from_modes = moment + weight * lengths**2 / 12.0
        self.assert_close(results["recovery/chassis/moment"][0], from_modes, absolute=1e-5 * size)
        self.assertLess(results.summary["sections"]["chassis"]["missing_moment_share"], 1e-4)


def find_warnings(text):
    return [line for line in text.splitlines() if line.startswith("warning: ")]


class Warnings(VerificationCase):
    def warn(self, verb, vehicle, run, *arguments):
        """The warnings in what a command prints."""
        self.write_model(vehicle, run)
        process = run_program(
            [os.environ["SPRUNG_DYNAMICS"], verb, "run.toml", "--superelements", SUPERELEMENTS, "--quiet", *arguments],
            cwd=self.folder, check=True,
        )  # fmt: skip
        return find_warnings(process.stdout)

    # A cantilever that is held at one end and loaded at the other: modes clamped at the loaded end have no moment
    # where the beam is held.
    def test_a_cantilever_clamped_where_it_is_loaded_misses_moments_in_every_command(self):
        vehicle = CANTILEVER.format(wall="wall", held="right", loaded="left")
        for verb in ("run", "equilibrium", "modes"):
            found, *_ = self.warn(verb, vehicle, "duration = 0.01\n[modes]\nbeam = 4\n")
            self.assertRegex(
                found,
                r"^warning: beam: its modes miss \d+(\.\d+)? % of the largest bending moment \(at x = ",
            )
        vehicle = CANTILEVER.format(wall="origin", held="left", loaded="right")
        self.assertEqual(self.warn("equilibrium", vehicle, "duration = 0.01\n[modes]\nbeam = 16\n"), [])

    def test_a_beam_driven_at_its_root_and_clamped_inside_misses_moments_with_few_and_with_many_modes(self):
        for superelement, expected in (("beam_inside", True), ("beam_at_end", False)):
            vehicle = SWUNG.format(amplitude=0.02).replace("spin_up_beam", superelement)
            for modes in (4, 16):
                found = self.warn("run", vehicle.replace("beam.root", "beam.left"), RUN.format(modes=modes))
                missed = [line for line in found if "its modes miss" in line]
                self.assertEqual(bool(missed), expected, (superelement, modes, found))

    def test_rounding_errors_are_no_missing_moments(self):
        # Free fall has no moments, and pure tension has none either.
        free = CANTILEVER.format(wall="origin", held="left", loaded="right").replace("-10.0", "0.0")
        joint = free[free.index("[[joints]]"):free.index("[[forces]]")]
        pulled = CANTILEVER.format(wall="origin", held="left", loaded="right")
        pulled = pulled.replace("force = [0.0, -10.0]", "force = [1000.0, 0.0]")
        for vehicle in (free.replace(joint, "").replace("gravity = [0.0, 0.0]", "gravity = [0.0, -9.8]"), pulled):
            found = self.warn("run", vehicle, 'start = "as-given"\nduration = 0.05\n[modes]\nbeam = 4\n')
            self.assertFalse([line for line in found if "bending moment" in line], found)


class Truck(VerificationCase):
    def run_truck(self, modes, *arguments, duration=1.5):
        span = ("--set", f"duration={duration}", "--set", f"statistics.to={duration}")
        return self.run_to_results(
            BUMP, "--set", f"modes.chassis={modes}", *span, *arguments, superelements=TRUCK_SUPERELEMENTS
        )

    def largest_moment(self, *arguments, **options):
        moment = self.run_truck(*arguments, **options).summary["sections"]["chassis"]["moment"]
        return abs(moment["from_loads"]["value"])

    def test_the_static_moment_does_not_depend_on_the_number_of_modes(self):
        truth = self.run_truck(36, duration=0.001)["recovery/chassis/moment_from_loads"][0]
        for modes in (0, 2, 4, 8):
            found = self.run_truck(modes, duration=0.001)["recovery/chassis/moment_from_loads"][0]
            self.assert_close(found, truth, absolute=0.005 * np.max(np.abs(truth)))

    def test_too_few_modes_are_told_by_their_moments(self):
        for modes, is_told in ((2, True), (4, True), (36, False)):
            warnings = [one["text"] for one in self.run_truck(modes, duration=1.0).summary["warnings"]]
            told = [text for text in warnings if "of the largest bending moment (at x = " in text]
            self.assertEqual(bool(told), is_told, warnings)

    def test_four_modes_give_the_largest_moment_over_the_bump(self):
        truth = self.largest_moment(36)
        self.assert_close(self.largest_moment(4), truth, relative=0.03)
        certified = ("--set", "vehicle.bodies.chassis.superelement=chassis_certified")
        self.assert_close(self.largest_moment('"certified"', *certified), truth, relative=0.01)


if __name__ == "__main__":
    unittest.main()
