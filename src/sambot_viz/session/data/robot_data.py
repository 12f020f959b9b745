"""The robot of a session, moved by the messages of its sources."""

from __future__ import annotations

import re
import time
from functools import partial

from sambot_viz.errors import Problem
from sambot_viz.frames.data_frames import DataFrames
from sambot_viz.frames.display_time import DisplayTime, SyncMode
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.frames.history import FrameHistory
from sambot_viz.frames.samples import Sample
from sambot_viz.publishing.written import time_of
from sambot_viz.session.data.display_topics import DisplayTopics
from sambot_viz.session.data.feed import Feed
from sambot_viz.session.data.inbox import Inbox
from sambot_viz.session.data.live_clock import LiveClock, wrong_clock
from sambot_viz.session.data.player import Player
from sambot_viz.session.data.source_topics import PAUSE, SLICE, SourceTopics
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.drawings import drawing_of
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Change, Signal, connect
from sambot_viz.session.worker import Worker
from sambot_viz.sources.live.clock_topic import CLOCK
from sambot_viz.sources.message import Recorded
from sambot_viz.topics.live_evidence import LiveEvidence
from sambot_viz.topics.placement import Placement
from sambot_viz.topics.reasons import TopicReason
from sambot_viz.topics.report import TopicReport
from sambot_viz.topics.source_robot import Lease, SourceRobot
from sambot_viz.topics.survey import Survey
from sambot_viz.topics.transforms import not_looked_further, problems_of_transforms

AGEING_PERIOD = 0.5
"""So often frames grow older [s]."""
LOOKS_ON_AFTER = 2.0
"""So long after the first page a recording is looked through, for jumps [s]."""
RESTS_AFTER = 10.0
"""So long after the last page data are still drawn, which may be loaded again [s]."""


class RobotData:
    """Moves a robot and its frames by messages.

    Recordings, which can seek, have a player. Live messages wait in an inbox.

    Args:
        moved_by: the robot's messages.
        history: the history of the session's frames.
        frames: the same frames, as they are drawn.
        robot: the robot to move.
        change: sends problems and the state of a live source.
        worker: takes the messages.
        scene: the displays of the messages.
        problems: collects the faults of the received transforms.

    Attributes:
        moved_by: as given.
        name: the name of the recording or the live robot.
        transforms: takes /tf and /tf_static.
        player: the time of a recording; None without one.
        inbox: the messages of a live robot that wait.
        topics: the accounts of the topics.
        messages: the messages that displays draw.
        status: emitted when the state of a live source changes.
        clock: the time of a live robot.
        time: the time at which frames are drawn.
        doubt: the problem of that time.
    """

    def __init__(
        self,
        moved_by: SourceRobot,
        history: FrameHistory,
        frames: DataFrames,
        robot: RobotState,
        change: Change,
        worker: Worker,
        scene: Scene,
        problems: Signal[tuple[Problem, ...]],
    ) -> None:
        self.moved_by = moved_by
        self._lease: Lease | None = moved_by.lease()
        self.name = moved_by.name
        self.transforms = moved_by.transforms(history)
        self._problems = problems
        self.status = Signal(change, None)
        self.doubt: TopicReason | None = None
        self._joint_states = moved_by.joint_states()
        self._frames = frames
        self._robot = robot
        self._change = change
        self._worker = worker
        self._period = 1 / 30
        self._said: tuple[object, ...] = (0, "")
        self._doubted = ""
        self._named: tuple[int, str | None] = (0, moved_by.topics.description)
        self._looked = float("-inf")
        self._closed = self._looks_on = False
        self._viewers: set[object] = set()
        self._left = 0.0
        source = self.source = moved_by.source.of_session()
        self.player: Player | None = None
        if source.playback is not None:
            is_begun = moved_by.at_ns is not None
            self.player = Player(source.playback, self._draw, change, worker, is_begun)
        self.inbox = Inbox(
            worker, self._look_back, self._take, partial(self._draw, False)
        )
        self.clock = LiveClock(source, change)
        self.time = DisplayTime(history, source.clock_ns)
        self._history = history
        self._feed = Feed(source, self.player)
        placement = Placement(moved_by, self.transforms)
        messages = self.messages = DisplayTopics(
            moved_by, self._feed, placement, self.inbox.wake, worker.report
        )
        live = LiveEvidence(
            moved_by, placement, scene.fault_of, messages.heard, worker.clock.now
        )
        report = None
        if self.player is not None:
            report = TopicReport(
                Survey(moved_by), frames.tree, lambda: scene.context.fixed_frame
            )
        drawing = partial(drawing_of, scene)
        self.topics = SourceTopics(
            moved_by, report, live, drawing, self.player, change, worker
        )
        messages.unheard = self.topics.unheard
        # The statuses of displays contain the accounts of their topics.
        connect([self.topics.looked], partial(self._look_at_time, True))
        frames.changed = self.transforms.changed
        frames.pairs = self.transforms.pairs
        frames.prefix = lambda robot: moved_by.prefix_of(robot, self.transforms.pairs())
        frames.ahead = self._ahead
        self._moves = self._has_motion()
        if self._moves:
            robot.followed.set(self.name)
        for subscriber in (self.transforms, self._joint_states):
            self._feed.add(subscriber, self.inbox.put)
        self._tell_status = partial(worker.post, self.status.touch)
        self._look = partial(worker.post, self._listen)
        moved_by.on_topics.append(self._look)
        moved_by.on_status.append(self._tell_status)
        if moved_by.can("clock"):
            self._tell_problems()
            self._tick()

    @property
    def period(self) -> float:
        """The time between two pictures [s]."""
        return self._period

    @period.setter
    def period(self, period: float) -> None:
        self._period = self.inbox.period = period
        if self.player is not None:
            self.player.period = period

    def begin(self) -> None:
        """Play a recording when the first page is there, unless it was stopped."""
        if self.player is not None:
            self.player.begin()

    # Who looks

    @property
    def is_looked_at(self) -> bool:
        """Whether a page shows it."""
        return bool(self._viewers)

    def rest(self) -> None:
        """Decode no data until a page is open; the robot and its frames move on."""
        self.messages.rest()

    def look(self, viewer: object) -> None:
        """Show the present state to one more viewer."""
        if not self._viewers:
            with self._change():
                self.messages.wake()
                self._robot.messages_came()
            self._look_at_time(jumped=True)
        self._viewers.add(viewer)
        if self.player is not None and not self._looks_on:
            self._looks_on = True
            self._worker.post_later(LOOKS_ON_AFTER, self._look_on)

    def leave(self, viewer: object) -> None:
        """Take note that one looks no longer; after the last one data rest, later."""
        self._viewers.discard(viewer)
        self._left = self._worker.clock.now()
        self._worker.post_later(RESTS_AFTER, self._rest_alone)

    def _rest_alone(self) -> None:
        alone_s = self._worker.clock.now() - self._left
        if not self._viewers and not self._closed and alone_s >= RESTS_AFTER:
            self.rest()

    def _look_on(self) -> None:
        """Look at a little more of a recording, while nothing else is to be done."""
        if self._closed:
            return
        end = time.perf_counter() + SLICE
        while time.perf_counter() < end:
            if not self.moved_by.look_on():
                self._tell_problems()
                return
        self._worker.post_later(PAUSE, self._look_on)

    def follow_on(self, before: RobotData) -> None:
        """Have the viewers of what had this place before."""
        self.period = before.period
        if not before.is_looked_at:
            self.rest()
        for viewer in before._viewers:
            self.look(viewer)

    def resume(self) -> None:
        """Show what messages say now, after another robot is shown."""
        if self.source.live is not None:
            self._robot.note_followed(self._joint_states.last)
            self._robot.draw_moved()
        if self.player is not None:
            self.player.resume()

    def synchronize(self, mode: int, source: str) -> None:
        """Draw frames by the times of a display's messages; see `DisplayTime`."""
        with self._change():
            self.time.synchronize(SyncMode(mode), source)
            self._draw_at_time()

    def follow(self, follow: bool) -> None:
        """Let the messages move the joints, or users; frames such as odom move on."""
        self._robot.set_followed(self.name if follow else "")
        if follow:
            self.resume()

    @property
    def is_unfollowed(self) -> bool:
        """Whether a live robot publishes its motion, and Follow is off."""
        is_followed = bool(self._robot.followed.value)
        return self.source.live is not None and self._moves and not is_followed

    def time_s(self) -> float:
        """Return the time of the messages [s since 1970]."""
        return self.source.clock_ns() * 1e-9

    def stamp_ns(self) -> int:
        """Return the time for the stamp of a message to the robot [ns]."""
        return time_of(self.source, self.transforms.newest_ns)

    def is_paced(self, frame: str) -> bool:
        """Return whether a frame has the time of a recording beside a live robot."""
        if self.player is None or self.source.live is None:
            return False
        told_by = self.transforms.parents.get(plain_name(frame), {}).values()
        return bool(told_by) and all(map(self._feed.is_recorded, told_by))

    def close(self) -> None:
        """Stop taking messages."""
        self._closed = True
        self.moved_by.on_topics.remove(self._look)
        self.moved_by.on_status.remove(self._tell_status)
        self.topics.close()
        self.messages.close()
        for subscriber in (self.transforms, self._joint_states):
            self._feed.remove(subscriber)
        if self.player is not None:
            self.player.close()
        self._lease = None

    def _ahead(self) -> dict[str, Sample]:
        if self.player is None:
            return {}
        return self.transforms.to_come(self.player.time_ns)

    def _has_motion(self) -> bool:
        topics = self.moved_by.topics
        return bool(topics.moving or topics.joint_states)

    def _listen(self) -> None:
        """Ask for the topics of the robot that are new; runs in the worker."""
        topics = self.moved_by.topics
        published = self.source.topics()
        self.transforms.set_topics(topics.moving, topics.static, published)
        self._joint_states.set_topics(topics.joint_states)
        if not self._moves and self._has_motion():
            self._moves = True
            if not self._robot.leads:
                self._robot.set_followed(self.name)
        if not self._closed:
            for one in (self.transforms, self._joint_states):
                self._feed.listen(one, one.topics)
            if self._is_named_otherwise:
                self._draw(False)
            self._tell_problems()

    def _tell_problems(self) -> None:
        is_live, name = self.player is None, self.name
        of_frames = problems_of_transforms(
            self.transforms,
            name,
            is_live=is_live,
            turned_back_by=self.moved_by.turned_back_by,
        )
        unfound = self._joint_states.unfound
        of_joints = not_looked_further("joint", unfound, name)
        self._problems.set((*self.moved_by.hidden, *of_frames, *of_joints))

    def _take(self, message: Recorded) -> None:
        # What waited may be of a topic that is the robot's no longer.
        if message.topic in self.transforms.topics:
            self.transforms.take(message)
        elif message.topic in self._joint_states.topics:
            self._joint_states.take(message)

    def _draw(self, jumped: bool) -> None:
        said = (
            self.transforms.turned_back_by,
            self.transforms.limit.left_out,
            *self.transforms.unfound,
            *self._joint_states.unfound,
        )
        if said != self._said:
            self._said = said
            self._tell_problems()
        is_renamed, self._named = self._is_named_otherwise, self._names
        jumped = jumped or is_renamed
        if jumped:
            self.time.forget()
        self.time.step()
        at_ns = self._history.shown_at
        self._note_joints(jumped)
        self._frames.waiting = True
        # One picture is one change.
        with self._change():
            if is_renamed:
                self._robot.build_tree()
            if jumped:
                self._robot.after_jump()
            else:
                self._robot.draw_moved()
            self._robot.messages_came()
            if self._history.shown_at != at_ns:
                self._draw_at_time()
        self._look_at_time(jumped)

    def _draw_at_time(self) -> None:
        self._frames.waiting = True
        self._robot.draw_moved()

    @property
    def _names(self) -> tuple[int, str | None]:
        """What the names of frames depend on, and which robot has its own."""
        return self.transforms.renamed, self.moved_by.topics.description

    @property
    def _is_named_otherwise(self) -> bool:
        return self._named != self._names

    def _note_joints(self, jumped: bool) -> None:
        changed = self._joint_states.changed()
        if jumped and self.source.live is None:
            # Played from its beginning, they would not have moved yet.
            starts = self._robot.starts(self._joint_states.gone())
            changed = {**starts, **changed}
        self._robot.note_followed(changed)

    def _look_at_time(self, jumped: bool = False) -> None:
        now = self._worker.clock.now()
        if jumped or now - self._looked >= AGEING_PERIOD:
            self._looked = now
            self._robot.time_passed()

    # The time of a live robot

    def _tick(self) -> None:
        """Let frames of a robot that has fallen silent grow old; runs in the worker."""
        if not self._closed:
            self._look_back()
            self._look_at_time()
            self._look_at_clock()
            self._worker.post_later(AGEING_PERIOD, self._tick)

    def _look_back(self) -> None:
        """Forget what RViz forgets when a simulation is reset; runs in the worker."""
        back = self.clock.went_back()
        if back > 0.0:
            self.transforms.go_back(round(back * 1e9))
            self._joint_states.clear()
            self.messages.reset()
            self._draw(True)
            if self.player is not None:
                self.player.resume()

    def _look_at_clock(self) -> None:
        self.clock.look()
        source = self.source
        doubt = None
        if source.status.is_connected and self._moves:
            stamp, now = self.transforms.newest_ns * 1e-9, self.time_s()
            has_topic = CLOCK in source.topics()
            doubt = wrong_clock(stamp, now, has_topic, source.has_clock)
        # A state that ends with the first message is no news, nor is a later time.
        last, self._doubted = self._doubted, _without_times(doubt)
        if self._doubted == last and last != _without_times(self.doubt):
            self.doubt = doubt
            self.status.touch()


def _without_times(doubt: TopicReason | None) -> str:
    return "" if doubt is None else re.sub(r"[0-9.]+", "", doubt.text)
