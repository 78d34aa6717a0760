"""What a build says of a mesh that is too coarse for its band."""

import json
import math
import re

import h5py

from reduce_case import ReduceTestCase, run_tests

BEAM = """[materials.steel]
youngs_modulus = 2.1e11
density = 7850.0
[sections.bar]
material = "steel"
shape = "rectangle"
width = 0.05
height = 0.2
[points]
a = [0.0, 0.0]
m = [1.5, 0.0]
e = [3.0, 0.0]
[[lines]]
through = ["a", "m", "e"]
section = "bar"
elements = 1
[reference]
point = "m"
[reduction]
highest_frequency = 350.0
[modes]
damping_ratio = 0.01
"""
# The free beam's second mode: cos x cosh x = 1 at x = 7.853205, ω = (x/L)² h √(E/12ρ).
SECOND = (7.853205 / 3.0) ** 2 * 0.2 * math.sqrt(2.1e11 / (12.0 * 7850.0)) / (2.0 * math.pi)

# A truss of eleven members, whose bars bend below the band.
NODES = {1: (-6, 0), 2: (-3, 1.5), 3: (0, 0), 4: (3, 1.5), 5: (6, 0), 6: (-4, 0), 7: (4, 0)}
MEMBERS = [(1, 2), (2, 3), (3, 4), (4, 5), (1, 6), (6, 3), (3, 7), (7, 5), (2, 4), (6, 2), (7, 4)]


def make_truss(elements):
    points = "".join(f"n{number} = [{float(x)}, {y}]\n" for number, (x, y) in NODES.items())
    lines = "".join(f'[[lines]]\nfrom = "n{a}"\nto = "n{b}"\nsection = "bar"\nelements = {elements}\n'
                    for a, b in MEMBERS)  # fmt: skip
    return ('[materials.steel]\nyoungs_modulus = 2.1e11\ndensity = 7850.0\n[sections.bar]\nmaterial = "steel"\n'
            f'area = 0.01\nsecond_moment = 8e-6\n[points]\n{points}{lines}[reference]\npoint = "n3"\n[interface]\n'
            'n1 = "xy"\nn5 = "xy"\n[reduction]\nhighest_frequency = 60.0\n[modes]\ndamping_ratio = 0.01\n')  # fmt: skip


class MeshError(ReduceTestCase):
    def build_text(self, text):
        (self.folder / "body.toml").write_text(text, encoding="utf-8")
        printed = self.build("body.toml", "--force").stdout
        with h5py.File(self.folder / "out/body.h5") as file:
            kinds = [kind.decode() for kind in file["modes/kind"]]
            modes = [hz for hz, kind in zip(file["modes/frequency"], kinds) if kind != "residual"]
        return printed, modes

    def find_parts(self, printed):
        """The number of elements that the remark asks for."""
        return int(re.search(r"remark: the mesh is too coarse .*; (\d+) elements in its place keep within 1 %",
                             printed).group(1))  # fmt: skip

    def test_a_beam_with_too_few_elements_is_told_how_many_it_needs(self):
        printed, modes = self.build_text(BEAM)
        self.assertAlmostEqual(SECOND, 325.676, delta=0.01)
        self.assertGreater(modes[1] / SECOND, 1.13)
        self.assertIn("350 Hz: there the element of 'bar' between node 1 'a' at (0, 0) and node 2 'm' at (1.5, 0) "
                      "makes frequencies too high by about 19 %", printed)  # fmt: skip
        self.assertIn("(proved, of this mesh)", printed)
        parts = self.find_parts(printed)
        printed, modes = self.build_text(BEAM.replace("elements = 1", f"elements = {parts}"))
        self.assertNotIn("remark", printed)
        self.assertLess(abs(modes[1] / SECOND - 1.0), 0.01)
        self.assertRegex(printed, r"mesh: its elements make frequencies too high by about 0\.\d+ % at 350 Hz")

    def test_the_file_tells_it(self):
        self.build_text(BEAM)
        name = "estimated error of the mesh at 350 Hz"
        for command in ("info", "check"):
            result = self.run_program(command, "out/body.h5")
            self.assertEqual(result.returncode, 0)
            self.assertRegex(result.stdout, name + r" +1\.9\de-01 +none")
        checks = json.loads(self.run_program("check", "out/body.h5", "--json").stdout)["checks"]
        told = [check for check in checks if check["name"] == name]
        self.assertIsNone(told[0]["tolerance"])

    # The frequencies of members of sixteen elements, of which those of eight differ by 1e-5.
    def test_a_truss_of_one_element_per_member_is_told_how_many_it_needs(self):
        _, fine = self.build_text(make_truss(16))
        printed, coarse = self.build_text(make_truss(1))
        self.assertGreater(coarse[0] / fine[0], 1.3)
        self.assertIn("too high by more than 30 %", printed)
        parts = self.find_parts(printed)
        printed, refined = self.build_text(make_truss(parts))
        self.assertNotIn("remark", printed)
        self.assertEqual(sum(hz < 60.0 for hz in refined), sum(hz < 60.0 for hz in fine))
        for found, true in zip(refined, fine):
            if true < 60.0:
                self.assertLess(abs(found / true - 1.0), 0.01)

    # Of clamped modes without a band the highest one that was asked for counts, though the certificate's band is lower.
    def test_clamped_modes_are_judged_at_the_highest_one(self):
        text = BEAM.replace("[reduction]\nhighest_frequency = 350.0\n", "").replace("[modes]", "[modes]\ncount = 4")
        printed, modes = self.build_text(text)
        self.assertIn(f"the mesh is too coarse for {modes[-1]:.6g} Hz", printed)


if __name__ == "__main__":
    run_tests()
