"""Damaged files: whatever is changed in a file, a tool ends well or with an InputError, never with another exception.

The mutants are made from a fixed seed, so that a failure names the one that causes it. SPRUNG_MUTANTS=10 tries ten
times as many and prints how many were refused.
"""

import contextlib
import io
import os
import random
import re
import shutil
import sys
import unittest
from unittest import mock

import h5py
import numpy as np
from commands import list_readers
from fatigue_test import write_loads
from mode_runs import write_adaptive_run
from plot_modes_test import write_choice
from plot_response_test import SEAT, write_response
from small_decks import ABAQUS, NASTRAN
from synthetic_results import write_results
from tool_test_case import ROOT, ToolTestCase

from sprung_tools.cli import (
    compare_frequencies,
    convert_mesh,
    export_csv,
    export_paraview,
    fatigue,
    plot_modes,
    plot_response,
    plot_results,
    report,
    report_peaks,
    ride,
)
from sprung_tools.files.errors import InputError
from sprung_tools.plots import picture_file

ROUNDS = int(os.environ.get("SPRUNG_MUTANTS", "1"))
SUPERELEMENTS = [ROOT / f"tests/reduce/data/version_{number}.h5" for number in (1, 7)]
VALUES = (np.nan, np.inf, -1, 0, 10**9, "text", b"\xff\xfe", np.arange(3), np.bytes_("x"))
NUMBERS = (
    b"9999999999", b"9" * 30, b"-1", b"0", b"1e308", b"nan", b"", b"1 THRU 9999999999", b"*", b"GENERATE", b"1.5-",
)  # fmt: skip
RUN_COMMANDS = (
    (report_peaks, "{file} --show points/chassis.seat/acceleration.y --show bodies/chassis/displacement.y"),
    (export_csv, "{file} -o out.csv --show bodies/chassis/modal/amplitude.1 --show energy/kinetic"),
    (ride, "{file}"),
    (report, "{file} -o out.html"),
    (export_paraview, "{file} -o out.pvd --every 0.4"),
)
SUPERELEMENT_COMMANDS = (
    (compare_frequencies, "{file} --printed 6.11 6.11"),
    (export_paraview, "{file} -o out.pvd --modes 1 2"),
)
# What writes a file, and the commands that draw it.
DRAWN = (
    (write_adaptive_run, ((plot_modes, "{file} -o out.png --over-time"),
                          (plot_results, "{file} -o out.png --mark-road --show bodies/chassis/displacement.y"))),
    (write_choice, ((plot_modes, "{file} -o out.png"),)),
    (write_response, ((plot_response, f"{{file}} -o out.png --show {SEAT} --spectrum"),
                      (plot_response, f"{{file}} -o out.png --show {SEAT} --bands"))),
    (write_loads, ((fatigue, "{file} --category 71 -o out.png"), (fatigue, "{file} --category 71 --json"))),
)  # fmt: skip


def change_attribute(item, rng):
    """Removes an attribute of a group or a dataset, or gives it another value."""
    key = rng.choice(sorted(item.attrs))
    if rng.random() < 0.4:
        del item.attrs[key]
    else:
        item.attrs[key] = rng.choice(VALUES)


def change_values(values, rng):
    """Other values, another shape or another type in place of a dataset's."""
    values = np.asarray(values)
    kind = rng.randrange(5)
    if kind == 0:
        return values[..., None]
    if kind == 1 and values.ndim:
        return values[: rng.randrange(values.shape[0] + 1)]
    if kind == 2 and values.size and values.dtype.kind in "fiu":
        spoilt = values.astype(float)
        spoilt.flat[rng.randrange(values.size)] = rng.choice((-1.0, 0.5, 1e9, np.nan, np.inf))
        return spoilt
    return np.bytes_("nothing") if kind == 3 else values.size


def change_structure(path, rng):
    """Changes one thing in an HDF5 file: an object is removed, replaced, or given other values or attributes."""
    with h5py.File(path, "a") as file:
        names: list[str] = []
        file.visit(names.append)
        name = rng.choice(sorted(names))
        item = file[name]
        kind = rng.random()
        if kind < 0.35 and len(item.attrs):
            change_attribute(item, rng)
        elif kind < 0.6 or isinstance(item, h5py.Group):
            del file[name]
            if rng.random() < 0.3:
                file[name] = 1.0
        else:
            values, attributes = item[()], dict(item.attrs)
            del file[name]
            file[name] = change_values(values, rng)
            file[name].attrs.update(attributes)


def change_bytes(content, rng):
    """Changes one thing in a text or in bytes: a bit, a number, a line, or the end."""
    content = bytearray(content)
    kind = rng.randrange(5)
    lines = bytes(content).split(b"\n")
    if kind == 0:
        content[rng.randrange(len(content))] ^= 1 << rng.randrange(8)
    elif kind == 1:
        del content[rng.randrange(len(content)) :]
    elif kind == 2:
        first, last = rng.choice([found.span() for found in re.finditer(rb"[-+0-9.eE]+", bytes(content))])
        content[first:last] = rng.choice(NUMBERS)
    elif kind == 3:
        del lines[rng.randrange(len(lines))]
        content = bytearray(b"\n".join(lines))
    else:
        lines.insert(rng.randrange(len(lines)), rng.choice(lines))
        content = bytearray(b"\n".join(lines))
    return bytes(content)


class Completeness(ToolTestCase):
    def test_every_command_that_reads_such_files_is_here(self):
        drawn = [command for _, commands in DRAWN for command in commands]
        modules = {module for module, _ in (*RUN_COMMANDS, *SUPERELEMENT_COMMANDS, *drawn)} | {convert_mesh}
        self.assertEqual({module.__name__.rpartition(".")[2] for module in modules}, list_readers())


class Mutants(ToolTestCase):
    """Each test counts how many mutants were refused, so that it cannot pass where no mutant is damaged."""

    def setUp(self):
        super().setUp()
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)

    def is_refused(self, module, arguments):
        """Runs a command in this process. Whether it refused its input; any exception but InputError gets through."""
        with contextlib.ExitStack() as stack:
            stack.enter_context(mock.patch.object(sys, "argv", ["tool", *arguments.split()]))
            stack.enter_context(contextlib.redirect_stdout(io.StringIO()))
            stack.enter_context(contextlib.redirect_stderr(io.StringIO()))
            stack.enter_context(np.errstate(all="ignore"))
            try:
                module.main()
            except InputError as error:
                self.assertRegex(str(error), r"^[^ ]+: error: .")
                return True
        return False

    def count_refused(self, base, commands, change, seeds):
        """The number of mutants that were refused. base: file that is changed."""
        refused = 0
        seeds = range(seeds.start, seeds.start + ROUNDS * len(seeds))
        for seed in seeds:
            rng = random.Random(seed)
            target = self.folder / f"{base.stem}_{seed}{base.suffix}"  # what a command leaves open is not written again
            shutil.copy(base, target)
            change(target, rng)
            module, arguments = rng.choice(commands)
            with self.subTest(base.name, seed=seed, command=module.__name__):
                refused += self.is_refused(module, arguments.format(file=target.name))
        if ROUNDS > 1:
            print(f"{base.name}: {refused} of {len(seeds)} refused", flush=True)
        return refused

    def test_a_results_file_with_something_changed(self):
        write_results(self.folder / "run.h5")
        with h5py.File(self.folder / "run.h5", "a") as file:
            file["energy/kinetic"] = np.ones(file["time"].shape)
        write_adaptive_run(self.folder / "adaptive.h5")
        for name in ("run.h5", "adaptive.h5"):
            self.assertGreater(self.count_refused(self.folder / name, RUN_COMMANDS, change_structure, range(120)), 20)

    def test_a_superelement_with_something_changed(self):
        for path, seeds in zip(SUPERELEMENTS, (range(100), range(1250, 1300))):
            self.assertGreater(self.count_refused(path, SUPERELEMENT_COMMANDS, change_structure, seeds), 3)

    def test_files_that_are_drawn_with_something_changed(self):
        self.enterContext(mock.patch.object(picture_file, "DOTS_PER_INCH", 20))  # saves time
        refused = 0
        for write, commands in DRAWN:
            base = self.folder / f"{write.__name__}.h5"
            write(base)
            refused += self.count_refused(base, commands, change_structure, range(5))
        self.assertGreater(refused, 6)

    def test_a_results_file_with_damaged_bytes(self):
        write_results(self.folder / "run.h5")

        def change(path, rng):
            path.write_bytes(change_bytes(path.read_bytes(), rng))

        self.assertGreater(self.count_refused(self.folder / "run.h5", RUN_COMMANDS, change, range(60)), 20)

    def test_a_dataset_that_claims_to_be_larger_than_the_file(self):
        write_results(self.folder / "run.h5")
        with h5py.File(self.folder / "run.h5", "a") as file:
            del file["bodies/chassis/position"]
            shape = {"shape": (201, 3), "maxshape": (None, 3), "chunks": (201, 3)}  # no chunk is ever written
            file.create_dataset("bodies/chassis/position", dtype=float, **shape)
        with self.assertRaisesRegex(InputError, "run.h5: error: dataset 'bodies/chassis/position' is damaged"):
            with mock.patch.object(sys, "argv", ["tool", "run.h5", "--show", "bodies/chassis/position.y"]):
                report_peaks.main()

    def test_decks_and_meshes_with_something_changed(self):
        (self.folder / "a.inp").write_text(ABAQUS + "*NSET, NSET=B, GENERATE\n1, 3, 1\n", encoding="utf-8")
        (self.folder / "a.bdf").write_text(NASTRAN.replace("ENDDATA", "SET1,4,1,THRU,2\nENDDATA"), encoding="utf-8")
        for name in ("portal_22.msh", "portal_41_binary.msh"):
            shutil.copy(ROOT / "tests/fem/data" / name, self.folder)

        def change(path, rng):
            path.write_bytes(change_bytes(path.read_bytes(), rng))

        commands = ((convert_mesh, "{file} out.msh"),)
        for name in ("a.inp", "a.bdf", "portal_22.msh", "portal_41_binary.msh"):
            self.assertGreater(self.count_refused(self.folder / name, commands, change, range(80)), 20)

    def test_a_deck_of_endless_sets_and_numbers(self):
        for name, text, fragment in (
            ("a.inp", ABAQUS + "*NSET, NSET=B, GENERATE\n1, 2000000000, 1\n", "generates more than"),
            ("a.inp", ABAQUS.replace("3, 1.,", "99999999999999999999, 1.,"), "numbers? of a node or an element|end at"),
            ("a.bdf", NASTRAN.replace("ENDDATA", "SET1,4,1,THRU,2000000000\nENDDATA"), "is not a range of"),
            ("a.bdf", NASTRAN.replace("ENDDATA", f"SET1,4,1,THRU,{'9' * 30}\nENDDATA"), "is not a node's number"),
            ("a.bdf", NASTRAN.replace("ENDDATA", f"SET1,4,{'9' * 5000}\nENDDATA"), "is not a node's number"),
            ("a.bdf", NASTRAN.replace("2,0.,1.,0.", f"2,{'9' * 5000}"), "numbers end at|is no node"),
            ("a.inp", f"{ABAQUS}*NSET, NSET=B, GENERATE\n1, {'9' * 30}\n", "which end at"),
            ("a.inp", f"{ABAQUS}*NSET, NSET=B\n1, {'9' * 5000}\n", "is not a number"),
            ("a.bdf", NASTRAN.replace("GRID,2", "GRID,99999999999999999999"), "numbers end at"),
            ("a.inp", ABAQUS.replace("2, 1.,", "2, 1e308,").replace("3, 1.,", "3, -1e308,"), "too large"),
        ):
            (self.folder / name).write_text(text, encoding="utf-8")
            with self.subTest(fragment), self.assertRaisesRegex(InputError, fragment):
                with mock.patch.object(sys, "argv", ["tool", name, "out.msh"]):
                    convert_mesh.main()


if __name__ == "__main__":
    unittest.main()
