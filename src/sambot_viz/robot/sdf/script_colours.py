"""Colours with common names, as in Gazebo's scripts."""

from __future__ import annotations

SCRIPT_COLOURS = {
    "red": "1 0 0 1",
    "green": "0 1 0 1",
    "blue": "0 0 1 1",
    "yellow": "1 1 0 1",
    "orange": "1 0.5 0 1",
    "purple": "1 0 1 1",
    "turquoise": "0 1 1 1",
    "cyan": "0 1 1 1",
    "grey": "0.5 0.5 0.5 1",
    "gray": "0.5 0.5 0.5 1",
    "white": "1 1 1 1",
    "black": "0 0 0 1",
}
"""Name → red, green, blue and opacity."""
