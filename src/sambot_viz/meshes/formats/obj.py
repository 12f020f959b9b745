"""OBJ with MTL, as RViz shows it.

Grey where no material says otherwise, flat where a face has no normals. Smoothing
groups, lines, points and curves are ignored.

trimesh is not used: on 806 real files it cuts 22 concave polygons differently from
Assimp, invents an image where there is none, and says nothing about a missing .mtl
file or texture.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from sambot_viz.meshes.assembly.assemble import Floats, Submesh
from sambot_viz.meshes.assembly.triangles import (
    DECIMAL_COMMA,
    WITH_POINTS,
    parse_floats,
    parse_ints,
    table_of,
    triangulate,
)
from sambot_viz.meshes.formats.obj_material import read_libraries
from sambot_viz.meshes.mesh import GREY
from sambot_viz.meshes.mesh_source import MeshMaterial, MeshSource

_TWO_SLASHES = re.compile(rb"/\d*/")
_MISSING = np.iinfo(np.int64).min


@dataclass(slots=True)
class _Group:
    """Consecutive faces of one material, with what had been listed before them."""

    material: str
    seen: tuple[int, int, int]
    lines: list[bytes] = field(default_factory=list[bytes])


@dataclass(slots=True)
class _Lines:
    """The lines of a file by what they are."""

    positions: list[bytes] = field(default_factory=list[bytes])
    uvs: list[bytes] = field(default_factory=list[bytes])
    normals: list[bytes] = field(default_factory=list[bytes])
    groups: list[_Group] = field(default_factory=list[_Group])
    libraries: list[str] = field(default_factory=list[str])


def read_obj(source: MeshSource) -> list[Submesh]:
    """Return the triangles of an OBJ file."""
    lines = _sort(source.data)
    faces = sum(len(group.lines) for group in lines.groups)
    source.budget.spend_triangles(faces, len(lines.positions))
    looks = read_libraries(lines.libraries, source)
    tables = (
        _table(lines.positions, 3, source),
        _table(lines.uvs, 2, source),
        _table(lines.normals, 3, source),
    )
    pieces: list[Submesh] = []
    for group in lines.groups:
        if not group.lines:
            continue
        look = looks.get(group.material)
        if look is None and group.material and looks:
            source.warn(
                "mesh-material-broken",
                f"the material '{group.material}' is not in the .mtl file; grey is "
                "shown",
            )
        look = look or MeshMaterial(GREY)
        for piece in _pieces(group, tables, source):
            piece.rgba, piece.texture = look.rgba, look.texture
            pieces.append(piece)
    return pieces


def _sort(data: bytes) -> _Lines:
    data = data.replace(b"\\\r\n", b" ").replace(b"\\\n", b" ").replace(b"\t", b" ")
    lines = _Lines()
    positions, uvs, normals = lines.positions, lines.uvs, lines.normals
    group = _Group("", (0, 0, 0))
    lines.groups.append(group)
    for line in data.splitlines():
        # Files have hundreds of thousands of lines, so the common ones come first.
        start = line[:2]
        if start == b"v ":
            positions.append(line[2:])
        elif start == b"f ":
            seen = (len(positions), len(uvs), len(normals)) if b"-" in line else None
            if seen is not None and seen != group.seen:
                # It counts backwards from the lines so far.
                group = _Group(group.material, seen)
                lines.groups.append(group)
            group.lines.append(line[2:])
        elif start == b"vn":
            normals.append(line[3:])
        elif start == b"vt":
            uvs.append(line[3:])
        else:
            keyword, _, rest = line.strip().partition(b" ")
            if keyword == b"usemtl":
                group = _Group(_text(rest), group.seen)
                lines.groups.append(group)
            elif keyword == b"mtllib":
                lines.libraries.append(_text(rest))
            elif keyword in (b"v", b"vn", b"vt", b"f") and line[:1] == b" ":
                # Indented: rare enough to begin again.
                stripped = [text.lstrip() for text in data.splitlines()]
                return _sort(b"\n".join(stripped))
    return lines


def _text(line: bytes) -> str:
    return line.decode("utf-8", "replace").strip()


def _table(lines: list[bytes], width: int, source: MeshSource) -> Floats:
    """Read the first numbers of every line, (rows, width)."""
    if not lines:
        return np.empty((0, width), dtype=np.float32)
    columns = len(lines[0].split())
    values = parse_floats(b" ".join(lines))
    if values is not None and columns >= width and len(values) == columns * len(lines):
        return table_of(values, columns)[:, :width]
    rows = [parse_floats(b" ".join(line.split()[:width])) for line in lines]
    table = np.full((len(rows), width), np.nan, dtype=np.float32)
    for number, row in enumerate(rows):
        if row is not None:
            table[number, : len(row)] = row
    if width == 2:
        return np.nan_to_num(table)
    if np.any(np.isnan(table)):
        commas = DECIMAL_COMMA.search(b" ".join(lines))
        source.warn(
            "mesh-geometry-broken",
            (
                f"the OBJ file has decimal commas ({commas[0].decode()})"
                if commas
                else "some lines of the OBJ file are not three numbers"
            )
            + "; what uses them is left out",
            WITH_POINTS if commas else "export the mesh again",
        )
    return table


def _pieces(
    group: _Group, tables: tuple[Floats, Floats, Floats], source: MeshSource
) -> list[Submesh]:
    """Make the triangles of a group: smooth where all corners have normals."""
    counts = np.array([len(line.split()) for line in group.lines], dtype=np.int64)
    corners = _corners(b" ".join(group.lines), int(counts.sum()))
    if corners is None:
        source.warn(
            "mesh-geometry-broken",
            "a face of the OBJ file has an index that is not a whole number; the faces "
            f"of the material '{group.material}' are left out",
            "export the mesh again",
        )
        return []
    # Counted from one, or backwards from what had been listed so far.
    index = corners - 1
    if corners.min() < 0:
        seen = np.array(group.seen, dtype=np.int64)
        index = np.where((corners < 0) & (corners != _MISSING), corners + seen, index)
        index = np.where(corners == _MISSING, -1, index)
    positions, uvs, normals = tables
    points, there = _fill(positions, index[:, 0])
    points[~there] = np.nan
    faces = triangulate(counts, points, source.budget)
    faces = _with_all_corners(faces, there, source)
    # Lines that are not three numbers have been reported.
    faces = faces[~np.any(np.isnan(points)[faces], axis=(1, 2))]
    # As in Assimp a corner without uv takes the image at (0, 0).
    uv, has_uv = _fill(uvs, index[:, 1])
    normal, has_normal = _fill(normals, index[:, 2])
    smooth = np.all(has_normal[faces], axis=1)
    uv = uv if np.any(has_uv) else None
    pieces = [
        Submesh(points, faces[smooth], normals=normal, uv=uv),
        Submesh(points, faces[~smooth], uv=uv),
    ]
    return [piece for piece in pieces if len(piece.faces)]


def _with_all_corners(
    faces: npt.NDArray[np.int64], there: npt.NDArray[np.bool_], source: MeshSource
) -> npt.NDArray[np.int64]:
    """Drop the triangles of corners that the file does not have."""
    whole = np.all(there[faces], axis=1)
    if not np.all(whole):
        source.warn(
            "mesh-index-out-of-range",
            f"{np.count_nonzero(~whole)} triangles use vertices that the file does "
            "not have; they are left out",
            "export the mesh again",
        )
    return faces[whole]


def _fill(
    table: Floats, index: npt.NDArray[np.int64]
) -> tuple[Floats, npt.NDArray[np.bool_]]:
    """Return the rows at these places, else zeros, and which of them are there."""
    there = (index >= 0) & (index < len(table))
    rows = np.zeros((len(index), table.shape[1]), dtype=np.float32)
    rows[there] = table[index[there]]
    return rows, there


def _corners(text: bytes, count: int) -> npt.NDArray[np.int64] | None:
    """Read position, uv and normal of each corner as written, (count, 3)."""
    text = text.replace(b"//", b"/0/")
    slashes = text.count(b"/")
    table = np.full((count, 3), _MISSING, dtype=np.int64)
    uniform = slashes in (0, 2 * count) or (
        slashes == count and _TWO_SLASHES.search(text) is None
    )
    if uniform and count:
        width = 1 + slashes // count
        values = parse_ints(text.replace(b"/", b" "))
        if values is None or len(values) != width * count:
            return None
        table[:, :width] = table_of(values, width)
    else:
        for row, corner in enumerate(text.split()):
            values = parse_ints(corner.replace(b"/", b" "))
            if values is None or not 1 <= len(values) <= 3:
                return None
            table[row, : len(values)] = values
    table[table == 0] = _MISSING
    return table
