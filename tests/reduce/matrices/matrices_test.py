"""Bodies from matrices of other programs against the same bodies from beams, as a user builds them.

Usage: matrices_test.py PROGRAM SOURCE_DIR [unittest arguments]
"""

import sys
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "program"))
sys.path.insert(0, str(Path(__file__).resolve().parent))

import matrix_files as files  # noqa: E402  after the path
from reduce_case import ReduceTestCase, run_tests  # noqa: E402

# A beam of two elements of 1 m, of which every entry of K and M is a whole number.
BEAM = """[materials.stuff]
youngs_modulus = 1e6
density = 4200.0
[sections.bar]
material = "stuff"
area = 0.1
second_moment = 1e-3
[points]
a = [0.0, 0.0]
b = [2.0, 0.0]
[[lines]]
from = "a"
to = "b"
section = "bar"
elements = 2
"""
BASIS = """[reference]
point = "a"
[reduction]
highest_frequency = 0.6
[modes]
damping_ratio = 0.01
"""
CLAMPED = '[reference]\npoint = "a"\n[modes]\nall = true\ndamping_ratio = 0.01\n'
IDS = (1, 2, 3)
PLACES = ((0.0, 0.0), (1.0, 0.0), (2.0, 0.0))
POINTS = "[points]\na = [0.0, 0.0]\nb = [2.0, 0.0]\n"
FILES = 'stiffness = "k.mtx"\nmass = "m.mtx"\nfreedoms = "f.csv"\nnodes = "n.csv"\n'

# What both ways give exactly. Of rotations that are coupled with displacements, a mass matrix does not tell the split
# of products by directions.
EXACT = ("modes/frequency", "modes/shape", "matrices/stiffness", "matrices/mass", "matrices/damping", "inertia/mass",
         "inertia/first_moment", "inertia/second_moment", "inertia/P", "inertia/c", "inertia/d", "inertia/M_ff",
         "certificate/free_frequency", "certificate/static_flexibility", "certificate/error", "deflections/point_load",
         "deflections/acceleration", "deflections/modal_acceleration")


def ordered(file, name):
    """A dataset; of nodes in the order of their places, since a design of lines numbers them otherwise."""
    values = file[name][()]
    if name != "modes/shape":
        return values
    x, y = file["nodes/position"][()].T
    return values[np.lexsort((y, x))]


class MatricesTest(ReduceTestCase):
    def write_design(self, name, matrices, rest=BASIS, points=POINTS):
        (self.folder / f"{name}.toml").write_text(f"{points}[matrices]\n{matrices}{rest}")
        return f"{name}.toml"

    def write_beam_files(self, write, names=("k.mtx", "m.mtx"), ids=IDS):
        for path, matrix in zip(names, files.make_beam(len(ids) - 1)):
            write(self.folder / path, matrix)
        files.write_freedoms(self.folder / "f.csv", files.plane_freedoms(ids))
        files.write_nodes(self.folder / "n.csv", ids, [(float(i), 0.0) for i in range(len(ids))])

    def build_beam(self, rest=BASIS):
        (self.folder / "beam.toml").write_text(BEAM + rest)
        self.build("beam.toml")

    def assert_same(self, made, expected="beam", tolerance=1e-9, names=EXACT):
        with h5py.File(self.folder / f"out/{made}.h5") as a, h5py.File(self.folder / f"out/{expected}.h5") as b:
            for name in names:
                found, expected_values = ordered(a, name), ordered(b, name)
                scale = np.abs(expected_values).max(initial=0.0)
                if name == "inertia/first_moment":
                    scale = b["inertia/mass"][0] * np.abs(b["nodes/position"][()]).max()
                self.assertEqual(found.shape, expected_values.shape, name)
                np.testing.assert_allclose(found, expected_values, rtol=0, atol=tolerance * scale, err_msg=name)

    def frequencies(self, name):
        with h5py.File(self.folder / f"out/{name}.h5") as file:
            return file["modes/frequency"][()]

    # The truck's chassis, by the program's own matrices.

    def test_the_chassis_from_its_own_matrices_is_the_chassis_from_beams(self):
        for name, rest in (("chassis", "[reduction]\nbasis = \"clamped\"\n[modes]\nall = true\ndamping_ratio = 0.01\n"),
                           ("chassis_certified", None)):
            result = self.run_program("matrices", f"{name}.toml", "-o", name)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(len(result.stdout.split()), 4)
            text = (self.folder / f"{name}.toml").read_text()
            points = text[text.index("[points]") : text.index("[[lines]]")]
            rest = rest and '[reference]\npoint = "middle"\n' + rest or text[text.index("[reference]") :]
            design = self.write_design(
                f"{name}_matrices", f'format = "matrix-market"\nstiffness = "{name}_stiffness.mtx"\n'
                f'mass = "{name}_mass.mtx"\nfreedoms = "{name}_freedoms.csv"\nnodes = "{name}_nodes.csv"\n'
                "expected = { mass = 11950.0, inertia = 58300.0, centre_of_mass = [0.0, 0.0] }\n"
                if name == "chassis" else
                f'format = "matrix-market"\nstiffness = "{name}_stiffness.mtx"\nmass = "{name}_mass.mtx"\n'
                f'freedoms = "{name}_freedoms.csv"\nnodes = "{name}_nodes.csv"\n', rest, points)
            output = self.build(f"{name}.toml", design).stdout
            self.assertIn("matrices do not tell section loads, axial shares and geometric stiffness", output)
            self.assert_same(f"{name}_matrices", name)
            with h5py.File(self.folder / f"out/{name}_matrices.h5") as file:
                self.assertEqual(file["elements/node"].shape, (0, 2))
                self.assertEqual(file["stiffening/centrifugal"].shape, (0, 0))
                self.assertEqual(file["section_loads/point_load"].shape[0], 0)
            info = self.run_program("info", f"out/{name}_matrices.h5").stdout
            self.assertIn("stiffening  none: made from matrices", info)
            self.assertIn("sections    none: made from matrices", info)
            self.assertEqual(self.run_program("check", f"out/{name}_matrices.h5").returncode, 0)
            self.assertEqual(self.run_program("diff", f"out/{name}.h5", f"out/{name}_matrices.h5").returncode, 0)

    def test_a_changed_matrix_is_noticed(self):
        self.write_beam_files(files.write_matrix_market)
        design = self.write_design("body", f'format = "matrix-market"\n{FILES}')
        self.build(design)
        self.assertIn("up to date", self.build(design).stdout)
        (self.folder / "m.mtx").write_text((self.folder / "m.mtx").read_text() + "\n")
        self.assertIn("(m.mtx changed)", self.build(design).stdout)

    # Every format.

    def test_matrix_market_in_each_of_its_forms(self):
        self.build_beam()
        design = self.write_design("body", f'format = "matrix-market"\n{FILES}')
        for write in (files.write_matrix_market, files.write_array,
                      lambda path, matrix: files.write_matrix_market(path, matrix, symmetric=False)):
            self.write_beam_files(write)
            self.build(design)
            self.assert_same("body")

    def test_abaqus_in_both_forms(self):
        self.build_beam()
        freedoms = files.plane_freedoms(IDS)
        self.write_beam_files(lambda path, matrix: files.write_abaqus(path, matrix, freedoms))
        self.build(self.write_design("body", 'format = "abaqus"\n' + FILES.replace('freedoms = "f.csv"\n', "")))
        self.assert_same("body")
        for separator in (" ", ", "):
            self.write_beam_files(lambda path, matrix, s=separator: files.write_coordinates(path, matrix, s))
            self.build(self.write_design("body", f'format = "abaqus"\n{FILES}'))
            self.assert_same("body")

    def test_the_scale_factor_of_matrix_input(self):
        # Keywords Reference, *MATRIX INPUT: a number "by which all matrix entries will be multiplied".
        self.build_beam()
        freedoms = files.plane_freedoms(IDS)
        self.write_beam_files(lambda path, matrix: files.write_abaqus(path, 4.0 * matrix, freedoms))
        for name, factor in (("k.mtx", "scale factor = 2.5e-1"), ("m.mtx", "SCALEFACTOR=.25")):
            text = (self.folder / name).read_text()
            (self.folder / name).write_text(text.replace("TYPE=SYMMETRIC", f"type = Symmetric, {factor}"))
        self.build(self.write_design("body", 'format = "abaqus"\n' + FILES.replace('freedoms = "f.csv"\n', "")))
        self.assert_same("body")

    def test_calculix(self):
        self.build_beam()
        self.write_beam_files(files.write_calculix)
        freedoms = files.plane_freedoms(IDS)
        (self.folder / "f.dof").write_text("".join(f"{node}.{direction}\n" for node, direction in freedoms))
        self.build(self.write_design("body", 'format = "calculix"\n' + FILES.replace("f.csv", "f.dof")))
        self.assert_same("body")

    def test_nastran_in_fields_of_8_and_16_columns_and_between_commas(self):
        self.build_beam()
        files.write_nodes(self.folder / "n.csv", IDS, PLACES)
        design = self.write_design("body", 'format = "nastran"\nstiffness = "p.pch"\nmass = "p.pch"\n'
                                   'stiffness_name = "KAAX"\nmass_name = "MAAX"\nnodes = "n.csv"\n')
        K, M = files.make_beam(2)
        for width in (0, 8, 16):
            for form in (1, 6):
                files.write_dmig(self.folder / "p.pch", {"KAAX": K, "MAAX": M}, files.plane_freedoms(IDS), width, form)
                self.build(design, "--force")
                self.assert_same("body")

    def test_nastran_superelement_with_its_other_entries(self):
        """What Nastran writes before and after the matrices, as in published punch files."""
        self.build_beam()
        files.write_nodes(self.folder / "n.csv", IDS, PLACES)
        design = self.write_design("body", 'format = "nastran"\nstiffness = "p.pch"\nmass = "p.pch"\n'
                                   'stiffness_name = "KAAX"\nmass_name = "MAAX"\nnodes = "n.csv"\n')
        K, M = files.make_beam(2)
        files.write_dmig(self.folder / "p.pch", {"KAAX": K, "MAAX": M}, files.plane_freedoms(IDS))
        before = ("BEGIN SUPER     111\n"
                  "CORD2R *               7              0.              1.              0.\n"
                  "*                     0.              0.              1.              1.\n"
                  "*                     0.              0.\n"
                  "EXTRN          1  123456       2  123456       3  123456\n"
                  "GRID   *               1               7              0.              0.\n"
                  "*                     0.\n"
                  "GRID           2              1.      0.      0.       0\n"
                  "ASET           1  123456       2  123456       3  123456\n"
                  "QSET1          0     101    THRU     103\n")
        after = ("DTI     TUG1    0       66      105     32767   0       7       0\n"
                 "        PHIP            7                       REAL           1ENDREC\n"
                 "DMIG    MUG1T          0       9       2       0                       3\n"
                 "DMIG*   MUG1T                          1               0\n"
                 "*                      1               1 1.000000000D+00\n"
                 "ENDDATA\n")
        path = self.folder / "p.pch"
        path.write_text(before + path.read_text() + after)
        self.build(design)
        self.assert_same("body")

    def test_nodes_from_a_mesh(self):
        self.build_beam()
        (self.folder / "frame.geo").write_text('Point(1) = {0, 0, 0}; Point(2) = {2, 0, 0}; Line(1) = {1, 2};\n'
                                               'Transfinite Curve{1} = 3; Physical Curve("bar") = {1};\n')
        self.write_beam_files(files.write_matrix_market)
        order = [0, 2, 1]  # gmsh numbers the ends first
        files.write_freedoms(self.folder / "f.csv", files.plane_freedoms([order[i] + 1 for i in range(3)]))
        design = 'mesh = "frame.geo"\n' + POINTS + '[matrices]\nformat = "matrix-market"\n'
        (self.folder / "body.toml").write_text(design + FILES.replace('nodes = "n.csv"\n', "") + BASIS)
        self.build("body.toml")
        self.assert_same("body")

    # Units, axes, symmetry.

    def test_millimetres_and_tonnes(self):
        self.build_beam()
        K, M = files.make_beam(2)
        scale = np.tile([1e-3, 1e-3, 1.0], 3)  # displacements in m per mm, rotations
        energy = 1e-3  # tonne·mm²/s² per joule is 1e-3 kg·m²… of a tonne·mm²
        files.write_matrix_market(self.folder / "k.mtx", K * np.outer(scale, scale) / energy)
        files.write_matrix_market(self.folder / "m.mtx", M * np.outer(scale, scale) / energy)
        files.write_freedoms(self.folder / "f.csv", files.plane_freedoms(IDS))
        files.write_nodes(self.folder / "n.csv", IDS, [(1000.0 * x, 1000.0 * y) for x, y in PLACES])
        self.build(self.write_design("body", f'format = "matrix-market"\nlength_unit = 1e-3\nmass_unit = 1e3\n{FILES}'))
        self.assert_same("body")

    def test_a_plane_of_space_in_any_axes(self):
        # x of the plane along −y of space, y along z: a right-handed turn about −x.
        self.build_beam()
        K, M = files.make_beam(2)
        freedoms = [(node, direction) for node in IDS for direction in (1, 2, 3, 4, 5, 6)]
        rows = [6 * i + d for i in range(3) for d in (1, 2, 3)]
        signs = np.tile([-1.0, 1.0, -1.0], 3)  # y of space, z, rotation about x
        out = np.array([6 * i + d for i in range(3) for d in (0, 4, 5)])
        for name, matrix in (("k.mtx", K), ("m.mtx", M)):
            whole = np.zeros((18, 18))
            whole[np.ix_(rows, rows)] = matrix * np.outer(signs, signs)
            whole[out, out] = 1e3
            files.write_matrix_market(self.folder / name, whole)
        files.write_freedoms(self.folder / "f.csv", freedoms)
        files.write_nodes(self.folder / "n.csv", IDS, [(0.7, -x, y) for x, y in PLACES])
        self.build(self.write_design("body", f'format = "matrix-market"\naxes = ["-y", "z"]\n{FILES}'))
        self.assert_same("body")

    # Two nodes of each place at z = ±0.4. Symmetric coordinates: (x, y, rotation about z) of both, and half the
    # difference of (z, rotation about x, rotation about y), which a spring couples with the bending.
    def make_mirrored(self):
        K, M = files.make_beam(2)
        across = np.zeros((3, 18))
        for i in range(3):  # a linear combination that no rigid motion strains
            across[i, 9 + 3 * i] = 1.0
            across[i, [2, 5]] = (0.3, -0.3)
            across[i, 9 + 3 * i + 1] = 0.2 + 0.1 * i
        Ks, Ms = np.zeros((2, 18, 18))
        Ks[:9, :9], Ms[:9, :9] = K, M
        Ks += across.T @ np.diag([5e3, 7e3, 9e3]) @ across
        Ks[9:, 9:] += np.diag(np.tile([4e3, 3e3, 2e3], 3))
        Ms[9:, 9:] = np.diag(np.tile([50.0, 4.0, 3.0], 3))
        return Ks, Ms

    def test_mirrored_pairs_move_symmetrically(self):
        Ks, Ms = self.make_mirrored()
        # Coordinates of both nodes from symmetric and antisymmetric ones, and back.
        turn = np.zeros((36, 36))
        for i in range(3):
            for d in range(6):
                even = d in (0, 1, 5)
                symmetric = 3 * i + (0, 1, -1, -1, -1, 2)[d] if even else 9 + 3 * i + d - 2
                for node, sign in ((2 * i, 1.0), (2 * i + 1, 1.0 if even else -1.0)):
                    turn[symmetric, 6 * node + d] = 0.5 * sign
                    turn[18 + 6 * i + d, 6 * node + d] = 0.5 if node % 2 == 0 else (-0.5 if even else 0.5)
        rest = np.eye(18) * 1e4
        for name, matrix, other in (("k.mtx", Ks, rest), ("m.mtx", Ms, rest * 0.01)):
            whole = np.block([[matrix, np.zeros((18, 18))], [np.zeros((18, 18)), other]])
            files.write_matrix_market(self.folder / name, turn.T @ whole @ turn)
        ids = (11, 12, 21, 22, 31, 32)
        files.write_freedoms(self.folder / "f.csv", [(node, d) for node in ids for d in (1, 2, 3, 4, 5, 6)])
        files.write_nodes(self.folder / "n.csv", ids, [(float(i), 0.0, z) for i in range(3) for z in (2.4, 1.6)])
        self.build(self.write_design("body", f'format = "matrix-market"\n{FILES}', CLAMPED))
        held = slice(3, None)
        omega_squared = np.linalg.eigvals(np.linalg.solve(Ms[held, held], Ks[held, held]))
        expected = np.sqrt(np.sort(omega_squared.real)) / (2.0 * np.pi)
        np.testing.assert_allclose(self.frequencies("body"), expected, rtol=1e-9)
        with h5py.File(self.folder / "out/body.h5") as file:
            self.assertEqual(list(file["nodes/id"]), [11, 21, 31])
            self.assertAlmostEqual(file["inertia/mass"][0], 840.0, places=9)

    # Where entries of both sides of the plane cancel, what is left of them is rounding, and couples freedoms that the
    # sums of other entries do not.

    def test_the_rounding_of_entries_that_cancel_resists_no_motion(self):
        self.build_beam()
        self.write_beam_files(files.write_matrix_market)
        K, _ = files.make_beam(len(IDS) - 1)
        noise = np.random.default_rng(1).uniform(-1.0, 1.0, K.shape)
        size = np.sqrt(np.diag(K))
        for share, is_refused in ((1e-10, False), (1e-6, True)):
            rounding = 0.5 * share * (noise + noise.T) * np.outer(size, size)
            files.write_matrix_market(self.folder / "k.mtx", K + rounding)
            name = self.write_design("body", f'format = "matrix-market"\n{FILES}')
            if is_refused:
                self.assertIn("resists a rigid", self.build(name, "--force", code=2).stderr)
                continue
            self.build(name)
            self.assert_same("body", tolerance=1e-6, names=("modes/frequency", "inertia/mass"))

    # Freedoms without mass, and nodes without rotations.

    def test_freedoms_without_mass_follow_the_others(self):
        K, _ = files.make_beam(4)
        M = np.diag(np.tile([420.0, 420.0, 0.0], 5))
        M[2, 2] = 5.0  # the node that all modes of the held body could not move otherwise
        ids = (1, 2, 3, 4, 5)
        self.write_beam_files(lambda path, _: None, ids=ids)
        files.write_matrix_market(self.folder / "k.mtx", K)
        files.write_matrix_market(self.folder / "m.mtx", M)
        for method in (CLAMPED, CLAMPED.replace("all = true", "count = 3")):
            output = self.build(self.write_design("body", f'format = "matrix-market"\n{FILES}', method)).stdout
            self.assertIn("4 freedoms have no mass: the rotation of node 2, the rotation of node 3", output)
            held_K, mass = K[3:, 3:], M[3:, 3:]
            massive, massless = np.flatnonzero(np.diag(mass)), np.flatnonzero(np.diag(mass) == 0)
            condensed = held_K[np.ix_(massive, massive)] - held_K[np.ix_(massive, massless)] @ np.linalg.solve(
                held_K[np.ix_(massless, massless)], held_K[np.ix_(massless, massive)])
            expected = np.sqrt(np.linalg.eigvalsh(condensed / 420.0)) / (2.0 * np.pi)
            found = self.frequencies("body")
            np.testing.assert_allclose(found, expected[: len(found)], rtol=1e-9)
        self.assertEqual(len(found), 3)

    # Lumped masses of displacements, none of rotations: of five nodes 10 motions have mass, 7 of them elastic. Held at
    # a node, 8 have mass, since its rotation moves against the masses without inertia.
    def test_more_clamped_modes_than_motions_with_mass_are_refused_by_the_reason(self):
        K, _ = files.make_beam(4)
        self.write_beam_files(lambda path, _: None, ids=(1, 2, 3, 4, 5))
        files.write_matrix_market(self.folder / "k.mtx", K)
        files.write_matrix_market(self.folder / "m.mtx", np.diag(np.tile([420.0, 420.0, 0.0], 5)))
        for wanted in ("all = true", "count = 8"):
            design = self.write_design("body", f'format = "matrix-market"\n{FILES}',
                                       CLAMPED.replace("all = true", wanted))
            self.assertIn("asks for 8 clamped modes, but they have only 7 elastic motions with mass, because the "
                          "reference, node 1 'a' at (0, 0), has no mass of its own in some direction; take fewer",
                          self.build(design, code=2).stderr)
        self.build(self.write_design("body", f'format = "matrix-market"\n{FILES}',
                                     CLAMPED.replace("all = true", "count = 3")))
        self.assertEqual(len(self.frequencies("body")), 3)

    def test_a_mass_at_one_node_leaves_no_elastic_mode(self):
        self.write_beam_files(files.write_matrix_market)
        for masses, text in (((420.0, 420.0, 5.0), "only 3 freedoms of the body have mass"),
                             ((420.0, 420.0, 0.0), "only 2 freedoms of the body have mass")):
            files.write_matrix_market(self.folder / "m.mtx", np.diag([0.0, 0.0, 0.0, *masses, 0.0, 0.0, 0.0]))
            for rest in (BASIS, CLAMPED):
                design = self.write_design("body", f'format = "matrix-market"\n{FILES}', rest)
                error = self.build(design, code=2).stderr
                self.assertIn(f"m.mtx: error: {text}: with three rigid motions it has no elastic mode", error)

    def test_nodes_without_rotations_rotate_as_the_nodes_around_them(self):
        # A strip of squares with diagonals, of bars that carry axial forces alone; the free body's frequencies need
        # no rotation.
        places = [(float(i), float(j)) for i in range(4) for j in range(2)]
        bars = [(a, b) for a in range(8) for b in range(a + 1, 8) if np.hypot(*np.subtract(places[a], places[b])) < 1.5]
        K = np.zeros((16, 16))
        for a, b in bars:
            along = np.subtract(places[b], places[a])
            row = np.zeros(16)
            row[2 * b : 2 * b + 2], row[2 * a : 2 * a + 2] = along / (along @ along), -along / (along @ along)
            K += 1e5 * np.outer(row, row)
        M = np.eye(16) * 2.0
        files.write_matrix_market(self.folder / "k.mtx", K)
        files.write_matrix_market(self.folder / "m.mtx", M)
        files.write_freedoms(self.folder / "f.csv", [(i + 1, d) for i in range(8) for d in (1, 2)])
        files.write_nodes(self.folder / "n.csv", range(1, 9), places)
        points = "[points]\na = [0.0, 0.0]\nb = [3.0, 1.0]\n"
        interface = '[interface]\nb = "xy"\n'
        rest = interface + BASIS.replace("0.6", "40.0")
        output = self.build(self.write_design("body", f'format = "matrix-market"\n{FILES}', rest, points)).stdout
        self.assertIn("8 nodes have no rotation in the matrices", output)
        expected = np.sqrt(np.abs(np.linalg.eigvalsh(K / 2.0))) / (2.0 * np.pi)
        with h5py.File(self.folder / "out/body.h5") as file:
            found = file["certificate/free_frequency"][()]
            self.assertGreater(len(found), 1)
            np.testing.assert_allclose(found, expected[3 : 3 + len(found)], rtol=1e-9)
            # A unit load at b of the free body: K⁺ without the rigid motions, by M-orthogonal projection.
            x, y = np.array(places).T
            rigid = np.zeros((16, 3))
            rigid[0::2, 0] = rigid[1::2, 1] = 1.0
            rigid[0::2, 2], rigid[1::2, 2] = -y, x
            keep = np.eye(16) - rigid @ np.linalg.solve(rigid.T @ rigid, rigid.T)
            flexibility = keep @ np.linalg.pinv(K, rcond=1e-10) @ keep
            np.testing.assert_allclose(file["certificate/static_flexibility"], np.diag(flexibility)[14:], rtol=1e-8)

    # What a mass matrix with coupled rotations does not tell.

    def test_the_error_of_turned_products_is_of_second_order(self):
        errors = []
        for num_elements in (2, 4, 8):
            design = BEAM.replace("elements = 2", f"elements = {num_elements}").replace("[2.0, 0.0]", "[1.6, 1.2]")
            rest = CLAMPED.replace("all = true", "count = 4")
            (self.folder / "beam.toml").write_text(design + rest)
            self.run_program("matrices", "beam.toml", "-o", "k", check=True)
            points = POINTS.replace("[2.0, 0.0]", "[1.6, 1.2]")
            self.build("beam.toml", self.write_design(
                "body", 'format = "matrix-market"\nstiffness = "k_stiffness.mtx"\nmass = "k_mass.mtx"\n'
                'freedoms = "k_freedoms.csv"\nnodes = "k_nodes.csv"\n', rest, points))
            with h5py.File(self.folder / "out/beam.h5") as a, h5py.File(self.folder / "out/body.h5") as b:
                exact, found = a["inertia/B"][()], b["inertia/B"][()]
                np.testing.assert_allclose(b["inertia/phi_x_phi_x"][()] + b["inertia/phi_y_phi_y"][()],
                                           a["inertia/phi_x_phi_x"][()] + a["inertia/phi_y_phi_y"][()], atol=1e-12)
            errors.append(np.abs(found - exact).max() / np.abs(exact).max())
        self.assertLess(errors[1], errors[0] / 3.5)
        self.assertLess(errors[2], errors[1] / 3.5)
        self.assertLess(errors[2], 0.02)  # reduce/matrices/README.md has the numbers

    def test_an_independent_interpolation_is_exact_in_everything(self):
        # Displacements and rotations linear in between, each for itself, as shear-flexible beams and solids have them.
        line = np.array([[2.0, 1.0, 0.0], [1.0, 4.0, 1.0], [0.0, 1.0, 2.0]]) * 420.0 / 6.0
        K, _ = files.make_beam(2)
        M = np.zeros((9, 9))
        for d, share in enumerate((1.0, 1.0, 0.01)):
            M[d::3, d::3] = share * line
        self.write_beam_files(files.write_matrix_market)
        files.write_matrix_market(self.folder / "m.mtx", M)
        self.build(self.write_design("body", f'format = "matrix-market"\n{FILES}', CLAMPED))
        with h5py.File(self.folder / "out/body.h5") as file:
            shape, inertia = file["modes/shape"][()], file["inertia"]
            x, y, r = shape[:, 0, :], shape[:, 1, :], shape[:, 2, :]
            place = np.array([0.0, 1.0, 2.0])
            for name, expected in (
                ("phi_x_phi_x", x.T @ line @ x), ("phi_x_phi_y", x.T @ line @ y), ("phi_y_phi_y", y.T @ line @ y),
                ("B", x.T @ line @ y - y.T @ line @ x), ("x_phi_x", place @ line @ x), ("x_phi_y", place @ line @ y),
                ("c", place @ line @ y + 0.01 * np.ones(3) @ line @ r), ("d", place @ line @ x),
            ):
                np.testing.assert_allclose(inertia[name], expected, atol=1e-10, err_msg=name)
            self.assertAlmostEqual(inertia["second_moment"][0], place @ line @ place + 0.01 * 840.0, places=9)


if __name__ == "__main__":
    run_tests()
