"""Positions for viser: always finite, whatever a model contains."""

from __future__ import annotations

from sambot_viz.geometry import Matrix, Vector3

FARTHEST = 1e30
"""Browsers compute with 32 bits: what is farther away [m] would be infinite there."""


def position_of(T: Matrix) -> Vector3:
    """Return the translation of a (4, 4) matrix [m], always finite.

    viser keeps what it is given for every browser that comes later, so this is the
    last place where an absurd number can be stopped.
    """
    return (_shown(T[0, 3]), _shown(T[1, 3]), _shown(T[2, 3]))


def _shown(metres: float) -> float:
    """Return a finite coordinate; NaN (of two infinities) becomes 0."""
    # A comparison with NaN is never true.
    return (
        float(metres)
        if -FARTHEST < metres < FARTHEST
        else FARTHEST
        if metres > 0
        else -FARTHEST
        if metres < 0
        else 0.0
    )
