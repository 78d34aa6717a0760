"""Bodies that another program reduced by Craig and Bampton: nodes at the interfaces, and modal freedoms.

Usage: reduced_bodies_test.py PROGRAM SOURCE_DIR [unittest arguments]
"""

import json
import sys
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "program"))
sys.path.insert(0, str(Path(__file__).resolve().parent))

import matrix_files as files  # noqa: E402  after the path
from reduce_case import ReduceTestCase, run_tests  # noqa: E402

# A beam of 12 elements of 0.5 m at an angle to no axis; nodes 1, 5, 9 and 13 are the interface.
NUM_NODES, LENGTH = 13, 0.5
KEPT = (0, 4, 8, 12)
RIGIDITY = {"axial": 2e8, "bending": 4e6, "mass": 90.0}
DESIGN = """[points]
a = [0.0, 0.0]
b = [2.0, 0.0]
c = [4.0, 0.0]
d = [6.0, 0.0]
[matrices]
FILES
[reference]
point = "b"
METHOD
damping_ratio = 0.01
"""
ALL = '[reduction]\nbasis = "clamped"\n[modes]\nall = true'


def kept_rows(nodes):
    return [3 * node + d for node in nodes for d in range(3)]


def reduce_body(K, M, num_modes):
    """Craig and Bampton by their definition: K and M of the interface freedoms, then of fixed-interface modes."""
    kept = kept_rows(KEPT)
    inner = [i for i in range(len(K)) if i not in kept]
    Koo, Moo = K[np.ix_(inner, inner)], M[np.ix_(inner, inner)]
    lower = np.linalg.inv(np.linalg.cholesky(Moo))
    omega_squared, y = np.linalg.eigh(lower @ Koo @ lower.T)
    T = np.zeros((len(K), len(kept) + num_modes))
    T[kept, : len(kept)] = np.eye(len(kept))
    T[inner, : len(kept)] = -np.linalg.solve(Koo, K[np.ix_(inner, kept)])
    T[inner, len(kept) :] = (lower.T @ y)[:, :num_modes]
    return T.T @ K @ T, T.T @ M @ T, np.sqrt(omega_squared)


def calc_hz(K, M):
    lower = np.linalg.inv(np.linalg.cholesky(M))
    values = np.linalg.eigvalsh(lower @ K @ lower.T)
    return np.sqrt(np.abs(values)) / (2 * np.pi)


class ReducedBodiesTest(ReduceTestCase):
    def setUp(self):
        super().setUp()
        self.K, self.M = files.make_beam(NUM_NODES - 1, LENGTH, **RIGIDITY)
        self.num_inner = 3 * (NUM_NODES - len(KEPT))
        self.ids = [node + 1 for node in KEPT]
        files.write_nodes(self.folder / "n.csv", self.ids, [(LENGTH * node, 0.0) for node in KEPT])

    def freedoms(self, num_modes):
        return files.plane_freedoms(self.ids) + [(101 + i, 0) for i in range(num_modes)]

    def write_reduced(self, num_modes, name="nastran", method=ALL):
        K, M, _ = reduce_body(self.K, self.M, num_modes)
        K, M = 0.5 * (K + K.T), 0.5 * (M + M.T)
        freedoms = self.freedoms(num_modes)
        if name == "nastran":
            # As Nastran writes it: modal freedoms are scalar points; 16 columns hold ten digits.
            files.write_dmig(self.folder / "p.pch", {"KAAX": K, "MAAX": M}, freedoms)
            lines = 'stiffness = "p.pch"\nmass = "p.pch"\nstiffness_name = "KAAX"\nmass_name = "MAAX"\n'
        elif name.startswith("abaqus"):
            internal = [(node, d) if d else (100 - node, 1) for node, d in freedoms]
            if name == "abaqus with internal elements":  # whose nodes have several directions, as of a B33
                internal = [(node, d) if d else ((99 - node) // 3, (node - 101) % 3 + 1) for node, d in freedoms]
            files.write_abaqus(self.folder / "k.mtx", K, internal)
            files.write_abaqus(self.folder / "m.mtx", M, internal)
            lines = 'stiffness = "k.mtx"\nmass = "m.mtx"\n'
        elif name in ("substructure", "substructure of CalculiX"):
            internal = [(node, d) if d else (100 - node, 1) for node, d in freedoms]
            matrices = {"STIFFNESS": K, "STRUCTURAL DAMPING": 0.0 * K, "MASS": M}
            files.write_substructure(self.folder / "s.mtx", matrices, internal, name != "substructure")
            lines = 'stiffness = "s.mtx"\nmass = "s.mtx"\n'
        else:
            files.write_matrix_market(self.folder / "k.mtx", K)
            files.write_matrix_market(self.folder / "m.mtx", M)
            files.write_freedoms(self.folder / "f.csv", [(node, d or "q") for node, d in freedoms])
            lines = 'stiffness = "k.mtx"\nmass = "m.mtx"\nfreedoms = "f.csv"\n'
        lines = f'format = "{name.replace("substructure", "abaqus").split()[0]}"\n{lines}nodes = "n.csv"\n'
        if num_modes == 0 and "s.mtx" not in lines:
            lines += "reduced = true\n"
        (self.folder / "body.toml").write_text(DESIGN.replace("FILES", lines).replace("METHOD", method))

    def build_reduced(self, num_modes, name="nastran", method=ALL):
        self.write_reduced(num_modes, name, method)
        self.build("body.toml", "--force")
        return h5py.File(self.folder / "out/body.h5")

    def vehicle(self, K, M, nodes, keep=None):
        """Frequencies of a frame on springs at both ends, with a mass of 300 kg on a spring at node c."""
        n = len(K)
        whole_K, whole_M = np.zeros((2, n + 1, n + 1))
        whole_K[:n, :n], whole_M[:n, :n] = K, M
        whole_M[n, n] = 300.0
        for row in (nodes[0], nodes[3]):
            whole_K[row[1], row[1]] += 3e5
            whole_K[row[0], row[0]] += 1e5
        hung = np.zeros(n + 1)
        hung[nodes[2][1]], hung[n] = 1.0, -1.0
        return calc_hz(whole_K + 2e5 * np.outer(hung, hung), whole_M)

    def vehicle_of_file(self, file):
        """The same by the superelement: the frame's motion (x, y, angle) at b, and its vectors."""
        shape = file["modes/shape"][()]
        x = file["nodes/position"][()]
        num = shape.shape[2]
        inertia = {name: file["inertia/" + name][()] for name in ("mass", "first_moment", "second_moment", "P", "c")}
        m, J = inertia["mass"].item(), inertia["second_moment"].item()
        Sx, Sy = inertia["first_moment"].ravel()
        size = 3 + num
        K, M = np.zeros((2, size, size))
        K[3:, 3:], M[3:, 3:] = file["matrices/stiffness"][()], file["inertia/M_ff"][()]
        M[:3, :3] = [[m, 0, -Sy], [0, m, Sx], [-Sy, Sx, J]]
        M[:2, 3:], M[2, 3:] = inertia["P"].reshape(2, num), inertia["c"].ravel()
        M[3:, :3] = M[:3, 3:].T
        whole_K, whole_M = np.zeros((2, size + 1, size + 1))
        whole_K[:size, :size], whole_M[:size, :size] = K, M
        whole_M[size, size] = 300.0

        def motion(place, axis):
            node = int(np.argmin(np.abs(x[:, 0] - place)))
            row = np.zeros(size + 1)
            row[axis], row[2] = 1.0, (-x[node, 1], x[node, 0])[axis]
            row[3:size] = shape[node, axis]
            return row
        for place in (-2.0, 4.0):
            for axis, stiffness in ((0, 1e5), (1, 3e5)):
                row = motion(place, axis)
                whole_K += stiffness * np.outer(row, row)
        hung = motion(2.0, 1)
        hung[size] = -1.0
        return calc_hz(whole_K + 2e5 * np.outer(hung, hung), whole_M)

    def full_vehicle(self):
        return self.vehicle(self.K, self.M, [[3 * node, 3 * node + 1] for node in KEPT])

    # With all modes the reduction is a change of coordinates; the written digits limit what is left.

    def test_all_modes_give_the_vehicle_of_the_whole_frame_exactly(self):
        full = self.full_vehicle()
        formats = (("matrix-market", 1e-9), ("abaqus", 1e-9), ("abaqus with internal elements", 1e-9),
                   ("substructure", 1e-9), ("substructure of CalculiX", 1e-9), ("nastran", 1e-6))
        for name, tolerance in formats:
            with self.subTest(name), self.build_reduced(self.num_inner, name) as file:
                np.testing.assert_allclose(self.vehicle_of_file(file), full, rtol=tolerance)
                self.assertEqual(list(file["nodes/id"]), self.ids)

    def test_modes_of_equal_frequency_may_be_mixed_across_the_plane(self):
        # A bar that bends out of the plane as in it, as one of a square section; each mode of the one is mixed with its
        # equal of the other by an angle of its own.
        reduced = reduce_body(self.K, self.M, self.num_inner)[:2]
        size, num_kept = len(reduced[0]), 3 * len(KEPT)
        mix = np.eye(2 * size)
        for i in range(num_kept, size):
            pair, angle = [i, size + i], 0.1 + 0.7 * i
            mix[np.ix_(pair, pair)] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        for path, matrix in zip(("k.mtx", "m.mtx"), reduced):
            whole = mix.T @ np.kron(np.eye(2), 0.5 * (matrix + matrix.T)) @ mix
            files.write_matrix_market(self.folder / path, whole)
        out = {1: 4, 2: 3, 6: 5, 0: 0}  # torsion, and bending across the plane
        even = [(node, d) for node, d in self.freedoms(self.num_inner)]
        odd = [(node if d else node + 100, out[d]) for node, d in even]
        files.write_freedoms(self.folder / "f.csv", [(node, d or "q") for node, d in even + odd])
        lines = 'format = "matrix-market"\nstiffness = "k.mtx"\nmass = "m.mtx"\nfreedoms = "f.csv"\nnodes = "n.csv"\n'
        (self.folder / "body.toml").write_text(DESIGN.replace("FILES", lines).replace("METHOD", ALL))
        self.build("body.toml")
        with h5py.File(self.folder / "out/body.h5") as file:
            np.testing.assert_allclose(self.vehicle_of_file(file), self.full_vehicle(), rtol=1e-9)

    def test_few_modes_give_the_vehicle_within_the_truncation(self):
        # Frequencies from a subspace are never too low. Of an exact mode of ω² the modes left out hold the share
        # s ≤ r/(1 − r)² of the strain energy, r = (ω/ω_next)², ω_next of the first one left out, because each follows
        # the interface as a forced oscillator. Rayleigh's quotient without them is above ω² by no more than s/(1 − 2s).
        full = self.full_vehicle()
        *_, omega = reduce_body(self.K, self.M, self.num_inner)
        lowest = 6
        errors = []
        for num_modes in (0, 2, 4, 8):
            with self.build_reduced(num_modes, "substructure") as file:
                error = self.vehicle_of_file(file)[:lowest] / full[:lowest] - 1.0
            self.assertGreater(error.min(), -1e-9)
            ratio = (2 * np.pi * full[:lowest] / omega[num_modes]) ** 2
            share = ratio / (1 - ratio) ** 2
            bound = share / (1 - 2 * share)
            self.assertTrue((error <= bound + 1e-9).all(), (num_modes, error, bound))
            errors.append(error.max())
        self.assertTrue(all(b < a for a, b in zip(errors, errors[1:])), errors)
        self.assertGreater(errors[0], 1e-4)  # the truncation shows

    def test_the_free_basis_has_the_frequencies_of_the_whole_free_frame(self):
        method = "[reduction]\nhighest_frequency = 300.0\n[modes]"
        with self.build_reduced(self.num_inner, "matrix-market", method) as file:
            found = file["certificate/free_frequency"][()]
        self.assertGreater(len(found), 2)
        np.testing.assert_allclose(found, calc_hz(self.K, self.M)[3 : 3 + len(found)], rtol=1e-9)

    def test_mass_and_its_moments_are_those_of_the_whole_frame(self):
        # Mass, centre and moment of inertia of a uniform bar of 6 m about b.
        mass = 90.0 * 6.0
        for num_modes in (0, 3):
            with self.build_reduced(num_modes, "matrix-market") as file:
                self.assertAlmostEqual(file["inertia/mass"][()].item() / mass, 1.0, places=10)
                np.testing.assert_allclose(file["inertia/first_moment"][()].ravel(), [mass, 0.0], atol=1e-7 * mass)
                self.assertAlmostEqual(file["inertia/second_moment"][()].item() / (mass * 4.0), 1.0, places=9)

    # A symmetric frame in space: each rail is the beam, and the rails move alike or against each other.

    def test_modal_freedoms_across_the_plane_are_left_out(self):
        num_modes = 6
        K, M, _ = reduce_body(self.K, self.M, num_modes)
        n, k = len(K) - num_modes, num_modes
        ids = [node for node in self.ids] + [node + 100 for node in self.ids]
        files.write_nodes(self.folder / "n.csv", ids, [(LENGTH * node, 0.0, z) for z in (-0.4, 0.4) for node in KEPT])
        # Modes of the pair: both rails alike, both against each other, in turn.
        share = np.sqrt(0.5)
        turn = np.zeros((2 * (n + k), 2 * (n + k)))
        for rail, sign in ((0, 1.0), (1, -1.0)):
            turn[rail * (n + k) : rail * (n + k) + n, rail * n : rail * n + n] = np.eye(n)
            for i in range(k):
                turn[rail * (n + k) + n + i, 2 * n + 2 * i] = share
                turn[rail * (n + k) + n + i, 2 * n + 2 * i + 1] = sign * share
        two = [turn.T @ np.kron(np.eye(2), 0.5 * matrix) @ turn for matrix in (K, M)]
        for name, matrix in zip(("k.mtx", "m.mtx"), two):
            files.write_matrix_market(self.folder / name, 0.5 * (matrix + matrix.T))
        files.write_freedoms(self.folder / "f.csv",
                             files.plane_freedoms(ids) + [(201 + i, "q") for i in range(2 * k)])
        lines = 'format = "matrix-market"\nstiffness = "k.mtx"\nmass = "m.mtx"\nfreedoms = "f.csv"\nnodes = "n.csv"\n'
        (self.folder / "body.toml").write_text(DESIGN.replace("FILES", lines).replace("METHOD", ALL))
        self.build("body.toml", "--force")
        held = [i for i in range(len(K)) if i not in (3, 4, 5)]
        with h5py.File(self.folder / "out/body.h5") as file:
            found = file["modes/frequency"][()]
        np.testing.assert_allclose(found, calc_hz(K[np.ix_(held, held)], M[np.ix_(held, held)]), rtol=1e-9)
        # A body with more freedoms than those of its nodes is followed, too.
        for flag in ((), ("--preview",)):
            sweep = ("sweep", "body.toml", "--vary", "matrices.mass_unit=1.0:4.0:1", "--modes", "3", "--json", *flag)
            result = self.run_program(*sweep)
            self.assertEqual(result.returncode, 0, result.stderr)
            light, heavy = (point["clamped"]["frequency_hz"] for point in json.loads(result.stdout)["points"])
            # The unit of mass scales K and M alike.
            np.testing.assert_allclose(heavy, light, rtol=1e-9)

    # What is refused.

    def assert_refused(self, *parts):
        result = self.build("body.toml", code=2)
        for part in parts:
            self.assertIn(part, result.stderr)

    def test_a_point_that_is_both_a_node_and_modal(self):
        self.write_reduced(2)
        text = (self.folder / "p.pch").read_text()
        before, after = text.rsplit(f"{101:16d}{0:16d}", 1)
        (self.folder / "p.pch").write_text(f"{before}{13:16d}{0:16d}{after}")
        line, column = before.count("\n") + 1, len(before) - before.rfind("\n") - 1 + 32
        self.assert_refused(
            f"p.pch:{line}:{column}: error: 13 is a scalar point here, and a grid point in a line before"
        )

    def test_modal_freedoms_that_hold_the_body_or_lack_stiffness(self):
        self.write_reduced(2, "matrix-market")
        K, _, _ = reduce_body(self.K, self.M, 2)
        K[12, 0] = K[0, 12] = 0.1 * K[0, 0]
        files.write_matrix_market(self.folder / "k.mtx", 0.5 * (K + K.T))
        self.assert_refused("k.mtx: error: the stiffness resists a rigid", "modal freedom 101")
        K[12, :] = K[:, 12] = 0.0
        files.write_matrix_market(self.folder / "k.mtx", 0.5 * (K + K.T))
        self.assert_refused("k.mtx: error: no stiffness acts on 1 freedom: modal freedom 101")

    def test_a_condensed_body_that_does_not_say_so(self):
        # A right angle of two bars of 6 m, of which the ends are kept: the ends do not tell where the mass is.
        n, bar = 3 * NUM_NODES, 6.0
        quarter = np.kron(np.eye(NUM_NODES), np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]))
        K, M = np.zeros((2, 2 * n - 3, 2 * n - 3))
        for whole, part in ((K, self.K), (M, self.M)):
            whole[:n, :n] += part
            whole[n - 3 :, n - 3 :] += quarter @ part @ quarter.T
        kept = kept_rows((0, 2 * NUM_NODES - 2))
        inner = [i for i in range(len(K)) if i not in kept]
        T = np.zeros((len(K), 6))
        T[kept] = np.eye(6)
        T[inner] = -np.linalg.solve(K[np.ix_(inner, inner)], K[np.ix_(inner, kept)])
        for name, matrix in (("k.mtx", T.T @ K @ T), ("m.mtx", T.T @ M @ T)):
            files.write_matrix_market(self.folder / name, 0.5 * (matrix + matrix.T))
        files.write_freedoms(self.folder / "f.csv", files.plane_freedoms((1, 2)))
        files.write_nodes(self.folder / "n.csv", (1, 2), [(0.0, 0.0), (bar, bar)])
        lines = 'format = "matrix-market"\nstiffness = "k.mtx"\nmass = "m.mtx"\nfreedoms = "f.csv"\nnodes = "n.csv"\n'
        design = DESIGN.replace("METHOD", ALL).replace('"b"', '"a"')
        for point in ("b = [2.0, 0.0]", "c = [4.0, 0.0]", "d = [6.0, 0.0]"):
            design = design.replace(point + "\n", "")
        (self.folder / "body.toml").write_text(design.replace("FILES", lines))
        self.assert_refused("m.mtx: error: mass and places of the nodes do not fit together", "'reduced = true'")
        (self.folder / "body.toml").write_text(design.replace("FILES", lines + "reduced = true\n"))
        self.build("body.toml")
        with h5py.File(self.folder / "out/body.h5") as file:
            # Of both bars, with their centres at (3, 0) and (6, 3), about the free end of the first one.
            mass = 90.0 * bar
            np.testing.assert_allclose(file["inertia/first_moment"][()].ravel(), [9.0 * mass, 3.0 * mass], rtol=1e-9)
            inertia = mass * (bar**2 / 3 + bar**2 / 12 + 6.0**2 + 3.0**2)
            self.assertAlmostEqual(file["inertia/second_moment"][()].item() / inertia, 1.0, places=9)


if __name__ == "__main__":
    run_tests()
