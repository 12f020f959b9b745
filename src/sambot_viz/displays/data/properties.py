"""Properties that many displays of messages have."""

from __future__ import annotations

from typing import Any

from sambot_viz.rviz import FloatProperty


def alpha_property(default: float = 1.0, **more: Any) -> FloatProperty:
    """Return the property of an alpha between 0 and 1."""
    return FloatProperty(
        "Alpha",
        default=default,
        minimum=0.0,
        maximum=1.0,
        help="How opaque it is.",
        **more,
    )


def metres(name: str, default: float, help: str, shape: Any = None) -> FloatProperty:
    """Return the property of a length [m].

    Args:
        name: of the property.
        default: [m].
        help: a sentence.
        shape: path and values of the property that must be chosen; None for always.
    """
    return FloatProperty(
        name, default=default, minimum=0.0, unit="m", help=help, hidden_unless=shape
    )
