"""Publish the joints that users move to a live robot.

As joint_state_publisher_gui does: all joints, ten times a second, on /joint_states,
while Follow is off and no other node publishes the topic.
"""

from __future__ import annotations

from collections.abc import Callable

from sambot_viz.errors import PublishError, SourceError
from sambot_viz.publishing.publisher import Publisher
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.signals import Change, Signal, connect
from sambot_viz.session.worker import Worker
from sambot_viz.text import capitalized

KNOWN_AFTER = 2.0
"""Time after connecting until a robot's own publishers are known [s]."""
PERIOD = 0.1
"""Between two messages [s], as of joint_state_publisher_gui."""


class JointsOut:
    """Publishes the joints of a robot that users move, where that is allowed.

    Args:
        robot: the robot with the joints.
        publisher: sends them.
        change: sends changes of `said` to pages.
        worker: calls the timer.

    Attributes:
        said: the receiver, or why nothing is sent; "" where sending is not wanted.
        publishes: whether they were sent the last time.
    """

    def __init__(
        self,
        robot: RobotState,
        publisher: Publisher,
        change: Change,
        worker: Worker,
    ) -> None:
        self.said = Signal(change, "")
        self.publishes = False
        self._robot, self._publisher = robot, publisher
        self._change, self._worker = change, worker
        self._ticks = self._closed = False
        self._since: float | None = None
        facts = [robot.changed, robot.followed]
        self._disconnect: Callable[[], None] = connect(facts, self.begin)

    @property
    def _is_wanted(self) -> bool:
        robot, model = self._robot, self._robot.model
        # The placeholder of a robot that has not come yet has no joints.
        has_joints = robot.joints is not None and bool(robot.joints.all_positions())
        is_free = has_joints and model is not None and not robot.followed.value
        return is_free and not self._publisher.refusal("joints")

    def begin(self) -> None:
        """Begin to publish, if there is something to publish now."""
        if not self._ticks and not self._closed and self._is_wanted:
            self._ticks = True
            self._worker.post(self._tick)

    def close(self) -> None:
        """Stop publishing for good."""
        self._closed = True
        self._disconnect()

    def _tick(self) -> None:
        joints = self._robot.joints
        if self._closed or not self._is_wanted or joints is None:
            self._ticks = self._robot.leads = self.publishes = False
            self._say("")
            return
        self._worker.post_later(PERIOD, self._tick)
        if not self._knows_others():
            return
        try:
            told = self._publisher.send_joints(joints.all_positions())
        except (PublishError, SourceError) as error:
            self.publishes = False
            self._say(capitalized(str(error)))
        else:
            # What comes back of it, also as transforms, does not take the joints.
            self._robot.leads = self.publishes = True
            self._say(f"Published on {told}")

    def _knows_others(self) -> bool:
        """Whether it is known who publishes the joints, some time after connecting."""
        robot, now = self._publisher.robot, self._worker.clock.now()
        if robot is None or not robot.source.status.is_connected:
            self._since = None
        elif self._since is None:
            self._since = now
        return self._since is not None and now - self._since >= KNOWN_AFTER

    def _say(self, sentence: str) -> None:
        if self.said.value != sentence:
            with self._change(self.said):
                self.said.set(sentence)
