"""A group of displays."""

from __future__ import annotations

from sambot_viz.displays.display import Display


class GroupDisplay(Display):
    """Displays that are switched on and off together."""

    kind = "rviz_common/Group"
    properties = ()

    def draw(self) -> None:
        """A group has no picture of its own."""

    def clear(self) -> None:
        """A group has no picture of its own."""
