"""sprung-reduce as a user calls it: what it builds, prints and returns."""

import json
import shutil

import h5py

from reduce_case import SOURCE, ReduceTestCase, run_tests


class Program(ReduceTestCase):
    def test_builds_several_designs_and_then_leaves_them_alone(self):
        result = self.build("chassis.toml", "long_arm.toml")
        self.assertIn("building from chassis.toml (new)", result.stdout)
        self.assertIn("36 freedoms, 36 modes from 6.1112", result.stdout)
        self.assertEqual(self.files(), ["chassis.h5", "long_arm.h5"])
        before = {name: (self.folder / "out" / name).stat().st_mtime_ns for name in self.files()}
        result = self.build("chassis.toml", "long_arm.toml")
        self.assertEqual(result.stdout.count("up to date"), 2)
        self.assertNotIn("building", result.stdout)
        after = {name: (self.folder / "out" / name).stat().st_mtime_ns for name in self.files()}
        self.assertEqual(before, after)

    # 9.7219 Hz is the free beam's first frequency: 22.373/2π √(EI/mL⁴).

    def test_a_certified_basis_is_told_with_its_bound_and_checked(self):
        result = self.build("chassis_certified.toml")
        self.assertIn("36 freedoms, 5 free modes from 9.7219 to 87.0238 Hz, 10 residual vectors", result.stdout)
        self.assertRegex(
            result.stdout, r"interface flexibility within 0\.78 % up to 60 Hz \(proved, of this mesh\); "
            r"worst: \w+_pivot y at 60 Hz"
        )
        path = self.folder / "out/chassis_certified.h5"
        self.assertEqual(self.run_program("check", path).returncode, 0)
        info = self.run_program("info", path).stdout
        for text in ("residual", "no frequency of the body", "error in the band %", "front_spring rotation"):
            self.assertIn(text, info)
        certificate = json.loads(self.run_program("info", path, "--json").stdout)["certificate"]
        self.assertEqual(len(certificate["interface"]), 13)
        self.assertLess(certificate["error"], certificate["tolerance"])

    def test_a_plain_beam_with_many_named_points_is_built(self):
        """More than 60 loads get their responses at once. These nearly depend on each other: rounding spoiled the
        modes, and the beam was refused for its stiffnesses."""
        names = [f"p{number}" for number in range(25)]
        points = "".join(f"{name} = [{0.3 * number}, 0.0]\n" for number, name in enumerate(names))
        (self.folder / "beam.toml").write_text(
            '[materials.steel]\nyoungs_modulus = 2.1e11\ndensity = 7850.0\n[sections.bar]\nmaterial = "steel"\n'
            f'shape = "rectangle"\nwidth = 0.05\nheight = 0.1\n[points]\n{points}[[lines]]\nthrough = {names}\n'
            'section = "bar"\nelements = 1\n[reference]\npoint = "p12"\n[reduction]\nhighest_frequency = 5.0\n'
            "tolerance = 0.001\n[modes]\ndamping_ratio = 0.01\n", encoding="utf-8",
        )  # fmt: skip
        for setting in ("tolerance=0.01", "tolerance=0.001", "tolerance=0.00001", "residual_vectors=\"all\""):
            with self.subTest(setting):
                self.build("beam.toml", "--force", "--set", f"reduction.{setting}")
                path = self.folder / "out/beam.h5"
                certificate = json.loads(self.run_program("info", path, "--json").stdout)["certificate"]
                self.assertLess(certificate["error"], certificate["tolerance"])

    def test_a_clamped_basis_is_told_how_poor_it_is(self):
        self.change("chassis.toml", "all = true", "count = 8")
        result = self.build("chassis.toml")
        unbounded = r"interface flexibility without a bound up to [\d.]+ Hz: "
        worst = r"the free mode at 52\.57\d* Hz is 0\.29 % off, the most in the band"
        self.assertRegex(result.stdout, unbounded + worst)
        info = self.run_program("info", self.folder / "out/chassis.h5").stdout
        self.assertIn("What the damping of the clamped modes is on the free body", info)

    def test_the_name_of_a_file_is_no_folder_for_superelements(self):
        result = self.run_program("build", self.folder / "chassis.toml", "-o", self.folder / "frame.h5")
        self.assertEqual(result.returncode, 2)
        self.assertIn("frame.h5: error: --output-dir got the name of a file, expected a folder", result.stderr)
        self.assertFalse((self.folder / "frame.h5").exists())

    def test_a_folder_for_superelements_whose_name_is_too_long_is_refused(self):
        result = self.run_program("build", self.folder / "chassis.toml", "-o", self.folder / ("f" * 300))
        self.assertEqual(result.returncode, 2)
        self.assertIn(": error: cannot be used as a folder for the superelements: File name too long", result.stderr)

    def test_same_input_gives_same_bytes_whatever_the_folder(self):
        self.build("chassis.toml", "ladder_frame.toml")
        other = self.folder / "elsewhere" / "deeper"
        other.mkdir(parents=True)
        for name in ("chassis.toml", "ladder_frame.toml", "ladder_frame.geo"):
            shutil.copy(self.folder / name, other / name)
        result = self.run_program("build", other / "chassis.toml", other / "ladder_frame.toml", "-o", other)
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in ("chassis.h5", "ladder_frame.h5"):
            self.assertEqual(self.read(name), (other / name).read_bytes())
        before = self.read("chassis.h5")
        self.assertIn("(forced)", self.build("chassis.toml", "--force").stdout)
        self.assertEqual(self.read("chassis.h5"), before)

    def test_a_changed_design_is_rebuilt_and_says_what_moved(self):
        self.build("chassis.toml", "long_arm.toml")
        arm = self.read("long_arm.h5")
        self.change("chassis.toml", "second_moment = 1.9e-4", "second_moment = 2.09e-4")
        result = self.build("chassis.toml", "long_arm.toml")
        self.assertIn("(the design changed)", result.stdout)
        # ω ∝ √I in bending: √1.1 = 1.04881; the axial pair stays.
        rows = [line.split() for line in result.stdout.splitlines()]
        self.assertIn(["1–2", "6.1112", "1–2", "6.4095", "+4.881", "1.0000"], rows)
        self.assertIn(["5–6", "83.3623", "5–6", "83.3623", "0.000", "1.0000"], rows)
        self.assertEqual(self.read("long_arm.h5"), arm)
        self.assertIn("up to date", self.build("chassis.toml").stdout)

    def test_a_file_of_an_earlier_algorithm_is_made_again(self):
        for version in (1, 2):
            with self.subTest(version=version):
                stored = SOURCE / f"tests/reduce/data/version_{version}.h5"
                with h5py.File(stored) as file:
                    design = file["provenance/design_text"][0]
                (self.folder / "out").mkdir(exist_ok=True)
                (self.folder / stored.name).with_suffix(".toml").write_bytes(design)
                shutil.copy(stored, self.folder / "out" / stored.name)
                result = self.build(f"version_{version}.toml")
                self.assertRegex(result.stdout, rf"\(algorithm revision \d+ instead of {version}\)")
                self.assertIn("up to date", self.build(f"version_{version}.toml").stdout)

    def test_a_changed_mesh_file_is_noticed(self):
        self.build("ladder_frame.toml")
        self.change("ladder_frame.geo", "height = 0.8", "height = 0.80 ")
        self.assertIn("(ladder_frame.geo changed)", self.build("ladder_frame.toml").stdout)
        self.assertIn("up to date", self.build("ladder_frame.toml").stdout)

    def test_every_design_of_the_project_builds_and_checks(self):
        designs = sorted((SOURCE / "meshes").glob("*/*.toml"))
        self.assertGreaterEqual(len(designs), 5)
        self.build(*designs)
        result = self.run_program("check", *(self.folder / "out" / (path.stem + ".h5") for path in designs))
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertEqual(result.stdout.count("all checks passed"), len(designs))

    def test_a_bad_design_is_reported_and_spoils_nothing(self):
        self.build("chassis.toml", "long_arm.toml", "ladder_frame.toml")
        before = {name: self.read(name) for name in self.files()}
        self.change("long_arm.toml", "second_moment", "second_momnt")
        self.change("ladder_frame.toml", "highest_frequency = 150.0", "count = 3")
        result = self.build("chassis.toml", "long_arm.toml", "ladder_frame.toml", code=2)
        self.assertIn("long_arm.toml:10:1: error: unknown key 'second_momnt' in 'sections.arm' "
                      "(did you mean 'second_moment'?)", result.stderr)
        self.assertIn("chassis.h5: up to date", result.stdout)
        self.assertEqual(self.files(), sorted(before))
        self.assertEqual(self.read("chassis.h5"), before["chassis.h5"])
        self.assertEqual(self.read("long_arm.h5"), before["long_arm.h5"])
        self.assertNotEqual(self.read("ladder_frame.h5"), before["ladder_frame.h5"])

    def test_a_mesh_too_fine_is_a_numerical_error(self):
        self.change("chassis.toml", "elements = 1 ", "elements = 2000 ")
        self.change("chassis.toml", "all = true", "count = 2")
        result = self.build("chassis.toml", code=3)
        self.assertIn("chassis.toml: error: rounding spoils the lowest mode", result.stderr)
        self.assertEqual(self.files(), [])

    def test_two_designs_for_one_file_are_refused(self):
        (self.folder / "other").mkdir()
        shutil.copy(self.folder / "chassis.toml", self.folder / "other/chassis.toml")
        result = self.build("chassis.toml", "other/chassis.toml", code=2)
        self.assertIn("would be written to 'out/chassis.h5', as would 'chassis.toml'", result.stderr)

    def test_a_missing_design_is_named(self):
        self.assertIn("none.toml: error: ", self.build("none.toml", code=2).stderr)

    def test_info_shows_modes_mass_points_checks_and_origin(self):
        self.build("chassis.toml")
        text = self.run_program("info", "out/chassis.h5").stdout
        for part in ("mass                              11950 kg", "centre of mass                    (0, 0) m",
                     "front_short_pivot", "38.3104", "axial", "algorithm revision", "passed",
                     "section modulus known of 12 of 12 elements"):
            self.assertIn(part, text)
        self.assertNotIn("FAILED", text)

    def test_json_says_the_same_with_all_digits(self):
        self.build("chassis.toml")
        data = json.loads(self.run_program("info", "out/chassis.h5", "--json").stdout)
        with h5py.File(self.folder / "out/chassis.h5") as file:
            self.assertEqual([mode["frequency_hz"] for mode in data["modes"]], list(file["modes/frequency"]))
            self.assertEqual(data["mass_kg"], file["inertia/mass"][0])
            self.assertEqual(data["num_elements_with_section_modulus"], 12)
            self.assertEqual(set(file["sections/modulus"]), {1.267e-3})
            self.assertEqual(set(file["sections/area"]), {1.2004e-2})
            self.assertEqual(data["content_sha256"], file.attrs["content_hash"].decode()
                             if isinstance(file.attrs["content_hash"], bytes) else file.attrs["content_hash"])
        self.assertEqual(len(data["points"]), 13)
        self.assertTrue(all(check["passed"] for check in data["checks"]))
        checks = json.loads(self.run_program("check", "out/chassis.h5", "--json").stdout)
        self.assertEqual(checks["checks"], data["checks"])
        diff = json.loads(self.run_program("diff", "out/chassis.h5", "out/chassis.h5", "--json").stdout)
        self.assertEqual(diff["modes"][0]["old_modes"], [1, 2])
        self.assertAlmostEqual(diff["modes"][0]["mac"], 1.0)

    def test_diff_of_two_files(self):
        self.build("chassis.toml")
        shutil.copy(self.folder / "out/chassis.h5", self.folder / "old.h5")
        self.change("chassis.toml", "mass_per_length = 1561.8057", "mass_per_length = 1700.0")
        self.build("chassis.toml")
        result = self.run_program("diff", "old.h5", "out/chassis.h5")
        self.assertEqual(result.returncode, 0)
        self.assertIn("-4.151", result.stdout)  # √(1561.8057/1700) − 1

    def test_diff_of_a_body_whose_lines_cross_without_being_joined(self):
        """Where a line has a node on the other one, each has its own displacement. With finer lines the modes stay."""
        cross = (
            '[materials.steel]\nyoungs_modulus = 2.1e11\ndensity = 7850.0\n[sections.bar]\nmaterial = "steel"\n'
            'shape = "rectangle"\nwidth = 0.05\nheight = 0.05\n[points]\na = [-1.0, -0.5]\nb = [1.0, 0.5]\n'
            'c = [1.0, -0.5]\nd = [-1.0, 0.5]\n'
            '[[lines]]\nthrough = ["a", "b"]\nsection = "bar"\nelements = {}\n'
            '[[lines]]\nthrough = ["d", "c"]\nsection = "bar"\nelements = {}\n'
            '[[lines]]\nthrough = ["a", "d"]\nsection = "bar"\nelements = 2\n[reference]\npoint = "a"\n'
            "[reduction]\nhighest_frequency = 100.0\n[modes]\ndamping_ratio = 0.01\n"
        )
        for name, elements in (("coarse", (4, 3)), ("fine", (8, 7))):
            (self.folder / f"{name}.toml").write_text(cross.format(*elements), encoding="utf-8")
        self.build("coarse.toml", "fine.toml")
        for other in ("coarse", "fine"):
            diff = json.loads(self.run_program("diff", "out/coarse.h5", f"out/{other}.h5", "--json").stdout)
            self.assertGreater(min(mode["mac"] for mode in diff["modes"]), 0.999)
            self.assertTrue(all(mode["new_modes"] for mode in diff["modes"]))

    def test_what_points_without_mass_miss_is_told_with_its_remedies(self):
        """A link of two elements has six elastic motions with mass; all of them leave 98 % of the flexibility of the
        rubber at its eyes, which have no mass."""
        link = (
            '[materials.steel]\nyoungs_modulus = 2.1e11\ndensity = 7850.0\n[sections.bar]\nmaterial = "steel"\n'
            'shape = "tube"\nouter_diameter = 0.03\nwall = 0.004\n[points]\neye = [-0.24, 0.0]\na = [-0.2, 0.0]\n'
            'm = [0.0, 0.0]\nb = [0.2, 0.0]\nother_eye = [0.24, 0.0]\n[[lines]]\nthrough = ["a", "m", "b"]\n'
            'section = "bar"\nelements = {elements}\n'
            '[[springs]]\nfrom = "a"\nto = "eye"\naxial_stiffness = 1e7\nrotational_stiffness = 2000.0\n'
            '[[springs]]\nfrom = "b"\nto = "other_eye"\naxial_stiffness = 1e7\nrotational_stiffness = 2000.0\n'
            '{more}[reference]\npoint = "m"\n[interface]\neye = "xyr"\nother_eye = "xyr"\n'
            "[reduction]\nhighest_frequency = {highest}\n[modes]\ndamping_ratio = 0.01\n"
        )
        eyes = "".join(
            f'[[point_masses]]\npoint = "{eye}"\nmass = 0.05\ninertia = 1e-5\n' for eye in ("eye", "other_eye")
        )
        for elements, highest, more, misses in ((1, 1000.0, "", r"0\.\d+"), (1, 2e5, "", r"0\.9\d+"),
                                                (2, 1000.0, "", None), (1, 1000.0, eyes, None)):  # fmt: skip
            with self.subTest(elements=elements, highest=highest, more=more):
                text = link.format(elements=elements, highest=highest, more=more)
                (self.folder / "link.toml").write_text(text, encoding="utf-8")
                result = self.build("link.toml", code=3 if misses else 0)
                if misses:
                    said = rf"the basis misses {misses} of an interface flexibility with \d residual vectors, tolerance"
                    self.assertRegex(result.stderr, said + r" 0\.01: no other motion has mass: give points without")

    # f ∝ √I of a clamped beam in bending; its axial modes have nothing of I.

    def test_sensitivity_tells_what_each_number_of_a_design_changes(self):
        result = self.run_program("sensitivity", "chassis.toml", "--modes", "6")
        self.assertEqual(result.returncode, 0, result.stderr)
        clamped = result.stdout[result.stdout.index("clamped") :]
        row = next(line.split() for line in clamped.splitlines() if line.startswith("sections.frame.second_moment"))
        self.assertEqual(row[-6:], ["0.5000"] * 4 + ["0.0000"] * 2)
        data = json.loads(self.run_program("sensitivity", "chassis.toml", "--json").stdout)
        by_mass = next(one for one in data["parameters"] if one["key"] == "sections.frame.mass_per_length")
        self.assertAlmostEqual(by_mass["derivative"]["mass_kg"], 2 * 3.8257)
        self.assertEqual(len(data["elements"]), 12)
        result = self.run_program("sensitivity", "chassis.toml", "--set", "sections.frame.are=1")
        self.assertEqual(result.returncode, 2)
        self.assertIn("unknown key 'are' in 'sections.frame'", result.stderr)

    def test_a_value_set_in_place_of_the_design_s_is_kept_with_the_file(self):
        self.build("chassis.toml", "--set", "sections.frame.second_moment=2.09e-4")
        set_before = self.read("chassis.h5")
        modes = json.loads(self.run_program("info", "out/chassis.h5", "--json").stdout)["modes"]
        self.assertAlmostEqual(modes[0]["frequency_hz"], 6.4095, places=4)
        result = self.build("chassis.toml", "--set", "sections.frame.second_moment=2.09e-4")
        self.assertIn("up to date", result.stdout)
        self.assertIn("(the design changed)", self.build("chassis.toml").stdout)
        self.assertNotEqual(self.read("chassis.h5"), set_before)
        result = self.build("chassis.toml", "--set", "sections.frame.second_momnt=1", code=2)
        self.assertIn("unknown key 'second_momnt'", result.stderr)

    def test_sweep_follows_the_modes_of_a_design(self):
        vary = "sections.frame.second_moment=1.9e-4:7.6e-4:6"
        result = self.run_program("sweep", "chassis.toml", "--vary", vary, "--modes", "6", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        points = json.loads(result.stdout)["points"]
        self.assertEqual(len(points), 7)
        first, last = (point["clamped"]["frequency_hz"] for point in (points[0], points[-1]))
        for mode in range(4):
            self.assertAlmostEqual(last[mode] / first[mode], 2.0, places=6)
        self.assertAlmostEqual(last[4], first[4], places=6)  # the axial pair, which bending has passed
        for bad in ("sections.frame.area", "a=1:2", "a=1:2:0", "a=1:x:3"):
            result = self.run_program("sweep", "chassis.toml", "--vary", bad)
            self.assertEqual(result.returncode, 2)
            self.assertIn(f"'{bad}' is not of the form key.path=FROM:TO:STEPS", result.stderr)

    def test_modes_of_a_body_of_millimetres_and_grams_are_followed_as_those_of_one_of_metres(self):
        # All lengths times s: frequencies times 1/s, masses times s³, the same correlations.
        def make_design(s):
            sections = "".join(f'[sections.{name}]\nmaterial = "steel"\nshape = "rectangle"\nwidth = {0.05 * s!r}\n'
                               f"height = {height * s!r}\n" for name, height in (("a", 0.03), ("b", 0.04)))
            points = "".join(f"{name} = [{x * s!r}, {y * s!r}]\n"
                             for name, x, y in (("o", 0.0, 0.0), ("p", 2.0, 0.0), ("q", 0.0, 1.7), ("r", 1.5, -0.8)))
            lines = "".join(f'[[lines]]\nfrom = "o"\nto = "{end}"\nsection = "{name}"\nelements = 8\n'
                            for end, name in (("p", "a"), ("q", "b"), ("r", "b")))
            return ('[materials.steel]\nyoungs_modulus = 2.1e11\ndensity = 7850.0\n' + sections + "[points]\n" + points
                    + lines + f'[[point_masses]]\npoint = "p"\nmass = {3.0 * s**3!r}\ninertia = {0.1 * s**5!r}\n'
                    '[reference]\npoint = "o"\n[modes]\ncount = 4\ndamping_ratio = 0.01\n')
        for flag in ((), ("--preview",)):
            of_scale = []
            for s in (1.0, 1e-3):
                (self.folder / "body.toml").write_text(make_design(s))
                vary = f"sections.a.height={0.03 * s!r}:{0.06 * s!r}:6"
                result = self.run_program("sweep", "body.toml", "--vary", vary, "--modes", "5", "--json", *flag)
                self.assertEqual(result.returncode, 0, result.stderr)
                of_scale.append(json.loads(result.stdout)["points"])
            for large, small in zip(*of_scale):
                self.assertAlmostEqual(small["mass_kg"] * 1e9 / large["mass_kg"], 1.0, places=9)
                for kind in ("free", "clamped"):
                    for i in range(5):
                        frequencies = [point[kind]["frequency_hz"][i] for point in (large, small)]
                        self.assertAlmostEqual(frequencies[1] * 1e-3 / frequencies[0], 1.0, places=7)
                        correlations = [point[kind]["correlation"][i] for point in (large, small)]
                        self.assertAlmostEqual(*correlations, places=6)
                        self.assertGreater(correlations[1], 0.9)

    def test_a_preview_of_a_sweep_is_right_for_small_changes_without_solving_them(self):
        # Expected: the modes solved for each value. Those in a space of shapes are not below them.
        sweep = ("sweep", "ladder_frame.toml", "--vary", "sections.post.height=0.08:0.084:1", "--modes", "6")
        result = self.run_program(*sweep, "--preview")
        self.assertTrue(result.stdout.startswith("Preview: all but the first line by the modes of the first line\n"))
        solved, previewed = (
            json.loads(self.run_program(*sweep, "--json", *flag).stdout) for flag in ((), ("--preview",))
        )
        self.assertEqual((solved["preview"], previewed["preview"]), (False, True))
        for kind in ("free", "clamped"):
            (before, after), (same, found) = (
                [point[kind]["frequency_hz"] for point in points["points"]] for points in (solved, previewed)
            )
            for mode in range(6):
                self.assertAlmostEqual(same[mode] / before[mode], 1.0, delta=1e-9)
                self.assertGreater(found[mode] / after[mode] - 1.0, -1e-9)
                self.assertLess(found[mode] / after[mode] - 1.0, 1e-3)
            self.assertGreater(after[2] / before[2], 1.03)
        moving = ("--vary", "points.front_end.0=-3.8257:-3.9:1", "--preview")
        result = self.run_program("sweep", "chassis.toml", *moving)
        self.assertEqual(result.returncode, 2)
        self.assertIn("'points.front_end.0' = -3.9 moves nodes", result.stderr)

    def test_quiet_prints_nothing_and_errors_still(self):
        result = self.build("chassis.toml", "--quiet")
        self.assertEqual((result.stdout, result.stderr), ("", ""))
        self.change("chassis.toml", "1.9e-4", "1.8e-4")
        self.assertEqual(self.build("chassis.toml", "--quiet").stdout, "")
        self.change("chassis.toml", "1.8e-4", "-1.8e-4")
        self.assertIn("must be > 0 m⁴", self.build("chassis.toml", "--quiet", code=2).stderr)

    def test_a_wrong_command_line_ends_with_exit_code_2_and_help_with_0(self):
        for arguments in ((), ("bild",), ("build",), ("build", "--no-such-option", "chassis.toml")):
            self.assertEqual(self.run_program(*arguments).returncode, 2, arguments)
        for arguments in (("--help",), ("build", "--help"), ("--version",)):
            result = self.run_program(*arguments)
            self.assertEqual(result.returncode, 0)
            self.assertIn("sprung-reduce", result.stdout)


if __name__ == "__main__":
    run_tests()
