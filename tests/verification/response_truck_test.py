#!/usr/bin/python3
"""The truck's response to the road: long waves, balance of forces, and runs over low roads."""

import os
import unittest

import numpy as np

from response_case import ResponseCase, overrides
from verification_case import ROOT

TRUCK = ROOT / "dynamics/models/truck/terrain.toml"
TRUCK_SUPERELEMENTS = os.environ["SPRUNG_TRUCK_SUPERELEMENTS"]


class Truck(ResponseCase):
    EQUAL_DAMPING = [argument for end in ("front", "rear") for argument in overrides(**{
        f"vehicle__forces__{end}_suspension__damper": "{ coefficient = 11527.5 }"})]

    def truck(self, *arguments):
        return self.response(TRUCK, *arguments, superelements=TRUCK_SUPERELEMENTS)

    def test_follows_a_long_wave(self):
        response = self.truck(*overrides(modes__chassis='"all"', response__from=1e-3, response__to=1.0,
                                         response__points='["chassis.seat", "rear_axle.origin", "chassis.origin"]'))
        # Wheels are −2.175 m … from the middle of a wave of 7.5 km: e^{−iκ 2.175} at the chassis, twice at the rear.
        kappa = response.omega[0] / 7.5
        for point, behind in (("chassis.seat", 0.0), ("chassis.origin", 2.175), ("rear_axle.origin", 4.35)):
            self.assert_close(response[f"points/{point}/displacement.y"][0] * np.exp(1j * kappa * behind), 1.0,
                              absolute=1e-5)
        self.assertEqual(response.report["remarks"],
                         ["Linearised with the mean of the two slopes at rest: front_suspension, rear_suspension"])

    def test_forces_move_the_masses(self):
        # Newton for the front axle, at every frequency: tyres, suspension and the reactions of both arms' joints.
        # With dampers that have their slope at rest, and the one for their motion on a road.
        table = "{ table = [[-1.0, -9e3], [-0.05, -3e3], [0.0, 0.0], [0.05, 4e3], [1.0, 1e4]] }"
        digressive = [*overrides(vehicle__forces__front_suspension__damper=table,
                                 vehicle__forces__rear_suspension__damper=table), *overrides(response__road__class="D")]
        for arguments in ([], digressive):
            response = self.truck(*overrides(modes__chassis=4), *arguments)
            for end, axle in (("front", 1185.0), ("rear", 1185.0)):
                arms = sum(-response[f"joints/{end}_{arm}_axle/reaction.y"] for arm in ("long", "short"))
                lift = response[f"forces/{end}_tyre/force"] - response[f"forces/{end}_suspension/force"] + arms
                inertia = axle * response[f"points/{end}_axle.origin/acceleration.y"]
                self.assert_close(np.abs(lift - inertia), 0.0, absolute=1e-6 * np.max(np.abs(inertia)))
        self.assertGreater(np.max(np.abs(response["joints/front_long_axle/reaction.y"])), 1e4)

    def test_run_over_a_low_sinusoidal_road(self):
        # 4 chassis modes, a wave of 0.1 mm and 1 m at 7.5 m/s; equal damping both ways, as a damper of two slopes is
        # not linear however small the motion. Amplitudes and phases from the last waves of the run.
        for length in (3.0, 0.75):
            with self.subTest(length=length):
                self.compare_with_run(length)

    def compare_with_run(self, length):
        amplitude, start = 1e-5, 1.0
        s = np.arange(0.0, 90.0, length / 60.0)
        easing = np.where(s < 3.0 * length, 0.5 - 0.5 * np.cos(np.pi * s / (3.0 * length)), 1.0)
        height = amplitude * easing * np.sin(2.0 * np.pi * s / length)
        road = self.folder / "sine.txt"
        road.write_text("".join(f"{a:.10g} {b:.15g}\n" for a, b in zip(s, height)), encoding="utf-8")
        setting = [*self.EQUAL_DAMPING, *overrides(modes__chassis=4)]
        results = self.run_to_results(
            TRUCK, *setting, *overrides(duration=9.0, output_step=1e-3, statistics="{ from = 0.0, to = 9.0 }",
                                        integrator__relative_tolerance=1e-10,
                                        road="{ shape = 'table', start = 1.0, file = '" + str(road) + "' }"),
            superelements=TRUCK_SUPERELEMENTS)
        frequency = 7.5 / length
        response = self.truck(*setting, *overrides(response__from=frequency, response__to=2.0 * frequency,
                                                   response__number=2))
        waves = round(3.0 * frequency)
        time = results.time
        last = (time > 9.0 - waves / frequency - 1e-9) & (time <= 9.0)
        carrier = np.exp(2j * np.pi * (7.5 * time[last] - start) / length)
        for name, series in {
            "points/chassis.seat/acceleration.y": results["points/chassis.seat/acceleration"][:, 1],
            "points/chassis.origin/displacement.y": results["bodies/chassis/position"][:, 1],
            "points/chassis.origin/displacement.angle": results["bodies/chassis/position"][:, 2],
            "bodies/chassis/modal/amplitude.1": results["bodies/chassis/modal/amplitude"][:, 0],
            "forces/front_suspension/deflection": results["forces/front_suspension/deflection"],
            "forces/rear_tyre/force": results["forces/rear_tyre/force"],
            "joints/front_long_chassis/reaction.y": results["joints/front_long_chassis/reaction"][:, 1],
        }.items():
            # Least squares for a constant and the wave's two parts; the road is Re(−i amplitude carrier).
            columns = np.column_stack([np.ones(last.sum()), carrier.real, -carrier.imag])
            _, real, imaginary = np.linalg.lstsq(columns, series[last], rcond=None)[0]
            found = (real + 1j * imaginary) / (-1j * amplitude)
            expected = response[name][0]
            with self.subTest(name):
                self.assertLess(abs(found / expected - 1.0), 0.01, f"{found} {expected}")

    def test_run_over_a_low_random_road(self):
        # Class A at a fiftieth of its height, so that the springs are almost linear.
        road = self.make_road("--iso-class", "A", "--length", "450", "--spacing", "0.05", "--ease", "3", "--seed", "2",
                              "--band", "0.055", "3.3")
        s, height = np.loadtxt(road, unpack=True)
        np.savetxt(road, np.column_stack([s, height / 50.0]), fmt="%.12g")
        setting = [*self.EQUAL_DAMPING, *overrides(modes__chassis=2)]
        results = self.run_to_results(
            TRUCK,
            *setting,
            *overrides(
                duration=60.0,
                output_step=4e-3,
                statistics="{ from = 0.0, to = 60.0 }",
                integrator__relative_tolerance=1e-8,
                road="{ shape = 'table', start = 1.0, file = '" + str(road) + "' }",
            ),
            superelements=TRUCK_SUPERELEMENTS,
        )
        response = self.truck(
            *setting,
            *overrides(
                response__road=f"{{ density = {16e-6 / 2500.0}, band = [0.055, 3.3] }}",
                response__from=0.1,
                response__to=40,
            ),
        )
        for name, series in {
            "points/chassis.seat/acceleration.y": results["points/chassis.seat/acceleration"][:, 1],
            "points/chassis.origin/acceleration.y": results["bodies/chassis/acceleration"][:, 1],
            "points/chassis.origin/displacement.y": results["bodies/chassis/position"][:, 1],
            "bodies/chassis/modal/amplitude.1": results["bodies/chassis/modal/amplitude"][:, 0],
            "forces/front_suspension/deflection": results["forces/front_suspension/deflection"],
            "forces/rear_tyre/force": results["forces/rear_tyre/force"],
        }.items():
            with self.subTest(name):
                self.assert_close(np.std(series), response.rms(name), relative=0.03)


if __name__ == "__main__":
    unittest.main()
