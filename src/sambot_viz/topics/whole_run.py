"""Where the frames of a recording are over its length, by a few looks into it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import islice

import numpy as np
import numpy.typing as npt

from sambot_viz.frames import FrameHistory, FrameTree
from sambot_viz.frames.data_frames import DataFrames
from sambot_viz.topics.source_robot import SourceRobot

Points = npt.NDArray[np.float64]
"""Some points, (N, 3), or one, (3,) [m]."""

LOOKS = 8
"""So often it is looked into a recording, from its beginning to its end."""
_MESSAGES = 50
"""Messages taken at each look: a recording of any length costs the same."""
_APART = 0.001
"""Frames nearer than this are at one place [m]."""


@dataclass(frozen=True, slots=True)
class WholeRun:
    """How far frames are apart, and where they are, at some times.

    Attributes:
        spacing: the usual way from a frame to its parent [m]; 0 without any.
        origins: frame at the top of a tree → the origins of those below it, (N, 3) [m].
    """

    spacing: float = 0.0
    origins: Mapping[str, Points] = field(default_factory=dict[str, Points])

    def box(self, frame: str) -> tuple[Points, Points] | None:
        """Return the box around all that is ever below a frame at the top of a tree.

        Args:
            frame: another one has no box.

        Returns:
            Its lowest and its highest corner, (3,) each [m].
        """
        origins = self.origins.get(frame)
        return None if origins is None else (origins.min(axis=0), origins.max(axis=0))


def whole_run(recorded: SourceRobot) -> WholeRun:
    """Look at the frames of a recording; a robot that is live has no whole run."""
    origins, ways = dict[str, list[Points]](), list[float]()
    for tree in _looks(recorded):
        for frame in tree.frames:
            top = tree.root_of(frame)
            at = tree.drawn(top, frame).translation
            origins.setdefault(top, []).append(at)
            if tree.parent(frame) is not None:
                hop = tree.hop(frame).transform.translation
                ways.append(float(np.linalg.norm(hop)))
    apart = [way for way in ways if way > _APART]
    spacing = float(np.median(apart)) if apart else 0.0
    return WholeRun(spacing, {top: np.array(found) for top, found in origins.items()})


def _looks(recorded: SourceRobot) -> Iterator[FrameTree]:
    """Yield the frames at some times, each where it was told of last."""
    recording, topics = recorded.recording, recorded.topics
    start = None if recording is None else recording.start_ns
    end = None if recording is None else recording.end_ns
    if recording is None or start is None or end is None:
        return
    transforms = recorded.transforms(FrameHistory())
    frames = DataFrames(FrameTree(transforms.history))
    frames.changed, frames.pairs = transforms.changed, transforms.pairs
    for message in recording.latched():
        if message.topic in transforms.always:
            transforms.take(message)
    for look in range(LOOKS):
        begin = start + (end - start) * look // LOOKS
        for message in islice(
            recording.messages(begin, None, topics.moving), _MESSAGES
        ):
            transforms.take(message)
        frames.settle()
        yield frames.tree
    for topic in topics.moving:
        if (last := recording.last(topic, end)) is not None:
            transforms.take(last)
    frames.settle()
    yield frames.tree
