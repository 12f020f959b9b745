"""Limits of the files of meshes, and of what belongs to them."""

from __future__ import annotations

from sambot_viz.limits.row import LimitRow

MESH = LimitRow(
    "a mesh file",
    500 * 2**20,
    "bytes",
    "the mesh is missing; Problems says so",
)
TRIANGLES = LimitRow(
    "triangles of a mesh file",
    20_000_000,
    "",
    "the mesh is missing; Problems says so",
)
TEXTURE = LimitRow(
    "the file of a texture",
    64 * 2**20,
    "bytes",
    "the mesh is drawn without it; Problems says so",
)
TEXTURE_PIXELS = LimitRow(
    "a texture",
    8192 * 8192,
    "pixels",
    "the mesh is drawn without it; Problems says so",
)
MESH_NODES = LimitRow(
    "nodes of a mesh file",
    100_000,
    "",
    "the mesh is missing; Problems says so",
)
MESH_VERTICES = LimitRow(
    "vertices of a mesh file",
    30_000_000,
    "",
    "the mesh is missing; Problems says so",
)
MESH_EMPTY = LimitRow(
    "entries of a mesh file without a byte",
    2**20,
    "",
    "the mesh is missing; Problems says so",
)
MESH_CUTTING = LimitRow(
    "work for polygons with inward corners: n² + 1000 for n corners",
    200_000_000,
    "",
    "later ones may be drawn wrongly; Problems says so",
)
MESH_NAMES = LimitRow(
    "work for equal names of nodes in a glTF file",
    5_000_000,
    "",
    "the mesh is missing; Problems says so",
)
MESH_DEPTH = LimitRow(
    "nodes in nodes of a Collada file",
    200,
    "",
    "deeper ones are left out; Problems says so",
)
PLY_HEADER = LimitRow(
    "the header of a PLY file",
    2**16,
    "bytes",
    "the mesh is missing; Problems says so",
)
MATERIALS = LimitRow(
    "a file of materials of an OBJ file",
    64 * 2**20,
    "bytes",
    "the mesh has no colours; Problems says so",
)
TEXTURE_SIDE = LimitRow(
    "a side of a texture",
    1024,
    "pixels",
    "it is drawn smaller",
)
