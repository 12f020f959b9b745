"""The edges of boxes as lines."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

_CORNERS = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)])
_EDGES = [(a, a | 1 << bit) for bit in range(3) for a in range(8) if not a >> bit & 1]


def box_lines(low: npt.ArrayLike, high: npt.ArrayLike) -> npt.NDArray[np.float32]:
    """Return the twelve edges of a box between two corners, (12, 2, 3) [m]."""
    corners = np.asarray(low) + _CORNERS * np.subtract(high, low)
    return corners[np.array(_EDGES)].astype(np.float32)
