"""Superelements written for other programs, read back by an independent reader that knows the formats alone.

A straight beam whose matrices the test makes itself gives the expected frequencies, masses and integrals.

Usage: export_test.py PROGRAM SOURCE_DIR [unittest arguments]
"""

import csv
import re
import sys
from pathlib import Path

import h5py
import numpy as np

for folder in ("program", "matrices"):
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / folder))

import matrix_files as files  # noqa: E402  after the path
from reduce_case import ReduceTestCase, run_tests  # noqa: E402

NUM_ELEMENTS = 3
MASS_PER_LENGTH = 420.0
# The beam lies beside the reference node's axes, so that no integral vanishes by chance.
DESIGN = f"""[materials.stuff]
youngs_modulus = 1e6
density = 4200.0
[sections.bar]
material = "stuff"
area = 0.1
second_moment = 1e-3
[points]
a = [0.0, 0.0]
b = [1.0, 0.0]
c = [3.0, 0.0]
[[lines]]
through = ["a", "b", "c"]
section = "bar"
elements = [1, {NUM_ELEMENTS - 1}]
[reference]
point = "b"
"""
CLAMPED = "[modes]\nall = true\ndamping_ratio = 0.02\n"
FREE = "[reduction]\nhighest_frequency = 2.0\n[modes]\ndamping_ratio = 0.02\n"
PLACES = np.arange(NUM_ELEMENTS + 1.0) - 1.0  # of the nodes, from the reference node


def integrate(function):
    """∫ function(element, ξ) ρA dx by Gauss quadrature, exact for products of two cubics."""
    points, weights = np.polynomial.legendre.leggauss(4)
    return sum(0.5 * weight * MASS_PER_LENGTH * function(element, 0.5 * (point + 1.0))
               for element in range(NUM_ELEMENTS) for point, weight in zip(points, weights))


def interpolate(shapes, element, xi):
    """(x, φ_x, φ_y) in an element of 1 m from shapes 3N×n in the order of PLACES."""
    a, b = shapes[3 * element : 3 * element + 3], shapes[3 * element + 3 : 3 * element + 6]
    across = ((1 - 3 * xi**2 + 2 * xi**3) * a[1] + (xi - 2 * xi**2 + xi**3) * a[2]
              + (3 * xi**2 - 2 * xi**3) * b[1] + (xi**3 - xi**2) * b[2])
    return PLACES[element] + xi, (1 - xi) * a[0] + xi * b[0], across


class Expected:
    """Integrals of shapes 3N×n in the order of PLACES."""

    def __init__(self, shapes):
        self.K, self.M = files.make_beam(NUM_ELEMENTS)
        n = len(PLACES)
        along_x, along_y, rotation = np.zeros((3, 3 * n))
        along_x[0::3] = along_y[1::3] = rotation[2::3] = 1.0
        rotation[1::3] = PLACES
        self.mass = along_x @ self.M @ along_x
        self.centre = along_y @ self.M @ rotation / self.mass
        self.second_moment = rotation @ self.M @ rotation
        self.P = np.array([along_x, along_y]) @ self.M @ shapes
        self.c = rotation @ self.M @ shapes
        self.x_phi_x, self.x_phi_y = (
            integrate(lambda e, xi, d=d: np.multiply(*self.pick(shapes, e, xi, 0, d))) for d in (1, 2))
        self.xx, self.xy, self.yy = (
            integrate(lambda e, xi, i=i, j=j: np.outer(*self.pick(shapes, e, xi, i, j)))
            for i, j in ((1, 1), (1, 2), (2, 2)))
        self.stiffness, self.M_ff = shapes.T @ self.K @ shapes, shapes.T @ self.M @ shapes

    @staticmethod
    def pick(shapes, element, xi, i, j):
        values = interpolate(shapes, element, xi)
        return values[i], values[j]

    def clamped_frequencies(self):
        held = [i for i in range(len(self.K)) if i // 3 != 1]
        squares = np.linalg.eigvals(np.linalg.solve(self.M[np.ix_(held, held)], self.K[np.ix_(held, held)]))
        return np.sqrt(np.sort(squares.real)) / (2.0 * np.pi)


class ExportTest(ReduceTestCase):
    def make_body(self, rest=CLAMPED):
        (self.folder / "beam.toml").write_text(DESIGN + rest)
        self.build("beam.toml", "--force")
        return h5py.File(self.folder / "out/beam.h5")

    def export(self, target):
        result = self.run_program("export", "out/beam.h5", "--to", target, "-o", "body")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("left out: ", result.stdout)
        for line in result.stdout.splitlines():
            if not line.startswith("left out: "):
                self.assertTrue((self.folder / line).exists(), line)
        return result.stdout

    def read_csv(self, name):
        with open(self.folder / name, encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def order(self, positions):
        np.testing.assert_allclose(np.sort(positions), PLACES, atol=1e-14)
        return np.argsort(positions)

    def assert_frequencies(self, stiffness, mass, expected):
        squares = np.linalg.eigvals(np.linalg.solve(mass, stiffness))
        found = np.sqrt(np.sort(squares.real)) / (2.0 * np.pi)
        np.testing.assert_allclose(found[: len(expected)], expected, rtol=1e-9)

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

    def test_csv_has_every_number_of_the_file(self):
        with self.make_body() as file:
            self.export("csv")
            found = {}
            for row in self.read_csv("body_values.csv"):
                found.setdefault(row["dataset"], []).append(float(row["value"]))
            names = []
            file.visititems(lambda name, item: names.append("/" + name)
                            if isinstance(item, h5py.Dataset) and item.dtype.kind == "f" and item.size else None)
            self.assertEqual(sorted(found), sorted(names))
            for name in names:
                self.assertEqual(sorted(found[name]), sorted(file[name][()].ravel()), name)
            self.assertEqual([int(row["mode"]) for row in self.read_csv("body_modes.csv")],
                             list(range(1, len(file["modes/frequency"]) + 1)))

    # MBDyn's modal joint.

    def read_fem(self):
        """Record groups by number: the numbers of each, without comments."""
        groups, group = {}, None
        for line in (self.folder / "body.fem").read_text().splitlines():
            heading = re.match(r"\*\* RECORD GROUP (\d+),", line)
            if heading:
                group = groups.setdefault(int(heading[1]), [])
            elif not line.startswith("**"):
                group.extend(line.split())
        return groups

    def read_sums(self):
        """(groups, nodes of the frame, their shapes 3N×n, and what MBDyn sums up over all nodes of the file)."""
        groups = self.read_fem()
        self.assertEqual(sorted(groups), [1, 2, *range(5, 14)])
        revision, count, n, *none = groups[1]
        self.assertEqual((revision, none), ("REV0", ["0", "0", "0"]))
        count, n, labels = int(count), int(n), groups[2]
        self.assertEqual(len(set(labels)), count)
        numbers = {number: np.array(words, float) for number, words in groups.items() if number > 2}
        shapes = numbers[8].reshape(n, count, 6)
        self.assertFalse(numbers[7].any() or shapes[:, :, 2:5].any())
        x, y, lumped = numbers[5], numbers[6], numbers[11].reshape(count, 6)
        self.assertTrue((lumped[:, :1] == lumped[:, :3]).all() and not lumped[:, 3:5].any() and (lumped >= 0).all())
        m, J = lumped[:, 0], lumped[:, 5]
        frame = [label.isdigit() for label in labels]
        self.assertFalse(lumped[frame].any())
        fx, fy, psi = (shapes[:, :, i].T for i in (0, 1, 5))
        sums = {"mass": m.sum(), "centre": (m @ x, m @ y), "J": m @ (x**2 + y**2) + J.sum(), "P": (m @ fx, m @ fy),
                "c": (m * x) @ fy - (m * y) @ fx + J @ psi, "d": (m * x) @ fx + (m * y) @ fy,
                "E": (fx.T * m) @ fx + (fy.T * m) @ fy, "R": (psi.T * J) @ psi, "B": (fx.T * m) @ fy - (fy.T * m) @ fx}
        frame_shapes = shapes[:, frame][:, :, [0, 1, 5]].transpose(1, 2, 0)
        return numbers, (x[frame], y[frame]), frame_shapes, sums

    def test_mbdyn(self):
        for rest in (CLAMPED, FREE):
            self.make_body(rest).close()
            self.assertIn("moments of inertia about x and y", self.export("mbdyn"))
            numbers, (x, y), shapes, sums = self.read_sums()
            n = shapes.shape[2]
            self.assertFalse(y.any())
            expected = Expected(shapes[self.order(x)].reshape(-1, n))
            mass, stiffness, damping = (numbers[i].reshape(n, n) for i in (9, 10, 13))
            np.testing.assert_allclose(mass, expected.M_ff, atol=1e-9)
            np.testing.assert_allclose(stiffness, expected.stiffness, atol=1e-9 * expected.stiffness.max())
            np.testing.assert_allclose(np.diag(damping), 0.04 * np.sqrt(np.diag(stiffness)), rtol=1e-9)
            if rest == CLAMPED:
                self.assert_frequencies(stiffness, mass, expected.clamped_frequencies())
            J = expected.second_moment - expected.mass * expected.centre**2
            np.testing.assert_allclose(
                numbers[12], [expected.mass, expected.centre, 0, 0, J / 2, 0, 0, 0, J / 2, 0, 0, 0, J], atol=1e-9)
            self.check_sums(sums, expected, np.zeros(n), 0.0)

    def check_sums(self, sums, e, psi, inertia):
        """@param psi, inertia  rotation of a point mass and its inertia, the only rotary one"""
        for name, expected in (
            ("mass", e.mass), ("centre", (e.mass * e.centre, 0.0)), ("J", e.second_moment + inertia), ("P", e.P),
            ("c", e.c + inertia * psi), ("d", e.x_phi_x), ("E", e.xx + e.yy), ("R", inertia * np.outer(psi, psi)),
            ("B", e.xy - e.xy.T),
        ):  # fmt: skip
            np.testing.assert_allclose(sums[name], expected, atol=1e-9 * max(1.0, np.abs(expected).max()), err_msg=name)

    def test_matrices_whose_integrals_belong_to_no_masses_are_refused_by_mbdyn(self):
        """B of cubic beams as matrices is not exact (reduce/matrices, eq. 7). With all modes of two elements no masses
        have it."""
        (self.folder / "beam.toml").write_text(DESIGN.replace(f"[1, {NUM_ELEMENTS - 1}]", "[1, 1]") + CLAMPED)
        result = self.run_program("matrices", "beam.toml", "-o", "frame")
        self.assertEqual(result.returncode, 0, result.stderr)
        (self.folder / "beam.toml").write_text(
            '[points]\nb = [1.0, 0.0]\n[matrices]\nformat = "matrix-market"\nstiffness = "frame_stiffness.mtx"\n'
            'mass = "frame_mass.mtx"\nfreedoms = "frame_freedoms.csv"\nnodes = "frame_nodes.csv"\n'
            '[reference]\npoint = "b"\n' + CLAMPED)
        self.build("beam.toml", "--force")
        result = self.run_program("export", "out/beam.h5", "--to", "mbdyn", "-o", "body")
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn("body.fem: error: no masses at points have the body's integrals", result.stderr)

    # Standard input data.

    def read_sid(self):
        """(refmod, nodes, matrices): a matrix is (zero order, [first order for each mode])."""
        lines = iter((self.folder / "body.SID_FEM").read_text().splitlines())
        header, part, modal = next(lines), next(lines), next(lines)
        self.assertRegex(header, r"^4 \d+ : ")
        self.assertEqual((part, modal), ("part", "new modal = beam"))
        refmod, nodes, matrices = {}, {}, {}
        target, ends = matrices, []
        for line in lines:
            key, _, value = (word.strip() for word in line.partition("="))
            if key in ("refmod", "frame"):
                ends.append(key)
            elif key == "new node":
                target = nodes.setdefault(int(value), {})
                ends.append("node")
            elif key.startswith("end "):
                self.assertEqual(key[4:], ends.pop() if ends else key[4:])
                target = matrices if key == "end node" else target
            elif value and ends == ["refmod"]:
                refmod[key] = value
            elif key == "rframe":
                self.assertEqual(value, "body ref")
            else:
                target[key] = self.read_taylor(key, lines)
        return refmod, nodes, matrices

    def read_taylor(self, name, lines):
        head = [next(lines).split(" = ") for _ in range(6)]
        self.assertEqual([key for key, _ in head], ["order", "nrow", "ncol", "nq", "nqn", "structure"])
        order, rows, columns, num_modes, _, _ = (int(value) for _, value in head)
        zero, first = np.zeros((rows, columns)), np.zeros((num_modes if order else 0, rows, columns))
        for line in lines:
            if line == f"end {name}":
                return zero, first
            match = re.fullmatch(r"m([01])\(([\d,]+)\) = (\S+)", line)
            place = [int(number) - 1 for number in match[2].split(",")]
            self.assertIn("D", match[3])
            value = float(match[3].replace("D", "E"))
            if match[1] == "0":
                zero[tuple(place)] = value
            else:
                row, mode, column = place
                first[mode, row, column] = value
        self.fail(f"{name} has no end")

    def test_sid_in_both_orders_of_the_indices(self):
        for target, by_mode in (("sid", False), ("sid-by-mode", True)):
            for rest in (CLAMPED, FREE):
                with self.make_body(rest) as file:
                    self.assertIn("moments of inertia about x and y", self.export(target))
                    self.check_sid(*self.read_sid(), by_mode, {name[12:]: file[name][()] for name in (
                        "/stiffening/centrifugal", "/stiffening/angular_acceleration", "/stiffening/acceleration",
                        "/stiffening/point_load")})
                    if rest == CLAMPED:
                        _, _, matrices = self.read_sid()
                        self.assert_frequencies(matrices["Ke"][0], matrices["Me"][0],
                                                Expected(np.zeros((12, 1))).clamped_frequencies())

    def check_sid(self, refmod, nodes, matrices, by_mode, K):
        def close(found, expected):
            np.testing.assert_allclose(found, expected, atol=1e-9 * max(1.0, np.abs(expected).max(initial=0.0)))

        n = int(refmod["nelastq"])
        places = {number: node["origin"][0][:, 0] for number, node in nodes.items()}
        order = sorted(nodes, key=lambda number: places[number][0])
        close([places[number] for number in order], [(x, 0.0, 0.0) for x in PLACES])
        shapes = np.concatenate([[*nodes[number]["phi"][0][:2], nodes[number]["psi"][0][2]] for number in order])
        e = Expected(shapes)
        zero, B, both = np.zeros(n), e.xy - e.xy.T, e.xx + e.yy
        self.assertAlmostEqual(float(refmod["mass"].replace("D", "E")), e.mass, places=9)
        close(matrices["mdCM"][0][:, 0], [e.mass * e.centre, 0, 0])
        close(matrices["mdCM"][1][:, :, 0].T, [*e.P, zero])
        close(matrices["J"][0][:, 0], e.second_moment * np.array([0.5, 0.5, 1.0, 0, 0, 0]))
        close(matrices["Ct"][0].T, [*e.P, zero])
        close(matrices["Cr"][0].T, [zero, zero, e.c])
        close(matrices["Me"][0], e.M_ff)
        close(matrices["Ke"][0], e.stiffness)
        close(np.diag(matrices["De"][0]), 0.04 * np.sqrt(np.diag(e.stiffness)))
        self.assertFalse(matrices["ksigma"][0].any())
        # −2 ∫r~ φ_k~ dm with y = 0, and the moment of inertia's derivative, half of it and its transpose.
        for k in range(n):
            products = np.array([[0, 0, 0], [-e.x_phi_y[k], e.x_phi_x[k], 0], [0, 0, e.x_phi_x[k]]])
            axes = slice(3 * k, 3 * k + 3) if by_mode else slice(k, None, n)
            close(matrices["Gr"][0][:, axes], 2 * products)
            tensor = products + products.T
            close(matrices["J"][1][k][:, 0], [*np.diag(tensor), tensor[0, 1], 0, 0])
            close(matrices["Ge"][0][:, axes].T, [zero, zero, -2 * B[:, k]])
        close(matrices["Oe"][0].T, [zero, -e.x_phi_x, -e.x_phi_x, e.x_phi_y, zero, zero])
        # First order: rows j, coordinates k.
        close(matrices["Cr"][1][:, :, 2].T, B.T + K["angular_acceleration"])
        close(matrices["Ct"][1][:, :, 0].T, K["acceleration"][0])
        close(matrices["Ct"][1][:, :, 1].T, K["acceleration"][1])
        first = matrices["Oe"][1].transpose(1, 0, 2)
        for column, expected in enumerate((-e.yy, -e.xx, K["centrifugal"] - both, e.xy + e.xy.T, 0 * B, 0 * B)):
            close(first[:, :, column], expected)
        # Nodes: their own motion moves origin and axes, and loads on points meet the geometric stiffness.
        points = [order[0], order[1], order[3]]  # a, b, c
        for number, node in nodes.items():
            close(node["origin"][1][:, :, 0].T, node["phi"][0])
            close(node["AP"][0], np.eye(3))
            close(node["AP"][1][:, 1, 0], node["psi"][0][2])
            close(node["AP"][1][:, 0, 1], -node["psi"][0][2])
            if number in points:
                at = 3 * points.index(number)
                for axis in range(2):
                    close(node["phi"][1][:, axis, :], -K["point_load"][at + axis])
                close(node["psi"][1][:, 2, :], -K["point_load"][at + 2])
            else:
                self.assertEqual(len(node["phi"][1]), 0)

    # Exudyn and MBSim: a dictionary of numpy arrays, and named integrals, as HDF5.

    def check_spatial(self, shapes, positions, rotations=None):
        """@return shapes of x, y and rotation in the order of PLACES, from three displacements of each node"""
        places = positions.reshape(-1, 3)
        self.assertFalse(places[:, 1:].any())
        order = self.order(places[:, 0])
        planar = shapes.reshape(len(places), 3, -1)[order]
        self.assertFalse(planar[:, 2].any())
        if rotations is not None:
            turned = rotations.reshape(planar.shape)[order]
            self.assertFalse(turned[:, :2].any())
            planar[:, 2] = turned[:, 2]
        return planar.reshape(shapes.shape)

    @staticmethod
    def read_dictionary(path):
        """A file as Exudyn's LoadDictFromHDF5 reads it: the attribute `datatype` says what each object is."""
        casts = {"float64": float, "int": int, "ndarray": np.array, "str": lambda value: value.decode("utf-8")}
        with h5py.File(path) as file:
            values = {}
            for key, item in file.items():
                datatype = item.attrs["datatype"]
                if isinstance(item, h5py.Group):
                    values[key] = {"list": [], "dict": {}}[datatype]
                    assert not len(item)
                else:
                    values[key] = casts[datatype](item[()])
            return values

    def test_exudyn(self):
        for rest in (CLAMPED, FREE):
            with self.make_body(rest) as file:
                rotations = np.zeros_like(file["modes/shape"])
                rotations[:, 2] = file["modes/shape"][:, 2]
            printed = self.export("exudyn")
            for word in ("damping", "rotations of the nodes", "inertia about x and y", "geometric stiffness"):
                self.assertIn(word, printed)
            data = self.read_dictionary(self.folder / "body.hdf5")
            self.assertEqual((data["type"], data["fileVersion"], data["rigidBodyNodeType"]), (
                "ObjectFFRFreducedOrderInterface", 1, "NodeType.RotationEulerParameters"))
            self.assertEqual((data["trigList"], data["postProcessingModes"]), ([], {}))
            n = data["modeBasis"].shape[1]
            self.assertEqual(data["infoList"].tolist(), [n, len(PLACES), 3, 4, 7, 7 + n])
            shapes = self.check_spatial(data["modeBasis"], data["xRef"], rotations.reshape(data["modeBasis"].shape))
            self.assertEqual([float(row["x"]) for row in self.read_csv("body_nodes.csv")], data["xRef"][::3].tolist())
            e = Expected(shapes)

            def close(name, expected):
                np.testing.assert_allclose(data[name], expected, atol=1e-9 * max(1.0, np.abs(expected).max()),
                                           err_msg=name)

            zero, J = np.zeros(n), e.second_moment
            close("totalMass", e.mass)
            close("Mtt", e.mass * np.eye(3))
            close("chiU", [e.centre, 0, 0])
            close("chiUtilde", [[0, 0, 0], [0, 0, -e.centre], [0, e.centre, 0]])
            close("inertiaLocal", np.diag([J / 2, J / 2, J]))
            close("massMatrixReduced", e.M_ff)
            close("stiffnessMatrixReduced", e.stiffness)
            close("mPhitTPsi", [*e.P, zero])
            close("mXRefTildePsi", [zero, zero, -e.c])
            close("mPsiTildePsi", np.stack([0 * e.xy, 0 * e.xy, e.xy.T - e.xy], axis=1).reshape(3 * n, n))
            for k in range(n):
                x, y = e.P[:, k]
                data["block"] = data["mPhitTPsiTilde"][:, 3 * k : 3 * k + 3]
                close("block", [[0, 0, y], [0, 0, -x], [-y, x, 0]])
                data["block"] = data["mXRefTildePsiTilde"][:, 3 * k : 3 * k + 3]
                close("block", [[0, 0, 0], [-e.x_phi_y[k], e.x_phi_x[k], 0], [0, 0, e.x_phi_x[k]]])
                for j in range(n):
                    data["block"] = data["mPsiTildePsiTilde"][3 * k : 3 * k + 3, 3 * j : 3 * j + 3]
                    close("block", [[e.yy[k, j], -e.xy[j, k], 0], [-e.xy[k, j], e.xx[k, j], 0],
                                    [0, 0, e.xx[k, j] + e.yy[k, j]]])
            if rest == CLAMPED:
                self.assert_frequencies(data["stiffnessMatrixReduced"], data["massMatrixReduced"],
                                        e.clamped_frequencies())

    def test_mbsim(self):
        for rest in (CLAMPED, FREE):
            self.make_body(rest).close()
            printed = self.export("mbsim")
            for word in ("moments of inertia about x and y", "geometric stiffness", "section loads"):
                self.assertIn(word, printed)
            with h5py.File(self.folder / "body.h5") as file:
                data = {name: item[()] for name, item in file.items()}
            n = data["stiffness matrix"].shape[0]
            shapes = self.check_spatial(data["nodal shape matrix of translation"], data["nodal relative position"],
                                        data["nodal shape matrix of rotation"])
            e = Expected(shapes)
            self.assertEqual(data["node numbers"].dtype, np.int32)
            self.assertEqual(sorted(data["node numbers"]), [1, 2, 3, 4])

            def close(found, expected):
                np.testing.assert_allclose(found, expected, atol=1e-9 * max(1.0, np.abs(expected).max()))

            close(data["mass"], e.mass)
            close(data["position integral"], [e.mass * e.centre, 0, 0])
            close(data["shape function integral"], [*e.P, np.zeros(n)])
            close(data["stiffness matrix"], e.stiffness)
            close(np.diag(data["damping matrix"]), 0.04 * np.sqrt(np.diag(e.stiffness)))
            # What MBSim's GenericFlexibleFfrBody makes of them, for motion in the plane.
            rr = data["position position integral"]
            rP = data["position shape function integral"].reshape(3, 3, n)  # [k][i] is the integral of r_k φ_i
            xx, xy, xz, yy, yz, zz = data["shape function shape function integral"].reshape(6, n, n)
            close(rr[0, 0] + rr[1, 1], e.second_moment)
            close(rP[0, 1] - rP[1, 0], e.c)
            close(rP[0, 0] + rP[1, 1], e.x_phi_x)
            close(xx + yy + zz, e.M_ff)
            close(xx + yy, e.xx + e.yy)
            close(xy - xy.T, e.xy - e.xy.T)
            self.assertFalse(xz.any() or yz.any() or rP[2].any() or rP[:, 2].any())
            if rest == CLAMPED:
                self.assert_frequencies(data["stiffness matrix"], xx + yy + zz, e.clamped_frequencies())

    def test_rotary_inertia_in_exudyn_mbsim_and_mbdyn(self):
        """The inertia J of a point mass adds ψᵀ J ψ to the mass of the modes, J ψ to their momentum and J to the
        moment of inertia, and nothing to the integrals of displacements."""
        inertia = 70.0
        (self.folder / "beam.toml").write_text(
            DESIGN + f'[[point_masses]]\npoint = "c"\nmass = 0.0\ninertia = {inertia}\n' + CLAMPED)
        self.build("beam.toml", "--force")
        self.export("exudyn")
        self.export("mbsim")
        exudyn = self.read_dictionary(self.folder / "body.hdf5")
        with h5py.File(self.folder / "body.h5") as file:
            mbsim = {name: item[()] for name, item in file.items()}
        shapes = self.check_spatial(mbsim["nodal shape matrix of translation"], mbsim["nodal relative position"],
                                    mbsim["nodal shape matrix of rotation"])
        e = Expected(shapes)
        psi = shapes[-1]
        self.assertGreater(np.abs(psi).max(), 1e-3)
        n = len(psi)
        rP = mbsim["position shape function integral"].reshape(3, 3, n)
        xx, _, _, yy, _, zz = mbsim["shape function shape function integral"].reshape(6, n, n)
        for found, expected in ((exudyn["massMatrixReduced"], e.M_ff + inertia * np.outer(psi, psi)),
                                (xx + yy + zz, e.M_ff + inertia * np.outer(psi, psi)),
                                (-exudyn["mXRefTildePsi"][2], e.c + inertia * psi),
                                (rP[0, 1] - rP[1, 0], e.c + inertia * psi),
                                (exudyn["inertiaLocal"][2, 2], e.second_moment + inertia),
                                (2 * mbsim["position position integral"][0, 0], e.second_moment + inertia),
                                (exudyn["mPsiTildePsiTilde"][2::3, 2::3], e.xx + e.yy),
                                (xx + yy, e.xx + e.yy)):
            np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())
        self.export("mbdyn")
        numbers, _, _, sums = self.read_sums()
        self.check_sums(sums, e, psi, inertia)
        np.testing.assert_allclose(numbers[9].reshape(n, n), e.M_ff + inertia * np.outer(psi, psi), atol=1e-9)

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
