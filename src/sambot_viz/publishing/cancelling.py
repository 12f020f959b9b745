"""Cancels the goals of Nav2: all that there are, by a service of its action."""

from __future__ import annotations

from collections.abc import Callable

from sambot_viz.messages import MessageTypes
from sambot_viz.publishing.outcome import cancel_of
from sambot_viz.publishing.services import CANCEL_GOAL, ServiceAnswer, call_service
from sambot_viz.sources.source import Source

_REFUSALS = {
    0: "",
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

    def answered(answer: ServiceAnswer) -> None:
        if answer.content is None:
            told(answer.refusal)
        else:
            code = int(answer.content.return_code)
            why = _REFUSALS.get(code, f"the robot answers {code}")
            if not code and not len(answer.content.goals_canceling):
                why = "the robot says that it cancels no goal"
            told(why)

    # An id and a time of zeros mean every goal.
    call_service(source, cancel_of(topic), CANCEL_GOAL, {}, types, answered)
