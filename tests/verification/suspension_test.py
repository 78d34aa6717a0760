#!/usr/bin/python3
"""Force elements of suspensions, against closed forms and by two methods of integration."""

import math
import unittest

import numpy as np

from response_case import ResponseCase, overrides
from verification_case import EXAMPLES, VerificationCase

DISC = """
name = "disc"
gravity = {gravity}
[bodies.disc]
mass = 2.0
inertia = 0.5
position = {position}
"""
TIGHT = "[integrator]\nrelative_tolerance = 1e-8\n"


def of_method(method, tolerance):
    return f'[integrator]\nmethod = "{method}"\nrelative_tolerance = {tolerance:g}\n'


# Each method with its tolerance, and the error that counts as agreement: of second order the error of
# generalized-alpha falls with the tolerance to the power 2/3.
METHODS = (("exponential", 1e-8, 1e-7), ("bdf", 1e-8, 1e-5), ("generalized-alpha", 1e-8, 1e-5))

STOP = """
[[forces]]
name = "stop"
type = "hydraulic-stop"
a = "ground.origin"
b = "disc.origin"
contact_length = 0.5
{laws}
"""


class HydraulicStop(VerificationCase):
    def test_impact_on_a_constant_orifice(self):
        # m δ'' = −c δ'² has δ' = v/(1 + c v t/m), δ = m/c ln(1 + c v t/m) after the touch, here at 0.1/3 s.
        m, c, v = 2.0, 50.0, 3.0
        for method, tolerance, error in METHODS:
            with self.subTest(method=method):
                results = self.run_text(
                    DISC.format(gravity="[0.0, 0.0]", position="[0.6, 0.0]")
                    + STOP.format(laws="metering = { coefficient = 50.0 }"),
                    'start = "as-given"\nduration = 0.2\n[initial.disc]\nvelocity = [-3.0, 0.0]\n'
                    + of_method(method, tolerance),
                )
                t = np.maximum(results.time - 0.1 / v, 0.0)
                rate = v / (1.0 + c * v * t / m)
                overlap = np.where(t > 0.0, m / c * np.log1p(c * v * t / m), 0.1 - v * results.time)
                overlap = np.where(t > 0.0, overlap, -overlap)
                self.assert_close(results["forces/stop/rate"], rate, absolute=10.0 * error)
                self.assert_close(results["forces/stop/overlap"], overlap, absolute=error)
                self.assert_close(results["forces/stop/force"], np.where(t > 0.0, c * rate**2, 0.0), absolute=0.05)
                self.assertLess(results.summary["energy_closure"], 10.0 * error)

    def test_oil_flows_back_without_resistance(self):
        # Into a metered stop with a spring and out again: what is lost on the way in is lost once, and on the way
        # out the motion is that of the spring alone.
        results = self.run_text(
            DISC.format(gravity="[0.0, 0.0]", position="[0.5, 0.0]")
            + STOP.format(
                laws="spring = { polynomial = [0.0, 800.0] }\n"
                "metering = { table = [[0.0, 0.0], [0.04, 30.0], [0.08, 90.0]] }"
            ),
            'start = "as-given"\nduration = 0.5\noutput_step = 1e-4\n[initial.disc]\nvelocity = [-3.0, 0.0]\n' + TIGHT,
        )
        overlap, rate = results["forces/stop/overlap"], results["forces/stop/rate"]
        metering = np.interp(overlap, [0.0, 0.04, 0.08, 1.08], [0.0, 30.0, 90.0, 1590.0])
        law = 800.0 * overlap + np.where(rate > 0.0, metering * rate**2, 0.0)
        inside = overlap > 1e-8
        self.assert_close(results["forces/stop/force"], np.where(inside, law, 0.0), absolute=1e-5)
        deepest = overlap.max()
        self.assert_close(-rate[-1], deepest * math.sqrt(800.0 / 2.0), relative=1e-6)
        back = (rate < 0.0) & inside
        lost = results["energy/dissipated"]
        self.assert_close(lost[back], lost[-1], relative=1e-7)
        self.assertLess(results.summary["energy_closure"], 1e-7)


BUSHING = """
[[forces]]
name = "mount"
type = "bushing"
a = "ground.origin"
b = "disc.origin"
{laws}
"""


class Bushing(VerificationCase):
    LAWS = """
x = { spring = { polynomial = [0.0, 800.0] }, damper = { coefficient = 4.0 } }
y = { spring = { polynomial = [0.0, 1800.0] } }
rotation = { spring = { polynomial = [0.0, 60.0] }, damper = { coefficient = 0.5 } }
"""

    def test_free_vibration_in_its_three_directions(self):
        # Damped oscillators: x'' + c/m x' + k/m x = 0. Its axes are those of the ground.
        for method, tolerance, error in METHODS:
            with self.subTest(method=method):
                results = self.run_text(
                    DISC.format(gravity="[0.0, 0.0]", position="[0.1, 0.05]") + BUSHING.format(laws=self.LAWS),
                    'start = "as-given"\nduration = 1.0\n[initial.disc]\nangular_velocity = 2.0\n'
                    + of_method(method, tolerance),
                )
                t = results.time
                d, w = 4.0 / 4.0, math.sqrt(400.0 - 1.0)
                x = 0.1 * np.exp(-d * t) * (np.cos(w * t) + d / w * np.sin(w * t))
                e, u = 0.5, math.sqrt(120.0 - 0.25)
                angle = 2.0 / u * np.exp(-e * t) * np.sin(u * t)
                expected = np.column_stack([x, 0.05 * np.cos(30.0 * t), angle])
                self.assert_close(results["bodies/disc/position"], expected, absolute=10.0 * error)
                self.assert_close(results["forces/mount/force_y"], -1800.0 * 0.05 * np.cos(30.0 * t), absolute=0.02)
                self.assertLess(results.summary["energy_closure"], 10.0 * error)

    def test_axes_turn_with_its_first_point(self):
        # The same bushing seen the other way round: a on the disc. Turned by half a right angle, the disc's x axis
        # meets ground at equal distances along both axes. Together they exert no torque on the pair.
        results = self.run_text(
            DISC.format(gravity="[0.0, 0.0]", position="[0.1, 0.0]")
            + BUSHING.format(laws=self.LAWS).replace("ground.origin", "DISC").replace("disc.origin", "ground.origin")
            .replace("DISC", "disc.origin"),
            'start = "as-given"\nduration = 0.5\n[initial.disc]\nangular_velocity = 1.0\n' + TIGHT,
        )
        position = results["bodies/disc/position"]
        cosine, sine = np.cos(position[:, 2]), np.sin(position[:, 2])
        deflection = np.column_stack(
            [-cosine * position[:, 0] - sine * position[:, 1], sine * position[:, 0] - cosine * position[:, 1]]
        )
        self.assert_close(results["forces/mount/deflection_x"], deflection[:, 0], absolute=1e-11)
        self.assert_close(results["forces/mount/deflection_y"], deflection[:, 1], absolute=1e-11)
        on_disc, on_ground = results["forces/mount/on_a"], results["forces/mount/on_b"]
        self.assert_close(on_disc[:, :2], -on_ground[:, :2], absolute=1e-10)
        about_ground = on_disc[:, 2] + on_ground[:, 2] + position[:, 0] * on_disc[:, 1] - position[:, 1] * on_disc[:, 0]
        self.assert_close(about_ground, 0.0, absolute=1e-10)
        self.assertLess(results.summary["energy_closure"], 1e-7)

    def test_equilibrium_and_modes(self):
        run = self.write_model(
            DISC.format(gravity="[0.0, -10.0]", position="[0.0, 0.0]") + BUSHING.format(laws=self.LAWS),
            "duration = 0.1\n",
        )
        balance = self.program("equilibrium", run)
        self.assert_close(balance["bodies"]["disc"]["y"], -20.0 / 1800.0, absolute=1e-9)
        self.assert_close(self.modes(run)[0], [math.sqrt(120.0), 20.0, 30.0], relative=1e-7)

    def relax(self, stiffness, time):
        """A disc on a spring of 800 N/m with a part that relaxes, along x; A of d/dt (x, v, e) = A (x, v, e), where e
        is the deflection of the part's own spring."""
        relaxation = f"{{ stiffness = {stiffness:g}, time = {time:g} }}"
        laws = f"x = {{ spring = {{ polynomial = [0.0, 800.0] }}, relaxation = {relaxation} }}"
        matrix = np.array([[0.0, 1.0, 0.0], [-400.0, 0.0, -stiffness / 2.0], [0.0, 1.0, -1.0 / time]])
        return BUSHING.format(laws=laws), matrix

    def test_vibration_with_a_part_that_relaxes(self):
        # Slow, as quick as the vibration, and so quick that it is stiff for methods without implicit steps.
        for stiffness, time in ((500.0, 0.5), (2000.0, 0.03), (5000.0, 1e-4)):
            bushing, matrix = self.relax(stiffness, time)
            values, vectors = np.linalg.eig(matrix)
            start = np.linalg.solve(vectors, np.array([0.1, 0.0, 0.0]))
            for method, tolerance, error in METHODS:
                with self.subTest(method=method, time=time):
                    results = self.run_text(
                        DISC.format(gravity="[0.0, 0.0]", position="[0.1, 0.0]") + bushing,
                        'start = "as-given"\nduration = 1.0\n' + of_method(method, tolerance),
                    )
                    t = results.time[:, None]
                    expected = ((start * np.exp(values * t)) @ vectors.T).real
                    self.assert_close(results["bodies/disc/position"][:, 0], expected[:, 0], absolute=10.0 * error)
                    state = math.sqrt(stiffness) * expected[:, 2]
                    self.assert_close(results["forces/mount/state"][:, 0], state, absolute=1000.0 * error)
                    self.assertLess(results.summary["energy_closure"], 10.0 * error)

    def test_modes_with_a_part_that_relaxes(self):
        for stiffness, time in ((500.0, 0.5), (2000.0, 0.03), (5000.0, 1e-4)):
            with self.subTest(time=time):
                bushing, matrix = self.relax(stiffness, time)
                run = self.write_model(
                    DISC.format(gravity="[10.0, 0.0]", position="[0.0, 0.0]") + bushing, "duration = 0.1\n"
                )
                # At rest the relaxed part bears nothing.
                balance = self.program("equilibrium", run)
                self.assert_close(balance["bodies"]["disc"]["x"], 20.0 / 800.0, absolute=1e-9)
                modes = self.program("modes", run)["modes"]
                self.assertEqual(sum(mode["rigid_body"] for mode in modes), 2)
                (mode,) = (mode for mode in modes if not mode["rigid_body"])
                s = max(np.linalg.eigvals(matrix), key=lambda value: value.imag)
                self.assert_close(mode["undamped_frequency"], 20.0 / (2.0 * math.pi), relative=1e-7)
                self.assert_close(mode["damped_frequency"], s.imag / (2.0 * math.pi), relative=1e-7)
                self.assert_close(mode["damping_ratio"], -s.real / abs(s), relative=1e-7)

    def test_modes_that_a_part_holds_more_than_the_spring(self):
        # Of the cubic's roots the pair oscillates, however far it is from the frequency of the spring alone. The first
        # part has the share of the spring that a rigid-body mode is told by: none.
        for spring, stiffness, time in ((0.0, 1e4, 0.05), (8.0, 1e4, 0.05), (800.0, 3e6, 10.0)):
            with self.subTest(spring=spring):
                law = f"spring = {{ polynomial = [0.0, {spring}] }}, " if spring else ""
                laws = f"x = {{ {law}relaxation = {{ stiffness = {stiffness}, time = {time} }} }}"
                run = self.write_model(
                    DISC.format(gravity="[0.0, 0.0]", position="[0.0, 0.0]") + BUSHING.format(laws=laws),
                    "duration = 0.1\n",
                )
                matrix = np.array([[0.0, 1.0, 0.0], [-spring / 2.0, 0.0, -stiffness / 2.0], [0.0, 1.0, -1.0 / time]])
                s = max(np.linalg.eigvals(matrix), key=lambda value: value.imag)
                modes = self.program("modes", run)["modes"]
                (mode,) = (mode for mode in modes if mode["damped_frequency"] > 0.0)
                self.assert_close(mode["undamped_frequency"], math.sqrt(spring / 2.0) / (2.0 * math.pi), relative=1e-6,
                                  absolute=1e-9)
                self.assert_close(mode["damped_frequency"], s.imag / (2.0 * math.pi), relative=1e-6)
                self.assert_close(mode["damping_ratio"], -s.real / abs(s), relative=1e-6, absolute=1e-9)

    def test_response_with_a_part_that_relaxes(self):
        # The quarter car with a suspension of dynamic stiffness k + c s + k_r τs/(1 + τs).
        ms, mu, k, c, kt, kr, tau = 300.0, 40.0, 2.0e4, 1500.0, 2.0e5, 3.0e4, 0.02
        vehicle = (EXAMPLES / "quarter_car.toml").read_text(encoding="utf-8")
        before, rest = vehicle.split('[[forces]]\nname = "suspension"')
        tyre = rest[rest.index("[[forces]]") :]
        laws = f"""
free_position = [0.0, 0.3]
[forces.y]
spring = {{ polynomial = [{-ms * 9.81:.6g}, {k:g}] }}
damper = {{ coefficient = {c:g} }}
relaxation = {{ stiffness = {kr:g}, time = {tau:g} }}
"""
        mount = BUSHING.format(laws=laws).replace("ground.origin", "unsprung.origin").replace("disc", "sprung")
        run = self.write_model(before + mount + tyre, "duration = 1.0\nspeed = 5.0\n")
        response = self.program("response", run)
        s = 2j * math.pi * np.array(response["frequency"])
        spring = k + c * s + kr * tau * s / (1.0 + tau * s)
        determinant = (ms * s**2 + spring) * (mu * s**2 + spring + kt) - spring**2
        body, wheel = spring * kt / determinant, (ms * s**2 + spring) * kt / determinant
        for name, expected in (("deflection_y", body - wheel), ("force_y", -spring * (body - wheel))):
            output = response["outputs"][f"forces/mount/{name}"]
            found = np.array(output["real"]) + 1j * np.array(output["imaginary"])
            self.assert_close(np.abs(found / expected - 1.0), 0.0, absolute=1e-6)

    def test_a_run_continues_with_the_states_of_another(self):
        bushing, _ = self.relax(2000.0, 0.3)
        vehicle = DISC.format(gravity="[0.0, 0.0]", position="[0.1, 0.0]") + bushing
        whole = self.run_text(vehicle, 'start = "as-given"\nduration = 1.0\n' + TIGHT)["bodies/disc/position"][-1]
        first = self.folder / "first.h5"
        self.program(
            "run", self.write_model(vehicle, 'start = "as-given"\nduration = 0.4\n' + TIGHT), "-o", str(first)
        )
        second = self.run_text(vehicle, f'continue_from = "{first}"\nduration = 1.0\n' + TIGHT)
        self.assert_close(second["bodies/disc/position"][-1], whole, absolute=1e-8)


LEAF = """
[[forces]]
name = "leaf"
type = "leaf-spring"
a = "ground.origin"
b = "disc.origin"
free_length = {length}
spring = {{ polynomial = [0.0, {stiffness:g}] }}
friction = {{ coefficient = {friction:g} }}
presliding_deflection = {beta:g}
"""
GUIDE = """
[[joints]]
name = "guide"
type = "translational"
a = "ground.origin"
b = "disc.origin"
axis = {axis}
"""


class LeafSpring(VerificationCase):
    def test_loops(self):
        # Driven: deflection 0.1 m + 30 mm sin(2π t). Behind each reversal p = s + (p_0 − s) e^(−|d − d_0|/β).
        beta, full = 0.004, 60.0
        for method, tolerance, error in METHODS:
            with self.subTest(method=method):
                results = self.run_text(
                    DISC.format(gravity="[0.0, 0.0]", position="[0.5, 0.0]")
                    + GUIDE.format(axis="[1.0, 0.0]")
                    + LEAF.format(length=0.6, stiffness=900.0, friction=full, beta=beta)
                    + """
[[motions]]
name = "drive"
joint = "guide"
function = { harmonic = { mean = 0.5, amplitude = -0.03, frequency = 1.0 } }
""",
                    'start = "as-given"\nduration = 2.75\n' + of_method(method, tolerance),
                )
                d, place, p = 0.1 + 0.03 * np.sin(2.0 * math.pi * results.time), 0.1, 0.0
                share = np.empty(len(d))
                for k, reversal in enumerate(np.arange(0.25, 3.0, 0.5)):
                    sign = 1.0 if k % 2 == 0 else -1.0
                    rows = (results.time > reversal - 0.5 - 1e-9) & (results.time < reversal + 1e-9)
                    share[rows] = sign + (p - sign) * np.exp(-np.abs(d[rows] - place) / beta)
                    end = 0.1 + sign * 0.03
                    p = sign + (p - sign) * math.exp(-abs(end - place) / beta)
                    place = end
                self.assert_close(results["forces/leaf/friction"], full * share, absolute=1e4 * error)
                self.assert_close(results["forces/leaf/force"], 900.0 * d + full * share, absolute=1e4 * error)
                # The work of a closed loop: 4 F (A − β tanh(A/β)).
                lost = results["energy/dissipated"]
                loop = lost[results.row(2.25)] - lost[results.row(1.25)]
                self.assert_close(loop, 4.0 * full * (0.03 - beta * math.tanh(0.03 / beta)), relative=1e3 * error)
                self.assertLess(results.summary["energy_closure"], 100.0 * error)

    def test_holds_a_load_at_rest_without_creep(self):
        # Let go 10 mm above its place of balance it comes to rest elsewhere, held by friction, and stays there.
        vehicle = (
            DISC.format(gravity="[0.0, -10.0]", position="[0.0, 0.5]")
            + GUIDE.format(axis="[0.0, 1.0]")
            + LEAF.format(length=0.5, stiffness=2000.0, friction=8.0, beta=0.002)
            + """
[[forces]]
name = "absorber"
type = "spring-damper"
a = "ground.origin"
b = "disc.origin"
free_length = 0.5
damper = { coefficient = 30.0 }
"""
        )
        for method in ("exponential", "generalized-alpha"):
            with self.subTest(method=method):
                results = self.run_text(
                    vehicle, 'start = "as-given"\nduration = 60.0\noutput_step = 0.01\n' + of_method(method, 1e-9)
                )
                y, friction = results["bodies/disc/position"][:, 1], results["forces/leaf/friction"]
                self.assertGreater(abs(friction[-1]), 0.5)
                self.assert_close(y[-1], 0.49 + friction[-1] / 2000.0, absolute=1e-8)
                # Less than the tolerance of one step, times the length of the spring.
                self.assert_close(y[results.row(10.0) :], y[-1], absolute=5e-10)

    def test_equilibrium_and_modes(self):
        # Friction bears nothing in equilibrium. In small vibration it adheres, as a spring of stiffness F/β.
        run = self.write_model(
            DISC.format(gravity="[0.0, -10.0]", position="[0.0, 0.5]")
            + GUIDE.format(axis="[0.0, 1.0]")
            + LEAF.format(length=0.5, stiffness=2000.0, friction=8.0, beta=0.002),
            "duration = 0.1\n",
        )
        self.assert_close(self.program("equilibrium", run)["bodies"]["disc"]["y"], 0.49, absolute=1e-9)
        (mode,) = self.program("modes", run)["modes"]
        self.assert_close(mode["undamped_frequency"], math.sqrt(1000.0) / (2.0 * math.pi), relative=1e-7)
        self.assert_close(mode["damped_frequency"], math.sqrt(3000.0) / (2.0 * math.pi), relative=1e-6)


class LeafSpringOnRoad(ResponseCase):
    """The quarter car with half of its damper and 400 N of friction."""

    def write(self):
        vehicle = (EXAMPLES / "quarter_car.toml").read_text(encoding="utf-8")
        vehicle = vehicle.replace("coefficient = 1500.0", "coefficient = 700.0").replace("[0.0, 5.0]", "[0.0, 20.0]")
        leaf = LEAF.format(length=0.3, stiffness=0.0, friction=400.0, beta=0.003)
        leaf = leaf.replace("ground.origin", "unsprung.origin").replace("disc", "sprung")
        return self.write_model(vehicle + leaf, "duration = 80.0\nspeed = 20.0\noutput_step = 0.005\n")

    def test_response_agrees_with_runs_in_time(self):
        run = self.write()
        road = self.make_road("--iso-class", "C", "--length", "1600", "--spacing", "0.05", "--ease", "5", "--seed", "4",
                              "--band", "0.011", "2.0")  # fmt: skip
        results = self.run_to_results(
            run, *overrides(road="{ shape = 'table', start = 1.0, file = '" + str(road) + "' }")
        )
        response = self.response(
            run,
            *overrides(response__road__class="C", response__road__band="[0.011, 2.0]", response__from=0.1,
                       response__to=60),
        )  # fmt: skip
        remark = response.report["remarks"][-1]
        self.assertIn("Friction and orifices linearised for the r.m.s. deflection on this road: leaf (", remark)
        # The linear law has the damping and the stiffness of the loops, but not the corners of the force, which the
        # body's acceleration feels: an independent calculation gives 1.56 m/s² by (forces, eq. 23) and 1.70 m/s² in
        # time, and 10.06 mm and 9.79 mm.
        for name, series, error in (
            ("points/sprung.origin/acceleration.y", results["bodies/sprung/acceleration"][:, 1], 0.12),
            ("forces/suspension/deflection", results["forces/suspension/deflection"] - 0.14715, 0.05),
        ):
            self.assert_close(response.rms(name), np.sqrt(np.mean(series**2)), relative=error)
        self.assert_close(response.rms("points/sprung.origin/acceleration.y"), 1.561, relative=2e-3)
        self.assert_close(response.rms("forces/suspension/deflection"), 0.010055, relative=2e-3)

    def test_without_a_spectrum_friction_adheres(self):
        # Body and wheel are then joined by the suspension and 400 N/3 mm beside it.
        run = self.write()
        response = self.response(run)
        self.assertIn("Friction holds and orifices let pass as near rest", response.report["remarks"][-1])
        ms, mu, kt = 300.0, 40.0, 2e5
        s = 1j * response.omega
        spring = 2e4 + 700.0 * s + 400.0 / 0.003
        determinant = (ms * s**2 + spring) * (mu * s**2 + spring + kt) - spring**2
        body = spring * kt / determinant
        self.assert_close(np.abs(response["points/sprung.origin/displacement.y"] / body - 1.0), 0.0, absolute=1e-6)


if __name__ == "__main__":
    unittest.main()
