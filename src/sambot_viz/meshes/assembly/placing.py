"""Node transforms, baked into triangles."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from sambot_viz.geometry import Matrix
from sambot_viz.meshes.assembly.assemble import Submesh


def placed(piece: Submesh, T: Matrix) -> Submesh:
    """The piece where a node puts it.

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
