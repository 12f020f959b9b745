"""Names of wheels."""

from __future__ import annotations

import re

WHEEL = re.compile("wheel|whl|t[iy]re")
SWIVELS = re.compile("cast|swivel|steer|support|omni|rot|turn|pivot|yaw")
CASTER = re.compile("(?<!broad)cast[eo]r", re.IGNORECASE)
"""Names of parts that should touch the ground."""


def rolls(joint: str, link: str) -> bool:
    """Return whether a joint turns a wheel that does not swivel, by the names.

    Args:
        joint: name of the joint.
        link: name of its child.
    """
    names = f"{joint} {link}".lower()
    return WHEEL.search(names) is not None and SWIVELS.search(names) is None
