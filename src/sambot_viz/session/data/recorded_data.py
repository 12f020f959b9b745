"""The robot of a session, moved by the messages of a recording."""

from __future__ import annotations

from sambot_viz.frames.data_frames import DataFrames
from sambot_viz.frames.history import FrameHistory
from sambot_viz.session.data.display_topics import RecordedDisplayTopics
from sambot_viz.session.data.player import Player
from sambot_viz.session.data.recorded_topics import RecordedTopics
from sambot_viz.session.data.robot_data import RobotData
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.signals import Change
from sambot_viz.session.worker import Worker
from sambot_viz.topics.source_robot import SourceRobot


class RecordedData(RobotData):
    """Moves a robot as a recording says, with a player.

    Args:
        recorded: the robot's messages.
        history: of the session's frames.
        frames: the same, as they are drawn.
        robot: is moved.
        change: tells what the player does.
        worker: takes its steps.
    """

    def __init__(
        self,
        recorded: SourceRobot,
        history: FrameHistory,
        frames: DataFrames,
        robot: RobotState,
        change: Change,
        worker: Worker,
    ) -> None:
        transforms, states = recorded.transforms(history), recorded.joint_states()
        name = recorded.name
        super().__init__(name, transforms, states, frames, robot, change, worker)
        self.recorded = recorded
        topics = recorded.topics
        if topics.moving or topics.joint_states:
            robot.followed.set(recorded.name)
        source = recorded.source.of_session().playback
        assert source is not None
        self.player = Player(
            source, self._draw, change, worker, is_begun=recorded.at_ns is not None
        )
        self._player = self.player
        for subscriber in (transforms, states):
            self.player.add(subscriber)
        self.messages = RecordedDisplayTopics(recorded, self.player, worker.report)
        self.topics = RecordedTopics(recorded, frames.tree, self.player, change, worker)
        frames.ahead = lambda: transforms.to_come(self._player.time_ns)

    def time_s(self) -> float:
        """Return the log time of the player [s since 1970]."""
        return self._player.time_ns * 1e-9

    def begin(self) -> None:
        """Play, unless somebody has stopped it before."""
        self._player.period = self.period
        self._player.begin()

    def resume(self) -> None:
        """Show the present time again."""
        self._player.period = self.period
        self._player.resume()

    def close(self) -> None:
        """Play nothing any more."""
        self.messages.close()
        self._player.close()
