"""Joints that move by themselves, as steps without a clock."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from itertools import pairwise

from sambot_viz.joints.state import JointState

LONGEST = 24.0
"""Of a whole sweep, however many joints there are [s]."""
OF_A_JOINT = 3.0
"""Of one joint in a sweep, where there is time for it [s]."""
SHORTEST = 1.2
"""Of one joint in a sweep; of many joints several move at the same time [s]."""


def wrap_angle(angle: float) -> float:
    """Return the same direction within −π ≤ angle < π [rad]."""
    wrapped = math.fmod(angle + math.pi, 2 * math.pi)
    return wrapped - math.pi if wrapped >= 0 else wrapped + math.pi


def turn(
    state: JointState, velocities: Mapping[str, float], dt: float, *, wrap: bool = False
) -> dict[str, float]:
    """Return positions after a time at constant velocities: a wheel keeps turning.

    Args:
        state: the positions now; not changed.
        velocities: free joint → velocity [rad/s or m/s].
        dt: the time [s].
        wrap: keep continuous joints within −π … π instead of counting turns.

    Returns:
        The new positions of those joints. A joint with limits stops at its limit.

    Raises:
        JointError: a joint is unknown or cannot be set, or a number is not finite.
    """
    positions: dict[str, float] = {}
    for name, velocity in velocities.items():
        now = state.positions.get(name, 0.0)
        position = state.checked(name, now + state.checked(name, velocity) * dt)
        if not state.joints[name].endless:
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


def eased(part: float) -> float:
    """Return the part of a way that is done after a part of its time, both 0 to 1.

    A motion begins and ends slowly.
    """
    return (1.0 - math.cos(math.pi * part)) / 2.0


def sweep(state: JointState, period: float) -> Iterator[tuple[float, dict[str, float]]]:
    """Yield the steps of a motion that moves every joint and ends where it begins.

    A joint with limits goes to the upper one, to the lower one and back; a continuous
    joint turns once. Followers follow.

    Args:
        state: where the motion begins; it is not changed.
        period: time between two steps [s].

    Yields:
        The time from the start [s], and joint → position [rad or m] of those that are
        elsewhere than one step before. Nothing without joints.
    """
    names = state.sliders
    if not names:
        return
    each = max(SHORTEST, min(OF_A_JOINT, LONGEST / len(names)))
    total = min(LONGEST, each * len(names))
    apart = (total - each) / max(1, len(names) - 1)
    steps = math.ceil(total / period)
    before: Mapping[str, float] = {name: state.positions[name] for name in names}
    for step in range(steps + 1):
        time = min(step * period, total)
        now = {
            name: _position(state, name, (time - number * apart) / each)
            for number, name in enumerate(names)
        }
        yield time, {n: q for n, q in now.items() if q != before[n]}
        before = now


def _position(state: JointState, name: str, part: float) -> float:
    """Return the position of a joint after a part of its time, from 0 to 1."""
    start, joint = state.positions[name], state.joints[name]
    if not 0.0 < part < 1.0:
        return start
    way = eased(part)
    if joint.endless:
        return start + 2.0 * math.pi * way
    lower, upper = sorted(joint.range)
    corners = (start, upper, lower, start)
    left = way * sum(abs(b - a) for a, b in pairwise(corners))
    for here, there in pairwise(corners):
        length = abs(there - here)
        if left <= length and length > 0.0:
            return here + (there - here) * left / length
        left -= length
    return start
