"""Why Nav2 has given a goal up: its result, by a service of its action."""

from __future__ import annotations

from collections.abc import Callable

from sambot_viz.messages import MessageTypes
from sambot_viz.publishing.outcome import result_of
from sambot_viz.publishing.services import GET_RESULT, ServiceAnswer, call_service
from sambot_viz.sources.source import Source
from sambot_viz.text import text

_FRAMES = "a transform is missing or too old"
_CODES = {
    101: "there is no such controller",
    102: _FRAMES,
    103: "the path cannot be followed",
    104: "it took too long to get on",
    105: "the robot does not get on",
    106: "no velocity is safe",
    107: "the controller takes too long",
    201: "there is no such planner",
    202: _FRAMES,
    203: "the robot is outside of the map",
    204: "the goal is outside of the map",
    205: "something is where the robot is",
    206: "something is where the goal is",
    207: "the planner takes too long",
    208: "there is no way",
    9001: "the behaviour tree cannot be loaded",
    9002: _FRAMES,
    9003: "it took too long",
}
"""Error codes of Nav2's actions FollowPath, ComputePathToPose and NavigateToPose."""


def ask_why(
    source: Source,
    topic: str,
    goal: bytes,
    types: MessageTypes,
    told: Callable[[str], object],
) -> None:
    """Ask Nav2 why a goal was given up.

    Args:
        source: the robot.
        topic: where its goals are sent.
        goal: the id of the goal.
        types: has the definitions of the messages.
        told: called with the reason, "" where it does not say one; in the thread of the
            source, or at once.
    """

    def answered(answer: ServiceAnswer) -> None:
        told(why_of(answer))

    fields = {"goal_id": {"uuid": [*goal]}}
    call_service(source, result_of(topic), GET_RESULT, fields, types, answered)


def why_of(answer: ServiceAnswer) -> str:
    """Return why a goal was given up, by its result; "" where that does not say it."""
    if answer.content is None:
        return ""
    result = answer.content.result
    code = int(result.error_code)
    said = text(str(getattr(result, "error_msg", "")), 300)
    known = said or _CODES.get(code, "")
    if code:
        known = f"{known} (error {code})" if known else f"error {code}"
    return known
