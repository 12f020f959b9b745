"""Sends one goal to a robot on the network, and says what becomes of it."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from threading import Event

from sambot_viz.errors import PublishError, SourceError
from sambot_viz.frames.history import FrameHistory
from sambot_viz.publishing.goals import Goals
from sambot_viz.publishing.outbound import GOAL_TOPIC, Goal
from sambot_viz.publishing.outcome import Outcome, status_of
from sambot_viz.publishing.takers import FOUND_WITHIN, frame_fault, who_takes
from sambot_viz.publishing.written import time_of, written
from sambot_viz.sources.message import Recorded
from sambot_viz.sources.source import Outgoing
from sambot_viz.text import text
from sambot_viz.topics.source_robot import SourceRobot

DISCOVERY = 0.5
"""ROS finds a new publisher within this time, as a rule [s]."""
_LOOKS = 0.1
"""Who gets a topic is looked at so often [s]."""


class GoalSender:
    """Sends a goal to a live robot, after a look at whether it can come to something.

    What the robot says is taken in the thread that calls.

    Args:
        robot: not connected yet; whoever made it closes it.
        topic: where it takes goals.
    """

    def __init__(self, robot: SourceRobot, topic: str = GOAL_TOPIC) -> None:
        self._robot, self._source = robot, robot.source
        self._topic = topic
        self._status = status_of(topic)
        self._transforms = robot.transforms(FrameHistory())
        self._changed = Event()
        self._goals = Goals(robot, self._changed.set, with_distance=False)
        self._outgoing: Outgoing | None = None
        self._action = ""
        self._outcomes: list[Outcome] = []
        self._came: deque[tuple[Callable[[Recorded], None], Recorded]] = deque()
        robot.on_topics.append(self._changed.set)
        robot.on_status.append(self._changed.set)

    def connect(self, seconds: float) -> None:
        """Connect, and subscribe to the robot's frames and the progress of goals.

        Raises:
            SourceError: there is no robot within the time limit [s].
        """
        self._source.open()
        self._goals.follow(self._topic)
        if not self._wait(lambda: bool(self._source.topics()), seconds):
            none = "; it has no topic" if self._source.status.is_connected else ""
            raise SourceError(f"{self._source.status.sentence}{none}")

    def send(self, goal: Goal) -> str:
        """Send a goal, and return who gets it, in words.

        Raises:
            PublishError: nothing would become of it, and why.
            SourceError: the robot takes no messages, or has left.
        """
        self._require_frame(goal.frame)
        outgoing = self._source.advertise(self._topic, Goal.type_name)
        self._outgoing = outgoing
        self._wait(lambda: self._acts(goal) or bool(outgoing.refused), DISCOVERY)
        if self._action:
            return f"the action {self._action}"
        self._wait(lambda: bool(outgoing.receivers.names), FOUND_WITHIN)
        who = who_takes(outgoing, "goal", "name another one with --topic")
        self._require_taken()
        self._goals.begin(goal, self._topic, outgoing, self._outcomes.append)
        types = self._robot.decoding.types
        outgoing.send(written(outgoing, goal, self._now_ns(), types))
        return who

    def _acts(self, goal: Goal) -> bool:
        """Send a goal to its action; return whether the robot shows that by now."""
        if goal.by_action:
            told = self._outcomes.append
            with suppress(SourceError):
                self._action = self._goals.send(self._topic, goal, self._now_ns(), told)
        return bool(self._action)

    def _now_ns(self) -> int:
        return time_of(self._source, self._transforms.newest_ns)

    def follow(self, seconds: float, say: Callable[[str], None]) -> Outcome | None:
        """Follow a goal that was sent to its end, and return how far it has come.

        Args:
            seconds: how long, at most [s].
            say: takes each word that the robot says of it.

        Returns:
            What was said last; None when nothing was.

        Raises:
            PublishError: the robot has refused it.
            SourceError: the robot has left.
        """
        said = 0

        def is_over() -> bool:
            nonlocal said
            self._require_taken()
            # More may come in another thread, and is for the next time.
            new = self._outcomes[said:]
            said += len(new)
            for outcome in new:
                say(outcome.words)
            return any(outcome.is_over for outcome in new)

        self._wait(is_over, seconds)
        return self._outcomes[-1] if self._outcomes else None

    @property
    def can_follow(self) -> bool:
        """Whether the robot says what becomes of goals."""
        return bool(self._action) or self._status in self._source.topics()

    @property
    def status_topic(self) -> str:
        """Where it would say that."""
        return self._status

    # What the robot says

    def _listen(self, topic: str, take: Callable[[Recorded], None]) -> None:
        self._source.subscribe(topic, partial(self._queue, take))

    def _queue(self, take: Callable[[Recorded], None], message: Recorded) -> None:
        self._came.append((take, message))
        self._changed.set()

    def _wait(self, is_there: Callable[[], bool], seconds: float) -> bool:
        """Take what comes until something is there, at most so long [s]."""
        until = time.monotonic() + seconds
        while True:
            while self._came:
                take, message = self._came.popleft()
                take(message)
            if is_there():
                return True
            left = until - time.monotonic()
            if left <= 0.0:
                return False
            self._changed.wait(min(left, _LOOKS))
            self._changed.clear()

    # Whether it can come to something

    def _require_frame(self, frame: str) -> None:
        """Refuse a goal in a frame without a way to that of the planner."""
        robot, frames = self._robot, self._transforms.history
        listened = set[str]()

        def is_fine() -> bool:
            moving, static = robot.topics.moving, robot.topics.static
            for topic in {*moving, *static} - listened:
                self._transforms.set_topics(moving, static, self._source.topics())
                self._listen(topic, self._transforms.take)
                listened.add(topic)
            return bool(frames.frames) and not frame_fault(frames, frame, "goal")

        self._wait(is_fine, FOUND_WITHIN)
        if why := frame_fault(frames, frame, "goal"):
            raise PublishError(f"the robot takes no goal in that frame: {why}")

    def _require_taken(self) -> None:
        if not self._source.status.is_connected:
            raise SourceError(f"the robot has left: {self._source.status.sentence}")
        if self._outgoing is not None and self._outgoing.refused:
            why = text(self._outgoing.refused, 400)
            raise PublishError(f"the robot refuses it: {why}")
