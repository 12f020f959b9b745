"""The frame that a click means: the one whose origin is next to the pointer."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from sambot_viz.displays.picking.rays import Array
from sambot_viz.tools.tool import Click

REACH = 6.0
"""How far from the pointer an origin may be in the picture [pixels]."""


def frame_at(click: Click, origins: Mapping[str, Array]) -> str | None:
    """Return the frame whose origin is next to a click in the picture.

    What hides an origin does not count: that of a wheel is inside it. Of several as
    near, that in front is meant.

    Args:
        click: where, in the fixed frame.
        origins: frame → position in the fixed frame, (3,) [m].

    Returns:
        None when there is none within `REACH`.
    """
    if not origins:
        return None
    names = list(origins)
    away = np.array([origins[name] for name in names]) - click.origin
    depths = away @ click.direction
    beside = np.linalg.norm(away - depths[:, None] * click.direction, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        pixels = np.where(depths > 0, beside / (depths * click.pixel), np.inf)
    best = min(range(len(names)), key=lambda n: (round(float(pixels[n]), 1), depths[n]))
    return names[best] if pixels[best] <= REACH else None
