#!/usr/bin/python3
"""Forces in time and about axes, against closed forms."""

import math
import unittest

import numpy as np

from verification_case import EXAMPLES, VerificationCase

DISC = """
name = "disc"
gravity = {0}
[bodies.disc]
mass = 2.0
inertia = 0.5
position = [0.0, 0.0]
"""


class Applied(VerificationCase):
    def test_kinks_in_time_are_stepped_to(self):
        # Momentum is the integral of the force, here of straight lines; at a loose tolerance no step may run over a
        # pulse of a millisecond after seconds of nothing.
        results = self.run_text(
            DISC.format("[0.0, 0.0]")
            + """
[[forces]]
name = "hammer"
type = "applied"
point = "disc.origin"
force = [{ table = [[1.5, 0.0], [1.5003, 9000.0], [1.501, 0.0]] }, 0.0]
torque = { step = { before = 0.0, after = 3.0, start = 2.0, end = 2.002 } }
""",
            'start = "as-given"\nduration = 4.0\n[integrator]\nrelative_tolerance = 1e-3\n',
        )
        velocity = results["bodies/disc/velocity"]
        self.assert_close(velocity[results.row(1.5), 0], 0.0, absolute=1e-12)
        self.assert_close(velocity[-1, 0], 0.5 * 9000.0 * 1e-3 / 2.0, relative=1e-5)
        # 3 N·m from 2.002 s on, and half of that for the 2 ms before.
        self.assert_close(velocity[-1, 2], 3.0 / 0.5 * (1.998 + 0.001), relative=1e-5)

    def test_following_force_turns_with_its_body(self):
        # A disc that turns at 3 rad/s under a force along its own x: v = F/(m ω) (sin ωt, 1 − cos ωt).
        results = self.run_text(
            DISC.format("[0.0, 0.0]")
            + """
[[forces]]
name = "jet"
type = "applied"
point = "disc.origin"
axes = "following"
force = [10.0, 0.0]
""",
            'start = "as-given"\nduration = 2.0\n[initial.disc]\nangular_velocity = 3.0\n'
            "[integrator]\nrelative_tolerance = 1e-8\n",
        )
        angle = 3.0 * results.time
        expected = 10.0 / (2.0 * 3.0) * np.column_stack([np.sin(angle), 1.0 - np.cos(angle)])
        self.assert_close(results["bodies/disc/velocity"][:, :2], expected, absolute=1e-7)
        self.assertLess(results.summary["energy_closure"], 1e-7)

    def test_gravity_in_any_direction(self):
        results = self.run_text(DISC.format("[3.0, -4.0]"), 'start = "as-given"\nduration = 1.0\n')
        t = results.time
        self.assert_close(
            results["bodies/disc/position"][:, :2], np.column_stack([1.5 * t**2, -2.0 * t**2]), absolute=1e-8
        )
        self.assertLess(results.summary["energy_closure"], 1e-8)


AXLE = """
[[joints]]
name = "axle"
type = "revolute"
a = "ground.origin"
b = "disc.origin"
"""


class TorsionPendulum(VerificationCase):
    def test_spring_and_damper_about_an_axis(self):
        # J = 0.5, k = 2 · 40, c = 2 · 0.3: decaying oscillation about the free angle of 0.4 rad, from 0 at rest.
        results = self.run_text(
            DISC.format("[0.0, 0.0]")
            + AXLE
            + """
[[forces]]
name = "wire"
type = "rotational-spring-damper"
a = "ground.origin"
b = "disc.origin"
free_angle = 0.4
multiplicity = 2
spring = { polynomial = [0.0, 40.0] }
damper = { coefficient = 0.3 }
""",
            'start = "as-given"\nduration = 2.0\n[integrator]\nrelative_tolerance = 1e-8\n',
        )
        decay = 0.6 / (2.0 * 0.5)
        omega = math.sqrt(80.0 / 0.5 - decay**2)
        t = results.time
        shape = np.exp(-decay * t) * (np.cos(omega * t) + decay / omega * np.sin(omega * t))
        self.assert_close(results["bodies/disc/position"][:, 2], 0.4 * (1.0 - shape), absolute=1e-7)
        self.assert_close(results["joints/axle/coordinate"], results["bodies/disc/position"][:, 2], absolute=1e-14)
        modes = self.program("modes", self.folder / "run.toml")["modes"]
        self.assert_close(modes[0]["undamped_frequency"], math.sqrt(160.0) / (2.0 * math.pi), relative=1e-8)
        self.assert_close(modes[0]["damping_ratio"], decay / math.sqrt(160.0), relative=1e-8)

    def test_stops_are_located(self):
        # Free between −0.1 and 0.1 rad, thrown from one stop to the other without loss: the same speed each time.
        results = self.run_text(
            DISC.format("[0.0, 0.0]")
            + AXLE
            + """
[[forces]]
name = "stops"
type = "rotational-spring-damper"
a = "ground.origin"
b = "disc.origin"
compression_stop = { deflection = 0.1, rate = 5.0e4 }
rebound_stop = { deflection = -0.1, rate = 5.0e4 }
""",
            'start = "as-given"\nduration = 3.0\n[initial.disc]\nangular_velocity = 1.0\n',
        )
        self.assertGreaterEqual(results.summary["switches"], 24)
        free = np.abs(results["bodies/disc/position"][:, 2]) < 0.1
        self.assert_close(np.abs(results["bodies/disc/velocity"][free, 2]), 1.0, absolute=1e-5)
        self.assertLess(results.summary["energy_closure"], 1e-6)


STOP = """
[[forces]]
name = "stop"
type = "hydraulic-stop"
a = "ground.origin"
b = "disc.origin"
contact_length = 0.5
spring = {{ polynomial = [0.0, {stiffness:g}] }}
damping = {damping:g}
"""


class HydraulicStop(VerificationCase):
    def test_impact(self):
        # m δ'' = −δ (k + c δ') has the integral v/c − k/c² ln(1 + c v/k) + δ²/2m, v = δ'.
        m, k, c = 2.0, 4.0e4, 2.0e4
        results = self.run_text(
            DISC.format("[0.0, 0.0]").replace("position = [0.0, 0.0]", "position = [0.6, 0.0]")
            + STOP.format(stiffness=k, damping=c),
            'start = "as-given"\nduration = 0.3\noutput_step = 1e-4\n[initial.disc]\nvelocity = [-3.0, 0.0]\n'
            "[integrator]\nrelative_tolerance = 1e-8\n",
        )

        def integral(overlap, rate):
            return rate / c - k / c**2 * np.log1p(c * rate / k) + overlap**2 / (2.0 * m)

        x, v = results["bodies/disc/position"][:, 0], results["bodies/disc/velocity"][:, 0]
        overlap, rate = results["forces/stop/overlap"], results["forces/stop/rate"]
        self.assert_close(overlap, 0.5 - x, absolute=1e-12)
        self.assert_close(rate, -v, absolute=1e-12)
        inside = overlap > 0.0
        self.assertGreater(np.count_nonzero(inside), 50)
        start = integral(0.0, 3.0)
        self.assert_close(integral(overlap[inside], rate[inside]), start, absolute=1e-6 * start)
        self.assert_close(integral(0.0, rate[-1]), start, absolute=1e-6 * start)  # after the rebound
        force = np.where(inside, overlap * (k + c * rate), 0.0)
        self.assert_close(results["forces/stop/force"], force, absolute=1e-6 * force.max())
        self.assertEqual(results.summary["switches"], 2)
        self.assertLess(results.summary["energy_closure"], 1e-7)

    def test_it_never_pulls(self):
        # Driven: overlap 0.1 sin(20 t) m, so that the rate falls below −k/c = −1 m/s before the points part.
        results = self.run_text(
            DISC.format("[0.0, 0.0]").replace("position = [0.0, 0.0]", "position = [0.5, 0.0]")
            + STOP.format(stiffness=1e4, damping=1e4)
            + """
[[joints]]
name = "guide"
type = "translational"
a = "ground.origin"
b = "disc.origin"
axis = [1.0, 0.0]
[[motions]]
name = "drive"
joint = "guide"
function = { harmonic = { mean = 0.5, amplitude = -0.1, frequency = 3.1830988618379066 } }
""",
            'start = "as-given"\nduration = 1.0\n[integrator]\nrelative_tolerance = 1e-8\n',
        )
        t = results.time
        overlap, rate = 0.1 * np.sin(20.0 * t), 2.0 * np.cos(20.0 * t)
        law = overlap * (1e4 + 1e4 * rate)
        self.assertLess(law[overlap > 0.0].min(), -100.0)
        force = np.where(overlap > 0.0, np.maximum(law, 0.0), 0.0)
        self.assert_close(results["forces/stop/force"], force, absolute=0.05)
        self.assertLess(results.summary["energy_closure"], 1e-6)

    def test_equilibrium_and_modes_of_a_mass_that_rests_on_it(self):
        m, k, c = 2.0, 4.0e3, 5.0e3
        self.run_text(
            DISC.format("[0.0, -10.0]").replace("position = [0.0, 0.0]", "position = [0.0, 0.45]")
            + STOP.format(stiffness=k, damping=c)
            + """
[[joints]]
name = "guide"
type = "translational"
a = "ground.origin"
b = "disc.origin"
axis = [0.0, 1.0]
""",
            "duration = 0.1\n",
        )
        balance = self.program("equilibrium", self.folder / "run.toml")
        overlap = m * 10.0 / k
        self.assert_close(balance["bodies"]["disc"]["y"], 0.5 - overlap, absolute=1e-9)
        (mode,) = self.program("modes", self.folder / "run.toml")["modes"]
        self.assert_close(mode["undamped_frequency"], math.sqrt(k / m) / (2.0 * math.pi), relative=1e-7)
        self.assert_close(mode["damping_ratio"], c * overlap / (2.0 * math.sqrt(k * m)), relative=1e-7)

    def test_response_of_a_mass_that_rests_on_it(self):
        # 300 kg on the stop on 40 kg on a tyre of 200 kN/m. The stop counts as a spring k and a damper c δ₀.
        ms, mu, k, c, kt = 300.0, 40.0, 2.0e4, 1.0e4, 2.0e5
        overlap = ms * 9.81 / k
        vehicle = (EXAMPLES / "quarter_car.toml").read_text(encoding="utf-8")
        before, rest = vehicle.split('[[forces]]\nname = "suspension"')
        tyre = rest[rest.index("[[forces]]") :]
        stop = STOP.format(stiffness=k, damping=c).replace("0.5", "0.44715")
        stop = stop.replace("ground.origin", "unsprung.origin").replace("disc.origin", "sprung.origin")
        (self.folder / "vehicle.toml").write_text(before + stop + tyre, encoding="utf-8")
        run = self.folder / "run.toml"
        run.write_text('vehicle = "vehicle.toml"\nduration = 1.0\nspeed = 5.0\n', encoding="utf-8")
        response = self.program("response", run)
        s = 2j * math.pi * np.array(response["frequency"])
        spring = k + c * overlap * s
        determinant = (ms * s**2 + spring) * (mu * s**2 + spring + kt) - spring**2
        body, wheel = spring * kt / determinant, (ms * s**2 + spring) * kt / determinant
        for name, expected in (("overlap", wheel - body), ("force", spring * (wheel - body))):
            output = response["outputs"][f"forces/stop/{name}"]
            found = np.array(output["real"]) + 1j * np.array(output["imaginary"])
            self.assert_close(np.abs(found / expected - 1.0), 0.0, absolute=1e-6)


DRIVEN = """
name = "one mass over a base"
gravity = [0.0, -9.80665]
[bodies.mass]
mass = 100.0
inertia = 1.0
position = [0.0, 1.0]
[bodies.base]
mass = 1.0
inertia = 1.0
position = [0.0, 0.0]
[[joints]]
name = "guide"
type = "translational"
a = "ground.origin"
b = "mass.origin"
axis = [0.0, 1.0]
[[joints]]
name = "drive"
type = "translational"
a = "ground.origin"
b = "base.origin"
axis = [0.0, 1.0]
[[motions]]
name = "road"
joint = "drive"
function = {{ harmonic = {{ amplitude = 0.05, frequency = 2.0 }} }}
[[forces]]
name = "suspension"
type = "spring-damper"
a = "base.origin"
b = "mass.origin"
free_length = 1.05
spring = {{ polynomial = [0.0, 2.0e4] }}
damper = {damper}
"""
RUN = 'start = "as-given"\nduration = 2.0\noutput_step = 1e-3\n[integrator]\nrelative_tolerance = {tolerance:g}\n'


class KinkedForces(VerificationCase):
    """Forces whose laws have kinks, several of them within the length of a smooth step."""

    def test_the_energy_of_a_prescribed_motion_closes_with_the_tolerance(self):
        for tolerance in (1e-3, 1e-4, 1e-6, 1e-8):
            with self.subTest(tolerance=tolerance):
                results = self.run_text(
                    DRIVEN.format(damper="{ compression = 300.0, rebound = 1500.0 }"), RUN.format(tolerance=tolerance)
                )
                self.assertGreaterEqual(results.summary["switches"], 8)
                self.assertLess(results.summary["energy_closure"], tolerance)

    def test_outputs_show_the_piece_of_a_table_that_holds(self):
        # Six pieces, each of them passed within a few ms.
        rates = np.array([-1.0, -0.1, -0.02, 0.0, 0.03, 0.2, 1.0])
        forces = np.array([-900.0, -400.0, -250.0, 0.0, 80.0, 200.0, 500.0])
        table = ", ".join(f"[{x}, {y}]" for x, y in zip(rates, forces))
        for tolerance in (1e-2, 1e-3, 1e-4, 1e-6):
            with self.subTest(tolerance=tolerance):
                results = self.run_text(
                    DRIVEN.format(damper=f"{{ table = [{table}] }}"), RUN.format(tolerance=tolerance)
                )
                self.assertGreaterEqual(results.summary["switches"], 40)
                length = results["bodies/mass/position"][:, 1] - results["bodies/base/position"][:, 1]
                rate = results["bodies/base/velocity"][:, 1] - results["bodies/mass/velocity"][:, 1]
                force = 2e4 * (1.05 - length) + np.interp(rate, rates, forces)
                acceleration = results["points/mass.origin/acceleration"][:, 1]
                # A kink is located as accurately as the motion.
                self.assert_close(acceleration, force / 100.0 - 9.80665, absolute=max(1e-9, 3.0 * tolerance))

    def test_a_damper_stiff_on_one_side_does_not_bind_the_steps(self):
        # Soft at first, on the way down; then rebound at 1e6 N·s/m holds the mass for seconds.
        results = self.run_text(
            DRIVEN.format(damper="{ compression = 300.0, rebound = 1.0e6 }").replace(
                "amplitude = 0.05", "amplitude = 0.0"
            ),
            RUN.format(tolerance=1e-6) + "[initial.mass]\nvelocity = [0.0, -0.5]\n",
        )
        self.assertLess(results.summary["evaluations"], 2000)
        self.assertLess(results.summary["energy_closure"], 1e-6)


if __name__ == "__main__":
    unittest.main()
