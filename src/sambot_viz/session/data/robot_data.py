"""The robot of a session, moved by messages."""

from __future__ import annotations

import time

from sambot_viz.errors import Problem
from sambot_viz.frames.data_frames import DataFrames
from sambot_viz.session.data.display_topics import (
    LiveDisplayTopics,
    RecordedDisplayTopics,
)
from sambot_viz.session.data.live_topics import LiveTopics
from sambot_viz.session.data.player import Player
from sambot_viz.session.data.recorded_topics import RecordedTopics
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.signals import Change, Signal
from sambot_viz.session.worker import Worker
from sambot_viz.topics.joint_states import JointStateTopics
from sambot_viz.topics.source_robot import SourceRobot
from sambot_viz.topics.transforms import TransformTopics, problems_of_transforms

AGEING_PERIOD = 0.5
"""So often frames grow older [s]."""


class RobotData:
    """Moves a robot and its frames as messages say.

    Args:
        name: of the recording or the live robot.
        transforms: takes /tf and /tf_static.
        joint_states: takes /joint_states.
        frames: those of the session, as they are drawn.
        robot: is moved.
        change: tells what is wrong.
        worker: its clock says when frames have grown older.

    Attributes:
        name: as given.
        transforms: as given.
        recorded: the recording; None for a live robot.
        live: the live robot; None for a recording.
        player: the time of the recording; None for a live robot.
        topics: what is said of the topics.
        messages: those that displays draw.
        problems: what the transforms that were taken had wrong.
        period: the time between two pictures [s].
    """

    recorded: SourceRobot | None = None
    live: SourceRobot | None = None
    player: Player | None = None
    topics: RecordedTopics | LiveTopics
    messages: RecordedDisplayTopics | LiveDisplayTopics

    def __init__(
        self,
        name: str,
        transforms: TransformTopics,
        joint_states: JointStateTopics,
        frames: DataFrames,
        robot: RobotState,
        change: Change,
        worker: Worker,
    ) -> None:
        self.name = name
        self._change = change
        self._worker = worker
        self.problems = Signal[tuple[Problem, ...]](change, ())
        self._said: tuple[int, str] = (0, "")
        self._looked = float("-inf")
        self.transforms = transforms
        self.period = 1 / 30
        self._joint_states = joint_states
        self._frames = frames
        self._robot = robot
        frames.changed = transforms.changed
        frames.pairs = transforms.pairs

    def begin(self) -> None:
        """Begin when the first page is there."""

    def resume(self) -> None:
        """Show what messages say now, after another robot is shown."""

    def close(self) -> None:
        """Take nothing any more."""

    def follow(self, follow: bool) -> None:
        """Let the messages move the joints, or users; frames such as odom move on."""
        self._robot.set_followed(self.name if follow else "")
        if follow:
            self.resume()

    def time_s(self) -> float:
        """Return the time of the messages [s since 1970]."""
        return time.time()

    def _draw(self, jumped: bool) -> None:
        said = (self.transforms.turned_back_by, self.transforms.limit.left_out)
        if said != self._said:
            self._said = said
            is_live = self.live is not None
            self.problems.set(
                problems_of_transforms(self.transforms, self.name, is_live=is_live)
            )
        self._robot.note_followed(self._joint_states.changed())
        self._frames.waiting = True
        # One picture is one change.
        with self._change():
            if jumped:
                self._robot.after_jump()
            else:
                self._robot.draw_moved()
            self._robot.messages_came()
        self._look_at_time(jumped)

    def _look_at_time(self, jumped: bool = False) -> None:
        now = self._worker.clock.now()
        if jumped or now - self._looked >= AGEING_PERIOD:
            self._looked = now
            self._robot.time_passed()
