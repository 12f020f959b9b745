"""The frames of the last seconds, as tf2's buffer keeps and finds them.

Where a frame was between two messages is interpolated, and nothing is guessed beyond
the first and the last one. Static transforms hold at all times. Times are whole
nanoseconds, as in the headers of messages: a float of seconds since 1970 is exact to
0.2 µs only, and a look-up at the newest stamp would sometimes be refused. The rules
and texts are those of tf2 in ROS 2.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Protocol

import numpy as np

from sambot_viz.frames.frame_errors import LookupReason, LookupRefused, TransformFault
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.frames.samples import (
    FramePair,
    Gap,
    Pose,
    Poses,
    Sample,
    Samples,
    name_fault,
    number_faults,
)
from sambot_viz.frames.transform import Transform
from sambot_viz.geometry import rotation_from_xyzw, xyzw_product, xyzw_rotated

DURATION = 10.0
"""The time for which tf2's listeners keep a transform [s]."""
_DEEPEST = 1000
"""A longer way to the root is a ring for tf2."""
_HERE: Pose = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
_NEVER = 1 << 62
_GAPS: dict[str, LookupReason] = {
    "past": "extrapolation-past",
    "future": "extrapolation-future",
    "one": "extrapolation-one",
}


class HeldFrames(Protocol):
    """Frames beside the history whose latest value holds at all times: a robot's."""

    @property
    def frames(self) -> tuple[str, ...]:
        """All of them."""
        ...

    def held(self, child: str) -> Sample | None:
        """Return where a frame is; None for a root and for an unknown frame."""
        ...


class FrameHistory:
    """The transforms of the last seconds: no thread, no clock, no socket.

    Names are taken as tf2 takes them: one leading slash is stripped. Not thread-safe.

    Args:
        duration: how long a transform is kept after the newest of its frame [s].

    Attributes:
        shown_at: the time that is meant where none is asked for, as far as all is known
            by then [ns]; None for the latest.
    """

    def __init__(self, duration: float = DURATION) -> None:
        self.shown_at: int | None = None
        self._duration = round(duration * 1e9)
        self._samples = Samples(self._duration)
        self._static: dict[str, Sample] = {}
        self._frames: dict[str, None] = {}

    @property
    def frames(self) -> tuple[str, ...]:
        """All frames in the order in which they became known."""
        return tuple(self._frames)

    def add(
        self, time_ns: int, edges: Sequence[FramePair], poses: Poses
    ) -> dict[int, TransformFault]:
        """Take the transforms of a message that have one stamp.

        Args:
            time_ns: the stamp [ns].
            edges: (parent, child) of each row of `poses`.
            poses: (N, 7) float64: the child's x, y, z [m] and quaternion x, y, z, w
                in its parent. Copied.

        Returns:
            Row → tf2's name for the fault for which every listener ignores it, such as
            TF_NAN_INPUT, or TF_OLD_DATA for one older than all kept transforms of its
            frame. The other rows are added.
        """
        is_new = not self._samples.knows(edges)
        faults = self._samples.add(time_ns, edges, poses)
        if is_new:
            for row, (parent, child) in enumerate(edges):
                if row not in faults:
                    self._know(parent, child)
                    # As in tf2, a frame is static or moves, as the last word says.
                    self._static.pop(plain_name(child), None)
        return faults

    def add_static(self, parent: str, child: str, pose: Pose) -> TransformFault | None:
        """Take a transform that holds at all times; all others of the child go.

        Args:
            parent: the frame in which the pose is given.
            child: the frame whose pose it is.
            pose: translation [m] and quaternion x, y, z, w.

        Returns:
            tf2's name for the fault for which every listener ignores it, or None.
        """
        parent, child = plain_name(parent), plain_name(child)
        rows = np.array([[*pose[0], *pose[1]]], dtype=np.float64)
        fault = name_fault(parent, child) or number_faults(rows).get(0)
        if fault is None:
            x, y, z, qx, qy, qz, qw = rows[0].tolist()
            self._static[child] = Sample(0, parent, ((x, y, z), (qx, qy, qz, qw)))
            self._samples.forget(child)
            self._know(parent, child)
        return fault

    def forget_all(self) -> None:
        """Know no frame, as at the start."""
        self.clear()
        self._static.clear()
        self._frames.clear()

    def clear(self) -> None:
        """Forget what moves, as after a jump in time; static transforms stay."""
        self._samples = Samples(self._duration)

    def forget(self, children: Iterable[str]) -> None:
        """Forget how some frames move, as after a jump in the time of their source."""
        for child in children:
            if child in self._samples:
                self._samples.forget(child)

    def lookup(
        self,
        target: str,
        source: str,
        time_ns: int | None = None,
        beside: HeldFrames | None = None,
    ) -> Transform:
        """Return the pose of the source frame in the target frame at a time.

        Args:
            target: the frame in which the pose is wanted.
            source: the frame whose pose is wanted.
            time_ns: the time [ns]; None is the latest common time, or `shown_at`.
            beside: frames whose latest value holds at all times.

        Returns:
            T_target_source, its quaternion with tf2's sign.

        Raises:
            LookupRefused: a frame that does not exist, frames of separate trees, or a
                time before the first or after the last sample on the way; with the
                texts of tf2 and RViz.
        """
        target, source = plain_name(target), plain_name(source)
        if target == source and target:
            return Transform.identity()
        if time_ns is None:
            time_ns = self.latest_common_time(target, source, beside) or 0
            if self.shown_at is not None:
                time_ns = min(time_ns, self.shown_at)
        else:
            self._require(target, source, beside)
        way = _Way(target, source, time_ns)
        frame, pose, found = source, _HERE, {source: _HERE}
        sample = self._at(frame, time_ns, beside)
        # As in tf2, a target on the way is found although a ring is above it.
        while isinstance(sample, Sample) and frame != target:
            frame, pose = sample.parent, _product(sample.pose, pose)
            way.step(frame)
            found[frame] = pose
            sample = self._at(frame, time_ns, beside)
        # There may be a way below the frame of which nothing is known at this time.
        gap = None if isinstance(sample, Sample) else sample
        frame, pose = target, _HERE
        while frame not in found:
            sample = self._at(frame, time_ns, beside)
            if not isinstance(sample, Sample):
                raise way.refusal(sample or gap)
            frame, pose = sample.parent, _product(sample.pose, pose)
            way.step(frame)
        return transform_of(_product(_inverse(pose), found[frame]))

    def latest_common_time(
        self, target: str, source: str, beside: HeldFrames | None = None
    ) -> int | None:
        """Return the oldest of the newest stamps on the way [ns]; None when all holds.

        Raises:
            LookupRefused: a frame that does not exist, or frames of separate trees.
        """
        target, source = plain_name(target), plain_name(source)
        self._require(target, source, beside)
        way = _Way(target, source, None)
        frame, low, found = source, _NEVER, {source: _NEVER}
        while frame != target and (sample := self._latest(frame, beside)) is not None:
            frame, low = sample.parent, min(low, sample.stamp)
            way.step(frame)
            found[frame] = low
        frame, low = target, _NEVER
        while frame not in found:
            sample = self._latest(frame, beside)
            if sample is None:
                raise way.refusal(None)
            frame, low = sample.parent, min(low, sample.stamp)
            way.step(frame)
        low = min(low, found[frame])
        return None if low == _NEVER else low

    def latest(self, child: str) -> Sample | None:
        """Return the newest sample of a frame, at time 0 for a static one.

        Returns:
            None for a root and for an unknown frame.
        """
        if child in self._samples:
            return self._samples.latest(child)
        return self._static.get(child)

    def shown(self, child: str) -> Sample | None:
        """Return where a frame is drawn: at `shown_at`, or at the sample next to it.

        Returns:
            None for a root and for an unknown frame.
        """
        latest, at = self.latest(child), self.shown_at
        if at is None or latest is None or child not in self._samples:
            return latest
        found = self._samples.at(child, min(at, latest.stamp))
        if isinstance(found, Gap):
            found = self._samples.at(child, found.stamp)
        return found if isinstance(found, Sample) else latest

    def stamps(self, child: str) -> Sequence[int]:
        """Return the stamps of the samples that are kept of a frame [ns], ascending."""
        return self._samples.stamps(child) if child in self._samples else ()

    def is_static(self, child: str) -> bool:
        """Return whether a frame has a transform that holds at all times."""
        return child in self._static and child not in self._samples

    # Inside

    def _know(self, *names: str) -> None:
        self._frames.update(dict.fromkeys(map(plain_name, names)))

    def _at(
        self, child: str, time_ns: int, beside: HeldFrames | None
    ) -> Sample | Gap | None:
        if child in self._samples:
            return self._samples.at(child, time_ns)
        return self._static.get(child) or (beside.held(child) if beside else None)

    def _latest(self, child: str, beside: HeldFrames | None) -> Sample | None:
        if child in self._samples:
            return self._samples.latest(child)
        sample = self._static.get(child) or (beside.held(child) if beside else None)
        # What holds at all times does not bound the common time.
        return sample and Sample(_NEVER, sample.parent, sample.pose)

    def _require(self, target: str, source: str, beside: HeldFrames | None) -> None:
        known = self._frames
        if beside is not None and not (target in known and source in known):
            known = {**known, **dict.fromkeys(beside.frames)}
        for name in (target, source):
            if name not in known:
                reason = "unknown-frame" if name else "empty-name"
                raise LookupRefused(target, source, reason, known, name)


class _Way:
    """A walk from two frames to the root, which a ring would make endless."""

    def __init__(self, target: str, source: str, time_ns: int | None) -> None:
        self._target, self._source, self._time = target, source, time_ns
        self._seen = 0

    def step(self, frame: str) -> None:
        self._seen += 1
        if self._seen > 2 * _DEEPEST:
            raise LookupRefused(self._target, self._source, "ring", unknown=frame)

    def refusal(self, gap: Gap | None) -> LookupRefused:
        if gap is None or self._time is None:
            return LookupRefused(self._target, self._source, "not-connected")
        times = (self._time, gap.stamp)
        reason = _GAPS[gap.kind]
        return LookupRefused(self._target, self._source, reason, times=times)


def _product(a: Pose, b: Pose) -> Pose:
    """Return the pose of c in a, from those of b in a and of c in b."""
    (x, y, z), (dx, dy, dz) = a[0], xyzw_rotated(a[1], b[0])
    return (x + dx, y + dy, z + dz), xyzw_product(a[1], b[1])


def _inverse(pose: Pose) -> Pose:
    qx, qy, qz, qw = pose[1]
    back = (-qx, -qy, -qz, qw)
    x, y, z = xyzw_rotated(back, pose[0])
    return (-x, -y, -z), back


def transform_of(pose: Pose) -> Transform:
    """Return the pose of a sample as a transform."""
    matrix = np.eye(4)
    matrix[:3, :3] = rotation_from_xyzw(pose[1])
    matrix[:3, 3] = pose[0]
    matrix.flags.writeable = False
    return Transform.trusted(matrix, pose[1])
