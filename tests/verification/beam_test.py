#!/usr/bin/python3
"""Beams: frequencies of one body from stage one, and of bodies assembled in stage two, against the theory of beams."""

import json
import math
import os
import unittest

from beam_theory import CLAMPED_FREE, FREE_FREE, GUIDED_FREE, PINNED_FREE, UNIT
from verification_case import MODELS, SUPERELEMENTS, VerificationCase, run_program


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

    def test_frequencies_about_an_equilibrium_that_rounding_hides_are_doubted(self):
        # A stiff beam that hangs from its end. Its reference is the other end, so that its swing is small beside the
        # stiffness of its modes. Started a little off, the search ends where rounding does not let it go on.
        design = """
            [materials.steel]
            youngs_modulus = 2.1e11
            density = 7850.0
            [sections.bar]
            material = "steel"
            shape = "rectangle"
            width = 0.05
            height = 0.1
            [points]
            a = [0.0, 0.0]
            b = [4.0, 0.0]
            [[lines]]
            from = "a"
            to = "b"
            section = "bar"
            elements = 32
            [reference]
            point = "b"
            [modes]
            all = true
            damping_ratio = 0.0
        """
        (self.folder / "hanging.toml").write_text(design, encoding="utf-8")
        run_program([os.environ["SPRUNG_REDUCE"], "build", "hanging.toml", "--output-dir", "."], cwd=self.folder,
                    check=True)  # fmt: skip
        vehicle = """
            name = "hanging"
            [bodies.beam]
            superelement = "hanging"
            position = [0.0, -4.0]
            angle = {angle}
            [[joints]]
            name = "pin"
            type = "revolute"
            a = "ground.origin"
            b = "beam.a"
        """
        right = 0.305203  # Hz, by finite elements with the weight's own stiffness, and with 2 to 90 modes alike
        for angle in (-math.pi / 2.0, -1.57079632, -1.5707963, -1.57):
            run_file = self.write_model(vehicle.format(angle=angle), 'duration = 1.0\n[modes]\nbeam = "all"\n')
            found = self.program("modes", run_file, superelements=self.folder)
            is_doubted = any("limited by rounding" in one["text"] for one in found["warnings"])
            if not is_doubted:
                self.assert_close(found["modes"][0]["undamped_frequency"], right, relative=1e-4)

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
                run = self.write_model(
                    f'name = "beam"\ngravity = [0.0, 0.0]\n[bodies.beam]\nsuperelement = "{superelement}"\n'
                    f"position = [{position}, 0.0]\n[ground.points]\nend = [0.0, 0.0]\n{held}",
                    'duration = 1.0\n[modes]\nbeam = "all"\n',
                )
                omega, rigid = self.modes(run, superelements=self.folder)
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

    def test_stiff_modes_that_nothing_excites_cost_no_steps(self):
        # A steel beam, clamped at its end by a joint and at another place for its modes. So the joint makes modal
        # coordinates dependent, which it closes to rounding only, and that is a force in modes of 1e5 Hz. Their
        # linearisation has to be free of it, or the modes begin to vibrate, up to the tolerance, whatever this is.
        design = (MODELS / "beam_inside.toml").read_text(encoding="utf-8")
        for old, new in (("count = 40", "count = 96"), ("area = 0.5", "area = 2.5e-3"),
                         ("second_moment = 2.0e-8", "second_moment = 5.2e-7")):
            self.assertIn(old, design)
            design = design.replace(old, new)
        (self.folder / "beam_at_end.toml").write_text(design, encoding="utf-8")
        run_program([os.environ["SPRUNG_REDUCE"], "build", "beam_at_end.toml", "--output-dir", "."], cwd=self.folder,
                    check=True)  # fmt: skip
        vehicle = self.VEHICLE.replace("position = [0.0, 0.0]", "position = [0.625, 0.0]").replace("-50.0", "-1e-3")
        vehicle = vehicle.replace('name = "loaded"', 'name = "loaded"\ngravity = [0.0, 0.0]')
        for modes in (24, 48, 72, 96):
            with self.subTest(modes=modes):
                run_file = self.write_model(vehicle, f'start = "as-given"\nduration = 1.0\n[modes]\nbeam = {modes}\n')
                process = run_program([os.environ["SPRUNG_DYNAMICS"], "run", run_file, "--superelements", ".", "--json",
                                       "--quiet", "-o", "results.h5"], cwd=self.folder)  # fmt: skip
                # The whole motion is below the tolerance, so its energies need not close.
                self.assertIn(process.returncode, (0, 1), process.stderr)
                self.assertLess(json.loads(process.stdout)["steps"], 100)


if __name__ == "__main__":
    unittest.main()
