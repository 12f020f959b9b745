"""The one way out of a session to its robot: permissions, receivers, and a log."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from sambot_viz.errors import (
    DecodeError,
    PublishError,
    PublishFrameError,
    PublishPaceError,
    SourceError,
)
from sambot_viz.files import LIVE_SOURCES
from sambot_viz.outlet import Painted, write_err
from sambot_viz.publishing.acted_goal import NAVIGATE
from sambot_viz.publishing.any_message import AnyMessage
from sambot_viz.publishing.driver import NOT_REACHED, Driver
from sambot_viz.publishing.goals import Goals
from sambot_viz.publishing.outbound import (
    KINDS,
    Goal,
    Kind,
    Outbound,
    kinds_of,
)
from sambot_viz.publishing.outcome import Outcome
from sambot_viz.publishing.parameters import set_parameter
from sambot_viz.publishing.sent_message import PublishLog, SentMessage
from sambot_viz.publishing.takers import (
    FOUND_WITHIN,
    KnownFrames,
    frame_fault,
    other_publishers,
    who_takes,
)
from sambot_viz.publishing.velocity import Velocity
from sambot_viz.publishing.written import written
from sambot_viz.sources.source import Outgoing
from sambot_viz.text import text
from sambot_viz.topics.source_robot import SourceRobot

JOINTS_TOPIC = "/joint_states"
DESCRIPTION_TOPIC, DESCRIPTION_NODE = "/robot_description", "/robot_state_publisher"
"""Where a robot is described, and the node that has it as a parameter."""
_LOOKS = 0.05
_TOPICS = 8
"""Maximum number of published topics at a time: more than there are tools."""
FASTEST = 0.05
"""Messages go at least so long after one another [s]; a hand is slower."""


@dataclass(frozen=True, slots=True)
class DriveSettings:
    """How a robot is driven by hand.

    Attributes:
        topic: where velocities go.
        most: the highest linear [m/s] and angular speed [rad/s].
        told: called when something is new about who drives; in any thread, must only
            post.
        post: has something done in the session's thread.
    """

    topic: str
    most: tuple[float, float]
    told: Callable[[], object]
    post: Callable[[Callable[[], object]], object]


class Publisher:
    """Sends messages to the robot of a session, if that was allowed.

    Not thread-safe: the session's lock is held.

    Args:
        allowed: which kinds may be sent.
        frames: of the session.
        log: where what was sent is written; None for nowhere.
        drive: how the robot is driven by hand.
        is_private: it is a copy of one user, who sends nothing.

    Attributes:
        robot: the live robot; None without one.
        driver: drives it; None where that is not allowed.
        goals: those of the robot; None without one.
        name_of: the user of a page, for the log.
        listeners: called with all that was sent, in the session's thread or in that of
            the program that sends it.
    """

    def __init__(
        self,
        allowed: Collection[Kind],
        frames: KnownFrames,
        log: PublishLog | None,
        drive: DriveSettings,
        *,
        is_private: bool = False,
    ) -> None:
        self.robot: SourceRobot | None = None
        self.driver: Driver | None = None
        self.goals: Goals | None = None
        self.name_of: Callable[[int], str] = lambda client: ""
        self.listeners: list[Callable[[SentMessage], object]] = []
        self._drive = drive
        self._allowed, self._frames, self._log = frozenset(allowed), frames, log
        self._is_private = is_private
        self._outgoing: dict[tuple[str, str], Outgoing] = {}
        self._now_ns: Callable[[], int] = lambda: 0
        self._last = self._stopped = 0.0
        self._joints: dict[str, float] = {}

    def take(self, robot: SourceRobot | None, now_ns: Callable[[], int]) -> None:
        """Send to another robot from now on, or to none.

        Args:
            robot: a live one, or None.
            now_ns: returns its time [ns].
        """
        self.close()
        self.robot, self._now_ns = robot, now_ns
        if robot is not None:
            self.goals = Goals(robot, self._drive.told)
        if robot is not None and not self.refusal("drive"):
            how = self._drive
            self.driver = Driver(
                robot, now_ns, how.topic, how.most, how.told, self._note_velocity
            )
        self._drive.told()

    def close(self) -> None:
        """Stop the robot, and end all topics; a second call does nothing."""
        if self.driver is not None:
            self.driver.close()
            self.driver = None
        for outgoing in self._outgoing.values():
            outgoing.close()
        self._outgoing.clear()
        if self.goals is not None:
            self.goals.close()
            self.goals = None

    @property
    def sends_anything(self) -> bool:
        """Whether something may be sent to a robot at all."""
        return any(not self.refusal(kind) for kind in KINDS)

    def stop(self, who: str) -> str:
        """Stop the robot, whoever drives; takes no lock of the session.

        Args:
            who: has pressed STOP.

        Returns:
            Why it was not stopped, as a sentence; "" where it was, or nothing may be
            sent.
        """
        name, failure = who or "Somebody", ""
        if self.driver is not None:
            failure = self.driver.stop(f"{name} pressed STOP", who=name, at_rest=True)
        elif self.robot is not None and self.sends_anything:
            is_there = self.robot.source.status.is_connected
            failure = "" if is_there else NOT_REACHED
        now = time.monotonic()
        if now - self._stopped < FASTEST or not self.sends_anything:
            # A page that floods fills neither the terminal nor the robot.
            return failure
        self._stopped = now
        if failure:
            write_err([f"sambot-viz: {name}: ", Painted(f"error: {failure}", "error")])
        else:
            write_err(f"sambot-viz: {name}: STOP")
        values = {"error": failure} if failure else {}
        self._drive.post(lambda: self._tell_sent("", "STOP", name, "", values))
        if self.goals is not None:
            self.goals.cancel()
        return failure

    def cancel(self, who: str) -> None:
        """Cancel all goals of the robot.

        Args:
            who: does so, for the log.
        """
        if self.goals is None:
            return
        name = who or "Somebody"
        write_err(f"sambot-viz: {name}: cancel")
        kind = "action_msgs/srv/CancelGoal"
        for service in self.goals.cancel():
            self._tell_sent(kind, service, name, "", {"cancel": "all"})

    def refusal(self, kind: Kind) -> str:
        """Return why a kind of messages may not be sent at all; empty when it may."""
        if self.robot is None:
            return (
                f"there is no live robot to send to: start with --source {LIVE_SOURCES}"
            )
        if self._is_private:
            return "a private copy sends nothing to the robot"
        if kind not in self._allowed:
            return (
                f"nothing is sent to the robot: start with --publish {kind} to allow it"
            )
        return ""

    def prepare(self, kind: Kind, topic: str, type_name: str) -> None:
        """Let the robot know of a topic before something is sent on it."""
        robot = self.robot
        if robot is None or self.refusal(kind):
            return
        if kind == "goal" and self.goals is not None:
            self.goals.follow(topic)
        self.advertise(topic, type_name)

    def advertise(self, topic: str, type_name: str) -> None:
        """Let the robot know of any topic, where something may be sent at all."""
        robot = self.robot
        if robot is None or not self.sends_anything:
            return
        # What is wrong is said when something is sent.
        with suppress(SourceError):
            self._topic(robot, topic, type_name)

    def wait(self, topic: str, type_name: str) -> None:
        """Wait until a topic has a receiver, or until it would be known.

        The session's lock is not held during the wait, only while `prepare` is called.

        Args:
            topic: the topic.
            type_name: the type of its messages.
        """
        outgoing = self._outgoing.get((topic, type_name))
        until = time.monotonic() + FOUND_WITHIN
        while outgoing is not None and time.monotonic() < until:
            if outgoing.receivers.names or outgoing.refused or self.robot is None:
                return
            time.sleep(_LOOKS)

    def send(
        self,
        message: Outbound,
        topic: str,
        who: str,
        tell: Callable[[Outcome], object] = lambda outcome: None,
        *,
        follows: bool = False,
    ) -> str:
        """Send a message once, and return its receivers, in words.

        Args:
            message: the message.
            topic: the topic.
            who: the sender, for the log.
            tell: called with the progress of a goal, in any thread.
            follows: whether it belongs to the last one, and may follow it at once.

        Raises:
            PublishError: it is not allowed, or has no receiver; a PublishFrameError if
                it would be accepted in another frame.
            SourceError: the robot accepts no messages, or has left.
        """
        robot = self._allowed_robot(message.kind)
        if why := frame_fault(self._frames, message.frame, message.kind):
            raise PublishFrameError(f"nothing was sent: {why}")
        now = time.monotonic()
        if now - self._last < FASTEST and not follows:
            raise PublishPaceError("nothing was sent: messages come too fast")
        self._last = now
        action = self._act(message, topic, tell)
        told = action or self._publish(robot, message, topic, tell)
        if message.words:
            write_err(f"sambot-viz: {who or 'Somebody'}: {message.words}")
        type_name = NAVIGATE if action else message.type_name
        self._tell_sent(type_name, action or topic, who, message.frame, message.told)
        return told

    def _act(
        self, message: Outbound, topic: str, tell: Callable[[Outcome], object]
    ) -> str:
        """Send a goal to its action, and return that; "" where there is none."""
        if isinstance(message, Goal) and message.by_action and self.goals is not None:
            # Else it is sent as RViz's own tool sends it.
            with suppress(SourceError):
                return self.goals.send(topic, message, self._now_ns(), tell)
        return ""

    def _publish(
        self,
        robot: SourceRobot,
        message: Outbound,
        topic: str,
        tell: Callable[[Outcome], object],
    ) -> str:
        """Publish a message of a tool, and return who takes it, in words."""
        outgoing = self._taken(robot, topic, message.type_name)
        told = who_takes(outgoing, message.kind)
        inner = message.without(outgoing.frame_prefix)
        content = written(outgoing, inner, self._now_ns(), robot.decoding.types)
        goals = self.goals if message.kind == "goal" else None
        if goals is not None:
            goals.begin(message, topic, outgoing, tell)
        try:
            self._send_once(robot, outgoing, content)
        except SourceError:
            if goals is not None:
                goals.forget()
            raise
        return told

    def send_any(self, message: AnyMessage, topic: str, who: str) -> str:
        """Send a message of a program once, and return its receivers, in words.

        Raises:
            PublishError: it is not allowed, or has no receiver.
            SourceError: the robot accepts no messages, or has left.
        """
        if not self.sends_anything:
            raise PublishError(self.refusal("goal"))
        robot = self.robot
        assert robot is not None
        try:
            shape = robot.decoding.types.shape(message.type_name)
        except DecodeError as error:
            raise PublishError(f"nothing was sent: {error}") from error
        if name := shape.unknown_field(message.content):
            raise PublishError(f"{message.type_name} has no field '{text(name, 80)}'")
        told = self._deliver(robot, message, topic, None, self._now_ns())
        self._tell_sent(message.type_name, topic, who, "", message.content)
        return told

    def send_joints(self, positions: Mapping[str, float]) -> str:
        """Send joint positions, and return their receivers, in words.

        Their time is that of the robot's clock: robot_state_publisher ignores messages
        that are not newer than the last. The log lists the changes.

        Args:
            positions: joint → position [rad or m].

        Raises:
            PublishError: it is not allowed, has no receiver, or another node publishes
                the topic.
            SourceError: the robot accepts no messages, or has left.
        """
        robot = self._allowed_robot("joints")
        if others := other_publishers(robot.source, JOINTS_TOPIC):
            raise PublishError(
                f"the joints are not published: {JOINTS_TOPIC} is that of "
                f"{text(others[0], 80)}; stop it first"
            )
        names, values = [*positions], [*positions.values()]
        content = {"header": {"frame_id": ""}, "name": names, "position": values}
        message = AnyMessage("sensor_msgs/msg/JointState", content)
        now_ns = robot.source.clock_ns()
        told = self._deliver(robot, message, JOINTS_TOPIC, "joints", now_ns)
        if positions != self._joints:
            self._joints = dict(positions)
            kind, values_of = message.type_name, self._joints
            self._tell_sent(kind, JOINTS_TOPIC, "the sliders", "", values_of)
        return told

    def describe(self, urdf: str, who: str, told: Callable[[str, str], object]) -> None:
        """Give the robot another description: its node publishes it from then on.

        Args:
            urdf: the model.
            who: sends it, for the log.
            told: called with the node that has the description, and with why it did
                not take this one, "" for success; in any thread.

        Raises:
            PublishError: it is not allowed.
        """
        robot = self._allowed_robot("description")
        known = robot.source.topics().get(DESCRIPTION_TOPIC)
        nodes = () if known is None else known.publishers
        node = nodes[0] if isinstance(nodes, tuple) and nodes else DESCRIPTION_NODE
        name, types = DESCRIPTION_TOPIC[1:], robot.decoding.types
        take = partial(told, node)
        set_parameter(robot.source, node, name, urdf, types, take)
        write_err(f"sambot-viz: {who}: {name} of {text(node, 80)}: {len(urdf):,} bytes")
        kind, values = "rcl_interfaces/srv/SetParameters", {name: urdf}
        self._tell_sent(kind, f"{node}/set_parameters", who, "", values)

    def _allowed_robot(self, kind: Kind) -> SourceRobot:
        """Return the robot, if something of a kind may be sent to it."""
        if why := self.refusal(kind):
            raise PublishError(why)
        assert self.robot is not None
        return self.robot

    def _deliver(
        self,
        robot: SourceRobot,
        message: AnyMessage,
        topic: str,
        kind: Kind | None,
        now_ns: int,
    ) -> str:
        """Send a message, and return who takes it, in words."""
        outgoing = self._taken(robot, topic, message.type_name)
        told = who_takes(outgoing, kind)
        content = written(outgoing, message, now_ns, robot.decoding.types)
        self._send_once(robot, outgoing, content)
        return told

    def _tell_sent(
        self,
        type_name: str,
        topic: str,
        who: str,
        frame: str,
        values: Sequence[float] | dict[str, Any],
    ) -> None:
        """Write down and tell what was sent."""
        sent = SentMessage(time.time(), who, topic, type_name, frame, values)
        if self._log is not None:
            self._log.add(sent)
        for listener in tuple(self.listeners):
            listener(sent)

    def _send_once(
        self, robot: SourceRobot, outgoing: Outgoing, content: bytes
    ) -> None:
        try:
            outgoing.send(content)
        except SourceError:
            # That connection has ended; there may be another one by now.
            topic, type_name = outgoing.topic, outgoing.type_name
            self._forget(topic, type_name)
            self._topic(robot, topic, type_name).send(content)

    def _note_velocity(self, velocity: Velocity, who: int | str) -> None:
        """Have a new velocity written down; what sends it does not wait for that."""
        if self._log is None and not self.listeners:
            return

        def told() -> None:
            topic = self._drive.topic
            name = who if isinstance(who, str) else self.name_of(who)
            self._tell_sent(velocity.type_name, topic, name, "", velocity.numbers)

        self._drive.post(told)

    def _taken(self, robot: SourceRobot, topic: str, type_name: str) -> Outgoing:
        """Return a topic that the robot has not refused."""
        outgoing = self._topic(robot, topic, type_name)
        if outgoing.refused:
            why = text(outgoing.refused, 400)
            # It is tried again the next time.
            self._forget(topic, type_name)
            raise PublishError(f"the robot refuses it: {why}")
        return outgoing

    def _topic(self, robot: SourceRobot, topic: str, type_name: str) -> Outgoing:
        key = topic, type_name
        if key in self._outgoing and self._outgoing[key].is_over:
            # Who takes it, and what was refused, was of a connection that was lost.
            self._forget(topic, type_name)
        if key not in self._outgoing:
            made = robot.source.advertise(topic, type_name)
            if len(self._outgoing) >= _TOPICS:
                # Of a property that was changed again and again.
                self._forget(*next(iter(self._outgoing)))
            self._outgoing[key] = made
        return self._outgoing[key]

    def _forget(self, topic: str, type_name: str) -> None:
        self._outgoing.pop((topic, type_name)).close()


def publisher_of(
    publish: str | None,
    log: str | os.PathLike[str] | None,
    frames: KnownFrames,
    drive: DriveSettings,
    *,
    is_private: bool,
) -> Publisher:
    """Return the way out of a session.

    Args:
        publish: the kinds of what may be sent, with commas; "" for all, None for none.
        log: a file for what was sent; None for none.
        frames: of the session.
        drive: how the robot is driven by hand.
        is_private: it is a copy of one user, who sends nothing.

    Raises:
        PublishError: the log cannot be written.
    """
    allowed = () if publish is None or is_private else kinds_of(publish)
    kept = None if log is None or not allowed else PublishLog(Path(log))
    return Publisher(allowed, frames, kept, drive, is_private=is_private)
