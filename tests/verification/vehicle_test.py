#!/usr/bin/python3
"""Vehicles: the quarter car against its exact linear solution, and the truck on both kinds of tyre."""

import math
import os
import unittest

import numpy as np

from verification_case import EXAMPLES, ROOT, VerificationCase, run_program

TRUCK = ROOT / "dynamics/models/truck/bump.toml"
DISTRIBUTED = ("--set", "vehicle.forces.front_tyre.contact=distributed", "--set",
               "vehicle.forces.rear_tyre.contact=distributed")


class QuarterCar(VerificationCase):
    """300 kg on 20 kN/m and 1500 N·s/m on 40 kg on 200 kN/m."""

    def test_frequencies_and_eigenvalues(self):
        modes = self.program("modes", EXAMPLES / "quarter_car_run.toml")["modes"]
        self.assertEqual(len(modes), 2)
        self.assert_close([mode["undamped_frequency"] for mode in modes], [1.23832987, 11.80982019], relative=1e-6)
        for mode, eigenvalue in zip(modes, (-2.11634652 + 7.61026948j, -19.13365348 + 70.54219364j)):
            imaginary = 2.0 * math.pi * mode["damped_frequency"]
            ratio = mode["damping_ratio"]
            self.assert_close(imaginary, eigenvalue.imag, relative=1e-6)
            self.assert_close(-ratio * imaginary / math.sqrt(1.0 - ratio**2), eigenvalue.real, relative=1e-6)

    def test_bump_against_the_exact_linear_solution(self):
        # M z̈ + C ż + K z = kt h(t) e₂ from rest, in steps of the exponential of the state matrix with h(t) as the sum
        # of a constant and a harmonic while the bump lasts.
        results = self.run_to_results(EXAMPLES / "quarter_car_run.toml")
        mass = np.diag([300.0, 40.0])
        damping = 1500.0 * np.array([[1.0, -1.0], [-1.0, 1.0]])
        stiffness = 2e4 * np.array([[1.0, -1.0], [-1.0, 1.0]]) + np.diag([0.0, 2e5])
        A = np.block([[np.zeros((2, 2)), np.eye(2)],
                      [-np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, damping)]])
        b = np.array([0.0, 0.0, 0.0, 2e5 / 40.0])
        omega, begin, end = 2.0 * math.pi * 5.0 / 2.0, 2.0 / 5.0, 4.0 / 5.0  # haversine of 2 m, 0.1 m, at 5 m/s
        values, vectors = np.linalg.eig(A)

        def propagate(x, time):
            return (vectors @ (np.exp(values * time) * np.linalg.solve(vectors, x))).real

        def particular(time):  # of h = 0.05 (1 − cos ωt)
            constant = -np.linalg.solve(A, 0.05 * b)
            harmonic = np.linalg.solve(1j * omega * np.eye(4) - A, -0.05 * b)
            return constant + (harmonic * np.exp(1j * omega * time)).real

        expected = []
        at_end = propagate(-particular(0.0), end - begin) + particular(end - begin)
        for time in results.time:
            if time <= begin:
                expected.append(np.zeros(4))
            elif time <= end:
                expected.append(propagate(-particular(0.0), time - begin) + particular(time - begin))
            else:
                expected.append(propagate(at_end, time - end))
        expected = np.array(expected)
        height = np.column_stack([results["bodies/sprung/position"][:, 1] - 0.6,
                                  results["bodies/unsprung/position"][:, 1] - 0.3])
        self.assert_close(height, expected[:, :2], absolute=1e-6)
        self.assertGreater(np.max(height), 0.1)
        self.assertLess(results.summary["energy_closure"], 1e-6)


class Truck(VerificationCase):
    def results(self, *arguments):
        return self.run_to_results(TRUCK, *arguments, superelements=os.environ["SPRUNG_TRUCK_SUPERELEMENTS"])

    def test_distributed_tyres_carry_the_same_weight_and_envelope_the_bump(self):
        point = self.results("--set", "duration=2.0")
        force = point["forces/front_tyre/force"]
        height = np.max(point["points/chassis.origin/position"][:, 1])
        distributed = self.results("--set", "duration=2.0", *DISTRIBUTED)
        self.assert_close(distributed["forces/front_tyre/force"][0], force[0], relative=1e-9)
        # A wheel of 0.6 m radius does not reach the foot of a bump 0.4 m long: it meets it earlier, and more softly.
        self.assertLess(np.max(distributed["forces/front_tyre/force"]), 0.6 * np.max(force))
        self.assertLess(np.max(distributed["points/chassis.origin/position"][:, 1]), height)
        begin = [np.argmax(np.abs(f - f[0]) > 1e-3 * f[0])
                 for f in (distributed["forces/front_tyre/force"], force)]
        self.assertLess(begin[0], begin[1])
        # The bump slows the truck down by the force on its edge. The road does no work, because it is at rest.
        self.assertLess(abs(distributed["bodies/chassis/velocity"][-1, 0]), 2.9)
        self.assert_close(distributed["energy/input"], 0.0, absolute=1e-9)
        self.assertLess(distributed.summary["energy_closure"], 1e-5)

    def test_dry_run_prints_the_model(self):
        report = self.program("run", TRUCK, "--dry-run", "-o", str(self.folder / "none.h5"),
                              superelements=os.environ["SPRUNG_TRUCK_SUPERELEMENTS"])
        # 7 bodies of 3 coordinates and 2 modes; 8 joints that hold x and y.
        self.assertEqual([report[key] for key in ("coordinates", "constraints", "freedoms")], [23, 16, 7])
        self.assertEqual(report["bodies"]["chassis"]["modes"], [1, 2])
        self.assertEqual(report["joints"]["front_long_axle"], {"type": "revolute", "holds": ["x", "y"]})
        self.assert_close(report["equilibrium"]["chassis"]["y"], 0.975, absolute=1e-3)
        self.assertFalse((self.folder / "none.h5").exists())
        command = [os.environ["SPRUNG_DYNAMICS"], "run", TRUCK, "--dry-run", "--superelements"]
        text = run_program([*command, os.environ["SPRUNG_TRUCK_SUPERELEMENTS"]], check=True).stdout
        for words in ("7 freedoms", "1 (6.11 Hz), 2 (6.11 Hz)", "front_suspension", "static equilibrium after"):
            self.assertIn(words, text)


if __name__ == "__main__":
    unittest.main()
