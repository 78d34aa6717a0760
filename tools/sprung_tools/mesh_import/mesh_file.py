"""Reading a mesh file by the reader for its format."""

import os

from sprung_tools.files.errors import InputError
from sprung_tools.mesh_import.abaqus_deck import read_abaqus
from sprung_tools.mesh_import.aster_mesh import is_aster_mesh, read_aster_mesh
from sprung_tools.mesh_import.line_mesh import LineMesh
from sprung_tools.mesh_import.nastran_cards import is_nastran
from sprung_tools.mesh_import.nastran_deck import read_nastran

DECKS = {".inp": read_abaqus, ".bdf": read_nastran, ".nas": read_nastran, ".fem": read_nastran}
MAYBE_NASTRAN = (".dat", ".pch", ".txt")


def read_mesh(path: str) -> LineMesh:
    """Reads the line elements of a mesh file; its ending says which format it has. InputError if it cannot be used."""
    if not os.path.isfile(path):
        raise InputError(f"{path}: error: {'is no regular file' if os.path.exists(path) else 'no such file'}")
    ending = os.path.splitext(path)[1].lower()
    if ending in DECKS:
        return DECKS[ending](path)
    if ending in MAYBE_NASTRAN and is_nastran(path):
        return read_nastran(path)
    if ending == ".mail" and is_aster_mesh(path):
        return read_aster_mesh(path)
    from sprung_tools.mesh_import.meshio_reader import read_with_meshio  # here because meshio takes long to load

    return read_with_meshio(path)
