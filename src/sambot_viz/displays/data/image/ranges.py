"""The range of values that is shown from black to white."""

from __future__ import annotations

from collections import deque
from typing import Any

import numpy as np

from sambot_viz import limits
from sambot_viz.displays.data.image.encodings import Bytes, Values


class Ranges:
    """The medians of the least and the greatest values of the last pictures."""

    def __init__(self) -> None:
        self._limits: deque[tuple[float, float]] = deque(
            maxlen=limits.IMAGE_MEDIAN.value
        )

    def add(self, values: Values) -> None:
        """Add a picture; values that are not finite are ignored."""
        finite = values[np.isfinite(values)]
        least = min(65535.0, float(finite.min())) if finite.size else 65535.0
        most = max(0.0, float(finite.max())) if finite.size else 0.0
        self._limits.append((least, most))

    def median(self, frames: int) -> tuple[float, float]:
        """Return the medians over some last pictures; there has to be one."""
        last = list(self._limits)[-max(frames, 1) :]
        least, most = (sorted(ones) for ones in zip(*last, strict=True))
        return least[len(last) // 2], most[len(last) // 2]

    def clear(self) -> None:
        """Forget all pictures."""
        self._limits.clear()


def scaled(values: Values, limits: tuple[float, float]) -> Bytes:
    """Return values as grey, (H, W): black at the lower limit, white at the upper one.

    Both are cut to whole numbers, as RViz does: a depth in metres of 0.6 to 4.7 is
    shown from 0 to 4.
    """
    least, most = int(limits[0]), int(limits[1])
    # Without a range RViz divides by 0; here all that is above is white.
    span = float(most - least) if most > least else 1e-6
    with np.errstate(invalid="ignore", over="ignore"):
        parts: Any = (values.astype(np.float32) - least) / span
        parts = parts.clip(0.0, 1.0)
    return np.nan_to_num(parts * 255.0, nan=0.0).astype(np.uint8)
