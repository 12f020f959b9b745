"""Words about elements, for messages."""

from __future__ import annotations

from collections.abc import Iterable

from sambot_viz.robot.xml.element import Element

REFUSED = "ROS refuses the model"


def described(element: Element) -> str:
    """Name the part of the robot that an element is, or is in: "visual v of link a"."""
    named: list[str] = []
    here: Element | None = element
    while here is not None and len(named) < 2:
        name = here.get("name")
        if name and here.tag not in ("model", "sdf", "material"):
            named.append(f"{here.tag} {name}")
        here = here.parent
    return " of ".join(named) or "the model"


def and_list(names: Iterable[str]) -> str:
    """Join names as a sentence does: "a, b and c"."""
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last
