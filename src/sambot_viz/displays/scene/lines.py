"""Hairlines with an alpha, which viser's own lines do not have.

A GLB with the primitive mode LINES becomes GL lines in the page: 1 pixel wide,
unlit, blended, without depth writes, as RViz draws its grid.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from sambot_viz.displays.scene.solids import OPAQUE_FROM, linear
from sambot_viz.meshes.glb import glb_file

_FLOAT, _LINES = 5126, 1

MOST_PIECES = 20000
"""More pieces than this are not made of lines (0.5 MB)."""


def in_pieces(
    segments: npt.NDArray[np.float32], longest: float
) -> npt.NDArray[np.float32]:
    """Cut lines into pieces.

    A GL line with an end behind the camera is dropped as a whole by some renderers
    (software WebGL does so); of a line in pieces only the nearest piece is lost.

    Args:
        segments: (N, 2, 3) float32 [m].
        longest: length that a piece should not exceed [m].

    Returns:
        (M, 2, 3) float32; M ≥ N.
    """
    start, step = segments[:, 0], segments[:, 1] - segments[:, 0]
    length = float(np.linalg.norm(step, axis=1).max())
    count = max(1, min(int(np.ceil(length / longest)), MOST_PIECES // len(segments)))
    at = np.arange(count + 1, dtype=np.float32)[:, None, None] / count
    points = start[None] + at * step[None]
    pieces = np.stack([points[:-1], points[1:]], axis=2)
    return np.concatenate(list(pieces)).astype(np.float32)


def lines_glb(
    segments: npt.NDArray[np.float32], color: tuple[int, int, int], alpha: float
) -> bytes:
    """Return a GLB file of line segments.

    Args:
        segments: (N, 2, 3) float32, start and end of each line [m].
        color: 0 to 255.
        alpha: 0 to 1; from `OPAQUE_FROM` on the lines are opaque and write depth.

    Returns:
        The bytes for `viser.SceneApi.add_glb`.
    """
    points = np.array(segments, dtype="<f4")
    rgba = [*(linear(c) for c in color), alpha]
    blended = alpha < OPAQUE_FROM
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [
            {
                "primitives": [
                    {"attributes": {"POSITION": 0}, "mode": _LINES, "material": 0}
                ]
            }
        ],
        "materials": [
            {
                "pbrMetallicRoughness": {"baseColorFactor": rgba, "metallicFactor": 0},
                "alphaMode": "BLEND" if blended else "OPAQUE",
            }
        ],
        "buffers": [{"byteLength": points.nbytes}],
        "bufferViews": [{"buffer": 0, "byteLength": points.nbytes}],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": _FLOAT,
                "count": 2 * len(points),
                "type": "VEC3",
                "min": points.min(axis=(0, 1)).tolist(),
                "max": points.max(axis=(0, 1)).tolist(),
            }
        ],
    }
    return glb_file(document, points.tobytes())
