"""Files of matrices that cannot be used, and the message for each: file, line, column, what is wrong.

Usage: matrix_errors_test.py PROGRAM SOURCE_DIR [unittest arguments]
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "program"))
sys.path.insert(0, str(Path(__file__).resolve().parent))

import matrix_files as files  # noqa: E402  after the path
from reduce_case import ReduceTestCase, run_tests  # noqa: E402

IDS = (1, 2, 3)
FREEDOMS = files.plane_freedoms(IDS)
DESIGN = """[points]
a = [0.0, 0.0]
[matrices]
format = "FORMAT"
stiffness = "k.mtx"
mass = "m.mtx"
freedoms = "f.csv"
nodes = "n.csv"
[reference]
point = "a"
[modes]
count = 3
damping_ratio = 0.01
"""


class MatrixErrorsTest(ReduceTestCase):
    def setUp(self):
        super().setUp()
        self.stiffness, self.mass = files.make_beam(2)
        self.write_good("matrix-market", lambda path, matrix: files.write_matrix_market(path, matrix))

    def write_good(self, name, write):
        (self.folder / "body.toml").write_text(DESIGN.replace("FORMAT", name))
        write(self.folder / "k.mtx", self.stiffness)
        write(self.folder / "m.mtx", self.mass)
        files.write_freedoms(self.folder / "f.csv", FREEDOMS)
        files.write_nodes(self.folder / "n.csv", IDS, [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)])

    def assert_error(self, *parts):
        result = self.build("body.toml", code=2)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        for part in parts:
            self.assertIn(part, result.stderr)
        self.assertEqual(self.files(), [])

    def assert_errors(self, name, changes):
        """Each change of a file, (old, new, message), by itself."""
        text = (self.folder / name).read_text()
        for old, new, message in changes:
            with self.subTest(new):
                self.change(name, old, new)
                self.assert_error(message)
                (self.folder / name).write_text(text)

    def test_matrix_market(self):
        self.assert_errors("k.mtx", [
            ("%%MatrixMarket matrix", "%%MatrixMarket vector", "k.mtx:1: error: does not begin with '%%MatrixMarket"),
            ("real symmetric", "complex symmetric",
             "k.mtx:1:34: error: 'complex' is not read, expected 'real' or 'integer'"),
            ("real symmetric", "real hermitian", "k.mtx:1:39: error: 'hermitian' is not read, expected 'symmetric' or"),
            ("\n9 9 ", "\n8 9 ", "k.mtx:3:1: error: the matrix has 8 rows, the table of freedoms has 9"),
            ("\n1 1 ", "\n1 12 ", "k.mtx:4:3: error: '12' is no whole number of 1 … 9"),
            ("\n4 1 ", "\n1 4 ", "k.mtx:5:3: error: stands above the diagonal of a symmetric matrix"),
            ("\n1 1 100000.0", "\n1 1 1e6x", "k.mtx:4:5: error: '1e6x' is no number of a double's range"),
            ("\n1 1 100000.0", "\n1 1 nan", "k.mtx:4:5: error: 'nan' is not finite"),
            ("\n1 1 100000.0", "\n1 1", "k.mtx:4: error: has 2 numbers, expected 3"),
            ("\n4 1 -100000.0", "\n1 1 5.0", "k.mtx:5:5: error: the entry (x of node 1; x of node 1) stands in line 4"),
        ])
        text = (self.folder / "k.mtx").read_text()
        (self.folder / "k.mtx").write_text(text[: text.rindex("\n9 9") + 1])
        self.assert_error("k.mtx:23: error: ends after 20 of 21 entries")
        (self.folder / "k.mtx").write_text("")
        self.assert_error("error: is empty, expected a Matrix Market file")
        (self.folder / "k.mtx").write_text(text + "9 9 1.0\n")
        self.assert_error("k.mtx:25: error: stands after the last of 21 entries")
        (self.folder / "k.mtx").unlink()
        self.assert_error("k.mtx: error: ")

    def test_a_matrix_that_is_not_symmetric(self):
        changed = self.stiffness.copy()
        changed[4, 1] *= 1.001
        files.write_matrix_market(self.folder / "k.mtx", changed, symmetric=False)
        self.assert_error("k.mtx:", "error: the matrix is not symmetric: the entry (y of node 1; y of node 2) is "
                          "-12000, and -12012 on the other side of the diagonal")

    def test_tables(self):
        self.assert_errors("f.csv", [
            ("node,direction", "node,dof", "f.csv:1: error: the heading is 'node,dof', expected 'node,direction'"),
            ("\n2,1", "\n2,7", "f.csv:5:3: error: '7' is no direction, expected 1 … 6 or x, y, z, rx, ry, rz, or q"),
            ("\n2,1", "\n1,1", "f.csv:5:1: error: x of node 1 stands in the table twice"),
            ("\n2,1", "\n2,1,0", "f.csv:5: error: has 3 cells, expected 2"),
            ("\n2,1", "\n0,1", "f.csv:5:1: error: '0' is no whole number of 1 … 2147483647"),
        ])
        self.assert_errors("n.csv", [
            ("node,x,y", "id,x,y", "n.csv:1: error: the heading is 'id,x,y', expected 'node,x,y' or 'node,x,y,z'"),
            ("\n2,1.0", "\n2,", "n.csv:3:3: error: '' is no number"),
            ("\n2,1.0", "\n1,1.0", "n.csv:3:1: error: node 1 stands in the table twice"),
            ("\n2,1.0", "\n4,1.0", "k.mtx: error: node 2 of the matrices is not in the table of nodes"),
        ])

    def test_abaqus(self):
        self.write_good("abaqus", lambda path, matrix: files.write_abaqus(path, matrix, FREEDOMS))
        self.change("body.toml", 'freedoms = "f.csv"\n', "")
        self.assert_errors("k.mtx", [
            ("*MATRIX INPUT", "*MATRIX ASSEMBLE",
             "k.mtx:2: error: '*MATRIX ASSEMBLE, NAME=K, TYPE=SYMMETRIC' is no part"),
            ("SYMMETRIC", "UNSYMMETRIC", "k.mtx:2:24: error: 'TYPE=UNSYMMETRIC' is not read, expected NAME, TYPE=SYM"),
            ("NAME=K", "NAME=K, INPUT=b.mtx", "k.mtx:2:24: error: 'INPUT=b.mtx' is not read"),
            ("NAME=K", "NAME=K, SCALE FACTOR=0.", "k.mtx:2:24: error: the scale factor is 0., expected another"),
            ("NAME=K", "NAME=K, SCALE FACTOR", "k.mtx:2:24: error: '' is no number"),
            ("\n2,1, 1,1,", "\n*MATRIX INPUT, NAME=M\n2,1, 1,1,", "k.mtx:4: error: begins a second matrix"),
            ("\n1,1, 1,1, 1.0", "\n1,8, 1,1, 1.0", "k.mtx:3:3: error: '8' is no whole number of 1 … 6"),
            ("1.000000000000000e+05", "1.0e+36",
             "k.mtx:3:11: error: the entry is 1e+36, which stands for a freedom that"),
            ("\n2,1, 1,1,", "\n2,1, 1,", "k.mtx:4: error: has 4 numbers, expected 5"),
        ])
        files.write_coordinates(self.folder / "k.mtx", self.stiffness)
        self.assert_error("k.mtx:1: error: is of the form row, column, value, which needs a table of the rows")

    def test_a_substructure(self):
        self.write_good("abaqus", lambda path, matrix: files.write_substructure(path, {
            "MASS" if path.name == "m.mtx" else "STIFFNESS": matrix}, FREEDOMS))
        self.change("body.toml", 'freedoms = "f.csv"\n', "")
        self.assert_errors("k.mtx", [
            ("STIFFNESS", "MASS", "k.mtx:21: error: has no *MATRIX, TYPE=STIFFNESS"),
            ("*MATRIX", "*ELEMENT", "k.mtx:6: error: '*ELEMENT,TYPE=STIFFNESS' is no part of a substructure"),
            ("LINEAR", "LINEAR, UNSYMM", "k.mtx:2: error: the element is unsymmetric"),
            ("NODES=         3", "NODES=         4", "k.mtx:5: error: 3 nodes stand in the comments"),
            ("** ELEMENT NODES", "** NODES", "k.mtx:5: error: 0 nodes stand in the comments"),
            ("\n1, 2, 6", "\n1, 2, 7", "k.mtx:5:7: error: '7' is no whole number of 1 … 6"),
            ("\n1, 2, 6", "\n1, 2, 6\n4, 1", "k.mtx:6:1: error: '4' is no whole number of 2 … 3"),
            ("\n1, 2, 6", "\n1, 2, 6\n2", "k.mtx:6:1: error: has no direction after the node's position"),
            ("\n1, 2, 6", "", "k.mtx:5: error: expected the directions of the nodes before"),
            ("\n1, 2, 6", "\n1, 2", "k.mtx:15:2: error: the matrix has more than 21 values, as 6 freedoms need"),
            ("\n1, 2, 6", "\n1, 2, 6, 6", "k.mtx:5: error: rotation about z of node 1 stands in the list twice"),
            ("*MATRIX", "*USER ELEMENT, NODES=1\n*MATRIX", "k.mtx:6: error: is a second element"),
            ("         3,\n", "         2,\n", "k.mtx:6: error: x of node 2 stands in the list twice"),
        ])
        text = (self.folder / "k.mtx").read_text()
        (self.folder / "k.mtx").write_text("\n".join(text.splitlines()[:-1]) + "\n")
        self.assert_error("error: the matrix has less than 45 values, as 9 freedoms need for one triangle")
        (self.folder / "k.mtx").write_text(text + text[text.index("*MATRIX"):])
        self.assert_error("error: *MATRIX, TYPE=STIFFNESS stands in the file twice")
        # With a table of the rows the file's own freedoms are only counted.
        (self.folder / "k.mtx").write_text(text.replace("         1,", "        -1,"))
        self.change("body.toml", 'nodes = "n.csv"', 'nodes = "n.csv"\nfreedoms = "f.csv"')
        self.build("body.toml")
        (self.folder / "out/body.h5").unlink()
        self.change("f.csv", "3,6\n", "")
        self.assert_error("k.mtx:6: error: the substructure has 9 freedoms, and the table 'freedoms' has 8")

    def test_a_byte_order_mark(self):
        (self.folder / "n.csv").write_bytes(b"\xef\xbb\xbf" + (self.folder / "n.csv").read_bytes())
        self.build("body.toml", "--force")

    def test_calculix(self):
        self.write_good("calculix", files.write_calculix)
        self.change("body.toml", "f.csv", "f.dof")
        (self.folder / "f.dof").write_text("".join(f"{node}.{direction}\n" for node, direction in FREEDOMS))
        self.assert_errors("k.mtx", [
            ("1 1 ", "1 10 ", "k.mtx:1:3: error: '10' is no whole number of 1 … 9"),
            ("1 1 ", "1 1 2 ", "k.mtx:1: error: has 4 numbers, expected 3"),
        ])
        self.assert_errors("f.dof", [
            ("1.2\n", "12\n", "f.dof:2: error: is '12', expected NODE.DIRECTION"),
            ("1.2\n", "1.9\n", "f.dof:2:3: error: '9' is no direction"),
            ("1.2\n", "1.1\n", "f.dof:2:1: error: x of node 1 stands in the table twice: CalculiX makes solids of "
                               "beams and shells, and writes all their nodes under one number; such a frame can"),
        ])

    def test_nastran(self):
        self.write_good("nastran", lambda path, matrix: files.write_dmig(path, {"KAAX": matrix}, FREEDOMS))
        self.change("body.toml", 'freedoms = "f.csv"\n', "")
        self.assert_errors("k.mtx", [
            ("       6       2", "       2       2",
             "k.mtx:2:32: error: the matrix has the form 2, expected 1 (square) or 6"),
            ("       6       2", "       6       4",
             "k.mtx:2:40: error: the matrix is complex (type 4), expected 1 or 2"),
            ("DMIG*   KAAX", "DMIC*   KAAX",
             "k.mtx:3: error: 'DMIC' is neither DMIG nor what stands beside the matrices of an external"),
            ("DMIG    KAAX", "GRID           1              0.      0.      0.       7\nDMIG    KAAX",
             "k.mtx:2:56: error: the point has displacements in the coordinate system 7; expected matrices"),
            ("DMIG    KAAX", "GRID*                  1                              0.              0.\n"
             "*                     0.               7\nDMIG    KAAX",
             "k.mtx:3:40: error: the point has displacements in the coordinate system 7; expected matrices"),
            ("               1               1\n", "               1               0\n",
             "k.mtx:4:40: error: 1 is a grid point here, and a scalar point in a line before"),
            ("1.000000000D+05", "1.0000000X0D+05", "error: '1.0000000X0D+05' is no number"),
            ("1.000000000D+05", "", "error: the value of the entry is missing"),
            ("1.000000000D+05", "1.000000000D+05 2.0", "error: a real matrix has an imaginary part"),
        ])
        files.write_dmig(self.folder / "k.mtx", {"KAAX": self.stiffness, "MAAX": self.mass}, FREEDOMS)
        self.assert_error("error: is a second matrix, 'MAAX' after 'KAAX': say which one is meant by 'stiffness_name'")
        self.change("body.toml", "[reference]", 'stiffness_name = "KGG"\n[reference]')
        self.assert_error("error: has no matrix 'KGG'")
        self.change("body.toml", '"KGG"', '"KAAX"')
        self.change("k.mtx", "DMIG    KAAX           0", "$MIG    KAAX           0")  # a comment
        self.assert_error("k.mtx:3: error: an entry of 'KAAX' stands before its header")

    def test_keys_of_the_design(self):
        self.assert_errors("body.toml", [
            ('"matrix-market"', '"ansys"', "body.toml:4:10: error: 'matrices.format' must be one of "),
            ("nodes =", "node =", "unknown key 'node' in 'matrices' (did you mean 'nodes'?)"),
            ("[reference]", 'axes = ["x", "-x"]\n[reference]',
             "error: 'matrices.axes' names one axis twice, expected two"),
            ("[reference]", 'mass_name = "M"\n[reference]',
             "error: 'matrices.mass_name' belongs to the format \"nastran\""),
            ("[points]", '[sections.a]\n[points]', "error: 'sections' describes beams, and stands beside [matrices]"),
            ("a = [0.0, 0.0]", "a = [0.5, 0.0]", "error: point 'a' at (0.5, 0) is 0.5 m away from the nearest node"),
            ("[reference]", "expected = { mass = 841.0 }\n[reference]",
             "error: the matrices have the mass 840 kg, expected 841 kg"),
            ("[reference]", "expected = { centre_of_mass = [0.9, 0.0] }\n[reference]",
             "error: the matrices have the centre of mass (1, 0) m, expected (0.9, 0) m"),
            ("[reference]", "expected = { inertia = 281.0 }\n[reference]",
             "error: the matrices have the moment of inertia 280 kg·m² about the centre of mass, expected 281 kg·m²"),
            ("[reference]", "length_unit = 0.0\n[reference]", "error: 'matrices.length_unit' must be > 0"),
        ])

    # Whole matrices that belong to no free body.

    def write_stiffness(self, matrix):
        files.write_matrix_market(self.folder / "k.mtx", matrix)

    def write_mass(self, matrix):
        files.write_matrix_market(self.folder / "m.mtx", matrix)

    def test_a_spring_to_the_ground(self):
        self.stiffness[4, 4] += 10.0
        self.write_stiffness(self.stiffness)
        self.assert_error("k.mtx: error: the stiffness resists a rigid displacement along y: 1 freedom gets a force",
                          "at y of node 2; boundary conditions")

    def test_places_of_the_nodes_in_other_units_or_another_order(self):
        files.write_nodes(self.folder / "n.csv", IDS, [(0.0, 0.0), (1000.0, 0.0), (2000.0, 0.0)])
        self.change("body.toml", "a = [0.0, 0.0]", "a = [1000.0, 0.0]")
        self.assert_error("k.mtx: error: the stiffness resists a rigid rotation")
        files.write_nodes(self.folder / "n.csv", IDS, [(1.0, 0.0), (0.0, 0.0), (2.0, 0.0)])
        self.assert_error("k.mtx: error: the stiffness resists a rigid rotation")

    def test_shuffled_freedoms(self):
        files.write_freedoms(self.folder / "f.csv", [FREEDOMS[i] for i in (1, 0, 2, 3, 4, 5, 6, 7, 8)])
        self.assert_error("k.mtx: error: the stiffness resists a rigid")

    def test_freedoms_without_stiffness_and_bodies_in_parts(self):
        changed = self.stiffness.copy()
        changed[[2, 5], :] = changed[:, [2, 5]] = 0.0
        self.write_stiffness(changed)
        self.assert_error("k.mtx: error: no stiffness acts on 2 freedoms: the rotation of node 1, the rotation of "
                          "node 2")
        one, _ = files.make_beam(1)
        changed = np.zeros((9, 9))
        changed[:6, :6] = one
        changed[6:, 6:] = np.eye(3)
        self.write_stiffness(changed)
        self.assert_error("k.mtx: error: the body is in parts: nothing connects node 3 with node 1")

    def test_truncated_files_of_formats_without_an_end(self):
        # Whatever line is the last one, what is left is no free body.
        writers = {"abaqus": lambda path, matrix: files.write_abaqus(path, matrix, FREEDOMS),
                   "calculix": files.write_calculix,
                   "nastran": lambda path, matrix: files.write_dmig(path, {"A": matrix}, FREEDOMS)}
        (self.folder / "f.dof").write_text("".join(f"{node}.{direction}\n" for node, direction in FREEDOMS))
        for name, write in writers.items():
            self.write_good(name, write)
            line = 'freedoms = "f.csv"\n'
            self.change("body.toml", line, 'freedoms = "f.dof"\n' if name == "calculix" else "")
            for cut in ("k.mtx", "m.mtx"):
                lines = (self.folder / cut).read_text().splitlines(keepends=True)
                for kept in (4, len(lines) // 2, len(lines) - 1):
                    with self.subTest(f"{name} {cut} {kept}"):
                        (self.folder / cut).write_text("".join(lines[:kept]))
                        self.assert_error("error: ")
                # A number that has lost its last digits is still a number.
                for lost in (1, 2, 4):
                    with self.subTest(f"{name} {cut} without its last {lost} characters"):
                        (self.folder / cut).write_text("".join(lines)[:-lost])
                        self.assert_error(f"{cut}:{len(lines)}: error: the file ends within a line")
                (self.folder / cut).write_text("".join(lines))

    def test_a_soft_spring_to_the_ground(self):
        # It moves the body of 840 kg along y as ω² = k/m does.
        spring = 1e-5 * self.stiffness[4, 4]
        changed = self.stiffness.copy()
        changed[4, 4] += spring
        self.write_stiffness(changed)
        said = self.build("body.toml").stdout
        self.assertIn(f"would vibrate at {np.sqrt(spring / 840.0) / (2.0 * np.pi):.3g} Hz", said)
        self.assertIn("; mass 840 kg, ", said)
        self.write_stiffness(self.stiffness)
        self.assertNotIn("vibrate", self.build("body.toml", "--force").stdout)

    def test_a_freedom_that_is_missing(self):
        keep = [i for i in range(9) if i != 4]
        self.write_stiffness(self.stiffness[np.ix_(keep, keep)])
        self.write_mass(self.mass[np.ix_(keep, keep)])
        files.write_freedoms(self.folder / "f.csv", [FREEDOMS[i] for i in keep])
        self.assert_error("k.mtx: error: y of node 2 is missing, as if a boundary condition held it")

    def test_masses_in_other_units_than_the_nodes(self):
        # In t and mm displacements have 1e-3, rotations 1e3 of the numbers in kg and m; the stiffness stays in N and m.
        scale = np.tile(np.sqrt([1e-3, 1e-3, 1e3]), 3)
        mass = scale[:, None] * self.mass * scale
        self.write_mass(mass)
        rotation = np.array([0.0, -1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0])  # about the middle node
        self.assert_error("m.mtx: error: the body's mass is 0.84 kg, and its radius of gyration "
                          f"{np.sqrt(rotation @ mass @ rotation / 0.84):.3g} m, though its nodes are within 2 m")

    def test_masses_of_no_body(self):
        changed = self.mass.copy()
        changed[3, 3] = -1.0
        self.write_mass(changed)
        self.assert_error("m.mtx: error: the mass is negative at x of node 2")
        changed = self.mass.copy()
        changed[1, 4] = changed[4, 1] = 1000.0
        self.write_mass(changed)
        self.assert_error("m.mtx: error: the mass matrix is not positive definite")
        shape = np.linalg.inv(np.linalg.cholesky(self.mass)).T[:, :-1]  # 8 of 9 motions have mass
        changed = self.mass @ shape @ shape.T @ self.mass
        self.write_mass(0.5 * (changed + changed.T))
        self.assert_error("m.mtx: error: the mass matrix is singular: a motion of several freedoms has no mass")
        changed = self.mass.copy()
        changed[8, 8] = 0.0
        self.write_mass(changed)
        self.assert_error("m.mtx: error: the mass couples the rotation of node 3 with y of node 2",
                          "but the rotation of node 3 itself has none")
        changed = self.mass.copy()
        changed[0, 0] += 1.0
        self.write_mass(changed)
        self.assert_error("m.mtx: error: the body's mass is 841 kg along x and 840 kg along y")
        changed = self.mass.copy()
        changed[0, 0] += 50.0
        changed[7, 7] += 50.0
        self.write_mass(changed)
        self.assert_error("m.mtx: error: mass and places of the nodes do not fit together")

    def test_bodies_that_are_not_symmetric_about_their_plane(self):
        files.write_nodes(self.folder / "n.csv", IDS, [(0.0, 0.0, 0.0), (1.0, 0.0, 0.1), (2.0, 0.0, 0.0)])
        self.assert_error("lies off the plane in the middle and has no mirror image")
        files.write_nodes(self.folder / "n.csv", IDS, [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (2.0, 0.0, 0.0)])
        whole = np.zeros((10, 10))
        whole[:9, :9] = self.stiffness
        whole[9, 9], whole[9, 4], whole[4, 9] = 100.0, 5.0, 5.0
        self.write_stiffness(whole)
        mass = np.zeros((10, 10))
        mass[:9, :9], mass[9, 9] = self.mass, 1.0
        self.write_mass(mass)
        files.write_freedoms(self.folder / "f.csv", [*FREEDOMS, (2, 3)])
        self.assert_error("k.mtx: error: the body is not symmetric about the plane: the motion in it (y of node 2) and "
                          "the motion out of it (z of node 2) are coupled")

    def test_a_sweep_names_the_same_places(self):
        sweep = ("sweep", "body.toml", "--vary", "matrices.mass_unit=1.0:2.0:2", "--modes", "3")
        self.assertEqual(self.run_program(*sweep).returncode, 0)
        self.change("k.mtx", "\n1 1 100000.0", "\n1 1 1e6x")
        for flag in ((), ("--preview",)):
            result = self.run_program(*sweep, *flag)
            self.assertEqual(result.returncode, 2)
            self.assertIn("k.mtx:4:5: error: '1e6x' is no number of a double's range", result.stderr)

    def test_programs_that_need_beams_say_so(self):
        result = self.run_program("sensitivity", "body.toml")
        self.assertEqual(result.returncode, 2)
        self.assertIn("body.toml:3:1: error: 'matrices' gives the body; sensitivities are those of beams",
                      result.stderr)
        result = self.run_program("matrices", "body.toml", "-o", "out")
        self.assertEqual(result.returncode, 2)
        self.assertIn("'body' has no beams", result.stderr)


if __name__ == "__main__":
    run_tests()
