"""Cancels the goals of Nav2: all that there are, by a service of its action."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable

from sambot_viz.errors import SourceError
from sambot_viz.messages import MessageTypes
from sambot_viz.publishing.outcome import cancel_of
from sambot_viz.sources.source import Encoding, Reply, Source
from sambot_viz.text import text

_GOAL = {"goal_id": {"uuid": [0] * 16}, "stamp": {"sec": 0, "nanosec": 0}}
"""An id and a time of zeros mean every goal."""
_REFUSALS = {
    1: "the robot refuses it",
    2: "the robot has no such goal",
    3: "the goal has ended already",
}
"""Return codes of action_msgs/srv/CancelGoal."""


def cancel_goals(
    source: Source, topic: str, types: MessageTypes, told: Callable[[str], object]
) -> None:
    """Ask a robot to cancel its goals.

    Args:
        source: the robot.
        topic: where its goals are sent.
        types: has the definition of the request.
        told: called with why they are not cancelled, "" for success; in the thread of
            the source, or at once.
    """

    def write(encoding: Encoding) -> bytes:
        if encoding == "json":
            return json.dumps({"goal_info": _GOAL}).encode()
        # A request with one field is written as that field.
        return types.shape("action_msgs/msg/GoalInfo").as_cdr(_GOAL)

    def answered(reply: Reply) -> None:
        told(_refusal(reply))

    try:
        source.call(cancel_of(topic), write, answered)
    except SourceError as error:
        told(str(error))


def _refusal(reply: Reply) -> str:
    """Return why goals were not cancelled, as a reply says it; "" when they were."""
    if reply.refusal:
        return reply.refusal
    try:
        if reply.is_json:
            code = int(json.loads(reply.content)["return_code"])
        else:
            (code,) = struct.unpack_from("<b", reply.content, 4)
    except (KeyError, TypeError, ValueError, struct.error):
        said = text(repr(reply.content), 80)
        return f"what the robot answers makes no sense: {said}"
    return _REFUSALS.get(code, f"the robot answers {code}") if code else ""
