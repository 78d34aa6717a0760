"""Superelements as standard input data, read back by an independent reader that knows the format alone.

Usage: sid_export_test.py PROGRAM SOURCE_DIR [unittest arguments]
"""

import re

import numpy as np
from export_case import CLAMPED, FREE, PLACES, Expected, ExportCase, run_tests


class SidExportTest(ExportCase):
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


if __name__ == "__main__":
    run_tests()
