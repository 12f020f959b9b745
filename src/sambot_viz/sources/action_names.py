"""The topics and services of an action, which ROS hides from lists."""

from __future__ import annotations

_INNER = "/_action/"
_STATUS = f"{_INNER}status"


def status_topic(action: str) -> str:
    """Return where an action says how its goals are."""
    return f"{action}{_STATUS}"


def feedback_topic(action: str) -> str:
    """Return where an action says how far its goals are."""
    return f"{action}{_INNER}feedback"


def send_service(action: str) -> str:
    """Return the service of an action that takes a goal."""
    return f"{action}{_INNER}send_goal"


def result_service(action: str) -> str:
    """Return the service of an action that says how a goal has ended."""
    return f"{action}{_INNER}get_result"


def cancel_service(action: str) -> str:
    """Return the service of an action that cancels goals."""
    return f"{action}{_INNER}cancel_goal"


def action_of(topic: str) -> str:
    """Return the action that says on a topic how its goals are; "" for no such one."""
    return topic.removesuffix(_STATUS) if topic.endswith(_STATUS) else ""
