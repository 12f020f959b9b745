"""Comparison of transforms up to rounding."""

from __future__ import annotations

import numpy as np

from sambot_viz import Transform


def is_close(a: Transform, b: Transform, tolerance: float = 1e-9) -> bool:
    """Whether no entry of the two matrices differs by more than the tolerance."""
    return bool(np.abs(a.matrix - b.matrix).max() <= tolerance)
