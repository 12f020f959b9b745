"""The displays that show a topic; each says itself what it shows (`topic_values`)."""

from __future__ import annotations

from collections.abc import Sequence

from sambot_viz.displays.display import Display
from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.topics import reasons


def displays_of_topic(topic: str, type_name: str) -> Sequence[type[Display]]:
    """Return the displays that show a topic: the usual one first, the others by name.

    Args:
        topic: its name.
        type_name: of its messages.
    """
    usual = reasons.display_of(topic, type_name)
    return sorted(
        (
            display
            for display in DISPLAYS.values()
            if display.topic_values(topic, type_name, None) is not None
        ),
        key=lambda display: (display.kind != usual, display.kind),
    )
