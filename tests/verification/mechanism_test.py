#!/usr/bin/python3
"""Mechanisms of rigid bodies: the examples, each against numbers from elsewhere."""

import os
import unittest

import h5py
import numpy as np

from verification_case import EXAMPLES, MODELS, VerificationCase, run_program


class Andrews(VerificationCase):
    """Angles at the end: an independent calculation by two formulations, and for β the source's 15.81077119629904."""

    def test_squeezing_mechanism(self):
        results = self.run_to_results(EXAMPLES / "andrews_run.toml")
        angle = {name: results[f"bodies/{name}/position"][:, 2] for name in results.file["bodies"]}
        self.assert_close(results["bodies/K1/acceleration"][0, 2], 14222.4439199541, relative=1e-12)
        last = {name: values[-1] for name, values in angle.items()}
        beta, delta, epsilon = last["K1"], last["K5"], last["K7"]
        self.assert_close(
            [beta, last["K2"] - beta, last["K3"], last["K4"] - delta, delta, epsilon],
            [15.81077119515, -15.75637105841, 0.040822240119, -0.53473011634, 0.52440996588, 1.04808074102],
            absolute=1e-7,
        )
        self.assert_close(results["bodies/K1/velocity"][-1, 2], 1139.92030226, relative=1e-6)
        stored = results.energy()
        work = 0.033 * (angle["K1"] - angle["K1"][0])
        self.assert_close(stored - stored[0], work, absolute=1e-8)
        self.assert_close(results["energy/input"], work, absolute=1e-8)
        self.assertLess(results.summary["constraint_violation"], 1e-10)


class Pendulum(VerificationCase):
    def test_simple_pendulum(self):
        results = self.run_to_results(EXAMPLES / "pendulum_run.toml")
        position = results["bodies/bob/position"][:, :2]
        self.assert_close(position[results.row(10.0)], [0.2750874625761, -0.9614192050991], absolute=1e-5)
        self.assert_close(position[results.row(100.0)], [0.1815133514, -0.9833884803], absolute=1e-3)
        # The link carries weight and centripetal force: along it, m (g cos + v²/L), away from the pin on point a.
        pull = results["joints/link/reaction"][:, :2]
        velocity = results["bodies/bob/velocity"][:, :2]
        expected = (-9.81 * position[:, 1] + np.sum(velocity**2, axis=1))[:, None] * position
        self.assert_close(pull, expected, absolute=1e-4)


class FourBar(VerificationCase):
    def test_positions_and_drive(self):
        results = self.run_to_results(EXAMPLES / "four_bar_run.toml")
        crank = 10.0 * results.time
        self.assert_close(results["bodies/crank/position"][:, 2], crank, absolute=1e-12)
        # Rocker: the end of the crank and the rocker's pin are two points from which the last joint is at 0.5, 0.4 m.
        end = 0.2 * np.column_stack([np.cos(crank), np.sin(crank)])
        span = np.array([0.5, 0.0]) - end
        length = np.hypot(span[:, 0], span[:, 1])
        along = (length**2 + 0.5**2 - 0.4**2) / (2.0 * length)
        across = np.sqrt(0.5**2 - along**2)
        unit = span / length[:, None]
        joint = end + along[:, None] * unit + across[:, None] * np.column_stack([-unit[:, 1], unit[:, 0]])
        self.assert_close(results["points/coupler.far/position"], joint, absolute=1e-9)
        # All freedoms are driven: the work of the motor is the change of the stored energy.
        power = results["joints/motor/drive"] * 10.0
        self.assert_close(results["joints/motor/rate"], 10.0, relative=1e-12)
        step = results.time[1] - results.time[0]
        stored = results.energy()
        rate = (8.0 * (stored[3:-1] - stored[1:-3]) - (stored[4:] - stored[:-4])) / (12.0 * step)
        self.assert_close(power[2:-2], rate, absolute=1e-6 * np.max(np.abs(rate)))
        self.assertLess(results.summary["energy_closure"], 1e-6)

    def test_a_mechanism_without_freedom_runs_by_every_method(self):
        expected = self.run_to_results(EXAMPLES / "four_bar_run.toml", "--set", "integrator.method=adams")
        reactions = expected["joints/coupler_rocker/reaction"]
        for method in ("exponential", "bdf", "generalized-alpha"):
            results = self.run_to_results(EXAMPLES / "four_bar_run.toml", "--set", f"integrator.method={method}")
            self.assert_close(results["joints/coupler_rocker/reaction"], reactions, absolute=1e-8)


class SliderCrank(VerificationCase):
    def test_piston_and_reactions(self):
        results = self.run_to_results(EXAMPLES / "slider_crank_run.toml")
        angle = results["bodies/crank/position"][:, 2]
        piston = results["bodies/piston/position"]
        expected = 0.05 * np.cos(angle) + np.sqrt(0.2**2 - (0.05 * np.sin(angle)) ** 2)
        self.assert_close(piston[:, 0], expected, absolute=1e-10)
        self.assert_close(piston[:, 1:], 0.0, absolute=1e-10)
        self.assert_close(results["joints/cylinder/coordinate"], piston[:, 0], absolute=1e-12)
        # Five turns of the motor, then rest; the crank comes after.
        motor = results["bodies/motor/position"][:, 2]
        self.assert_close(motor[[0, -1]], [0.0, 10.0 * np.pi], absolute=1e-10)
        self.assert_close(angle[-1], 10.0 * np.pi, absolute=0.1)
        # The motor's balance: J α = drive − torque of the coupling.
        torque = results["forces/coupling/torque"]  # on the crank
        self.assert_close(
            0.01 * results["bodies/motor/acceleration"][:, 2], results["joints/motor/drive"] - torque, absolute=1e-8
        )
        # Newton's law for the piston: pin, cylinder, gas and weight.
        pin = -results["joints/piston_pin/reaction"][:, :2]      # the reaction is on the rod
        wall = -results["joints/cylinder/reaction"][:, :2]       # the reaction is on the ground
        gas = np.column_stack([results["forces/gas/force_x"], results["forces/gas/force_y"]])
        weight = np.array([0.0, -0.3 * 9.81])
        self.assert_close(0.3 * results["bodies/piston/acceleration"][:, :2], pin + wall + gas + weight, absolute=1e-7)
        self.assert_close(wall[:, 0], 0.0, absolute=1e-9)  # a slide has a reaction across its axis only
        self.assertLess(results.summary["energy_closure"], 1e-6)


class FlexibleRod(VerificationCase):
    """The slider-crank with a flexible rod, whose body frame lies in its middle, away from both pins."""

    DESIGN = """
[materials.steel]
youngs_modulus = 2.1e11
density = 7850.0
[sections.bar]
material = "steel"
shape = "rectangle"
width = 0.012
height = 0.02
[points]
big_end = [-0.1, 0.0]
middle = [0.0, 0.0]
small_end = [0.1, 0.0]
[[lines]]
through = ["big_end", "middle", "small_end"]
section = "bar"
elements = 8
[reference]
point = "middle"
condition = "clamped"
[modes]
count = 48
damping_ratio = 0.01
"""

    def setUp(self):
        super().setUp()
        (self.folder / "rod.toml").write_text(self.DESIGN, encoding="utf-8")
        run_program([os.environ["SPRUNG_REDUCE"], "build", "rod.toml", "--output-dir", "."], cwd=self.folder,
                    check=True)  # fmt: skip
        vehicle = (EXAMPLES / "slider_crank.toml").read_text(encoding="utf-8")
        rigid = "mass = 0.4\ninertia = 1.5e-3\nposition = [0.15, 0.0]\n" \
                "points = { big_end = [-0.1, 0.0], small_end = [0.1, 0.0] }\n"  # fmt: skip
        self.assertIn(rigid, vehicle)
        self.vehicle = vehicle.replace(rigid, 'superelement = "rod"\nposition = [0.15, 0.0]\n')

    def run_rod(self, modes, method, tolerance, duration, output_step):
        run = f'start = "as-given"\nduration = {duration}\noutput_step = {output_step}\n[modes]\nrod = {modes}\n' \
              f'[integrator]\nmethod = "{method}"\nrelative_tolerance = {tolerance}\n'  # fmt: skip
        return self.run_to_results(self.write_model(self.vehicle, run), superelements=self.folder, violation=1e-8)

    def test_it_runs_with_most_of_its_modes_at_a_small_tolerance(self):
        """The joints were said to be open at t = 0. The other method has no partition."""
        for modes in (36, 44):
            found = []
            for method in ("exponential", "generalized-alpha"):
                with self.subTest(modes=modes, method=method):
                    results = self.run_rod(modes, method, 1e-8, 0.01, 1e-4)
                    found.append(results["bodies/piston/position"][:, 0])
            self.assert_close(found[0], found[1], absolute=1e-9)

    def test_accelerations_and_forces_by_steps_much_longer_than_the_periods_of_stiff_modes(self):
        """Closing the joints at outputs moved stiff modes: 50 m/s² at the piston, where 5.6 is right."""
        expected = self.run_rod(36, "exponential", 1e-7, 0.2, 1e-3)
        found = self.run_rod(36, "generalized-alpha", 3e-4, 0.2, 1e-3)
        for name, share in (("points/piston.origin/acceleration", 0.1), ("joints/piston_pin/reaction", 0.1),
                            ("recovery/rod/axial", 0.1), ("recovery/rod/axial_from_loads", 0.1)):  # fmt: skip
            with self.subTest(name=name):
                self.assert_close(found[name], expected[name], absolute=share * np.max(np.abs(expected[name])))


class Chains(VerificationCase):
    def test_track_hangs_with_its_weight_on_two_pins(self):
        balance = self.program("equilibrium", EXAMPLES / "track_run.toml")
        self.assertTrue(balance["stable"])
        results = self.run_to_results(
            EXAMPLES / "track_run.toml", "--set", "start=equilibrium", "--set", "duration=0.1"
        )
        lift = -sum(results[f"joints/{name}/reaction"][0, 1] for name in ("front", "rear"))
        self.assert_close(lift, 16.0 * 9.81, relative=1e-9)

    def test_track_let_go(self):
        results = self.run_to_results(EXAMPLES / "track_run.toml")
        self.assertLess(results.summary["energy_closure"], 1e-6)
        self.assertGreater(results["energy/dissipated"][-1], 1.0)

    def test_folding_chain_keeps_its_energy_through_new_partitions(self):
        results = self.run_to_results(MODELS / "folding_chain_run.toml", "--set", "duration=1.0")
        self.assertGreaterEqual(results.summary["repartitions"], 3)
        self.assertLess(results.summary["energy_closure"], 1e-6)


def double_pendulum(length):
    """Two equal uniform bars, hinged to the ground and to each other, at rest 0.3 and 1 rad above the horizontal."""
    first = 0.5 * length * np.exp(0.3j)
    second = 2.0 * first + 0.5 * length * np.exp(1.0j)
    bars = "".join(f"""
[bodies.{name}]
mass = 1.0
inertia = {length**2 / 12.0!r}
position = [{float(centre.real)!r}, {float(centre.imag)!r}]
angle = {angle}
points = {{ near = [{-0.5 * length!r}, 0.0], far = [{0.5 * length!r}, 0.0] }}
""" for name, centre, angle in (("upper", first, 0.3), ("lower", second, 1.0)))
    return f"""
name = "double pendulum"
gravity = [0.0, -9.81]
{bars}
[[joints]]
name = "support"
type = "revolute"
a = "ground.origin"
b = "upper.near"
[[joints]]
name = "hinge"
type = "revolute"
a = "upper.far"
b = "lower.near"
"""


class FullTurns(VerificationCase):
    def test_turns_are_counted_however_small_the_mechanism(self):
        """Lengths by s and times by √s give the same motion; the first step tried is then far too long."""
        angles = []
        for length in (1.0, 1e-2, 1e-4, 1e-6, 1e-8):
            time = 3.0 * length**0.5
            results = self.run_text(double_pendulum(length),
                                    f'start = "as-given"\nduration = {time!r}\noutput_step = {time / 100.0!r}\n')
            angles.append(np.column_stack([results[f"joints/{name}/coordinate"] for name in ("support", "hinge")]))
        for found in angles[1:]:
            self.assert_close(found, angles[0], absolute=1e-3)


class SteadyTurning(VerificationCase):
    VEHICLE = """
name = "rotor"
gravity = [0.0, 0.0]
[bodies.bar]
mass = 1.0
inertia = 0.02
position = [0.3, 0.0]
points = { eye = [-0.3, 0.0] }
[[joints]]
name = "bearing"
type = "revolute"
a = "ground.origin"
b = "bar.eye"
"""

    def test_the_energy_balance_of_steady_rotation_closes(self):
        """The terms of the energy change only by errors, which are small against the kinetic energy."""
        results = self.run_text(self.VEHICLE, """
start = "as-given"
duration = 10.0
output_step = 0.01
[initial.bar]
angular_velocity = 100.0
velocity = [0.0, 30.0]
""")
        self.assert_close(results["energy/kinetic"], 550.0, relative=1e-4)
        self.assertLess(results.summary["energy_closure"], 1e-3)


class GeneralizedAlpha(VerificationCase):
    """The second integrator shares neither coordinates nor formulas with the first, which is the reference."""

    def compare(self, run_file, tolerance, *, position, reaction, arguments=()):
        """Positions of all bodies to `position` [m, rad], reactions to `reaction` of the largest."""
        found = []
        for method, its_tolerance in (("generalized-alpha", tolerance), ("adams", 1e-9)):
            (self.folder / method).mkdir()
            path = self.folder / method / "results.h5"
            self.program("run", run_file, *arguments, "-o", str(path), "--set", f"integrator.method={method}",
                         "--set", f"integrator.relative_tolerance={its_tolerance}")
            with h5py.File(path) as file:
                found.append(({name: file[f"bodies/{name}/position"][:] for name in file["bodies"]},
                              {name: file[f"joints/{name}/reaction"][:] for name in file["joints"]
                               if "reaction" in file[f"joints/{name}"]}))
        (bodies, joints), (reference, reference_joints) = found
        largest = max(np.max(np.abs(values)) for values in reference_joints.values())
        for name, values in bodies.items():
            self.assert_close(values, reference[name], absolute=position)
        for name, values in joints.items():
            self.assert_close(values, reference_joints[name], absolute=reaction * largest)

    def test_andrews(self):
        self.compare(EXAMPLES / "andrews_run.toml", 1e-7, position=1e-6, reaction=1e-6)

    def test_four_bar_that_leaves_no_freedom(self):
        self.compare(EXAMPLES / "four_bar_run.toml", 1e-5, position=1e-9, reaction=1e-9)

    def test_slider_crank(self):
        self.compare(EXAMPLES / "slider_crank_run.toml", 1e-7, position=1e-6, reaction=1e-5)

    def test_track(self):
        self.compare(
            EXAMPLES / "track_run.toml", 1e-7, position=1e-5, reaction=1e-5, arguments=("--set", "duration=0.5")
        )

    def test_fixed_steps_of_any_radius(self):
        results = self.run_to_results(
            EXAMPLES / "slider_crank_run.toml",
            "--set",
            "integrator.method=generalized-alpha",
            "--set",
            "integrator.spectral_radius=0.5",
            "--set",
            "integrator.fixed_step=5e-4",
        )
        # Points of the gas force's table and the ends of the motor's step lie on the grid of steps.
        self.assertEqual(results.summary["steps"], 3000)
        self.assertGreater(results.summary["velocity_violation"], 1e-9)
        self.assertLess(results.summary["energy_closure"], 1e-3)

    def test_steps_without_numerical_damping_fail_with_the_reason(self):
        process = run_program(
            [os.environ["SPRUNG_DYNAMICS"], "run", EXAMPLES / "andrews_run.toml", "--set", "integrator.fixed_step=1e-3",
             "--set", "integrator.method=generalized-alpha", "--set", "integrator.spectral_radius=1.0"])
        self.assertEqual(process.returncode, 3, process.stderr)
        self.assertIn("nothing damps the joints' forces", process.stderr)


class StiffModes(VerificationCase):
    """Generalized-α on the truck over its bump with all 36 modes, whose highest frequency no step resolves. Its
    errors are those against the default method, which is good to 0.1 m/s² at 1e-5. Bounds: steps between switches
    that made vibrations of errors of position were 17 m/s² wrong at 1e-3, and stopped at a fixed step."""

    TRUCK = MODELS.parents[2] / "dynamics/models/truck/bump.toml"
    ALL = ("--set", "modes.chassis=36", "--set", "output.store.points=all", "--set", "output.precision=double")

    def run_truck(self, name, *arguments):
        path = self.folder / name
        process = run_program(
            [os.environ["SPRUNG_DYNAMICS"], "run", self.TRUCK, "--superelements",
             os.environ["SPRUNG_TRUCK_SUPERELEMENTS"], "--quiet", "-o", path, *self.ALL, *arguments], cwd=self.folder)
        with h5py.File(path) as file:
            return process, file["points/chassis.middle/acceleration"][:, 1]

    def test_accelerations_are_right_or_the_run_says_that_they_are_not(self):
        _, expected = self.run_truck("expected.h5", "--set", "integrator.relative_tolerance=1e-5")
        for key, value, bound in (("relative_tolerance", "1e-3", 10.0), ("fixed_step", "5e-4", 20.0),
                                  ("relative_tolerance", "1e-2", None), ("fixed_step", "1e-3", None)):
            with self.subTest(key=key, value=value):
                process, found = self.run_truck("results.h5", "--set", 'integrator.method="generalized-alpha"', "--set",
                                                f"integrator.{key}={value}")  # fmt: skip
                if bound is None:
                    self.assertEqual(process.returncode, 1, process.stderr)
                    self.assertIn("do not trust this run", process.stderr)
                else:
                    self.assertEqual(process.returncode, 0, process.stderr)
                    self.assert_close(found, expected, absolute=bound)


class SwingingBeam(VerificationCase):
    """An undamped beam on a hinge, with all of its vectors, released level. Its weight bends it, and nothing excites
    its stiff vectors but errors of steps. Expected: the default method at 1e-8, which solves vibration exactly."""

    DESIGN = """
[materials.steel]
youngs_modulus = 2.1e11
density = 7850.0
[sections.bar]
material = "steel"
shape = "rectangle"
width = 0.02
height = 0.02
[points]
hinge = [0.0, 0.0]
middle = [1.0, 0.0]
tip = [2.0, 0.0]
[[lines]]
through = ["hinge", "middle", "tip"]
section = "bar"
elements = 8
[reference]
point = "hinge"
[reduction]
highest_frequency = 400.0
tolerance = 1e-4
[modes]
damping_ratio = 0.0
"""
    VEHICLE = """
name = "swing"
monitor = ["beam.tip"]
[bodies.beam]
superelement = "beam"
position = [0.0, 0.0]
[[joints]]
name = "hinge"
type = "revolute"
a = "ground.origin"
b = "beam.hinge"
"""

    def test_accelerations_by_multistep_methods(self):
        (self.folder / "beam.toml").write_text(self.DESIGN, encoding="utf-8")
        run_program([os.environ["SPRUNG_REDUCE"], "build", "beam.toml", "--output-dir", "."], cwd=self.folder,
                    check=True)  # fmt: skip
        found = {}
        for method, tolerance in (("exponential", 1e-8), ("adams", 1e-3), ("adams", 1e-6), ("bdf", 1e-4)):
            run = f'start = "as-given"\nduration = 0.4\n[modes]\nbeam = "all"\n[integrator]\nmethod = "{method}"\n' \
                  f'relative_tolerance = {tolerance}\n'  # fmt: skip
            results = self.run_to_results(self.write_model(self.VEHICLE, run), superelements=self.folder)
            found[method, tolerance] = results["points/beam.tip/acceleration"][:, 1]
        expected = found.pop(("exponential", 1e-8))
        for key, acceleration in found.items():
            with self.subTest(key=key):
                error = np.sqrt(np.mean((acceleration - expected) ** 2) / np.mean(expected**2))
                self.assertLess(error, 0.05)


class UntrustedRun(VerificationCase):
    def test_a_run_whose_energies_do_not_close_ends_with_exit_code_1_and_its_results(self):
        # The pendulum with a step that is twenty times too long.
        process = run_program(
            [os.environ["SPRUNG_DYNAMICS"], "run", EXAMPLES / "pendulum_run.toml", "--quiet", "-o", "results.h5",
             "--set", 'integrator.method="generalized-alpha"', "--set", "integrator.fixed_step=0.05"], cwd=self.folder)
        self.assertEqual(process.returncode, 1, process.stderr)
        self.assertIn("do not trust this run", process.stderr)
        self.assertIn("energy balance", process.stdout)
        self.assertTrue((self.folder / "results.h5").is_file())


if __name__ == "__main__":
    unittest.main()
