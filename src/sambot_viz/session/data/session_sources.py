"""The sources of a session, and others that take their place."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial

from sambot_viz.errors import Problem
from sambot_viz.frames.data_frames import DataFrames
from sambot_viz.frames.history import FrameHistory
from sambot_viz.session.data.descriptions import SourceDescriptions
from sambot_viz.session.data.robot_data import RobotData
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Change, Signal, connect
from sambot_viz.session.worker import Worker
from sambot_viz.topics.source_robot import SourceRobot
from sambot_viz.topics.whole_run import whole_run


class SessionSources:
    """Connects a session to its sources, and to others that replace them.

    Args:
        history: the history of the session's frames; None where no messages come.
        frames: the same frames, as they are drawn.
        robot: the robot that the messages move.
        scene: draws them.
        change: sends the changes that messages cause.
        worker: takes the messages.
        is_given: whether a robot was named on the command line, which replaces the
            source's.

    Attributes:
        data: moves the robot; None without a source.
        replaced: emitted when other sources have replaced these.
        problems: the faults of the received transforms.
        notes: the faults of the recording itself.
    """

    def __init__(
        self,
        history: FrameHistory | None,
        frames: DataFrames,
        robot: RobotState,
        scene: Scene,
        change: Change,
        worker: Worker,
        is_given: bool,
    ) -> None:
        self.data: RobotData | None = None
        self.replaced = Signal(change, None)
        self.problems = Signal[tuple[Problem, ...]](change, ())
        self.notes: tuple[Problem, ...] = ()
        self._descriptions: SourceDescriptions | None = None
        self._history = history
        self._frames = frames
        self._robot = robot
        self._scene = scene
        self._change = change
        self._worker = worker
        self._is_given = is_given

    def take(self, moved_by: SourceRobot) -> None:
        """Let other messages move the robot; those before are forgotten.

        No display may listen meanwhile.

        Args:
            moved_by: the robot of the sources.
        """
        history, before = self._history, self.data
        if history is None:
            raise ValueError("the session was made without sources")
        self.close()
        self._frames.forget_all()
        self.problems.set(())
        found = moved_by.problems
        self.notes = tuple(
            p for p in found if not (self._is_given and p.code == "no-description")
        )
        worker, scene, context = self._worker, self._scene, self._scene.context
        data = self.data = RobotData(
            moved_by,
            history,
            self._frames,
            self._robot,
            self._change,
            worker,
            scene,
            self.problems,
        )
        context.now, context.is_paced = data.time_s, data.is_paced
        context.messages, context.time = data.messages, data.time
        redraw: Callable[[], None] = lambda: context.apply(scene.redraw)  # noqa: E731
        topics = data.topics
        self._descriptions = SourceDescriptions(
            moved_by, self._is_given, worker, redraw, topics.reason
        )
        connect([topics.looked], self._descriptions.look_again)
        context.descriptions = self._descriptions
        context.meant = moved_by.meant_frames
        scene.whole_run = cache(partial(whole_run, moved_by))
        if before is not None:
            data.follow_on(before)
            self.replaced.touch()

    def close(self) -> None:
        """Stop taking messages."""
        if self._descriptions is not None:
            self._descriptions.close()
        if self.data is not None:
            self.data.close()
