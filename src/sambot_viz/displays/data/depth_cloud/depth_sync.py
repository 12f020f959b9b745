"""Which camera info, and which colour image, belongs to a depth image."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from sambot_viz.sources.message import Recorded
from sambot_viz.topics.decoding import frame_and_stamp


@dataclass(frozen=True, slots=True)
class DepthMessage(Recorded):
    """A depth image with what belongs to it.

    Attributes:
        info: the newest camera info.
        color: the colour image that was taken nearest in time; None for none.
    """

    info: Recorded
    color: Recorded | None


class DepthSync:
    """Keeps the last messages of each topic until their partners have come.

    A depth image waits for a colour image of the same time or a later one, and gets the
    one with the nearest stamp.

    Args:
        size: number of images kept for each topic.
        has_color: whether there is a topic of colour images.
    """

    def __init__(self, size: int, has_color: bool) -> None:
        self.info: Recorded | None = None
        self._has_color = has_color
        self._depths = deque[tuple[int, Recorded]](maxlen=size)
        self._colors = deque[tuple[int, Recorded]](maxlen=size)

    @property
    def waits_for_color(self) -> bool:
        """Whether a depth image waits for a colour image alone."""
        return self._has_color and self.info is not None and bool(self._depths)

    def take_depth(self, one: Recorded, decode: Callable[[Recorded], Any]) -> None:
        """Take a depth image.

        Raises:
            DecodeError: it has no stamp.
        """
        self._depths.append((self._stamp(one, decode), one))

    def take_color(self, one: Recorded, decode: Callable[[Recorded], Any]) -> None:
        """Take a colour image.

        Raises:
            DecodeError: it has no stamp.
        """
        self._colors.append((self._stamp(one, decode), one))

    def ready(self) -> list[DepthMessage]:
        """Return the depth images that wait no longer, the oldest first."""
        made: list[DepthMessage] = []
        while self._depths and self.info is not None:
            stamp, depth = self._depths[0]
            color = None
            if self._has_color:
                near, color = min(
                    self._colors,
                    key=lambda one: abs(one[0] - stamp),
                    default=(0, None),
                )
                if color is None or (near < stamp and self._colors[-1][0] < stamp):
                    break
            self._depths.popleft()
            parts = (depth.topic, depth.channel, depth.log_ns, depth.publish_ns)
            made.append(DepthMessage(*parts, depth.payload, self.info, color))
        return made

    def _stamp(self, one: Recorded, decode: Callable[[Recorded], Any]) -> int:
        return (frame_and_stamp(decode(one))[1] or 0) if self._has_color else 0
