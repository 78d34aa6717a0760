"""Frames from other programs' mesh files, written as gmsh meshes."""
