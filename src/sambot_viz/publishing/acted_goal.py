"""A goal that is sent to Nav2's action, and what its reports say in words."""

from __future__ import annotations

import json
from typing import Any

from sambot_viz.errors import DecodeError, PublishError
from sambot_viz.messages import MessageTypes
from sambot_viz.publishing.goal_result import why_of
from sambot_viz.publishing.outbound import Goal
from sambot_viz.publishing.outcome import GoalFollower, Outcome, given_up
from sambot_viz.publishing.services import GET_RESULT, read_reply
from sambot_viz.sources.message import Recorded
from sambot_viz.sources.source import ABORTED, GoalReport, OutgoingAction
from sambot_viz.topics.decoding import Decoding

NAVIGATE = "nav2_msgs/action/NavigateToPose"
_GOAL = "geometry_msgs/PoseStamped pose\nstring behavior_tree"
_LEFT = f"""\
nav2_msgs/NavigateToPose_Feedback feedback
{"=" * 80}
MSG: nav2_msgs/NavigateToPose_Feedback
builtin_interfaces/Duration estimated_time_remaining
float32 distance_remaining
"""
"""The fields read from a feedback in JSON; for CDR a server sends the definition."""


def goal_content(
    action: OutgoingAction, goal: Goal, now_ns: int, types: MessageTypes
) -> bytes:
    """Return a goal as an action wants it.

    Its stamp is never the time of the server, which rosbridge takes for goals from its
    computer, not from a simulation.

    Args:
        action: of Nav2.
        goal: where to.
        now_ns: the time of the robot [ns].
        types: has the definitions of the messages.

    Raises:
        PublishError: a field is not what the type says.
    """
    sec, nanosec = divmod(now_ns, 10**9)
    inner = goal.without(action.frame_prefix)
    stamp = {"sec": sec, "nanosec": nanosec}
    fields = {"pose": inner.fields(stamp), "behavior_tree": ""}
    try:
        if action.encoding == "json":
            return json.dumps(fields, allow_nan=False).encode()
        return types.shape("nav2_msgs/NavigateToPose_Goal", _GOAL).as_cdr(fields)
    except (DecodeError, TypeError, ValueError) as error:
        raise PublishError(f"{action.type_name}: {error}") from error


class ActedGoal:
    """Reports the progress of one goal of an action.

    Args:
        decoding: decodes the messages of its robot.
        with_distance: whether to report the remaining distance repeatedly.
    """

    def __init__(self, decoding: Decoding, *, with_distance: bool) -> None:
        self._decoding, self._follower = decoding, GoalFollower()
        self._with_distance = with_distance

    def take(self, report: GoalReport) -> Outcome | None:
        """Accept a report; return the news about the goal."""
        if report.refusal:
            return Outcome(report.refusal, True, False)
        new = self._follower.take_status(report.status)
        if report.status == ABORTED and report.result is not None:
            answer = read_reply(report.result, GET_RESULT, self._decoding.types)
            return given_up(why_of(answer))
        if report.feedback is None or not self._with_distance:
            return new
        return self._take_distance(report.feedback) or new

    def _take_distance(self, feedback: Recorded) -> Outcome | None:
        if not self._follower.wants_distance():
            return None
        try:
            return self._follower.take_distance(self._read(feedback))
        except (DecodeError, TypeError, ValueError):
            return None

    def _read(self, message: Recorded) -> Any:
        if message.channel.message_encoding != "json":
            return self._decoding.decode(message)
        name = "nav2_msgs/NavigateToPose_FeedbackMessage"
        shape = self._decoding.types.shape(name, _LEFT)
        return shape.filled(json.loads(bytes(message.payload)))
