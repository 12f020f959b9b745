"""The robot of a session, moved by a recording."""

from __future__ import annotations

from sambot_viz.errors import Problem
from sambot_viz.frames.data_frames import DataFrames
from sambot_viz.frames.history import FrameHistory
from sambot_viz.session.data.player import Player
from sambot_viz.session.data.recorded_topics import RecordedTopics
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.signals import Change, Signal
from sambot_viz.session.worker import Clock, Worker
from sambot_viz.topics.recorded_robot import RecordedRobot
from sambot_viz.topics.transforms import problems_of_transforms


class RobotData:
    """Moves a robot and its frames as a recording says.

    Args:
        recorded: the robot's messages.
        history: of the session's frames.
        frames: the same, as they are drawn.
        robot: is moved.

    Attributes:
        recorded: as given.
        name: of the recording.
        player: the time of the recording.
        transforms: what /tf and /tf_static have told.
        topics: what is said of the topics.
        problems: what the transforms that were played had wrong.
    """

    def __init__(
        self,
        recorded: RecordedRobot,
        history: FrameHistory,
        frames: DataFrames,
        robot: RobotState,
        change: Change,
        worker: Worker,
        clock: Clock,
    ) -> None:
        self.recorded = recorded
        self.name = recorded.name
        self.transforms = recorded.transforms(history)
        self._joint_states = recorded.joint_states()
        self._frames = frames
        self._robot = robot
        self.topics = RecordedTopics(recorded, change, worker)
        self.problems = Signal[tuple[Problem, ...]](change, ())
        self._turned_back_by = 0
        frames.changed = self.transforms.changed
        frames.pairs = self.transforms.pairs
        topics = recorded.topics
        if topics.moving or topics.joint_states:
            robot.followed.set(recorded.name)
        subscribers = (self.transforms, self._joint_states)
        self.player = Player(
            recorded.recording,
            subscribers,
            self._draw,
            change,
            worker,
            clock,
            recorded.at_ns,
        )

    def follow(self, follow: bool) -> None:
        """Let the messages move the joints, or users; frames such as odom move on."""
        self._robot.set_followed(self.name if follow else "")
        if follow:
            self.player.resume()

    def _draw(self, jumped: bool) -> None:
        if self.transforms.turned_back_by != self._turned_back_by:
            self._turned_back_by = self.transforms.turned_back_by
            self.problems.set(problems_of_transforms(self.transforms, self.name))
        self._robot.note_followed(self._joint_states.changed())
        self._frames.waiting = True
        if jumped:
            self._robot.after_jump()
        else:
            self._robot.draw_moved()
