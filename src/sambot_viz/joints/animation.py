"""Joints that move by themselves, as steps without a clock."""

from __future__ import annotations

import math
from collections.abc import Mapping

from sambot_viz.joints.state import JointState


def wrap_angle(angle: float) -> float:
    """The same direction within −π ≤ angle < π [rad]."""
    wrapped = math.fmod(angle + math.pi, 2 * math.pi)
    return wrapped - math.pi if wrapped >= 0 else wrapped + math.pi


def turn(
    state: JointState,
    velocities: Mapping[str, float],
    dt: float,
    *,
    wrap: bool = False,
) -> dict[str, float]:
    """Positions after a time at constant velocities: a wheel keeps turning.

    Args:
        state: the positions now; not changed.
        velocities: free joint → velocity [rad/s or m/s].
        dt: the time [s].
        wrap: keep continuous joints within −π … π instead of counting turns.

    Returns:
        The new positions of those joints. A joint with limits stops at its limit.

    Raises:
        JointError: an unknown joint, one that cannot be set, no finite number.
    """
    positions: dict[str, float] = {}
    for name, velocity in velocities.items():
        now = state.positions.get(name, 0.0)
        position = state.checked(name, now + state.checked(name, velocity) * dt)
        if state.joints[name].type != "continuous":
            lower, upper = sorted(state.joints[name].range)
            position = _stopped(now, position, lower, upper)
        elif wrap:
            position = wrap_angle(position)
        positions[name] = position
    return positions


def _stopped(now: float, following: float, lower: float, upper: float) -> float:
    """Stop at a limit, but let a joint that is outside come back."""
    if following > now:
        return min(following, max(upper, now))
    return max(following, min(lower, now))
