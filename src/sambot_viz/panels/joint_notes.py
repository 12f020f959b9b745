"""What the Joints panel says beside its sliders, as HTML and as text to copy."""

from __future__ import annotations

import math

from sambot_viz.joints import JointState
from sambot_viz.joints.values import as_topic_pub, as_yaml
from sambot_viz.robot.joint import Joint
from sambot_viz.text import html_text, text

MOST_SKIPPED = 20


def unit_of(joint: Joint, degrees: bool) -> str:
    """The unit on screen: m, rad or °."""
    if joint.type == "prismatic":
        return "m"
    return "°" if degrees else "rad"


def factor_of(joint: Joint, degrees: bool) -> float:
    """What a position [rad or m] is multiplied with for the screen."""
    if degrees and joint.type != "prismatic":
        return math.degrees(1.0)
    return 1.0


def notes_html(state: JointState, degrees: bool) -> str:
    """Joints over a limit, joints that follow others, joints without a position."""
    positions = state.all_positions()
    parts: list[str] = []
    for name in state.over_limit():
        joint = state.joints[name]
        lower, upper = (_shown(joint, v, degrees) for v in sorted(joint.range))
        value = _shown(joint, positions[name], degrees)
        parts.append(
            f'<div class="sambot-warn">{html_text(name)} is over its limit: {value} '
            f"{unit_of(joint, degrees)} ({lower} … {upper})</div>"
        )
    for name, follower in state.followers.items():
        joint, mimic = state.joints[name], follower.mimic
        offset = f" + {mimic.offset:g}" if mimic.offset else ""
        parts.append(
            f"<div>{html_text(name)} = {_shown(joint, positions[name], degrees)} "
            f"{unit_of(joint, degrees)} (follows {mimic.multiplier:g} × "
            f"{html_text(mimic.joint)}{offset})</div>"
        )
    for name, why in list(state.skipped.items())[:MOST_SKIPPED]:
        if not why.startswith("fixed"):
            parts.append(f"<div>{html_text(name)}: {html_text(why)}</div>")
    return f'<div class="sambot-note">{"".join(parts)}</div>' if parts else ""


def as_text(state: JointState, kind: str) -> str:
    """The positions to copy: as yaml, or as the command that publishes them.

    Args:
        state: the joints.
        kind: "yaml", or anything else for ``ros2 topic pub``.
    """
    positions = state.all_positions()
    whole = as_yaml(positions) if kind == "yaml" else as_topic_pub(positions)
    return "\n".join(text(line, 100_000) for line in whole.splitlines())


def _shown(joint: Joint, value: float, degrees: bool) -> str:
    return f"{value * factor_of(joint, degrees):.4g}".replace("-", "−")
