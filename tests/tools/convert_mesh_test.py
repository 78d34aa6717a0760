"""tools/convert_mesh: frames from every format have the same modes, everything that is dropped is listed, and files
that cannot be used are refused. Needs sprung-reduce, which SPRUNG_REDUCE names."""

import os
import shutil
import unittest

import h5py
import meshio
import numpy as np
from small_decks import ABAQUS, NASTRAN
from tool_test_case import ROOT, ToolTestCase, run_program

DATA = ROOT / "tests/tools/data"
FEM_DATA = ROOT / "tests/fem/data"
TRUCK = ROOT / "meshes/truck"
FREQUENCY_TOLERANCE = 1e-12  # relative; the eigensolver's own under renumbering of nodes is 1e-13
INERTIA_TOLERANCE = 1e-10  # relative

# The portal of data/: nodes, and lines by section. Its sections are made up.
NODES = {
    "left_foot": (0.0, 0.0), "left": (0.1, 1.25), "left_top": (0.2, 2.5), "right_foot": (3.2, 0.1),
    "right": (3.1, 1.3), "right_top": (3.0, 2.6), "crown": (1.1, 2.7), "ridge": (2.0, 2.75),
}  # fmt: skip
LINES = {
    "post": [("left_foot", "left"), ("left", "left_top"), ("right_foot", "right"), ("right", "right_top")],
    "beam": [("left_top", "crown"), ("crown", "ridge"), ("ridge", "right_top")],
    "brace": [("left", "crown")],
}
MATERIAL = "[materials.steel]\nyoungs_modulus = 2.1e11\ndensity = 7850.0\n"
SECTIONS = {"post": (2.1e-3, 4.3e-6), "beam": (8.0e-3, 6.7e-6), "brace": (4.0e-4, 1.3e-8)}  # m², m⁴
MODES = '[reference]\npoint = "crown"\ncondition = "clamped"\n[modes]\nall = true\ndamping_ratio = 0.01\n'


def format_sections(names):
    """Section tables of a design; names: what each of SECTIONS is called."""
    return "".join(
        f'[sections."{names[section]}"]\nmaterial = "steel"\narea = {area}\nsecond_moment = {moment}\n'
        for section, (area, moment) in SECTIONS.items()
    )


def portal_by_lines():
    """The portal's design without a mesh file."""
    points = "".join(f"{name} = [{x}, {y}]\n" for name, (x, y) in NODES.items())
    lines = "".join(
        f'[[lines]]\nfrom = "{a}"\nto = "{b}"\nsection = "{section}"\nelements = 1\n'
        for section, pairs in LINES.items()
        for a, b in pairs
    )
    names = {section: section for section in SECTIONS}
    return f"{MATERIAL}{format_sections(names)}[points]\n{points}{lines}{MODES}"


def portal_by_mesh(names, point='crown = [1.1, 2.7]\n'):
    """Its design with mesh.msh. point: gives the crown its name where the mesh does not."""
    named = f"[points]\n{point}" if point else ""
    return f'mesh = "mesh.msh"\n{MATERIAL}{format_sections(names)}{named}{MODES}'


def make_portal_mesh():
    """The portal as meshio's mesh, nodes in another order than above, sections as whole numbers."""
    order = sorted(NODES)
    lines = [(order.index(a), order.index(b)) for pairs in LINES.values() for a, b in pairs]
    kinds = [number for number, pairs in enumerate(LINES.values(), start=1) for _ in pairs]
    points = np.array([(*NODES[name], 0.0) for name in order])
    return meshio.Mesh(points, [("line", np.array(lines))], cell_data={"section": [np.array(kinds)]})


class ConvertCase(ToolTestCase):
    def convert(self, source, *arguments):
        """Runs the tool, which must succeed in silence on stderr. Returns what it printed."""
        process = self.run_tool("convert_mesh", source, "mesh.msh", *arguments)
        self.assert_succeeds(process)
        return process.stdout

    def reduce(self, text, name):
        """Builds the design `text` in self.folder. Returns the open superelement file."""
        (self.folder / f"{name}.toml").write_text(f'name = "{name}"\n{text}', encoding="utf-8")
        command = [os.environ["SPRUNG_REDUCE"], "build", f"{name}.toml", "--output-dir", ".", "--quiet"]
        process = run_program(command, cwd=self.folder)
        self.assertEqual(process.returncode, 0, process.stdout + process.stderr)
        file = h5py.File(self.folder / f"{name}.h5")
        self.addCleanup(file.close)
        return file

    def assert_same_body(self, found, expected):
        frequencies = expected["modes/frequency"][:]
        np.testing.assert_allclose(found["modes/frequency"][:], frequencies, rtol=FREQUENCY_TOLERANCE)
        for name in expected["inertia"]:
            reference = expected[f"inertia/{name}"][()]
            error = np.linalg.norm(found[f"inertia/{name}"][()] - reference)
            # Integrals of modes are of the order of 1 (mass-normalised) where they are not zero by symmetry.
            self.assertLessEqual(error, INERTIA_TOLERANCE * max(np.linalg.norm(reference), 1.0), name)


class Truck(ConvertCase):
    """The truck's chassis in Abaqus and Nastran format against its native design."""

    def setUp(self):
        super().setUp()
        self.native = (TRUCK / "chassis.toml").read_text(encoding="utf-8")
        self.expected = self.reduce(self.native, "native")
        begin, end = self.native.index("[[lines]]"), self.native.index("[reference]")
        self.without_lines = self.native[:begin] + self.native[end:]

    def test_abaqus_with_its_names_of_points_gives_the_native_frequencies_and_invariants(self):
        self.convert(TRUCK / "chassis.inp")
        begin, end = self.without_lines.index("[points]"), self.without_lines.index("[reference]")
        text = 'mesh = "mesh.msh"\n' + self.without_lines[:begin] + self.without_lines[end:]
        found = self.reduce(text, "abaqus")
        self.assert_same_body(found, self.expected)
        self.assertEqual(sorted(found["points/name"][:]), sorted(self.expected["points/name"][:]))

    def test_nastran_gives_the_native_frequencies_and_invariants(self):
        self.convert(TRUCK / "chassis.bdf")
        text = 'mesh = "mesh.msh"\n' + self.without_lines.replace("sections.frame", "sections.property_7")
        self.assert_same_body(self.reduce(text, "nastran"), self.expected)


class Divided(ConvertCase):
    """The lines of an imported frame divided into elements."""

    def test_lines_divided_are_those_of_a_design_with_as_many_elements(self):
        self.reduce(portal_by_lines(), "coarse")
        expected = self.reduce(portal_by_lines().replace("elements = 1", "elements = 3"), "native")
        mesh = make_portal_mesh()
        meshio.write(self.folder / "portal.vtk", mesh)
        printed = self.convert("portal.vtk", "--elements", "3")
        self.assertIn("Each of the lines kept is divided into 3 elements", printed)
        names = {section: f"section_{number}" for number, section in enumerate(SECTIONS, start=1)}
        found = self.reduce(portal_by_mesh(names), "divided")
        self.assertEqual(len(found["elements/node"]), 3 * len(mesh.cells[0].data))
        self.assert_same_body(found, expected)

    def test_numbers_of_elements_that_no_line_has_are_refused(self):
        process = self.run_tool("convert_mesh", TRUCK / "chassis.inp", "mesh.msh", "--elements", "0")
        self.assertEqual(process.returncode, 2)
        self.assertIn("--elements: error: 0, expected 1 … 1000", process.stderr)


class Portal(ConvertCase):
    """A frame of three sections from each format against its design without a mesh."""

    def setUp(self):
        super().setUp()
        self.expected = self.reduce(portal_by_lines(), "native")

    def assert_portal(self, names, point="crown = [1.1, 2.7]\n"):
        self.assert_same_body(self.reduce(portal_by_mesh(names, point), "converted"), self.expected)

    def test_abaqus(self):
        told = self.convert(DATA / "portal.inp")
        names = {"post": "POST", "beam": "BEAM", "brace": "BRACE"}
        text = portal_by_mesh(names, "").replace('"crown"', '"CROWN"')
        self.assert_same_body(self.reduce(text, "converted"), self.expected)
        for fragment in (
            "beam kind B31 of 7 elements (shear-flexible in Abaqus)", "Starter design: mesh.toml",
            "element set 'EVERYTHING' (8 lines): overlaps", "no line uses: 99",
            "node set 'FEET' has 2 nodes: one point for each, 'FEET_1' to 'FEET_2'",
        ):  # fmt: skip
            self.assertIn(fragment, told)

    def test_nastran_in_another_plane_and_all_kinds_of_fields(self):
        told = self.convert(DATA / "portal.bdf", "--plane", "xz")
        names = {"post": "property_1", "beam": "property_2", "brace": "property_3"}
        text = portal_by_mesh(names, "").replace('"crown"', '"set_100"')
        self.assert_same_body(self.reduce(text, "converted"), self.expected)
        for fragment in (
            "offsets of elements 45", "beam kind CBEAM of 3 elements", "Starter design: mesh.toml",
        ):  # fmt: skip
            self.assertIn(fragment, told)

    def test_vtk_and_vtu_and_xdmf_with_whole_numbers_as_sections(self):
        names = {"post": "section_1", "beam": "section_2", "brace": "section_3"}
        for ending in ("vtk", "vtu", "xdmf"):
            with self.subTest(ending):
                make_portal_mesh().write(self.folder / f"portal.{ending}")
                told = self.convert(f"portal.{ending}")
                self.assertIn("sections, materials and orientations", told)
                self.assert_portal(names)

    def test_med_with_its_families(self):
        mesh = make_portal_mesh()
        mesh.cell_data = {"cell_tags": [-mesh.cell_data["section"][0]]}
        mesh.cell_tags = {-number: [name] for number, name in enumerate(LINES, start=1)}
        mesh.point_data["point_tags"] = np.array([int(name == "crown") for name in sorted(NODES)])
        mesh.point_tags = {1: ["crown"]}
        mesh.write(self.folder / "portal.med")
        self.convert("portal.med")
        self.assert_portal({section: section for section in SECTIONS}, point="")

    def test_gmsh_in_both_versions_text_and_binary_gives_what_gmsh_s_own_file_gives(self):
        text = portal_by_mesh({"post": "post", "beam": "rail", "brace": "brace"}, "").replace("crown", "left")
        for name in ("portal_22", "portal_22_binary", "portal_41", "portal_41_binary"):
            with self.subTest(name):
                shutil.copy(FEM_DATA / f"{name}.msh", self.folder / "mesh.msh")
                self.expected = self.reduce(text, f"gmsh_{name}")
                self.convert(FEM_DATA / f"{name}.msh")
                self.assert_same_body(self.reduce(text, f"converted_{name}"), self.expected)


class Refusing(ToolTestCase):
    """A file that cannot be used gives its error, and no file is written."""

    def assert_refused(self, name, content, *fragments, arguments=()):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        process = self.run_tool("convert_mesh", name, "out.msh", *arguments)
        with self.subTest(fragments[0]):
            self.assert_refuses(process, name, "error: ", *fragments)
            self.assertEqual(os.listdir(self.folder), [name])
        path.unlink()

    def test_the_deck_that_the_others_spoil_is_good(self):
        for name, text in (("a.inp", ABAQUS), ("a.bdf", NASTRAN)):
            (self.folder / name).write_text(text, encoding="utf-8")
            self.assertEqual(self.run_tool("convert_mesh", name, "out.msh").returncode, 0)
            (self.folder / "out.toml").unlink()

    def test_no_lines_and_solids_only(self):
        self.assert_refused("a.inp", "*NODE\n1, 0., 0.\n2, 1., 0.\n", "no line elements")
        solid = "*NODE\n" + "".join(f"{n}, {n}., 0., 0.\n" for n in range(1, 9))
        solid += "*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4,\n5, 6, 7, 8\n"
        self.assert_refused("a.inp", solid, "no line elements; the file holds 1 elements of type C3D8")
        tetra = meshio.Mesh(np.eye(4)[:, :3], [("tetra", [[0, 1, 2, 3]])])
        tetra.write(self.folder / "a.vtk")
        content = (self.folder / "a.vtk").read_bytes()
        self.assert_refused("a.vtk", content, "no line elements; the file holds 1 elements of type tetra")

    def test_lines_off_the_plane_with_the_deviation(self):
        tilted = ABAQUS.replace("3, 1., 1., 0.", "3, 1., 1., 0.02")
        fragments = ("parallel to x–y", "node 1 is at z = 0, node 3 at 0.02, 0.02 apart", "--plane xz or yz")
        self.assert_refused("a.inp", tilted, *fragments)
        self.assert_refused("a.inp", ABAQUS, "parallel to x–z", "or --plane xy or yz", arguments=("--plane", "xz"))

    def test_two_nodes_at_one_place_or_of_one_number(self):
        twice = ABAQUS.replace("3, 1., 1., 0.", "3, 1., 1., 0.\n4, 1., 1.0000000001, 0.") + "3, 1, 4\n"
        self.assert_refused("a.inp", twice, "nodes 3 and 4 are both at (1, 1)")
        self.assert_refused("a.inp", ABAQUS.replace("3, 1., 1.", "2, 1., 1."), "a.inp:4: ", "node 2 is defined twice")
        self.assert_refused("a.bdf", NASTRAN.replace("GRID,2", "GRID,1"), "a.bdf:3: ", "node 1 is defined twice")

    def test_truncated_files(self):
        self.assert_refused("a.inp", ABAQUS[:-3], "no line end: the file is truncated")
        self.assert_refused("a.inp", ABAQUS[: ABAQUS.index("2, 1.,")] + "2\n", "node 2 has no coordinates")
        self.assert_refused("a.inp", ABAQUS + "*NSET, NSET=B\n7\n", "the set 'B' names node 7, which is not there")
        self.assert_refused("a.inp", "*PART, NAME=A\n" + ABAQUS, "no *END PART follows: the file is truncated")
        self.assert_refused("a.bdf", NASTRAN.replace("GRID,2,,1.,0.,0.\n", ""), "names node 2, which is not there")
        msh = (FEM_DATA / "portal_41.msh").read_bytes()
        self.assert_refused(
            "a.msh", msh[: msh.index(b"$EndElements")], "last section has no end: the file is truncated"
        )
        self.assert_refused("a.msh", msh[: msh.index(b"$Elements")], "meshio", "cannot read it")
        vtk = (DATA / "gmsh_portal.vtk").read_bytes()
        self.assert_refused("a.vtk", vtk[: vtk.index(b"CELL_TYPES") - 20], "meshio", "cannot read it")
        make_portal_mesh().write(self.folder / "a.med")
        med = (self.folder / "a.med").read_bytes()
        self.assert_refused("a.med", med[: len(med) // 2], "meshio", "cannot read it")

    def test_what_would_misplace_nodes_or_lose_elements(self):
        self.assert_refused("a.inp", ABAQUS + "*NCOPY\n1, 5\n", "a.inp:8: ", "*NCOPY: is not followed")
        self.assert_refused("a.inp", ABAQUS + "*ELGEN\n7, 5\n", "a.inp:9: ", "names element 7, which is not there")
        curved = ABAQUS + "*NGEN, LINE=C\n1, 3, 1\n"
        self.assert_refused("a.inp", curved, "a.inp:8: ", "*NGEN: along a curve is not followed")
        self.assert_refused("a.inp", ABAQUS + "*NGEN\n1, 3, 4\n", "a.inp:9: ", "cannot go from node 1 to node 3")
        self.assert_refused("a.inp", ABAQUS.replace("*NODE", "*NODE, SYSTEM=S"), "neither in rectangular nor in cyl")
        self.assert_refused("a.inp", ABAQUS.replace("B21", "B22"), "a B22 has 2 nodes, expected 3")
        lost = "*INSTANCE, NAME=I, PART=P\n1., 0., 0.\n*END INSTANCE\n"
        self.assert_refused("a.inp", ABAQUS + lost, "a.inp:8: ", "names the part 'P', which is not there")
        turned = "*PART, NAME=P\n" + ABAQUS + "*END PART\n*INSTANCE, NAME=I, PART=P\n0.,\n1., 2.\n*END INSTANCE\n"
        self.assert_refused("a.inp", turned, "a.inp:12: ", "which are seven numbers")
        repeated = NASTRAN.replace("CBAR", "=,*1,*1,==\nCBAR")
        self.assert_refused("a.bdf", repeated, "a.bdf:4: ", "repeats the card before")
        self.assert_refused("a.bdf", NASTRAN.replace("GRID,2,,", "GRID,2,5,"), "a.bdf:3: ", "names coordinate system 5")
        flat = NASTRAN.replace("GRID,2,,", "CORD2R,5,,0.,0.,0.,0.,0.,1.,\n,0.,0.,2.\nGRID,2,5,")
        self.assert_refused("a.bdf", flat, "a.bdf:3: ", "CORD2R: has its three points on a line")
        own = NASTRAN.replace("GRID,2,,", "CORD2R,5,5,0.,0.,0.,0.,0.,1.,\n,1.,0.,2.\nGRID,2,5,")
        self.assert_refused("a.bdf", own, "a.bdf:3: ", "coordinate system 5 is defined by itself")
        self.assert_refused("a.bdf", NASTRAN.replace("GRID,2,,1.", "GRID,2,,1x"), "'1x' is no coordinate")
        self.assert_refused("a.inp", ABAQUS.replace("2, 1., 0.", "2, nan, 0."), "'nan' is not a number")

    def test_foreign_and_missing_files_and_wrong_arguments(self):
        self.assert_refused("a.inp", "what is this\n", "not an Abaqus deck")
        self.assert_refused("a.inp", "", "not an Abaqus deck, or truncated")
        self.assert_refused("a.xyz", "1 2 3\n", "meshio", "Could not deduce file format")
        self.assert_refused("a.msh", "", "the file is empty")
        self.assert_refused("a.inp", "*INCLUDE, INPUT=a.inp\n", "a.inp:1: ", "'a.inp' includes itself")
        self.assert_refused("a.inp", ABAQUS + "*NSET, NSET=B, INPUT=b.txt\n", "a.inp:8: ", "in another file (INPUT=…)")
        self.assert_refused(
            "a.inp", ABAQUS + "*NSET, NSET=B, ELSET=C\n", "a.inp:8: ", "the set 'C', which is not there"
        )
        twice = NASTRAN.replace("ENDDATA", "SET1,4,1\nSET1,4,2\nENDDATA")
        self.assert_refused("a.bdf", twice, "a.bdf:6: ", "set 4 is defined twice")
        self.assert_refused(
            "a.inp", ABAQUS, "no element set 'B' of lines; the file has A", arguments=("--sections", "B")
        )
        missing = self.run_tool("convert_mesh", "none.inp", "out.msh")
        self.assert_refuses(missing, "none.inp: error: no such file")
        (self.folder / "a.inp").write_text(ABAQUS, encoding="utf-8")
        self.assert_refuses(self.run_tool("convert_mesh", "a.inp", "out.vtk"), "must end in .msh")
        self.assert_refuses(self.run_tool("convert_mesh", "a.inp", "none/out.msh"), "cannot write the file")
        self.assert_refuses(self.run_tool("convert_mesh", "a.inp", "out.msh", "--scale", "0"), "expected a length > 0")
        self.assertEqual(os.listdir(self.folder), ["a.inp"])

    def test_the_source_and_an_earlier_mesh_stay_as_they_were(self):
        source = (FEM_DATA / "portal_41.msh").read_bytes()
        (self.folder / "a.msh").write_bytes(source)
        self.assert_refuses(self.run_tool("convert_mesh", "a.msh", "a.msh"), "a.msh: error: is one of the input files")
        (self.folder / "bad.inp").write_text(ABAQUS + "*NCOPY\n1, 5\n", encoding="utf-8")
        self.assert_refuses(self.run_tool("convert_mesh", "bad.inp", "a.msh"), "*NCOPY")
        self.assertEqual((self.folder / "a.msh").read_bytes(), source)
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.msh", "bad.inp"])


if __name__ == "__main__":
    unittest.main()
