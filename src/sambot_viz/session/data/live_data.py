"""The robot of a session, moved by the messages of a robot on the network."""

from __future__ import annotations

import re
import threading
from collections import deque
from functools import partial

from sambot_viz import limits
from sambot_viz.frames.data_frames import DataFrames
from sambot_viz.frames.history import FrameHistory
from sambot_viz.session.data.display_topics import LiveDisplayTopics
from sambot_viz.session.data.live_clock import LiveClock
from sambot_viz.session.data.live_topics import FaultOf, LiveTopics
from sambot_viz.session.data.robot_data import AGEING_PERIOD, RobotData
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.signals import Change, Signal
from sambot_viz.session.worker import Worker
from sambot_viz.sources.message import Recorded
from sambot_viz.sources.websocket.clock_topic import CLOCK
from sambot_viz.topics.decoding import Decoding
from sambot_viz.topics.joint_states import JointStateTopics
from sambot_viz.topics.live_reasons import wrong_clock
from sambot_viz.topics.reasons import TopicReason
from sambot_viz.topics.source_robot import SourceRobot
from sambot_viz.topics.transforms import TransformTopics

MOST_WAITING = limits.SESSION_WAITING.value
"""So many messages of a live robot wait for a session; of more the oldest are lost."""
MOST_BYTES = limits.WAITING_BYTES.value
SLICE = 2**18
"""So much of what waits is taken before clients get their turn [bytes]."""


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
        fault_of: says why a frame has no place in the picture; None when it has one.

    Attributes:
        status: told when the source is doing otherwise.
        lost: how many messages had to be dropped.
        clock: the time of the robot.
        doubt: what is wrong with that time.
    """

    def __init__(
        self,
        live: SourceRobot,
        history: FrameHistory,
        frames: DataFrames,
        robot: RobotState,
        change: Change,
        worker: Worker,
        fault_of: FaultOf,
    ) -> None:
        decoding = Decoding(live.decoding.types)
        transforms = TransformTopics(history, (), (), decoding.transforms)
        states = JointStateTopics((), decoding.decode)
        super().__init__(live.name, transforms, states, frames, robot, change, worker)
        self.live = live
        self.status = Signal(change, None)
        self.topics = self._topics = LiveTopics(live, fault_of, change, worker)
        self.lost = 0
        self.clock = LiveClock(live.source, change)
        self.doubt: TopicReason | None = None
        self._doubted = ""
        self._live = live
        self._waiting: deque[Recorded] = deque()
        self._size = 0
        self._subscribed: dict[str, None] = {}
        # The thread of the source adds, the worker takes.
        self._lock = threading.Lock()
        self._is_asked = False
        self._drawn = float("-inf")
        self._took = 0.0
        self._goes_on = False
        self._tell_status = partial(worker.post, self.status.touch)
        self._look = partial(worker.post, self._subscribe)
        live.on_topics.append(self._look)
        live.on_status.append(self._tell_status)
        self._closed = False
        self.messages = LiveDisplayTopics(live, self._wake, worker.report)
        self._look()
        self._tick()

    def _tick(self) -> None:
        """Let frames of a robot that has fallen silent grow old; runs in the worker."""
        if not self._closed:
            self._look_back()
            self._look_at_time()
            self._look_at_clock()
            self._worker.post_later(AGEING_PERIOD, self._tick)

    def time_s(self) -> float:
        """Return the time of the robot, which may be simulated [s]."""
        return self._live.source.clock_ns() * 1e-9

    def _look_back(self) -> None:
        """Forget what RViz forgets when a simulation is reset; runs in the worker."""
        back = self.clock.went_back()
        if back > 0.0:
            self.transforms.go_back(round(back * 1e9))
            self._joint_states.clear()
            self.messages.reset()
            self._draw(True)

    def _look_at_clock(self) -> None:
        self.clock.look()
        source = self._live.source
        doubt = None
        if source.status.is_connected and self._subscribed:
            stamp, now = self.transforms.newest_ns * 1e-9, self.time_s()
            has_topic = CLOCK in source.topics()
            doubt = wrong_clock(stamp, now, has_topic, source.has_clock)
        # What is so only until the first message is no news, nor that its times go on.
        last, self._doubted = self._doubted, _without_times(doubt)
        if self._doubted == last and last != _without_times(self.doubt):
            self.doubt = doubt
            self.status.touch()

    def resume(self) -> None:
        """Put the joints where the last messages had them."""
        self._robot.note_followed(self._joint_states.last)
        self._robot.draw_moved()

    def close(self) -> None:
        """Take nothing any more."""
        self._closed = True
        self._live.on_topics.remove(self._look)
        self._live.on_status.remove(self._tell_status)
        self._topics.close()
        self.messages.close()
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
            self._waiting.append(message)
            self._size += len(message.payload)
            while len(self._waiting) > MOST_WAITING or (
                self._size > MOST_BYTES and len(self._waiting) > 1
            ):
                self._size -= len(self._waiting.popleft().payload)
                self.lost += 1
        self._wake()

    def _wake(self) -> None:
        """Let the worker take what has come, at the Frame Rate; runs in any thread."""
        with self._lock:
            if self._is_asked:
                return
            self._is_asked = True
        left = self._drawn + self._pause - self._worker.clock.now()
        if left > 0:
            self._worker.post_later(left, self._take)
        else:
            self._worker.post(self._take)

    def _take(self) -> None:
        """Take some of what waits, and draw at the end; runs in the worker.

        However much waits, clients get their turn after a slice of it.
        """
        with self._lock:
            self._is_asked = False
        # What waits may be of the time after it.
        self._look_back()
        left = SLICE
        while left > 0 and (message := self._next_waiting()) is not None:
            left -= len(message.payload)
            if message.topic in self.transforms.topics:
                self.transforms.take(message)
            else:
                self._joint_states.take(message)
        if self._waiting and not self._goes_on:
            self._goes_on = True
            self._worker.post(self._go_on)
        begin = self._worker.clock.now()
        if begin - self._drawn < self._pause:
            self._wake()
            return
        self._drawn = begin
        self._draw(False)
        self._took = self._worker.clock.now() - begin

    def _go_on(self) -> None:
        self._goes_on = False
        self._take()

    @property
    def _pause(self) -> float:
        """The time from one drawing to the next [s].

        Nothing goes out while it is drawn: as long again is for those who wait for it.
        """
        return max(self.period, 2 * self._took)

    def _next_waiting(self) -> Recorded | None:
        with self._lock:
            if not self._waiting:
                return None
            message = self._waiting.popleft()
            self._size -= len(message.payload)
            return message


def _without_times(doubt: TopicReason | None) -> str:
    return "" if doubt is None else re.sub(r"[0-9.]+", "", doubt.text)
