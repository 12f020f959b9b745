"""joint_state_publisher's parameters `dependent_joints`: mimic without the file."""

from __future__ import annotations

import math
from collections.abc import Mapping

from sambot_viz.errors import UsageError
from sambot_viz.robot.model import Mimic

_KEYS = ("parent", "factor", "offset")

Parameter = str | float


def read_dependent_joints(
    parameters: Mapping[str, Parameter | Mapping[str, Parameter]],
) -> dict[str, Mimic]:
    """Read the parameters below `dependent_joints` (spec/ros-nodes.md §1.2).

    Args:
        parameters: "JOINT.parent", "JOINT.factor" and "JOINT.offset" with their
            values, or JOINT with a mapping of those three, as in a parameter file.
            Names with dots are fine here.

    Returns:
        Joint → what it follows, for `JointState(dependent_joints=…)`.

    Raises:
        UsageError: with the real node's text, and which joint it is about.
    """
    found: dict[str, dict[str, Parameter]] = {}
    for name, value in parameters.items():
        if isinstance(value, Mapping):
            found.setdefault(name, {}).update(value)
            continue
        joint, dot, key = name.rpartition(".")
        if not dot or not joint:
            raise UsageError(
                f"Invalid dependent_joint name '{name}'; "
                "write JOINT.parent, JOINT.factor or JOINT.offset"
            )
        found.setdefault(joint, {})[key] = value
    return {joint: _mimic(joint, given) for joint, given in found.items()}


def _mimic(joint: str, given: Mapping[str, Parameter]) -> Mimic:
    for key in given:
        if key not in _KEYS:
            raise UsageError(
                f"Invalid dependent_joint name '{key}' (allowed values are 'parent', "
                f"'factor', 'offset'); it stands at joint '{joint}'"
            )
    parent = given.get("parent", "")
    if not isinstance(parent, str) or not parent:
        raise UsageError(
            "All dependent_joints must at least have a parent; "
            f"'{joint}' has none: add {joint}.parent"
        )
    factor = _number(joint, "factor", given.get("factor", 1.0))
    return Mimic(parent, factor, _number(joint, "offset", given.get("offset", 0.0)))


def _number(joint: str, key: str, value: Parameter) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not math.isfinite(number):
        raise UsageError(f"{joint}.{key}: {value!r} is no finite number")
    return number
