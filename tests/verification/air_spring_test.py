#!/usr/bin/python3
"""Air springs against closed forms and by two methods of integration."""

import math
import os
import unittest

import numpy as np

from response_case import ResponseCase, overrides
from verification_case import EXAMPLES, VerificationCase, run_program

GRAVITY = 10.0
AMBIENT = 101325.0
METHODS = (("exponential", 1e-8, 1e-6), ("bdf", 1e-8, 1e-5), ("generalized-alpha", 1e-8, 1e-5))
# Data of one spring: area and its slope at the design height, volume, exponent.
HEIGHT, AREA, SLOPE, VOLUME, EXPONENT = 0.3, 0.05, -0.1, 0.014, 1.3

# The curve through two points is a cubic, level at 0.1 m and 0.5 m: AREA + ½ REACH (3v − v³), v = (h − 0.3)/0.2.
REACH = 0.2 * SLOPE / 1.5


def area_at(height):
    v = (height - HEIGHT) / 0.2
    return AREA + REACH * (1.5 * v - 0.5 * v**3)


def volume_at(height):
    v = (height - HEIGHT) / 0.2
    return VOLUME + 0.2 * (AREA * v + REACH * (0.75 * v**2 - 0.125 * v**4))


def of_method(method, tolerance):
    return f'[integrator]\nmethod = "{method}"\nrelative_tolerance = {tolerance:g}\n'


def load(name, mass, x=0.0, y=HEIGHT):
    """A body that is guided along y, at rest."""
    return f"""
[bodies.{name}]
mass = {mass:g}
inertia = 1.0
position = [{x:g}, {y:g}]
"""


def guide(name, ground="ground.origin"):
    return f"""
[[joints]]
name = "{name}_guide"
type = "translational"
a = "{ground}"
b = "{name}.origin"
axis = [0.0, 1.0]
"""


def air(keys, a="ground.origin", b="load.origin"):
    return f"""
[[forces]]
name = "air"
type = "air-spring"
a = "{a}"
b = "{b}"
design_height = {HEIGHT:g}
effective_area = [[0.1, {AREA - REACH:.17g}], [0.5, {AREA + REACH:.17g}]]
volume = {VOLUME:g}
exponent = {EXPONENT:g}
{keys}
"""


def vehicle(keys, mass=2500.0):
    return f'name = "v"\ngravity = [0.0, {-GRAVITY:g}]\n' + load("load", mass) + guide("load") + air(keys)


SMALL_AIR = """
[[forces]]
name = "air"
type = "air-spring"
a = "ground.origin"
b = "load.origin"
design_height = 0.25
effective_area = 0.002
volume = 1e-4
gauge_pressure = 4e5
"""


def gas_flow_at_rest(area, pressure, temperature=293.15):
    """dṁ/dw of (forces, eq. 27), w the logarithm of the ratio of densities."""
    density = pressure / (287.05 * temperature)
    return 0.6847 * area * math.sqrt(pressure * density) * math.sqrt(2.0 / 0.004) * EXPONENT / (1.0 - 0.5283)


class AirSpring(VerificationCase):
    def test_equilibrium_and_modes(self):
        # The load of 25 kN at 0.05 m² is 5 bar.
        pressure = 2500.0 * GRAVITY / AREA + AMBIENT
        stiffness = EXPONENT * pressure * AREA**2 / VOLUME - (pressure - AMBIENT) * SLOPE
        for key in ("gauge_pressure = 5e5", "load = 25e3", 'load = "static"'):
            with self.subTest(key=key):
                run = self.write_model(vehicle(key), "duration = 0.1\n")
                balance = self.program("equilibrium", run)
                self.assert_close(balance["bodies"]["load"]["y"], HEIGHT, absolute=1e-8)
                spring = balance["forces"]["air"]
                self.assert_close(spring["gauge_pressure"], 5e5, relative=1e-7)
                self.assert_close(spring["mass"], pressure * VOLUME / (287.05 * 293.15), relative=1e-7)
                ((omega,), _) = self.modes(run)
                self.assert_close(omega, math.sqrt(stiffness / 2500.0), relative=1e-6)

    def test_the_static_load_is_solved_from_any_drawing(self):
        # Drawn 60 mm too high, with two springs side by side, beside a spring of static length.
        text = vehicle('load = "static"\nmultiplicity = 2').replace(f"[0, {HEIGHT:g}]", "[0, 0.36]")
        run = self.write_model(text, "duration = 0.1\n")
        balance = self.program("equilibrium", run)
        self.assert_close(balance["bodies"]["load"]["y"], HEIGHT, absolute=1e-8)
        self.assert_close(balance["forces"]["air"]["gauge_pressure"], 2.5e5, relative=1e-7)
        said = self.refuse_text(text.replace(f"{-GRAVITY:g}]", "10.0]"), "duration = 0.1\n", verb="equilibrium")
        self.assertIn("'forces.air.load': the air spring would have to pull with", said)

    def test_polytropic_work(self):
        # Driven from 0.3 m to 0.22 m: the gas stores (p_2 V_2 − p_1 V_1)/(n − 1), less the work of the ambient air.
        for method, tolerance, error in METHODS:
            with self.subTest(method=method):
                results = self.run_text(
                    vehicle("gauge_pressure = 5e5").replace(f"{-GRAVITY:g}]", "0.0]")
                    + """
[[motions]]
name = "drive"
joint = "load_guide"
function = { step = { before = 0.3, after = 0.22, start = 0.1, end = 0.6 } }
""",
                    'start = "as-given"\nduration = 1.0\n' + of_method(method, tolerance),
                )
                volume = volume_at(0.22)
                before = 5e5 + AMBIENT
                after = before * (VOLUME / volume) ** EXPONENT
                work = (after * volume - before * VOLUME) / (EXPONENT - 1.0) + AMBIENT * (volume - VOLUME)
                stored = results["energy/spring"]
                self.assert_close(stored[-1] - stored[0], work, relative=1e-7)
                self.assert_close(results["forces/air/gauge_pressure"][-1], after - AMBIENT, relative=1e-7)
                self.assert_close(results["forces/air/force"][-1], (after - AMBIENT) * area_at(0.22), relative=1e-7)
                self.assertLess(results.summary["energy_closure"], 100.0 * error)

    def test_auxiliary_volume_and_coupled_springs_by_two_methods(self):
        # Two loads that are not balanced on springs at one pressure, let go away from rest.
        text = f'name = "v"\ngravity = [0.0, {-GRAVITY:g}]\n'
        text += load("load", 2500.0) + load("other", 2200.0, 1.0) + guide("load")
        text += guide("other", "ground.there")
        text = text.replace("[bodies.load]", "[ground.points]\nthere = [1.0, 0.0]\n[bodies.load]")
        text += air(
            "gauge_pressure = 4.7e5\n"
            "auxiliary = { volume = 0.02, orifice = { diameter = 0.008 } }\n"
            'partner = { a = "ground.there", b = "other.origin", line = { diameter = 0.006 } }'
        ) + """
[[forces]]
name = "post"
type = "spring-damper"
a = "ground.there"
b = "other.origin"
free_length = 0.3
spring = { polynomial = [0.0, 50000.0] }
damper = { coefficient = 3000.0 }
"""
        run = 'start = "as-given"\nduration = 3.0\noutput_step = 0.01\n'
        found = []
        for method, tolerance, error in METHODS:
            results = self.run_text(text, run + of_method(method, tolerance))
            self.assertLess(results.summary["energy_closure"], 100.0 * error)
            # Gas is neither lost nor made.
            self.assert_close(results["forces/air/mass"], results["forces/air/mass"][0], relative=1e-10)
            found.append(np.vstack([results["forces/air/length"], results["forces/air/partner_length"]]))
            self.assertGreater(np.abs(results["forces/air/line_pressure_difference"]).max(), 1e4)
        self.assert_close(found[1], found[0], absolute=3e-6)
        self.assert_close(found[2], found[0], absolute=3e-6)
        # At rest both have one pressure.
        balance = self.program("equilibrium", self.write_model(text, "duration = 1.0\n"))["forces"]["air"]
        self.assert_close(balance["partner_gauge_pressure"], balance["gauge_pressure"], relative=1e-9)

    def test_a_levelling_valve_is_closed_in_modes(self):
        valve = "levelling = { dead_band = 0.001, full_opening = 0.002, delay = 0.5, "
        valve += "supply_gauge_pressure = 9e5, orifice = { diameter = 0.02 } }"
        found = []
        for keys in ("", valve):
            run = self.write_model(vehicle(f'load = "static"\n{keys}'), "duration = 0.1\n")
            (mode,) = self.program("modes", run)["modes"]
            found.append([mode["undamped_frequency"], mode["damping_ratio"]])
        self.assert_close(found[1], found[0], absolute=1e-9)

    def test_a_levelling_valve_brings_the_height_back(self):
        # 3 kN more than in equilibrium from 0.5 s on, and less from 20 s on.
        text = vehicle(
            'load = "static"\nlevelling = { dead_band = 0.004, full_opening = 0.02, delay = 0.5, '
            "supply_gauge_pressure = 9e5, orifice = { diameter = 0.003 } }"
        ) + """
[[forces]]
name = "cargo"
type = "applied"
point = "load.origin"
force = [0.0, { pieces = [{ until = 0.5, function = 0.0 }, { until = 20.0, function = -3000.0 }, { function = 0.0 }] }]
[[forces]]
name = "absorber"
type = "spring-damper"
a = "ground.origin"
b = "load.origin"
free_length = 0.3
damper = { coefficient = 8000.0 }
"""
        for method, tolerance, error in (("exponential", 1e-6, 1e-4), ("generalized-alpha", 1e-7, 1e-3)):
            with self.subTest(method=method):
                results = self.run_text(text, "duration = 40.0\noutput_step = 0.02\n" + of_method(method, tolerance))
                height, mass = results["forces/air/length"], results["forces/air/mass"]
                self.assertLess(height[results.row(1.0) : results.row(3.0)].min(), HEIGHT - 0.005)
                for at in (19.9, 40.0):
                    self.assertLess(abs(height[results.row(at)] - HEIGHT), 0.0045)
                # The mass that bears 28 kN at the height that is left, and 25 kN in the end.
                for at, force in ((19.9, 28e3), (40.0, 25e3)):
                    reached = height[results.row(at)]
                    pressure = force / area_at(reached) + AMBIENT
                    share = volume_at(reached) / VOLUME
                    share *= (pressure / (25e3 / AREA + AMBIENT)) ** (1.0 / EXPONENT)
                    self.assert_close(mass[results.row(at)], mass[0] * share, relative=1e-3)
                self.assertGreater(results["energy/input"][-1], 0.0)
                self.assertLess(results.summary["energy_closure"], error)

    def test_a_run_continues_with_the_gas_of_another(self):
        text = vehicle("load = 24e3\nauxiliary = { volume = 0.02, orifice = { diameter = 0.004 } }")
        tight = of_method("exponential", 1e-9)
        whole = self.run_text(text, 'start = "as-given"\nduration = 1.0\n' + tight)["bodies/load/position"][-1]
        first = self.folder / "first.h5"
        self.program("run", self.write_model(text, 'start = "as-given"\nduration = 0.4\n' + tight), "-o", str(first))
        second = self.run_text(text, f'continue_from = "{first}"\nduration = 1.0\n' + tight)
        self.assert_close(second["bodies/load/position"][-1], whole, absolute=1e-8)

    def test_a_bellows_that_is_squeezed_to_nothing_ends_the_run(self):
        text = vehicle("load = 24e3\nauxiliary = { volume = 0.2, orifice = { diameter = 0.03 } }", mass=1e5)
        run = self.write_model(text, 'start = "as-given"\nduration = 2.0\n')
        process = run_program([os.environ["SPRUNG_DYNAMICS"], "run", run, "--quiet"], cwd=self.folder)
        self.assertEqual(process.returncode, 3, process.stderr)

    def test_so_it_does_with_sparse_factors(self):
        """Beyond 100 unknowns the matrix of generalized-α is sparse, and singular where the volume is none."""
        others = "".join(
            f"[bodies.other{k}]\nmass = 1.0\ninertia = 0.1\nposition = [{10.0 + k}, 5.0]\n" for k in range(45)
        )
        run = self.write_model(
            'name = "v"\ngravity = [0.0, -9.81]\n' + load("load", 500.0, y=0.25) + guide("load") + others + SMALL_AIR,
            'start = "as-given"\nduration = 1.0\n[initial.load]\nvelocity = [0.0, -20.0]\n'
            '[integrator]\nmethod = "generalized-alpha"\nfixed_step = 0.01\n',
        )
        process = run_program([os.environ["SPRUNG_DYNAMICS"], "run", run, "--quiet"], cwd=self.folder)
        self.assertEqual(process.returncode, 3, process.stderr)
        self.assertIn("the iteration of a step does not converge", process.stderr)


class AirSpringOnRoad(ResponseCase):
    """The quarter car on an air spring with an auxiliary volume, in the place of its spring."""

    def write(self, diameter, exact=True):
        text = (EXAMPLES / "quarter_car.toml").read_text(encoding="utf-8")
        text = text.replace("spring = { polynomial = [0.0, 2.0e4] }\n", "", 1).replace("[0.0, 5.0]", "[0.0, 20.0]")
        if not exact:
            text = text.replace("coefficient = 1500.0", "coefficient = 500.0")
        keys = f"load = {300.0 * 9.81!r}\nauxiliary = {{ volume = 0.004, orifice = {{ diameter = {diameter:g} }} }}"
        spring = air(keys, "unsprung.origin", "sprung.origin")
        spring = spring.replace(f"volume = {VOLUME:g}\n", "volume = 0.003\n").replace(
            f"[[0.1, {AREA - REACH:.17g}], [0.5, {AREA + REACH:.17g}]]", "0.01"
        )
        return self.write_model(text + spring, "duration = 80.0\nspeed = 20.0\noutput_step = 0.005\n")

    def test_stiffness_between_those_with_and_without_the_auxiliary_volume(self):
        ms, mu, c, kt, area, volume, auxiliary = 300.0, 40.0, 1500.0, 2e5, 0.01, 0.003, 0.004
        pressure = ms * 9.81 / area + AMBIENT
        density = pressure / (287.05 * 293.15)
        for diameter in (0.0005, 0.002, 0.02):
            with self.subTest(diameter=diameter):
                response = self.response(self.write(diameter))
                s = 1j * response.omega
                gain = gas_flow_at_rest(0.7 * math.pi / 4.0 * diameter**2, pressure)
                rate = gain * (1.0 / (density * volume) + 1.0 / (density * auxiliary))
                both = EXPONENT * pressure * area**2 / (volume + auxiliary)  # stiffness of both volumes
                stiffness = both * (1.0 + auxiliary / volume * s / (s + rate))
                spring = c * s + stiffness
                determinant = (ms * s**2 + spring) * (mu * s**2 + spring + kt) - spring**2
                body = spring * kt / determinant
                found = response["points/sprung.origin/displacement.y"]
                self.assert_close(np.abs(found / body - 1.0), 0.0, absolute=1e-3)
                wheel = (ms * s**2 + spring) * kt / determinant
                self.assert_close(
                    np.abs(response["forces/air/force"] / (-stiffness * (body - wheel)) - 1.0), 0.0, absolute=2e-3
                )

    def test_response_agrees_with_runs_in_time(self):
        run = self.write(0.0025, exact=False)
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
        self.assertIn("Friction and orifices linearised for the r.m.s. deflection on this road: air (",
                      response.report["remarks"][-1])  # fmt: skip
        for name, series in (
            ("points/sprung.origin/acceleration.y", results["bodies/sprung/acceleration"][:, 1]),
            ("forces/air/deflection", results["forces/air/deflection"]),
            ("forces/air/pressure_difference", results["forces/air/pressure_difference"]),
        ):
            self.assert_close(response.rms(name), np.std(series), relative=0.08)


if __name__ == "__main__":
    unittest.main()
