#!/usr/bin/python3
"""Beams whose axial forces change their bending: rotating, under load at the end, in large motion."""

import math
import os
import unittest

import numpy as np

from bracket_rounding_test import ANTENNA, ON_SPRINGS
from beam_theory import BENDING_RIGIDITY, CLAMPED_FREE, LENGTH, UNIT
from verification_case import MODELS, SUPERELEMENTS, VerificationCase, run_program


class RotatingBeam(VerificationCase):
    def test_without_stress_stiffening_rotation_softens(self):
        # Clamped to a shaft at γ = Ω/5 rad/s, linear bending in the plane: ω̂² = 3.51601527² − γ².
        for gamma in (0.0, 1.0, 2.0, 3.0, 3.4):
            omega, num_rigid = self.modes(
                MODELS / "rotating_beam_run.toml",
                "--set", f"vehicle.motions.speed.function.polynomial=[0.3, {UNIT * gamma}]",
            )
            self.assertEqual(num_rigid, 0)
            self.assert_close((omega[0] / UNIT) ** 2, CLAMPED_FREE[0] ** 2 - gamma**2, relative=1e-4)

    def test_unstable_beyond_its_first_frequency(self):
        command = [os.environ["SPRUNG_DYNAMICS"], "modes", MODELS / "rotating_beam_run.toml"]
        speed = "vehicle.motions.speed.function.polynomial=[0.3, 18.0]"
        process = run_program([*command, "--superelements", SUPERELEMENTS, "--set", speed])
        self.assertEqual(process.returncode, 3)
        self.assertIn("unstable", process.stderr)

    def test_stress_stiffening_outweighs_it(self):
        # First frequency in the plane of rotation, γ = 4 and 10, from the theory of the rotating beam; with 6 modes.
        for gamma, expected in ((4.0, 3.8977), (10.0, 5.0490)):
            omega, num_rigid = self.modes(
                MODELS / "rotating_beam_run.toml", "--set", "stiffening.beam=true",
                "--set", f"vehicle.motions.speed.function.polynomial=[0.3, {UNIT * gamma}]",
            )
            self.assertEqual(num_rigid, 0)
            self.assert_close(omega[0] / UNIT, expected, relative=1e-3)

    def test_many_stiffened_modes_come_to_rest(self):
        # With high modes rounding limits the equilibrium.
        omega, _ = self.modes(
            MODELS / "rotating_beam_run.toml", "--set", "stiffening.beam=true", "--set", "modes.beam=20",
            "--set", f"vehicle.motions.speed.function.polynomial=[0.3, {UNIT * 10.0}]",
        )
        self.assert_close(omega[0] / UNIT, 5.0490, relative=1e-4)

    def test_what_modes_left_out_change_is_not_estimated_where_small_motion_grows(self):
        # The estimate is without stiffening: beyond 17.6 rad/s it would grow without bounds, though the beam does not.
        for speed in (12.0, 18.0):
            words = ("--set", f"vehicle.motions.speed.function.polynomial=[0.3, {speed}]", "--set", "modes.beam=2",
                     "--set", "stiffening.beam=true", "--set", "output_step=1e-2")  # fmt: skip
            results = self.run_to_results(MODELS / "rotating_beam_run.toml", *words)
            found = results.summary["modes"]["left_out_together"]
            told = [one["text"] for one in results.summary["warnings"] if "is not estimated, because" in one["text"]]
            growth_squared = speed**2 - (CLAMPED_FREE[0] * UNIT) ** 2
            if growth_squared < 0.0:
                self.assertIn("of_rms_acceleration", found)
                self.assertEqual(told, [])
                continue
            self.assert_close(found["unstable_growth"], math.sqrt(growth_squared), relative=1e-2)
            self.assertIn(f"grows by itself ({found['unstable_growth']:.3g} 1/s)", told[0])


COLUMN = """
name = "column"
gravity = [0.0, 0.0]
[bodies.beam]
superelement = "beam_at_end"
position = [0.0, 0.0]
[ground.points]
end = [2.0, 0.0]
{joints}
[[forces]]
name = "load"
type = "applied"
point = "beam.right"
force = [{load}, 0.0]
"""
CLAMPED = """
[[joints]]
name = "foot"
type = "fixed"
a = "ground.origin"
b = "beam.left"
"""
PINNED = """
[[joints]]
name = "foot"
type = "revolute"
a = "ground.origin"
b = "beam.left"
[[joints]]
name = "head"
type = "pin-in-slot"
a = "ground.end"
b = "beam.right"
axis = [1.0, 0.0]
"""


class Column(VerificationCase):
    """Buckling under a load at the end: ω² decreases to zero at Euler's load, and increases as much under tension."""

    def omega_squared(self, joints, load):
        run = self.write_model(COLUMN.format(joints=joints, load=load),
                               "duration = 1.0\n[modes]\nbeam = 12\n[stiffening]\nbeam = true\n")
        return self.modes(run)[0][0] ** 2

    def buckling_load(self, joints, euler):
        # From two loads just below it: the mode is that of buckling there, and ω² falls in proportion to what is left.
        near, nearer = 0.98 * euler, 0.99 * euler
        first, second = self.omega_squared(joints, -near), self.omega_squared(joints, -nearer)
        self.assertGreater(first, second)
        return nearer + second * (nearer - near) / (first - second)

    def test_clamped(self):
        euler = math.pi**2 * BENDING_RIGIDITY / (4.0 * LENGTH**2)
        self.assert_close(self.buckling_load(CLAMPED, euler), euler, relative=1e-4)

    def test_pinned_at_both_ends(self):
        # Its modes are clamped at one end: 12 of them bring the load to a thousandth, from above.
        euler = math.pi**2 * BENDING_RIGIDITY / LENGTH**2
        found = self.buckling_load(PINNED, euler)
        self.assertGreater(found, euler)
        self.assert_close(found, euler, relative=2e-3)

    def test_a_pinned_column_follows_the_load_linearly(self):
        # Pinned–pinned ω₁² = (π/L)⁴ EI/μ (1 − P/P_E), for pressure and tension: exact, as the mode does not change.
        euler = math.pi**2 * BENDING_RIGIDITY / LENGTH**2
        free = (math.pi**2 * UNIT) ** 2
        for share in (-2.0, -1.0, 0.0, 0.5, 0.9):
            self.assert_close(self.omega_squared(PINNED, -share * euler), free * (1.0 - share), absolute=3e-3 * free)


class SoftPendulum(VerificationCase):
    def test_falls_as_the_exact_beam_does(self):
        # The reference is geometrically exact, with shear deformation and rotary inertia; the model needs both, and
        # stiffening.
        results = self.run_to_results(MODELS / "soft_pendulum_run.toml")
        tip = results["points/beam.tip/position"]
        deflection = results["points/beam.tip/deflection"][:, 1]  # from the tangent at the root
        for time, x, y, bent in ((0.20, 0.95866, -0.28460, 1.791e-2), (0.40, 0.43244, -0.90193, 6.606e-3),
                                 (0.70, -0.86921, -0.49467, -1.256e-2), (1.00, -0.99996, -0.00496, -1.319e-2)):
            row = results.row(time)
            self.assert_close(tip[row], [x, y], absolute=1e-3)
            self.assert_close(deflection[row], bent, relative=0.05)
        self.assertLess(results.summary["energy_closure"], 1e-6)

    def test_modes_that_the_start_sets_in_motion_take_part_though_not_named(self):
        start = ["--set", "stiffening.beam=false", "--set", "duration=0.2", "--set", "output_step=1e-3",
                 "--set", "initial.beam.modal_rate=[0.0, 0.4, 0.0, 0.0, 0.0, 0.0]"]  # fmt: skip
        runs = {}
        adaptive = ["1", "--set", "adaptivity.enabled=true", "--set", "adaptivity.available.beam=6"]
        for name, modes in (("full", ["6"]), ("adaptive", adaptive)):
            results = self.run_to_results(
                MODELS / "soft_pendulum_run.toml", *start, "--set", f"modes.beam={modes[0]}", *modes[1:]
            )
            runs[name] = (results["energy/kinetic"][0], results["points/beam.tip/position"])
        self.assertGreater(runs["full"][0], 0.07)
        self.assert_close(runs["adaptive"][0], runs["full"][0], relative=1e-9)
        moved = np.abs(runs["full"][1] - [1.0, 0.0]).max()
        self.assert_close(runs["adaptive"][1], runs["full"][1], absolute=0.01 * moved)


SPIN_UP = """
name = "spin-up"
gravity = [0.0, 0.0]
monitor = ["beam.tip"]
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
function = {{ table = {table} }}
"""
SPIN_UP_RUN = """
start = "as-given"
duration = 20.0
output_step = 0.05
[modes]
beam = 4
[stiffening]
beam = {stiffening}
[integrator]
relative_tolerance = 1e-7
"""


class SpinUp(VerificationCase):
    """The manoeuvre of Kane, Ryan & Banerjee (1987): a beam is brought from rest to 6 rad/s, twice its own
    frequency."""

    def angle(self, time):
        ramp = 0.4 * (time**2 / 2.0 + (7.5 / math.pi) ** 2 * (np.cos(2.0 * math.pi * time / 15.0) - 1.0))
        return np.where(time < 15.0, ramp, 6.0 * time - 45.0)

    def vehicle(self):
        times = np.arange(0.0, 30.0, 0.1)  # beyond the end of the run, where a table is constant
        return SPIN_UP.format(table=[[float(t), float(a)] for t, a in zip(times, self.angle(times))])

    def test_lags_behind_and_comes_back(self):
        # Reference: a chain of rigid links with springs between them, 16 and 32 of them, extrapolated by the square of
        # their length (own). Terms of third order in the slope, 0.15 rad, are what differs.
        results = self.run_text(self.vehicle(), SPIN_UP_RUN.format(stiffening="true"))
        angle = self.angle(results.time)
        tip = results["points/beam.tip/position"]
        along = np.cos(angle) * tip[:, 0] + np.sin(angle) * tip[:, 1] - 8.0
        across = -np.sin(angle) * tip[:, 0] + np.cos(angle) * tip[:, 1]
        for time, shortening, lag in ((5.0, -0.02803, -0.62314), (6.55, -0.04036, -0.75052),
                                      (7.5, -0.03552, -0.70699), (10.0, -0.01328, -0.43729)):
            row = results.row(time)
            self.assert_close(across[row], lag, relative=0.01)
            self.assert_close(along[row], shortening, relative=0.02)
        self.assert_close(np.min(across), -0.75052, relative=0.01)
        # Afterwards it is straight except for a remaining vibration of one to two hundredths of the lag.
        self.assertLess(np.max(np.abs(across[results.time > 16.0])), 0.015)
        self.assertLess(results.summary["energy_closure"], 1e-6)

    def test_a_beam_clamped_at_its_middle_and_driven_at_its_root_does_not_pass_quietly(self):
        # Its modes leave its middle straight and unmoved, and have no moment at the root: they are 36 and 11 % off in
        # the largest lag. Those clamped at the root are right.
        design = (MODELS / "spin_up_beam.toml").read_text(encoding="utf-8")
        for old, new in (("root = [0.0, 0.0]", "root = [-4.0, 0.0]\nmiddle = [0.0, 0.0]"), ("[8.0,", "[4.0,"),
                         ('["root", "tip"]', '["root", "middle", "tip"]'), ("elements = 16", "elements = 8"),
                         ('point = "root"', 'point = "middle"'), ("count = 4", "count = 20")):
            self.assertEqual(design.count(old), 1, old)
            design = design.replace(old, new)
        (self.folder / "spin_up_beam.toml").write_text(design, encoding="utf-8")
        build = [os.environ["SPRUNG_REDUCE"], "build", "spin_up_beam.toml", "--output-dir", "."]
        run_program(build, cwd=self.folder, check=True)
        for modes, off, superelements in ((4, 0.36, self.folder), (16, 0.11, self.folder), (4, 0.0, SUPERELEMENTS)):
            vehicle = self.vehicle()
            if off > 0.0:
                vehicle = vehicle.replace("position = [0.0, 0.0]", "position = [4.0, 0.0]")
            run = SPIN_UP_RUN.format(stiffening="true").replace("beam = 4", f"beam = {modes}").replace("20.0", "8.0")
            results = self.run_to_results(self.write_model(vehicle, run), superelements=superelements)
            angle = self.angle(results.time)
            tip = results["points/beam.tip/position"]
            lag = np.max(np.sin(angle) * tip[:, 0] - np.cos(angle) * tip[:, 1])
            self.assertAlmostEqual(lag / 0.7566, 1.0 - off, delta=0.01)
            warnings = [one["text"] for one in results.summary["warnings"] if "its modes miss" in one["text"]]
            self.assertEqual(bool(warnings), off > 0.0, warnings)
            self.assertEqual(results.summary["sections"]["beam"]["missing_moment_share"] > 0.05, off > 0.0)

    def test_flies_apart_without_stiffening(self):
        results = self.run_text(self.vehicle(), SPIN_UP_RUN.format(stiffening="false").replace("20.0", "9.0"))
        self.assertGreater(np.max(np.abs(results["points/beam.tip/deflection"][:, 1])), 8.0)
        self.assertRegex(" ".join(text.decode() for text in results["warnings/text"]), r"beam: .*set stiffening")

    def test_a_motion_without_bounds_ends_with_its_reason(self):
        # It took 36 million steps up to 12.4 s, where the tip was 1e8 m away.
        for method in ("exponential", "adams"):
            self.write_model(self.vehicle(), SPIN_UP_RUN.format(stiffening="false") + f'method = "{method}"\n')
            command = [os.environ["SPRUNG_DYNAMICS"], "run", "run.toml", "--superelements", SUPERELEMENTS]
            process = run_program(command, cwd=self.folder)
            self.assertEqual(process.returncode, 3, process.stderr)
            self.assertRegex(process.stderr, r"beam deflects by 1\d\.?\d* times its length at t = (8|9)\.")
            self.assertIn("set stiffening.beam = true", process.stderr)


class SoftPart(VerificationCase):
    """A beam on springs with a rod on its middle, at whose tip the body frame sits."""

    def test_a_part_that_axial_forces_could_move_far_and_do_not_says_nothing_of_the_bending(self):
        # With stiffening the frequencies change by 0.2 % at most.
        rod = ("outer_diameter = 0.006", "outer_diameter = 0.02"), ("wall = 0.003", "wall = 0.01")
        bases = {"free": 'basis = "free"', "clamped": 'basis = "clamped"', "fixed": 'basis = "fixed-interface"'}
        for name, basis in bases.items():
            design = ANTENNA.format(reference="tip").replace('basis = "free"', basis)
            for old, new in rod:
                design = design.replace(old, new)
            if name == "clamped":
                design = design.replace("[modes]", "[modes]\ncount = 10")
            if name != "free":
                design = design.replace("tolerance = 0.01", "")
            (self.folder / f"{name}.toml").write_text(design, encoding="utf-8")
        designs = [f"{name}.toml" for name in bases]
        run_program([os.environ["SPRUNG_REDUCE"], "build", *designs, "--output-dir", "."], cwd=self.folder, check=True)
        for name in bases:
            with self.subTest(name):
                vehicle = ON_SPRINGS.format(name=name, x=2.0, y=1.0, rate=1e6).replace("[0.0, 0.0]", "[0.0, -9.81]", 1)
                run = self.write_model(vehicle, 'duration = 0.1\n[modes]\nframe = "all"\n')
                effect = self.program("run", run, superelements=self.folder)["bending"]["frame"]["axial_effect"]
                self.assertLess(effect, 0.01)
                for verb in ("run", "modes", "equilibrium"):
                    texts = [one["text"] for one in self.program(verb, run, superelements=self.folder)["warnings"]]
                    self.assertFalse([one for one in texts if "axial forces" in one], texts)


if __name__ == "__main__":
    unittest.main()
