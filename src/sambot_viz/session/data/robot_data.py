"""The robot of a session, moved by the messages of a recording or of a live robot."""

from __future__ import annotations

import threading
import time
from collections import deque
from functools import partial

from sambot_viz.errors import Problem
from sambot_viz.frames.data_frames import DataFrames
from sambot_viz.frames.history import FrameHistory
from sambot_viz.session.data.player import Player
from sambot_viz.session.data.recorded_topics import RecordedTopics
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.signals import Change, Signal
from sambot_viz.session.worker import Clock, Worker
from sambot_viz.sources.message import Recorded
from sambot_viz.topics.decoding import Decoding
from sambot_viz.topics.joint_states import JointStateTopics
from sambot_viz.topics.live_robot import LiveRobot
from sambot_viz.topics.recorded_robot import RecordedRobot
from sambot_viz.topics.transforms import TransformTopics, problems_of_transforms

MOST_WAITING = 20_000
"""So many messages of a live robot wait for a session; of more the oldest are lost."""


class RobotData:
    """Moves a robot and its frames as messages say.

    Args:
        name: of the recording or the live robot.
        transforms: takes /tf and /tf_static.
        joint_states: takes /joint_states.
        frames: those of the session, as they are drawn.
        robot: is moved.
        change: tells what is wrong.

    Attributes:
        name: as given.
        transforms: as given.
        recorded: the recording; None for a live robot.
        live: the live robot; None for a recording.
        player: the time of the recording; None for a live robot.
        topics: what is said of the topics; None for a live robot.
        problems: what the transforms that were taken had wrong.
        period: the time between two pictures [s].
    """

    recorded: RecordedRobot | None = None
    live: LiveRobot | None = None
    player: Player | None = None
    topics: RecordedTopics | None = None

    def __init__(
        self,
        name: str,
        transforms: TransformTopics,
        joint_states: JointStateTopics,
        frames: DataFrames,
        robot: RobotState,
        change: Change,
    ) -> None:
        self.name = name
        self.problems = Signal[tuple[Problem, ...]](change, ())
        self._turned_back_by = 0
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


class RecordedData(RobotData):
    """Moves a robot as a recording says, with a player.

    Args:
        recorded: the robot's messages.
        history: of the session's frames.
        frames: the same, as they are drawn.
        robot: is moved.
        change: tells what the player does.
        worker: takes its steps.
        clock: the time of the computer.
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
        transforms, states = recorded.transforms(history), recorded.joint_states()
        super().__init__(recorded.name, transforms, states, frames, robot, change)
        self.recorded = recorded
        self.topics = RecordedTopics(recorded, change, worker)
        topics = recorded.topics
        if topics.moving or topics.joint_states:
            robot.followed.set(recorded.name)
        self.player = Player(
            recorded.recording,
            (transforms, states),
            self._draw,
            change,
            worker,
            clock,
            recorded.at_ns,
        )
        self._player = self.player

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
        self._player.close()


class LiveData(RobotData):
    """Moves a robot as a live source says, at the Frame Rate.

    Messages wait where the source leaves them until the session's worker takes them.

    Args:
        live: the robot's messages.
        history: of the session's frames.
        frames: the same, as they are drawn.
        robot: is moved.
        change: tells how the source is.
        worker: takes the messages.

    Attributes:
        status: told when the source is doing otherwise.
        lost: how many messages had to be dropped.
    """

    def __init__(
        self,
        live: LiveRobot,
        history: FrameHistory,
        frames: DataFrames,
        robot: RobotState,
        change: Change,
        worker: Worker,
    ) -> None:
        decoding = Decoding(live.decoding.types)
        transforms = TransformTopics(history, (), (), decoding.transforms)
        states = JointStateTopics((), decoding.decode)
        super().__init__(live.name, transforms, states, frames, robot, change)
        self.live = live
        self.status = Signal(change, None)
        self.lost = 0
        self._live = live
        self._worker = worker
        self._waiting: deque[Recorded] = deque()
        self._subscribed: dict[str, None] = {}
        # The thread of the source adds, the worker takes.
        self._lock = threading.Lock()
        self._is_asked = False
        self._drawn = float("-inf")
        self._tell_status = partial(worker.post, self.status.touch)
        self._look = partial(worker.post, self._subscribe)
        live.on_topics.append(self._look)
        live.on_status.append(self._tell_status)
        self._look()

    def resume(self) -> None:
        """Put the joints where the last messages had them."""
        self._robot.note_followed(self._joint_states.last)
        self._robot.draw_moved()

    def close(self) -> None:
        """Take nothing any more."""
        self._live.on_topics.remove(self._look)
        self._live.on_status.remove(self._tell_status)
        for topic in self._subscribed:
            self._live.source.unsubscribe(topic, self._receive)

    def _subscribe(self) -> None:
        """Ask for the topics of the robot; runs in the worker."""
        topics = self._live.topics
        self.transforms.set_topics(topics.moving, topics.static)
        self._joint_states.topics = topics.joint_states
        if not self._subscribed and (topics.moving or topics.joint_states):
            self._robot.set_followed(self.name)
        for topic in (*topics.static, *topics.moving, *topics.joint_states):
            if topic not in self._subscribed:
                self._subscribed[topic] = None
                self._live.source.subscribe(topic, self._receive)

    def _receive(self, message: Recorded) -> None:
        """Keep a message for the worker; runs in the thread of the source."""
        with self._lock:
            if len(self._waiting) >= MOST_WAITING:
                self._waiting.popleft()
                self.lost += 1
            self._waiting.append(message)
            if self._is_asked:
                return
            self._is_asked = True
        left = self._drawn + self.period - time.monotonic()
        if left > 0:
            self._worker.post_later(left, self._take)
        else:
            self._worker.post(self._take)

    def _take(self) -> None:
        """Take what waits, and draw once; runs in the worker."""
        with self._lock:
            waiting, self._waiting = self._waiting, deque()
            self._is_asked = False
        for message in waiting:
            if message.topic in self.transforms.topics:
                self.transforms.take(message)
            else:
                self._joint_states.take(message)
        self._drawn = time.monotonic()
        self._draw(False)
