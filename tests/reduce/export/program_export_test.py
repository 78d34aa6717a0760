"""Superelements for MBDyn, Exudyn and MBSim, read back by an independent reader that knows the formats alone.

Usage: program_export_test.py PROGRAM SOURCE_DIR [unittest arguments]
"""

import re

import h5py
import numpy as np
from export_case import CLAMPED, DESIGN, FREE, NUM_ELEMENTS, PLACES, Expected, ExportCase, run_tests


class ProgramExportTest(ExportCase):
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
            with h5py.File(self.folder / "body_mbsim.h5") as file:
                data = {name: item[()] for name, item in file.items()}
                # MBSim's reader lists the objects in the order in which they were made, and fails without it.
                listed = []
                root = h5py.h5g.open(file.id, b"/")
                root.links.iterate(listed.append, idx_type=h5py.h5.INDEX_CRT_ORDER)
                self.assertEqual(listed[0], b"mass")
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
        with h5py.File(self.folder / "body_mbsim.h5") as file:
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


if __name__ == "__main__":
    run_tests()
