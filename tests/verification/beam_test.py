#!/usr/bin/python3
"""Beams: frequencies of one body from stage one, and of bodies assembled in stage two, against the theory of beams.

(βL)² = ω √(μL⁴/EI): clamped–free 3.516…, free–free 22.373…, pinned–free 15.418… from cos βL cosh βL = ∓1 and
tan βL = tanh βL; the designs' √(EI/μL⁴) is 5 rad/s.
"""

import json
import math
import os
import subprocess
import unittest

import numpy as np

from verification_case import EXAMPLES, MODELS, SUPERELEMENTS, VerificationCase, run_program

UNIT = 5.0  # rad/s
LENGTH, BENDING_RIGIDITY = 2.0, 4000.0  # of these designs [m, N·m²]
CLAMPED_FREE = [3.51601527, 22.03449156, 61.69721441]
FREE_FREE = [22.37328545, 61.67282287, 120.90339173]
PINNED_FREE = [15.41820572, 49.96486203, 104.24769646]
GUIDED_FREE = [5.59332, 30.22585, 74.63888]  # tan βL + tanh βL = 0


def reduce_frequencies(path):
    """Frequencies [Hz] in a superelement."""
    process = run_program([os.environ["SPRUNG_REDUCE"], "info", "--json", path], check=True)
    return [mode["frequency_hz"] for mode in json.loads(process.stdout)["modes"]]


class Bodies(VerificationCase):
    def test_cantilever(self):
        omega = [2.0 * math.pi * f / UNIT for f in reduce_frequencies(f"{SUPERELEMENTS}/beam_at_end.h5")[:3]]
        self.assert_close(omega, CLAMPED_FREE, relative=1e-4)

    def test_cantilever_converges_at_the_order_of_the_element(self):
        # Cubic bending elements: frequencies converge with the fourth power of their length.
        errors = []
        for elements in (8, 16, 32):
            design = (MODELS / "beam_at_end.toml").read_text(encoding="utf-8")
            design = design.replace("elements = 32", f"elements = {elements}").replace("count = 20", "count = 3")
            path = self.folder / "beam.toml"
            path.write_text(design, encoding="utf-8")
            run_program([os.environ["SPRUNG_REDUCE"], "build", path, "--output-dir", self.folder], check=True)
            omega = 2.0 * math.pi * reduce_frequencies(self.folder / "beam.h5")[2] / UNIT
            errors.append(omega / CLAMPED_FREE[2] - 1.0)
        for coarse, fine in zip(errors, errors[1:]):
            self.assertAlmostEqual(math.log2(coarse / fine), 4.0, delta=0.1)

    def test_thick_cantilever_with_shear_and_rotary_inertia(self):
        # Bending and axial frequencies from an independent Timoshenko program with 128 elements.
        frequencies = reduce_frequencies(f"{SUPERELEMENTS}/timoshenko_cantilever.h5")[:5]
        self.assert_close(frequencies, [83.160, 498.406, 1297.194, 1310.905, 2378.04], relative=1e-5)


class AssembledBeams(VerificationCase):
    """A floating frame gives the frequencies of the beam as it is held in the assembled system, not those of its
    modes."""

    def test_unattached_wherever_clamped(self):
        for superelement in ("beam_at_end", "beam_inside"):
            omega, num_rigid = self.modes(
                MODELS / "unattached_beam_run.toml", "--set", f"vehicle.bodies.beam.superelement={superelement}"
            )
            self.assertEqual(num_rigid, 3)
            self.assert_close(omega[:3] / UNIT, FREE_FREE, relative=1e-4)

    def test_pinned_at_the_end(self):
        omega, num_rigid = self.modes(
            MODELS / "pinned_beam_run.toml", "--set", "vehicle.bodies.beam.superelement=beam_at_end",
            "--set", "vehicle.bodies.beam.position=[2.4243368787481967, -1.2433864639429066]",
        )
        self.assertEqual(num_rigid, 1)
        self.assert_close(omega[:3] / UNIT, PINNED_FREE, relative=1e-4)
        # Clamped elsewhere, more modes are needed for the third frequency: 40 for the same tolerance.
        omega, num_rigid = self.modes(MODELS / "pinned_beam_run.toml", "--set", "modes.beam=40")
        self.assertEqual(num_rigid, 1)
        self.assert_close(omega[:3] / UNIT, PINNED_FREE, relative=1e-4)

    def test_converges_from_above_as_modes_are_added(self):
        for case, expected in (("unattached", FREE_FREE), ("pinned", PINNED_FREE)):
            errors = [
                self.modes(MODELS / f"{case}_beam_run.toml", "--set", f"modes.beam={n}")[0][1] / UNIT / expected[1]
                - 1.0
                for n in (4, 8, 16, 32)
            ]
            for few, more in zip(errors, errors[1:]):
                self.assertGreater(few, more)
            self.assertGreater(errors[-1], 0.0)
            self.assertLess(errors[-1], errors[0] / 30.0)

    def test_all_modes_wherever_clamped_are_one_beam(self):
        # With all modes of its mesh the body behaves as the mesh, independent of where it was clamped: fixed at its
        # end it is a cantilever, on a slide across its axis it is guided–free. Eight elements: (βL/8)⁴/720 off the
        # theory, 2e-3 for the second mode.
        joint = '[[joints]]\nname = "end"\ntype = "{}"\na = "ground.end"\nb = "beam.left"\n'
        cases = {
            "fixed": (joint.format("fixed"), CLAMPED_FREE, 0),
            "slide": (joint.format("translational") + "axis = [0.0, 1.0]\n", GUIDED_FREE, 1),
            "pin": (joint.format("revolute"), PINNED_FREE, 1),
            "free": ("", FREE_FREE, 3),
        }
        self.build_coarse_beams()
        for name, (held, expected, num_rigid) in cases.items():
            found = []
            for superelement, position in (("beam_at_end", 0.0), ("beam_inside", 0.75)):
                (self.folder / "vehicle.toml").write_text(
                    f'name = "beam"\ngravity = [0.0, 0.0]\n[bodies.beam]\nsuperelement = "{superelement}"\n'
                    f"position = [{position}, 0.0]\n[ground.points]\nend = [0.0, 0.0]\n{held}", encoding="utf-8")
                (self.folder / "run.toml").write_text(
                    'vehicle = "vehicle.toml"\nduration = 1.0\n[modes]\nbeam = "all"\n', encoding="utf-8")
                omega, rigid = self.modes(self.folder / "run.toml", superelements=self.folder)
                self.assertEqual(rigid, num_rigid, name)
                found.append(omega[:4])
            self.assert_close(found[0], found[1], relative=1e-6)
            self.assert_close(found[0][:2] / UNIT, expected[:2], relative=2e-3)

    def build_coarse_beams(self):
        for name in ("beam_at_end", "beam_inside"):
            design = (MODELS / f"{name}.toml").read_text(encoding="utf-8")
            for old, new in (("elements = 32", "elements = 8"), ("elements = 10", "elements = 3"),
                             ("elements = 22", "elements = 5"), ("[0.625, 0.0]", "[0.75, 0.0]"),
                             ("count = 20", "all = true"), ("count = 40", "all = true"),
                             ("area = 0.5", "area = 0.005")):
                design = design.replace(old, new)
            (self.folder / f"{name}.toml").write_text(design, encoding="utf-8")
            build = [os.environ["SPRUNG_REDUCE"], "build", f"{name}.toml", "--output-dir", "."]
            run_program(build, cwd=self.folder, check=True)


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
        (self.folder / "vehicle.toml").write_text(COLUMN.format(joints=joints, load=load), encoding="utf-8")
        (self.folder / "run.toml").write_text(
            'vehicle = "vehicle.toml"\nduration = 1.0\n[modes]\nbeam = 12\n[stiffening]\nbeam = true\n',
            encoding="utf-8")
        return self.modes(self.folder / "run.toml")[0][0] ** 2

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

    def test_flies_apart_without_stiffening(self):
        (self.folder / "vehicle.toml").write_text(self.vehicle(), encoding="utf-8")
        (self.folder / "run.toml").write_text(
            'vehicle = "vehicle.toml"\n' + SPIN_UP_RUN.format(stiffening="false").replace("20.0", "9.0"),
            encoding="utf-8",
        )
        results = self.run_to_results(self.folder / "run.toml")
        self.assertGreater(np.max(np.abs(results["points/beam.tip/deflection"][:, 1])), 8.0)


class LoadedBeam(VerificationCase):
    """A cantilever with a load at its tip and all its modes."""

    VEHICLE = """
name = "loaded"
[bodies.beam]
superelement = "beam_at_end"
position = [0.0, 0.0]
points = { root = { node = "left" }, tip = { node = "right" } }
[[joints]]
name = "clamp"
type = "fixed"
a = "ground.origin"
b = "beam.root"
[[forces]]
name = "load"
type = "applied"
point = "beam.tip"
force = [0.0, -50.0]
"""

    def test_it_rests_and_its_energies_close(self):
        # Nothing moves: the changes of the energies are rounding, and the run must not be rejected.
        for method in ("exponential", "adams", "generalized-alpha"):
            run = f'duration = 0.05\n[modes]\nbeam = 8\n[integrator]\nmethod = "{method}"\n'
            results = self.run_text(self.VEHICLE, run)
            self.assertLess(results.summary["energy_closure"], 1e-3, method)


class UntrustedRun(VerificationCase):
    def test_a_run_whose_energies_do_not_close_ends_with_exit_code_1_and_its_results(self):
        # The pendulum with a step that is twenty times too long.
        process = subprocess.run(
            [os.environ["SPRUNG_DYNAMICS"], "run", str(EXAMPLES / "pendulum_run.toml"), "--quiet", "-o", "results.h5",
             "--set", 'integrator.method="generalized-alpha"', "--set", "integrator.fixed_step=0.05"],
            cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False,
        )
        self.assertEqual(process.returncode, 1, process.stderr)
        self.assertIn("do not trust this run", process.stderr)
        self.assertIn("energy balance", process.stdout)
        self.assertTrue((self.folder / "results.h5").is_file())


if __name__ == "__main__":
    unittest.main()
