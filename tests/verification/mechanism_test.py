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
