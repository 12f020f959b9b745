"""Assemble a drawable mesh: clean it, merge parts by look, share vertices.

Every reader ends in `assemble`. It is the one place that keeps invalid data away from
the browser: values that are not finite, indices out of range, empty meshes.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz.geometry import Matrix, Rgba
from sambot_viz.meshes.mesh import Mesh, MeshPart, Texture, mesh_error
from sambot_viz.meshes.mesh_source import MeshSource

Floats = npt.NDArray[np.floating[Any]]
Ints = npt.NDArray[np.integer[Any]]


@dataclass(slots=True)
class Submesh:
    """Triangles of one look, as a reader found them.

    Attributes:
        vertices: (N, 3) [m].
        faces: (M, 3) indices into `vertices`, possibly out of range.
        normals: (N, 3), or None for flat shading.
        rgba: colour, or None when the URDF decides.
        uv: (N, 2), v upwards, or None.
        texture: image, or None.
    """

    vertices: Floats
    faces: Ints
    normals: Floats | None = None
    rgba: Rgba | None = None
    uv: Floats | None = None
    texture: Texture | None = None


def placed(piece: Submesh, T: Matrix) -> Submesh:
    """Return the piece where a node puts it: node transforms are baked in.

    Args:
        piece: triangles in the node's coordinates.
        T: (4, 4), T_mesh_node; may scale unevenly or mirror. The triangles of a
            mirrored piece are turned back so that they face outwards.
    """
    linear = T[:3, :3]
    normals, faces = piece.normals, piece.faces
    size = float(linear[0, 0])
    if size > 0 and np.array_equal(linear, size * np.eye(3)):
        # Most nodes only apply the unit: nothing turns.
        return replace(piece, vertices=piece.vertices * size + T[:3, 3])
    if normals is not None:
        # The cofactor matrix turns normals rightly and exists for every transform.
        x, y, z = linear
        cofactors = np.array([np.cross(y, z), np.cross(z, x), np.cross(x, y)])
        normals = normals @ np.transpose(cofactors)
    if np.linalg.det(linear) < 0:
        faces = faces[:, ::-1]
        normals = None if normals is None else -normals
    vertices = piece.vertices @ np.transpose(linear) + T[:3, 3]
    return replace(piece, vertices=vertices, faces=faces, normals=normals)


def assemble(pieces: Iterable[Submesh], source: MeshSource) -> Mesh:
    """Return the mesh that the pieces make.

    Raises:
        MeshError: it has no triangle that could be drawn.
    """
    groups: dict[object, list[Submesh]] = {}
    for piece in pieces:
        clean = _clean(piece, source)
        if clean is not None:
            look = (clean.rgba, id(clean.texture), clean.normals is None)
            groups.setdefault(look, []).append(clean)
    if not groups:
        reasons = [problem.message for problem in source.findings.problems]
        raise mesh_error(
            source.path,
            "mesh-broken" if reasons else "mesh-empty",
            f"nothing of the mesh can be drawn: {reasons[0]}"
            if reasons
            else "the mesh has no triangles, so there is nothing to draw",
            "export it again and check that the part was selected",
        )
    return Mesh(
        path=source.path,
        parts=tuple(_weld(_join(group)) for group in groups.values()),
        problems=tuple(source.findings.problems),
        files=(source.path, *source.files.used),
    )


def _clean(piece: Submesh, source: MeshSource) -> Submesh | None:
    """Drop triangles that cannot be drawn; None when none is left."""
    vertices = piece.vertices.astype(np.float32, copy=False)
    faces = piece.faces
    if len(faces) and (faces.max() >= len(vertices) or faces.min() < 0):
        inside = np.all((faces >= 0) & (faces < len(vertices)), axis=1)
        source.warn(
            "mesh-index-out-of-range",
            f"{np.count_nonzero(~inside)} triangles use vertices that the file does "
            "not have; they are left out",
            "export the mesh again",
        )
        faces = faces[inside]
    finite = np.isfinite(np.sum(vertices, axis=1))
    if not np.all(finite):
        a, b, c = faces[:, 0], faces[:, 1], faces[:, 2]
        usable = finite[a] & finite[b] & finite[c]
        if not np.all(usable):
            source.warn(
                "mesh-vertex-not-finite",
                f"{np.count_nonzero(~usable)} triangles have a corner that is not "
                "a finite number; they are left out",
                "export the mesh again",
            )
        faces = faces[usable]
    if not len(faces):
        return None
    textured = piece.texture is not None and piece.uv is not None
    return Submesh(
        vertices=vertices,
        faces=faces,
        normals=None if piece.normals is None else _unit(piece.normals),
        rgba=piece.rgba,
        uv=np.nan_to_num(piece.uv) if textured and piece.uv is not None else None,
        texture=piece.texture if textured else None,
    )


def _unit(normals: Floats) -> Floats:
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.nan_to_num(normals / lengths, posinf=0.0, neginf=0.0)


def _join(group: list[Submesh]) -> Submesh:
    if len(group) == 1:
        return group[0]
    sizes = [len(piece.vertices) for piece in group]
    starts = np.cumsum([0, *sizes[:-1]])
    first = group[0]
    normals = [piece.normals for piece in group if piece.normals is not None]
    uvs = [piece.uv for piece in group if piece.uv is not None]
    return Submesh(
        vertices=np.concatenate([piece.vertices for piece in group]),
        faces=np.concatenate(
            [piece.faces + start for piece, start in zip(group, starts, strict=True)]
        ),
        normals=np.concatenate(normals) if normals else None,
        rgba=first.rgba,
        uv=np.concatenate(uvs) if uvs else None,
        texture=first.texture,
    )


def _weld(piece: Submesh) -> MeshPart:
    """Share the vertices that agree in position, normal and uv; drop unused ones.

    Normals count as equal within a quarter of a degree: files write the same
    smooth normal with differing last digits, and a browser that computes normals
    from the faces would show an edge there.
    """
    used = np.zeros(len(piece.vertices), dtype=bool)
    used[piece.faces] = True
    first, group = _kinds(piece, used)
    renumbered = np.zeros(len(piece.vertices), dtype=np.uint32)
    renumbered[used] = group

    def pick(values: Floats | None) -> npt.NDArray[np.float32] | None:
        return None if values is None else values[used][first].astype(np.float32)

    return MeshPart(
        vertices=piece.vertices[used][first].astype(np.float32),
        faces=renumbered[piece.faces],
        normals=pick(piece.normals),
        rgba=piece.rgba,
        uv=pick(piece.uv),
        texture=piece.texture,
    )


def _kinds(piece: Submesh, used: npt.NDArray[np.bool_]) -> tuple[Ints, Ints]:
    """Return the first of each kind of used vertices, and the kind of each."""
    # Adding zero makes minus zero the same as zero.
    columns = [piece.vertices[used].astype(np.float32) + np.float32(0)]
    if piece.normals is not None:
        columns.append(np.rint(piece.normals[used] * 256).astype(np.float32))
        columns[-1] += np.float32(0)
    if piece.uv is not None:
        columns.append(piece.uv[used].astype(np.float32) + np.float32(0))
    return _unique_rows(np.column_stack(columns))


def _unique_rows(rows: npt.NDArray[np.float32]) -> tuple[Ints, Ints]:
    """Return the first row of each kind in order of appearance, and each row's kind.

    Rows are compared through a 64-bit hash, ten times faster than comparing them
    as they are, and the outcome is verified.
    """
    flat = np.frombuffer(np.ascontiguousarray(rows), dtype=np.uint32)
    bits: Ints = np.reshape(flat, rows.shape)
    hashes = np.zeros(len(rows), dtype=np.uint64)
    for column in range(rows.shape[1]):
        hashes = (hashes ^ bits[:, column]) * np.uint64(0x9E3779B97F4A7C15)
        hashes ^= hashes >> np.uint64(29)
    _, first, kind = np.unique(hashes, return_index=True, return_inverse=True)
    if not np.array_equal(bits[first][kind], bits):
        _, first, kind = np.unique(bits, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return first[order], rank[np.ravel(kind)]
