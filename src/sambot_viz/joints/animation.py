"""Motion of joints by itself, as steps without a clock.

Each function takes positions and gives the next ones; whoever has a clock calls it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from sambot_viz.joints.state import JointState


def wrap_angle(angle: float) -> float:
    """The same direction within −π ≤ angle < π [rad]."""
    wrapped = math.fmod(angle + math.pi, 2 * math.pi)
    return wrapped - math.pi if wrapped >= 0 else wrapped + math.pi


@dataclass
class DeltaMotion:
    """joint_state_publisher's automatic motion: all free joints to and fro.

    At every step each joint moves by `delta`. Past its end a continuous joint jumps to
    its minimum; any other stands at the end and turns round with the next step
    (spec/ros-nodes.md §1.6).

    Attributes:
        delta: the step [rad or m]; not above 0 means no motion.
    """

    delta: float
    _backwards: set[str] = field(default_factory=set[str])

    def step(self, state: JointState) -> dict[str, float]:
        """The next positions of all free joints [rad or m]; `state` is not changed."""
        if not self.delta > 0:
            return {}
        return {
            name: self._next(state, name, position)
            for name, position in state.positions.items()
        }

    def _next(self, state: JointState, name: str, position: float) -> float:
        joint = state.joints[name]
        lower, upper = sorted(joint.range)
        if name in self._backwards:
            following = position - self.delta
            if following >= lower:
                return following
            self._backwards.discard(name)
            return lower
        following = position + self.delta
        if following <= upper:
            return following
        if joint.type == "continuous":
            return lower
        self._backwards.add(name)
        return upper


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
