#!/usr/bin/python3
"""/model/resolved against the histories of the same file: the histories follow from the parameters that it holds."""

import shutil
import subprocess
import unittest

import h5py
import numpy as np

from dynamics_test_case import PROGRAM, ROOT, SHORT, DynamicsTestCase

EXAMPLES = ROOT / "dynamics/models/examples"
ROUNDING = 1e-9  # of the largest value: sums of a few products in another order
CHANGES = (
    "speed=4.0", "output_step=2e-3", "road.height=0.15", "road.start=0.05", "integrator.relative_tolerance=1e-7",
    "integrator.method=adams", "modes.chassis=4", "modal_damping.chassis=0.03", "vehicle.gravity=[0.0, -9.0]",
    "vehicle.bodies.front_axle.mass=1300.0", "vehicle.forces.front_suspension.free_length=0.45",
    "vehicle.forces.front_suspension.compression_stop.deflection=0.12", "vehicle.forces.0.damper.rebound=9000.0",
    "vehicle.forces.front_tyre.radius=0.61",
)  # fmt: skip


def evaluate(function, x):
    """A function of the resolved model by its documented formula."""
    breakpoints, origins, coefficients = (function[name][:] for name in ("breakpoints", "origins", "coefficients"))
    piece = np.searchsorted(breakpoints, x, side="right")
    powers = (x - origins[piece])[:, None] ** np.arange(coefficients.shape[1])
    value = np.sum(coefficients[piece] * powers, axis=1)
    if "amplitude" in function.attrs:
        angle = 2.0 * np.pi * function.attrs["frequency"] * x + function.attrs["phase"]
        value = value + function.attrs["amplitude"] * np.sin(angle)
    for name in function:
        if name.startswith("oscillation_"):
            one = function[name]
            value = value + evaluate(one, x) * np.sin(2.0 * np.pi * one.attrs["frequency"] * x + one.attrs["phase"])
    return value


def text_of(value):
    return value.decode() if isinstance(value, bytes) else str(value)


class Resolved(DynamicsTestCase):
    def open_run(self, run, *changes):
        """Runs a file of `self.folder` under `--set`. Returns the open results and /model/resolved."""
        sets = [part for change in changes for part in ("--set", change)]
        command = [PROGRAM, "run", run, *SHORT, *sets, "-o", "results.h5"]
        process = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(process.returncode, 0, process.stderr)
        file = h5py.File(self.results, "r")
        self.addCleanup(file.close)
        return file, file["model/resolved"]

    def open_example(self, name, *changes):
        for path in EXAMPLES.glob(f"{name}*.toml"):
            shutil.copy(path, self.folder)
        return self.open_run(f"{name}_run.toml", *changes)

    def assert_close(self, found, expected, what):
        np.testing.assert_allclose(
            found, expected, rtol=0.0, atol=ROUNDING * max(1.0, np.max(np.abs(expected))), err_msg=what
        )

    def assert_springs(self, file, resolved, kind, exerted):
        """The forces of spring and damper elements are those of their functions at their deflections. Returns how
        many."""
        count = 0
        for name, element in resolved["forces"].items():
            if text_of(element.attrs["kind"]) != kind:
                continue
            count += 1
            history, parameters = file[f"forces/{name}"], element["parameters"]
            each = evaluate(parameters["spring"], history["deflection"][:]) + evaluate(
                parameters["damper"], history["rate"][:]
            )
            self.assert_close(history[exerted][:], parameters.attrs["multiplicity"] * each, name)
        return count

    def assert_tyres(self, file, resolved):
        count = 0
        for name, element in resolved["forces"].items():
            if not element.attrs["on_road"]:
                continue
            count += 1
            history, parameters = file[f"forces/{name}"], element["parameters"]
            (centre,) = (text_of(one) for one in element["points"])
            height = file[f"points/{centre}/position"][:, 1]
            self.assert_close(
                history["penetration"][:], parameters.attrs["radius"] - height + history["road_height"][:], name
            )
            each = (
                evaluate(parameters["spring"], history["penetration"][:])
                + parameters.attrs["damping"] * history["rate"][:]
            )
            if parameters.attrs["one_sided"]:
                each = np.where(history["contact"][:] > 0.5, np.maximum(each, 0.0), 0.0)
            self.assert_close(history["force"][:], parameters.attrs["multiplicity"] * each, name)
            self.assert_close(history["on_wheel"][:, 1], history["force"][:], name)
        return count

    def assert_newton(self, file, resolved):
        """The acceleration of each rigid body follows from mass, inertia, gravity, and the forces of joints and force
        elements."""
        bodies = {}
        for name, body in resolved["bodies"].items():
            gravity = body.attrs["mass"] * resolved["gravity"][:]
            bodies[name] = np.zeros((file["time"].shape[0], 3)) + [*gravity, 0.0]
        sources = {"joints": {"a": "reaction", "b": "reaction_b"}}
        for group in ("joints", "forces"):
            for name, element in resolved[group].items():
                for role, point in zip(map(text_of, element["point_roles"]), map(text_of, element["points"])):
                    owner = text_of(resolved[f"points/{point}"].attrs["body"])
                    if owner == "ground":
                        continue
                    wrench = file[f"{group}/{name}/{sources.get(group, {}).get(role, f'on_{role}')}"][:]
                    arm = file[f"points/{point}/position"][:] - file[f"bodies/{owner}/center_of_mass/position"][:]
                    turning = arm[:, 0] * wrench[:, 1] - arm[:, 1] * wrench[:, 0]
                    bodies[owner] += np.column_stack([wrench[:, :2], wrench[:, 2] + turning])
        for name, wrench in bodies.items():
            attributes = resolved[f"bodies/{name}"].attrs
            if attributes["num_modes"]:
                continue
            linear = attributes["mass"] * file[f"bodies/{name}/center_of_mass/acceleration"][:]
            angular = attributes["inertia"] * file[f"bodies/{name}/acceleration"][:, 2]
            size = max(1.0, np.max(np.abs(wrench)))
            # Reactions solve their equations to about 1e-9 of the forces.
            np.testing.assert_allclose(linear, wrench[:, :2], rtol=0.0, atol=1e-7 * size, err_msg=name)
            np.testing.assert_allclose(angular, wrench[:, 2], rtol=0.0, atol=1e-7 * size, err_msg=name)

    def assert_all(self, file, resolved):
        self.assert_tyres(file, resolved)
        self.assert_springs(file, resolved, "spring-damper", "force")
        self.assert_springs(file, resolved, "rotational-spring-damper", "torque")
        self.assert_newton(file, resolved)

    def test_the_truck_as_its_files_say(self):
        file, resolved = self.open_run("bump.toml")
        self.assertEqual(self.assert_springs(file, resolved, "spring-damper", "force"), 2)
        self.assertEqual(self.assert_tyres(file, resolved), 2)
        self.assert_newton(file, resolved)
        self.assertEqual(resolved.attrs["direction"], -1.0)
        np.testing.assert_array_equal(resolved["gravity"][:], [0.0, -9.80665])  # the default
        settings = resolved["settings"]
        self.assertEqual((settings.attrs["speed"], text_of(settings.attrs["speed_unit"])), (3.0, "m/s"))
        self.assertEqual((settings.attrs["statistics_from"], settings.attrs["statistics_to"]), (0.0, 0.05))
        self.assertEqual(settings["adaptivity"].attrs["recall"], 0.08)  # the default
        np.testing.assert_allclose(resolved["bodies/chassis/damping_ratio"][:], 0.01, rtol=1e-9)
        np.testing.assert_allclose(resolved["bodies/chassis/frequency"][:], 6.11, atol=5e-3)
        shapes = file["model/superelements/chassis/shapes"]
        point = resolved["points/chassis.front_spring"]
        np.testing.assert_array_equal(point["shapes"][:], shapes[int(point.attrs["node"]), :, :2])

    def test_the_truck_under_many_overrides(self):
        file, resolved = self.open_run("bump.toml", *CHANGES)
        self.assert_all(file, resolved)
        settings, integrator = resolved["settings"].attrs, resolved["settings/integrator"].attrs
        self.assertEqual((settings["speed"], settings["output_step"]), (4.0, 2e-3))
        self.assertAlmostEqual(file["bodies/front_axle/velocity"][0, 0], -4.0, places=9)
        self.assertEqual((text_of(integrator["method"]), integrator["relative_tolerance"]), ("adams", 1e-7))
        np.testing.assert_array_equal(resolved["gravity"][:], [0.0, -9.0])
        self.assertEqual(resolved["bodies/front_axle"].attrs["mass"], 1300.0)
        np.testing.assert_array_equal(resolved["bodies/chassis/mode_number"][:], [1, 2, 3, 4])
        np.testing.assert_allclose(resolved["bodies/chassis/damping_ratio"][:], 0.03, rtol=1e-12)
        suspension = resolved["forces/front_suspension/parameters"]
        self.assertEqual((suspension.attrs["free_length"], suspension.attrs["compression_stop"]), (0.45, 0.12))
        self.assertIn(0.12, suspension["spring/breakpoints"][:])
        self.assertEqual(resolved["forces/front_tyre/parameters"].attrs["radius"], 0.61)
        self.assertEqual(resolved["forces/rear_tyre/parameters"].attrs["radius"], 0.6)

    def test_the_road_is_the_one_under_the_wheels(self):
        # The half-sine from 0.05 m on, met by the front wheel alone in the first 0.05 s.
        file, resolved = self.open_run("bump.toml", "speed=4.0", "road.height=0.15", "road.start=0.05")
        road = resolved["road"]
        start, length, height = (road["parameters"].attrs[name] for name in ("start", "length", "height"))
        self.assertEqual((text_of(road.attrs["shape"]), start, length, height), ("half-sine", 0.05, 0.4, 0.15))
        x = file["points/front_axle.origin/position"][:, 0]
        u = (road.attrs["direction"] * x - road.attrs["origin"] - start) / length
        expected = np.where((u > 0.0) & (u < 1.0), height * np.sin(np.pi * u), 0.0)
        self.assertGreater(expected.max(), 0.05)
        self.assert_close(file["forces/front_tyre/road_height"][:], expected, "road")

    def test_the_quarter_car_under_overrides_of_its_vehicle(self):
        self.assert_all(*self.open_example("quarter_car"))
        file, resolved = self.open_example(
            "quarter_car", "vehicle.forces.tyre.radius=0.32", "vehicle.forces.suspension.multiplicity=2",
            "vehicle.forces.suspension.damper.coefficient=900.0", "vehicle.bodies.sprung.mass=350.0",
            "vehicle.motions.way.function.polynomial=[0.0, 6.0]", "road.start=0.0",
        )  # fmt: skip
        self.assert_all(file, resolved)
        self.assertEqual(resolved["forces/suspension/parameters"].attrs["multiplicity"], 2.0)
        way = resolved["joints/way"]
        self.assertEqual((way.attrs["is_motion"], text_of(way["parameters"].attrs["coordinate"])), (1, "along"))
        self.assert_close(file["joints/way/coordinate"][:], evaluate(way["parameters/value"], file["time"][:]), "way")

    def test_the_slider_crank_under_overrides_of_its_vehicle(self):
        file, resolved = self.open_example(
            "slider_crank", "duration=0.4", "vehicle.forces.coupling.free_angle=0.1", "vehicle.gravity=[0.0, -1.0]",
            "vehicle.motions.motor.function={ harmonic = { amplitude = 0.3, frequency = 2.0, "
            "mean = -0.1, phase = 0.34 } }",
            "vehicle.bodies.rod.inertia=2e-3", "vehicle.forces.gas.torque=0.2",
        )  # fmt: skip
        self.assertEqual(self.assert_springs(file, resolved, "rotational-spring-damper", "torque"), 1)
        self.assert_newton(file, resolved)
        motor, gas = resolved["joints/motor/parameters"], resolved["forces/gas/parameters"]
        time = file["time"][:]
        self.assert_close(file["joints/motor/coordinate"][:], evaluate(motor["value"], time), "motor")
        for component in ("force_x", "force_y", "torque"):
            self.assert_close(file[f"forces/gas/{component}"][:], evaluate(gas[component], time), component)
        self.assertEqual(resolved["forces/coupling/parameters"].attrs["free_angle"], 0.1)

    def test_composed_functions_of_time(self):
        beat = (
            "{ product = [{ harmonic = { amplitude = 0.3, frequency = 2.0, mean = 0.1 } },"
            " { step = { before = 0.0, after = 1.0, start = 0.05, end = 0.3 } },"
            " { harmonic = { amplitude = 1.0, frequency = 3.0, phase = 0.2 } }] }"
        )
        pieces = (
            "{ sum = [{ table = [[0.1013, 0.1], [0.1013, 0.5], [0.3, -0.2]] }, { pieces = [{ until = 0.2002,"
            " function = { harmonic = { amplitude = 0.2, frequency = 5.0 } } }, { function = 0.1 }] }] }"
        )
        file, resolved = self.open_example(
            "slider_crank", "duration=0.4",
            f"vehicle.motions.motor.function={beat}", f"vehicle.forces.gas.torque={pieces}",
        )  # fmt: skip
        motor, torque = (resolved[f"{name}/parameters"] for name in ("joints/motor", "forces/gas"))
        self.assertEqual(sum(name.startswith("oscillation_") for name in motor["value"]), 3)
        time = file["time"][:]
        self.assert_close(file["joints/motor/coordinate"][:], evaluate(motor["value"], time), "motor")
        self.assert_close(file["forces/gas/torque"][:], evaluate(torque["torque"], time), "torque")

    def test_every_number_has_a_unit(self):
        beat = "{ product = [{ harmonic = { amplitude = 3.0, frequency = 2.0 } }, { polynomial = [0.0, 1.0] }] }"
        _, oscillating = self.open_example("slider_crank", "duration=0.1", f"vehicle.forces.gas.torque={beat}")
        self.assert_units(oscillating)
        _, resolved = self.open_run("bump.toml", *CHANGES)
        self.assert_units(resolved)

    def assert_units(self, resolved):
        without = []

        def look(name, item):
            for attribute, value in item.attrs.items():
                is_number = isinstance(value, np.floating) and attribute != "direction"
                if is_number and f"{attribute}_unit" not in item.attrs:
                    without.append(f"{name}.{attribute}")

        resolved.visititems(look)
        self.assertEqual(without, [])


if __name__ == "__main__":
    unittest.main()
