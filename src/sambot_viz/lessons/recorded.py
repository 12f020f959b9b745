"""Observations of a running robot in a recording from the student's folder."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from sambot_viz.cached import cached_property
from sambot_viz.errors import DecodeError
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.geometry import PlainPose, Vector3
from sambot_viz.messages import MessageTypes
from sambot_viz.sources.bag import open_recording
from sambot_viz.topics.decoding import Decoding

if TYPE_CHECKING:
    from sambot_viz.sources.bag.recording import Recording
    from sambot_viz.sources.message import Recorded

_STATUS = "/_action/status"
SUCCEEDED = 4
"""Status of an action's goal that was reached."""


@dataclass(slots=True)
class SeenTopic:
    """Observations of a topic.

    Attributes:
        type_name: type of its messages.
        times: recording times of the first and the last message [ns].
        count: number of messages.
    """

    type_name: str
    times: tuple[int, int]
    count: int = 0

    @property
    def rate(self) -> float:
        """Messages a second; 0 for a single one."""
        seconds = (self.times[1] - self.times[0]) * 1e-9
        return (self.count - 1) / seconds if seconds > 0 else 0.0


@dataclass(slots=True)
class Seen:
    """Observations in all messages of a recording.

    Attributes:
        topics: name → observations.
        parents: child → parent, of all transforms.
        goals: names of the actions with a reached goal.
    """

    topics: dict[str, SeenTopic] = field(default_factory=dict[str, SeenTopic])
    parents: dict[str, str] = field(default_factory=dict[str, str])
    goals: set[str] = field(default_factory=set[str])


class StudentRecording:
    """A recording, read once for all questions of conditions.

    Args:
        paths: its files.

    Raises:
        SourceError: a file cannot be opened.
    """

    def __init__(self, paths: Sequence[Path]) -> None:
        self._paths = paths
        self._decoding = Decoding(MessageTypes([]))
        with closing(self._open()):
            pass

    @cached_property
    def seen(self) -> Seen:
        """The topics, frames and reached goals of the recording."""
        seen = Seen()
        with closing(self._open()) as recording:
            for message in recording.messages():
                self._see(message, seen)
        return seen

    def path_of(self, parent: str, child: str) -> Iterator[Vector3]:
        """Yield a frame's position in another one at each transform that sets it [m].

        Each position combines the newest transforms on the way between the two.
        """
        poses: dict[str, tuple[str, PlainPose]] = {}
        with closing(self._open()) as recording:
            names = [t for t in recording.topics if _has_transforms(t)]
            for message in recording.messages(topics=names):
                for above, below, pose in self._transforms(message):
                    poses[below] = (above, pose)
                pose = _pose(poses, parent, child)
                if pose is not None:
                    yield pose.position

    def _open(self) -> Recording:
        recording = open_recording(self._paths)
        while not recording.index_more():
            pass
        return recording

    def _see(self, message: Recorded, seen: Seen) -> None:
        name = message.channel.schema.name
        times = (message.log_ns, message.log_ns)
        topic = seen.topics.setdefault(message.topic, SeenTopic(name, times))
        topic.times = (topic.times[0], message.log_ns)
        topic.count += 1
        if _has_transforms(message.topic):
            for parent, child, _ in self._transforms(message):
                seen.parents[child] = parent
        elif message.topic.endswith(_STATUS) and self._succeeded(message):
            action = message.topic.removesuffix(_STATUS)
            seen.goals.add(action.rpartition("/")[2])

    def _transforms(self, message: Recorded) -> Iterator[tuple[str, str, PlainPose]]:
        try:
            found = self._decoding.transforms(message)
        except DecodeError:
            return
        for _, edges, rows in found:
            for (parent, child), row in zip(edges, rows.tolist(), strict=True):
                x, y, z, qx, qy, qz, qw = row
                length = math.sqrt(qx * qx + qy * qy + qz * qz + qw * qw)
                if 0.0 < length < math.inf:
                    turn = (qx / length, qy / length, qz / length, qw / length)
                    pose = PlainPose(turn, (x, y, z))
                    yield plain_name(parent), plain_name(child), pose

    def _succeeded(self, message: Recorded) -> bool:
        try:
            read: Any = self._decoding.decode(message)
        except DecodeError:
            return False
        rows: Any = _field(read, "status_list") or ()
        return any(_field(row, "status") == SUCCEEDED for row in rows)


def _field(value: Any, name: str) -> Any:
    """Return a field of a message, which is a dict where its type is unknown."""
    if isinstance(value, dict):
        return cast("dict[str, Any]", value).get(name)
    return getattr(value, name, None)


def _has_transforms(topic: str) -> bool:
    return topic.rpartition("/")[2] in ("tf", "tf_static")


def _pose(
    poses: dict[str, tuple[str, PlainPose]], parent: str, child: str
) -> PlainPose | None:
    """Return T_parent_child from the newest transforms; None without a connection."""
    found, at = PlainPose(), child
    for _ in range(len(poses) + 1):
        if at == parent:
            return found
        if at not in poses:
            return None
        at, T_above_at = poses[at]
        found = T_above_at @ found
    return None
