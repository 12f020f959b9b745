"""How old frames are, and how they look then: they fade to grey, and vanish."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from sambot_viz.displays.display import DisplayContext
from sambot_viz.displays.scene.solids import Rgb
from sambot_viz.errors import FrameError

GREY: Rgb = (178, 178, 178)
STEPS = 8
"""Number of steps of a frame on its way to grey, and again until it is gone: each is a
message to all browsers."""
SAME_CLOCK = 3600.0
"""Stamps further from the time of a recording are of another clock [s]."""
JUMP = 2.0
"""The time has jumped when it is further on than this [s], or back."""


@dataclass(frozen=True, slots=True)
class FrameLook:
    """How a frame looks at its age.

    Attributes:
        color: how much of its colours is left, the rest is grey; 0 to 1.
        alpha: 0 to 1.
    """

    color: float = 1.0
    alpha: float = 1.0

    def of(self, color: Rgb) -> Rgb:
        """Return a colour of a fresh frame as it is now, 0 to 255."""
        mixed = [
            round(self.color * c + (1 - self.color) * grey)
            for c, grey in zip(color, GREY, strict=True)
        ]
        return (mixed[0], mixed[1], mixed[2])


FRESH, GONE = FrameLook(), FrameLook(0.0, 0.0)


def look_at_age(age: float, timeout: float) -> FrameLook:
    """Return how a frame looks at an age [s], as in RViz but in steps.

    Args:
        age: since its transform to the fixed frame has changed [s].
        timeout: Frame Timeout [s].
    """
    third = timeout / 3
    if age <= third:
        return FRESH
    if age > timeout:
        return GONE
    left = (2 * third - age) / third
    if left > 0:
        return FrameLook(_step(left))
    return FrameLook(0.0, _step(1 + left))


def _step(part: float) -> float:
    """Round up, so that the rest is visible until the end."""
    return min(1.0, (int(part * STEPS) + 1) / STEPS)


class FrameAges:
    """Since when the transforms of frames to the fixed frame are the same.

    Args:
        context: the frames, and the time; without one no frame grows old.
    """

    def __init__(self, context: DisplayContext) -> None:
        self._context = context
        self._seen: dict[str, tuple[float, float]] = {}
        self._fixed = ""
        self._looked = float("-inf")
        self.looks: Mapping[str, FrameLook] = {}

    def look(self, frames: Iterable[str], timeout: float) -> bool:
        """Look again; `looks` has those that are not fresh.

        Args:
            frames: those that are shown.
            timeout: Frame Timeout [s].

        Returns:
            Whether one looks otherwise.
        """
        context, before = self._context, self.looks
        if context.now is None:
            return False
        now = context.now()
        jumped = not 0.0 <= now - self._looked <= JUMP
        if jumped or self._fixed != context.fixed_frame:
            self._seen.clear()
            self._fixed = context.fixed_frame
        self._looked = now
        looks = {frame: look_at_age(self._age(frame, now), timeout) for frame in frames}
        self.looks = {frame: one for frame, one in looks.items() if one != FRESH}
        return self.looks != before

    def _age(self, frame: str, now: float) -> float:
        try:
            stamp = self._context.tree.latest_common_time(self._fixed, frame)
        except FrameError:
            return 0.0
        if stamp == 0.0 or self._context.is_paced(frame):
            return 0.0
        seen = self._seen.get(frame)
        if seen is None:
            # It may have been silent for long; its stamp tells, if it is of our clock.
            age = now - stamp
            since = stamp if 0.0 <= age <= SAME_CLOCK else now
            seen = self._seen[frame] = (stamp, since)
        elif seen[0] != stamp:
            seen = self._seen[frame] = (stamp, now)
        return now - seen[1]
