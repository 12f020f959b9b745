"""Node transforms, baked into triangles."""

from __future__ import annotations

import numpy as np

from sambot_viz.robot.mesh.assembly import Piece
from sambot_viz.robot.model import Matrix


def placed(piece: Piece, T: Matrix) -> Piece:
    """The piece where a node puts it.

    Args:
        piece: triangles in the node's coordinates.
        T: (4, 4), T_mesh_node; may scale unevenly or mirror. The triangles of a
            mirrored piece are turned back so that they face outwards.
    """
    linear = T[:3, :3]
    normals, faces = piece.normals, piece.faces
    if normals is not None:
        # The cofactor matrix turns normals rightly and exists for every transform.
        x, y, z = linear
        cofactors = np.array([np.cross(y, z), np.cross(z, x), np.cross(x, y)])
        normals = normals @ np.transpose(cofactors)
    if np.linalg.det(linear) < 0:
        faces = faces[:, ::-1]
        normals = None if normals is None else -normals
    return Piece(
        vertices=piece.vertices @ np.transpose(linear) + T[:3, 3],
        faces=faces,
        normals=normals,
        rgba=piece.rgba,
        uv=piece.uv,
        texture=piece.texture,
    )
