"""What becomes of a goal, among those that a robot had before."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from sambot_viz.publishing.outcome import GoalFollower


def said(follower: GoalFollower, **statuses: int) -> str:
    """What a follower makes of the statuses of goals; "" when nothing is new."""
    array = SimpleNamespace(
        status_list=[
            SimpleNamespace(
                status=status,
                goal_info=SimpleNamespace(goal_id=SimpleNamespace(uuid=name.encode())),
            )
            for name, status in statuses.items()
        ]
    )
    content: Any = array
    outcome = follower.take(content, lambda message: message)
    return "" if outcome is None else outcome.words


def test_a_goal_that_has_ended_before_is_not_the_one_that_was_sent() -> None:
    follower = GoalFollower()
    follower.begin()
    # The latched message may come only now.
    assert said(follower, old=4) == ""
    assert said(follower, old=4, mine=2) == "on the way"
    assert said(follower, old=4, mine=4) == "reached"


def test_a_goal_is_followed_when_it_is_the_first_of_all() -> None:
    follower = GoalFollower()
    follower.begin()
    assert said(follower, mine=1) == "accepted"
    assert said(follower, mine=6).startswith("not reached")
