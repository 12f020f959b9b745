"""The goals of one robot: what becomes of those that were sent, and cancelling them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from sambot_viz.errors import SourceError
from sambot_viz.publishing.acted_goal import NAVIGATE, ActedGoal, goal_content
from sambot_viz.publishing.cancelling import cancel_goals
from sambot_viz.publishing.goal_result import ask_why
from sambot_viz.publishing.outbound import GOAL_TOPIC, Goal, Outbound
from sambot_viz.publishing.outcome import (
    GIVEN_UP,
    GoalFollower,
    Outcome,
    cancel_of,
    feedback_of,
    given_up,
    navigator_of,
    status_of,
)
from sambot_viz.sources.message import Recorded
from sambot_viz.sources.source import CancelGoal, GoalReport, OnMessage, Outgoing
from sambot_viz.text import text
from sambot_viz.topics.source_robot import SourceRobot

_TOPICS = 8
"""Maximum number of topics whose goals are followed at a time."""
_NOT_CANCELLED = "not cancelled: "
_SENT = Outcome("sent", False, True)


class Goals:
    """Follows the goals of a robot, topic by topic, before there is one.

    Args:
        robot: a live robot.
        told: called with news; in any thread, must only post.
        with_distance: whether to report the remaining distance repeatedly.

    Attributes:
        last: the progress of the last goal; None without one.
    """

    def __init__(
        self,
        robot: SourceRobot,
        told: Callable[[], object],
        *,
        with_distance: bool = True,
    ) -> None:
        self.last: Outcome | None = None
        self._goal: Outbound | None = None
        self._outgoing: Outgoing | None = None
        self._robot, self._told = robot, told
        self._with_distance = with_distance
        self._followed: dict[str, tuple[GoalFollower, OnMessage]] = {}
        self._tell: Callable[[Outcome], object] = lambda outcome: None
        self._acted: ActedGoal | None = None
        self._cancel_acted: CancelGoal = _nothing
        robot.on_status.append(self._look)

    @property
    def is_on_the_way(self) -> bool:
        """Whether a goal that was sent from here has not ended, as far as is known."""
        return self.last is not None and not self.last.is_over

    @property
    def on_the_way(self) -> Outbound | None:
        """The goal that was sent from here and has not ended, as far as is known."""
        return self._goal if self.is_on_the_way else None

    @property
    def goes_on(self) -> str:
        """Why a goal that was to be cancelled goes on; "" where none does."""
        words = self.last.words if self.last is not None else ""
        is_so = self.is_on_the_way and words.startswith(_NOT_CANCELLED)
        return words if is_so else ""

    def follow(self, topic: str) -> None:
        """Listen to what becomes of the goals of a topic."""
        if topic in self._followed:
            return
        decode, follower = self._robot.new_decoding().decode, GoalFollower()
        feedback = feedback_of(topic)

        def take(message: Recorded) -> None:
            is_feedback = message.topic == feedback
            look = follower.take_feedback if is_feedback else follower.take
            outcome = look(message, decode)
            if outcome is not None and outcome.words == GIVEN_UP:
                # The report about it contains the reason.
                types, goal = self._robot.decoding.types, follower.goal
                ask_why(self._robot.source, topic, goal, types, self._give_up)
            elif outcome is not None:
                self._pass_on(outcome)

        if len(self._followed) >= _TOPICS:
            self._follow_no_more(next(iter(self._followed)))
        self._followed[topic] = follower, take
        for one in self._topics_of(topic):
            self._robot.source.subscribe(one, take)

    def begin(
        self,
        goal: Outbound,
        topic: str,
        outgoing: Outgoing,
        tell: Callable[[Outcome], object],
    ) -> None:
        """Follow the next new goal of a topic, which is about to be sent.

        Args:
            goal: the goal, with the name of its frame here.
            topic: the topic.
            outgoing: the same topic at the robot.
            tell: called with its progress, in any thread.
        """
        self.follow(topic)
        self._leave_goals()
        self._tell, self._goal, self._outgoing = tell, goal, outgoing
        self._followed[topic][0].begin()
        self._note(_SENT)

    def send(
        self, topic: str, goal: Goal, now_ns: int, tell: Callable[[Outcome], object]
    ) -> str:
        """Send a goal to the action of Nav2, and return that.

        Args:
            topic: where Nav2 takes goals as messages.
            goal: where to.
            now_ns: the time of the robot [ns].
            tell: called with what becomes of it, in any thread.

        Raises:
            SourceError: the robot does not show the action; nothing was sent.
        """
        source, decoding = self._robot.source, self._robot.new_decoding()
        action = source.action(navigator_of(topic), NAVIGATE)
        content = goal_content(action, goal, now_ns, decoding.types)
        self._leave_goals()
        acted = ActedGoal(decoding, with_distance=self._with_distance)
        self._acted, self._tell, self._goal = acted, tell, goal
        self._outgoing = None

        def take(report: GoalReport) -> None:
            outcome = acted.take(report)
            if outcome is not None and self._acted is acted:
                self._pass_on(outcome)

        self._note(_SENT)
        try:
            self._cancel_acted = action.send(content, take)
        except SourceError:
            self.forget()
            raise
        return action.name

    def forget(self) -> None:
        """The goal that was begun could not be sent."""
        self.last = None
        self._leave_goals()

    def cancel(self) -> Sequence[str]:
        """Cancel all goals of the robot; takes no lock of the session.

        The outcome is reported with the goal.

        Returns:
            The called services.
        """
        if self.is_on_the_way:
            self._note(Outcome("asked to cancel", False, True))
            # The service may not be shown, or not be allowed.
            self._cancel_acted()
        types = self._robot.decoding.types
        topics = tuple(self._followed) or (GOAL_TOPIC,)
        for topic in topics:
            told = partial(self._tell_cancelled, topic)
            cancel_goals(self._robot.source, topic, types, told)
        return [cancel_of(topic) for topic in topics]

    def close(self) -> None:
        """Stop following goals."""
        self._robot.on_status.remove(self._look)
        for topic in tuple(self._followed):
            self._follow_no_more(topic)

    def _tell_cancelled(self, topic: str, why: str) -> None:
        """Take what the robot has answered to `cancel`; "" for success."""
        if not self.is_on_the_way:
            return
        if why:
            self._note(Outcome(f"{_NOT_CANCELLED}{text(why, 300)}", False, False))
        elif self._acted is None and (
            status_of(topic) not in self._robot.source.topics()
        ):
            # Nobody else says it.
            self._note(Outcome("cancelled", True, False))

    def _look(self) -> None:
        """Note that the bridge has refused what was sent; the robot knows no goal."""
        refused = "" if self._outgoing is None else self._outgoing.refused
        if refused and self.last is _SENT:
            words = f"the robot refuses it: {text(refused, 400)}"
            self._pass_on(Outcome(words, True, False))

    def _note(self, outcome: Outcome) -> None:
        self.last = outcome
        self._told()

    def _follow_no_more(self, topic: str) -> None:
        _, take = self._followed.pop(topic)
        for one in self._topics_of(topic):
            self._robot.source.unsubscribe(one, take)

    def _topics_of(self, topic: str) -> Sequence[str]:
        """Return the topics that report the progress of the goals of a topic."""
        far = (feedback_of(topic),) if self._with_distance else ()
        return (status_of(topic), *far)

    def _give_up(self, why: str) -> None:
        self._pass_on(given_up(why))

    def _leave_goals(self) -> None:
        """Say no more of goals that were sent before."""
        self._acted, self._cancel_acted = None, _nothing
        for follower, _ in self._followed.values():
            follower.forget()

    def _pass_on(self, outcome: Outcome) -> None:
        """Keep what the robot has said of a goal, and tell who has sent it."""
        self._note(outcome)
        self._tell(outcome)


def _nothing() -> None:
    return None
