"""Read and measure the polygon of a footprint."""

from __future__ import annotations

import math
import re

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_NUMBERS = re.compile(NUMBER)


def polygon_of(text: str) -> list[tuple[float, float]] | None:
    """Return the corners of a footprint [m]; None when they are unreadable."""
    numbers = [float(n) for n in _NUMBERS.findall(text)[:2000]]
    if len(numbers) < 6 or len(numbers) % 2 or not all(map(math.isfinite, numbers)):
        return None
    return list(zip(numbers[::2], numbers[1::2], strict=True))


def distance(
    point: tuple[float, float], a: tuple[float, float], b: tuple[float, float]
) -> float:
    """Return the distance of a point from the side between two corners [m]."""
    edge, to = (b[0] - a[0], b[1] - a[1]), (point[0] - a[0], point[1] - a[1])
    length = edge[0] ** 2 + edge[1] ** 2
    share = (to[0] * edge[0] + to[1] * edge[1]) / (length or 1.0)
    share = min(max(share, 0.0), 1.0)
    return math.hypot(to[0] - share * edge[0], to[1] - share * edge[1])
