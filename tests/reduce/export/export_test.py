"""Superelements as matrices and tables, read back by an independent reader that knows the formats alone.

Usage: export_test.py PROGRAM SOURCE_DIR [unittest arguments]
"""

import h5py
import numpy as np
from export_case import CLAMPED, FREE, Expected, ExportCase, files, run_tests


class ExportTest(ExportCase):
    def test_matrix_market(self):
        for rest in (CLAMPED, FREE):
            self.make_body(rest).close()
            self.export("matrix-market")
            nodes, modes, freedoms = (self.read_csv(f"body_{name}.csv") for name in ("nodes", "modes", "freedoms"))
            read = {name: files.read_matrix_market(self.folder / f"body_{name}.mtx")
                    for name in ("stiffness", "mass", "damping", "shapes", "body_mass", "B")}
            self.assertEqual([(row["node"], row["direction"]) for row in freedoms],
                             [(node["node"], d) for node in nodes for d in ("x", "y", "rz")])
            order = self.order([float(node["x"]) for node in nodes])
            self.assertEqual([nodes[i]["point"] for i in order], ["a", "b", "", "c"])
            shapes = read["shapes"].reshape(len(nodes), 3, -1)[order].reshape(read["shapes"].shape)
            expected = Expected(shapes)
            np.testing.assert_allclose(read["stiffness"], expected.stiffness, atol=1e-9 * expected.stiffness.max())
            np.testing.assert_allclose(read["mass"], expected.M_ff, atol=1e-9)
            np.testing.assert_allclose(read["B"], expected.xy - expected.xy.T, atol=1e-9)
            omega = 2.0 * np.pi * np.array([float(mode["frequency_hz"]) for mode in modes])
            np.testing.assert_allclose(np.diag(read["damping"]), 0.04 * omega, rtol=1e-12)
            n = len(modes)
            body = np.zeros((3 + n, 3 + n))
            body[0, 0] = body[1, 1] = expected.mass
            body[1, 2] = body[2, 1] = expected.mass * expected.centre
            body[2, 2] = expected.second_moment
            body[:2, 3:], body[2, 3:], body[3:, 3:] = expected.P, expected.c, expected.M_ff
            np.testing.assert_allclose(np.triu(read["body_mass"]), np.triu(body), atol=1e-9 * expected.mass)
            if rest == CLAMPED:
                self.assert_frequencies(read["stiffness"], read["mass"], expected.clamped_frequencies())

    def test_files_that_cannot_all_be_written_leave_those_of_before(self):
        self.make_body().close()
        for target, last in (("csv", "body_values.csv"), ("matrix-market", "body_modes.csv"),
                             ("exudyn", "body_nodes.csv")):  # fmt: skip
            with self.subTest(target=target):
                for path in self.folder.glob("body[_.]*"):
                    path.unlink()
                (self.folder / last).mkdir()
                result = self.run_program("export", "out/beam.h5", "--to", target, "-o", "body")
                self.assertEqual(result.returncode, 2, result.stdout)
                self.assertEqual([path.name for path in self.folder.glob("body*")], [last])
                (self.folder / last).rmdir()

    def test_csv_has_every_number_and_name_of_the_file(self):
        """Integers and texts were missing, so that rows of /resultants belonged to no element."""
        with self.make_body() as file:
            self.export("csv")
            found = {}
            for row in self.read_csv("body_values.csv"):
                found.setdefault(row["dataset"], []).append(row)
            names = []
            file.visititems(lambda name, item: names.append("/" + name)
                            if isinstance(item, h5py.Dataset) and item.size and not name.startswith("provenance")
                            else None)
            self.assertEqual(sorted(found), sorted(names))
            for name in names:
                values = file[name][()]
                if values.dtype.kind == "f":
                    self.assertEqual(sorted(float(row["value"]) for row in found[name]), sorted(values.ravel()), name)
                    continue
                for row in found[name]:
                    place = (int(row["row"]), int(row["column"]))[: values.ndim]
                    value = values[place]
                    self.assertEqual(row["value"], value.decode() if isinstance(value, bytes) else str(value), name)
                self.assertEqual(len(found[name]), values.size)
            self.assertEqual([int(row["mode"]) for row in self.read_csv("body_modes.csv")],
                             list(range(1, len(file["modes/frequency"]) + 1)))

    def test_a_target_that_is_not_known_and_a_file_that_cannot_be_written(self):
        self.make_body().close()
        result = self.run_program("export", "out/beam.h5", "--to", "adams", "-o", "body")
        self.assertEqual(result.returncode, 2)
        self.assertIn("adams", result.stderr)
        result = self.run_program("export", "out/beam.h5", "--to", "mbdyn", "-o", "none/body")
        self.assertEqual(result.returncode, 2)
        self.assertIn("none/body.fem: error: ", result.stderr)
        result = self.run_program("export", "beam.toml", "--to", "mbdyn", "-o", "body")
        self.assertEqual(result.returncode, 2)


if __name__ == "__main__":
    run_tests()
