#!/usr/bin/python3
"""Response with dampers of more than one slope: against Lyapunov equations, closed forms and a run in time."""

import unittest

import numpy as np
from response_case import ResponseCase, overrides
from scipy.integrate import quad
from scipy.linalg import solve_continuous_lyapunov
from scipy.stats import norm
from verification_case import EXAMPLES, MODELS

HALF_CAR = MODELS / "half_car_run.toml"
SPEED = 20.0
# N over m/s: 12 kN·s/m for slow motion, 0.95 kN·s/m beyond 0.05 m/s.
TABLE = np.array([[-1.0, -1500.0], [-0.05, -600.0], [0.0, 0.0], [0.05, 600.0], [1.0, 1500.0]])
COEFFICIENT = "damper = { coefficient = 1500.0 }"
BY_TABLE = f"damper = {{ table = {TABLE.tolist()} }}"
# The range holds all but 2e-4 of the mean squares over all frequencies.
WIDE = overrides(response__road__class="C", response__from=1e-3, response__to=1e4, response__number=2)
SLOPES_AT_REST = "Dampers have their slope at rest, since without response.road they have no amplitude: suspension"


def calc_mean_slope(sigma):
    """E[F(v) v]/σ² of the table, by quadrature of its definition."""
    def integrand(v):
        inner = np.interp(v, TABLE[:, 0], TABLE[:, 1])
        beyond = 900.0 / 0.95 * (max(v - 1.0, 0.0) + min(v + 1.0, 0.0))
        return (inner + beyond) * v * norm.pdf(v, scale=sigma)

    value, _ = quad(integrand, -12.0 * sigma, 12.0 * sigma, points=(-0.05, 0.0, 0.05), epsabs=0.0, epsrel=1e-10,
                    limit=400)
    return value / sigma**2


def calc_deviations(damping):
    """Standard deviations of the quarter car on class C: acceleration, deflection, rate, force of the suspension."""
    ms, mu, ks, kt = 300.0, 40.0, 2e4, 2e5
    # Deflection of the suspension (wheel minus body), velocity of the body, of the tyre, velocity of the wheel.
    A = np.array([
        [0.0, -1.0, 0.0, 1.0],
        [ks / ms, -damping / ms, 0.0, damping / ms],
        [0.0, 0.0, 0.0, -1.0],
        [-ks / mu, damping / mu, kt / mu, -damping / mu],
    ])  # fmt: skip
    # The slope of the road is white noise: (2π)² n² G(n) is constant.
    B = np.array([[0.0], [0.0], [1.0], [0.0]])
    density = (2.0 * np.pi) ** 2 * 256e-6 * 0.1**2 * SPEED
    P = solve_continuous_lyapunov(A, -0.5 * density * B @ B.T)
    rate = np.array([0.0, -1.0, 0.0, 1.0])
    force = ms * A[1]
    return {
        "points/sprung.origin/acceleration.y": np.sqrt(A[1] @ P @ A[1]),
        "forces/suspension/deflection": np.sqrt(P[0, 0]),
        "forces/suspension/rate": np.sqrt(rate @ P @ rate),
        "forces/suspension/force": np.sqrt(force @ P @ force),
    }


def settle():
    """The deviations with the damping that belongs to them."""
    damping = 1500.0
    for _ in range(200):
        found = calc_deviations(damping)
        damping = calc_mean_slope(found["forces/suspension/rate"])
    return found


class QuarterCar(ResponseCase):
    def write(self, damper, duration=1.0):
        vehicle = (EXAMPLES / "quarter_car.toml").read_text(encoding="utf-8")
        self.assertIn(COEFFICIENT, vehicle)
        vehicle = vehicle.replace(COEFFICIENT, damper).replace("[0.0, 5.0]", f"[0.0, {SPEED}]")
        return self.write_model(vehicle, f"duration = {duration}\nspeed = {SPEED}\noutput_step = 0.005\n")

    def assert_deviations(self, response, expected):
        for name, value in expected.items():
            with self.subTest(name):
                self.assert_close(response.rms(name), value, relative=2e-4)

    def test_a_table_has_the_slope_of_its_own_motion(self):
        expected = settle()
        # With the slope at rest, 12 kN·s/m, the acceleration would be 1.8 times as large.
        self.assertGreater(calc_deviations(12e3)["points/sprung.origin/acceleration.y"],
                           1.7 * expected["points/sprung.origin/acceleration.y"])
        response = self.response(self.write(BY_TABLE), *WIDE)
        self.assert_deviations(response, expected)
        rate = response.rms("forces/suspension/rate")
        self.assertEqual(response.report["remarks"],
                         [f"Dampers linearised for the r.m.s. rate on this road: suspension ({rate:.3g} m/s)"])

    def test_a_bushing_with_the_same_table_responds_the_same(self):
        expected = settle()
        spring = "y = { " + BY_TABLE + " }"
        bushing = f'''damper = {{ coefficient = 0.0 }}
[[forces]]
name = "damper"
type = "bushing"
a = "unsprung.origin"
b = "sprung.origin"
free_position = [0.0, 0.3]
{spring}
'''
        response = self.response(self.write(bushing), *WIDE)
        del expected["forces/suspension/force"]
        self.assert_deviations(response, expected)
        self.assert_close(response.rms("forces/damper/force_y"),
                          calc_mean_slope(expected["forces/suspension/rate"]) * expected["forces/suspension/rate"],
                          relative=2e-4)

    def test_a_run_agrees(self):
        run = self.write(BY_TABLE, duration=80.0)
        road = self.make_road("--iso-class", "C", "--length", "1600", "--spacing", "0.05", "--ease", "5", "--seed", "4",
                              "--band", "0.011", "2.0")  # fmt: skip
        results = self.run_to_results(
            run, *overrides(road="{ shape = 'table', start = 1.0, file = '" + str(road) + "' }")
        )
        response = self.response(run, *overrides(
            response__road__class="C", response__road__band="[0.011, 2.0]", response__from=0.1, response__to=60))
        # With a damper so far from linear the motion is not normal: the errors of statistical linearisation.
        for name, series, error in (
            ("points/sprung.origin/acceleration.y", results["bodies/sprung/acceleration"][:, 1], 0.1),
            ("forces/suspension/deflection", results["forces/suspension/deflection"] - 0.14715, 0.2),
            ("forces/suspension/rate", results["forces/suspension/rate"], 0.12),
        ):
            with self.subTest(name):
                self.assert_close(response.rms(name), np.sqrt(np.mean(series**2)), relative=error)

    def test_without_a_road_the_slope_at_rest_counts_and_is_named(self):
        response = self.response(self.write(BY_TABLE))
        self.assertEqual(response.report["remarks"], [SLOPES_AT_REST])
        expected = self.response(self.write("damper = { coefficient = 12000.0 }"))
        self.assertEqual(expected.report["remarks"], [])
        for name in expected.report["outputs"]:
            self.assert_close(response[name], expected[name], absolute=1e-8 * np.max(np.abs(expected[name])) + 1e-9)


class HalfCar(ResponseCase):
    def test_two_slopes_count_with_their_mean_in_all_outputs(self):
        # 1400 N·s/m is the mean of 500 and 2300: E[F(v) v]/σ² of two slopes, whatever σ is.
        text = (MODELS / "half_car.toml").read_text(encoding="utf-8")
        coefficient = "damper = { coefficient = 1400.0 }"
        self.assertEqual(text.count(coefficient), 2)
        run = "speed = 14.0\nduration = 1.0\n"
        two = text.replace(coefficient, "damper = { compression = 500.0, rebound = 2300.0 }")
        for road, remark in (
            (overrides(response__road__class="C"), "Dampers linearised for the r.m.s. rate on this road: "),
            ((), "Linearised with the mean of the two slopes at rest: "),
        ):  # fmt: skip
            response, expected = (self.response_text(one, run, *road) for one in (two, text))
            self.assertEqual(expected.report["remarks"], [])
            (found,) = response.report["remarks"]
            self.assertTrue(found.startswith(remark), found)
            self.assertEqual(response.report["outputs"].keys(), expected.report["outputs"].keys())
            for name in expected.report["outputs"]:
                self.assert_close(response[name], expected[name],
                                  absolute=1e-8 * np.max(np.abs(expected[name])) + 1e-9)
                if road:
                    self.assert_close(response.rms(name), expected.rms(name), relative=1e-6, absolute=1e-9)


if __name__ == "__main__":
    unittest.main()
