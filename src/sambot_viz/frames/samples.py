"""The samples of moving frames: where they were in the last seconds.

A publisher sends the same frames again and again, so the poses of a message are kept
as one array in the group of its frames: 300 frames cost little more than one. A frame
that several publishers move is in several groups, and its samples are all theirs.
"""

from __future__ import annotations

import bisect
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
import numpy.typing as npt

from sambot_viz import limits
from sambot_viz.frames.frame_errors import TransformFault
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.geometry import Vector3, Xyzw

FramePair = tuple[str, str]
"""A parent frame and its child."""
Pose = tuple[Vector3, Xyzw]
"""Translation [m] and rotation of a child in its parent."""
Poses = npt.NDArray[np.float64]
"""(N, 7): x, y, z [m] and the quaternion x, y, z, w of each frame."""

MOST_GROUPS = 256
"""Messages with further sets of frames are kept frame by frame."""
_LENGTH_TOLERANCE = 0.01
"""tf2 refuses quaternions whose squared length differs from 1 by more."""


@dataclass(frozen=True, slots=True)
class Sample:
    """The pose and the parent of a frame at one time.

    Attributes:
        stamp: the time [ns].
        parent: the frame in which the pose is given.
        pose: of the frame in the parent.
        order: grows with every message; of two with one stamp the later counts.
    """

    stamp: int
    parent: str
    pose: Pose
    order: int = 0


@dataclass(frozen=True, slots=True)
class Gap:
    """The reason why there is no sample at a time.

    Attributes:
        kind: the time is before the first sample ("past"), after the last one
            ("future"), or there is only one at another time ("one").
        stamp: the nearest sample [ns].
    """

    kind: Literal["past", "future", "one"]
    stamp: int


@dataclass(slots=True)
class _FrameGroup:
    """The messages about one set of frames, by time.

    Attributes:
        edges: of each row of the poses.
        shared: one of the frames is in another group too.
        stamps: of the messages [ns], ascending.
        poses: of each message.
        orders: the number of each message; of two with one stamp the later counts.
    """

    edges: tuple[FramePair, ...]
    shared: bool = False
    stamps: list[int] = field(default_factory=list[int])
    poses: list[Poses] = field(default_factory=list[Poses])
    orders: list[int] = field(default_factory=list[int])

    def insert(self, stamp: int, poses: Poses, order: int) -> None:
        at = bisect.bisect_left(self.stamps, stamp)
        end = at + (self.stamps[at : at + 1] == [stamp])
        self.stamps[at:end] = [stamp]
        self.poses[at:end] = [poses]
        self.orders[at:end] = [order]

    def trim(self, oldest: int, most: int) -> None:
        """Forget samples, an eighth at a time: it moves all others in the lists."""
        count = len(self.stamps)
        old = count - most if count > most + most // 8 else 0
        if count > 16 and self.stamps[count // 8] < oldest:
            old = max(old, bisect.bisect_left(self.stamps, oldest))
        if old:
            del self.stamps[:old], self.poses[:old], self.orders[:old]

    def sample(self, index: int, row: int) -> Sample:
        x, y, z, qx, qy, qz, qw = self.poses[index][row].tolist()
        pose = ((x, y, z), (qx, qy, qz, qw))
        parent, order = self.edges[row][0], self.orders[index]
        return Sample(self.stamps[index], parent, pose, order)


class Samples:
    """The samples of all moving frames, for a time [ns] after the newest of a frame."""

    def __init__(self, duration: int) -> None:
        self._duration = duration
        # Frames as a message names them, with slashes that tf2 strips, → their group.
        self._groups: dict[tuple[FramePair, ...], _FrameGroup] = {}
        self._places: dict[str, list[tuple[_FrameGroup, int]]] = {}
        self._columns = 0
        self._order = 0

    def __contains__(self, child: str) -> bool:
        return child in self._places

    def knows(self, edges: Sequence[FramePair]) -> bool:
        """Return whether a message has had these frames, in this order and spelling."""
        return tuple(edges) in self._groups

    def add(
        self, stamp: int, edges: Sequence[FramePair], poses: Poses
    ) -> dict[int, TransformFault]:
        """Keep the poses of frames at one time.

        Args:
            stamp: the time [ns].
            edges: (parent, child) of each row of `poses`. The same tuple for the
                messages of one publisher is the fast way.
            poses: (N, 7) float64: x, y, z [m] and the quaternion x, y, z, w. Copied.

        Returns:
            Row → why tf2 would ignore it; the other rows are kept.
        """
        kept = np.array(poses, dtype=np.float64)
        faults = number_faults(kept)
        group = self._groups.get(tuple(edges))
        is_old = group is not None and group.stamps[-1] > stamp + self._duration
        if group is None or group.shared or faults or is_old:
            return self._add_checked(stamp, edges, kept, faults)
        self._insert(group, stamp, kept)
        return {}

    def _add_checked(
        self,
        stamp: int,
        edges: Sequence[FramePair],
        poses: Poses,
        faults: dict[int, TransformFault],
    ) -> dict[int, TransformFault]:
        plain = [(plain_name(parent), plain_name(child)) for parent, child in edges]
        for row, (parent, child) in enumerate(plain):
            fault = name_fault(parent, child)
            if fault is None and child in self._places:
                is_old = self.latest(child).stamp > stamp + self._duration
                fault = "TF_OLD_DATA" if is_old else None
            if fault is not None:
                faults[row] = fault
        rows = [row for row in range(len(plain)) if row not in faults]
        kept = tuple(plain[row] for row in rows)
        too_many = kept not in self._groups and len(self._groups) >= MOST_GROUPS
        # Of two poses of one frame in a message the last one counts.
        if too_many or len({child for _, child in kept}) < len(kept):
            rows_of = [[row] for row in rows]
        else:
            rows_of = [rows] if rows else []
        for part in rows_of:
            group = self._group_of(tuple(plain[row] for row in part))
            self._insert(group, stamp, poses[part])
        if rows_of == [rows] and len(rows) == len(edges):
            self._groups.setdefault(tuple(edges), self._groups[kept])
        return faults

    def _group_of(self, edges: tuple[FramePair, ...]) -> _FrameGroup:
        group = self._groups.get(edges)
        if group is None:
            group = self._groups[edges] = _FrameGroup(edges)
            self._columns += len(edges)
            for row, (_, child) in enumerate(edges):
                places = self._places.setdefault(child, [])
                places.append((group, row))
                if len(places) > 1:
                    for other, _ in places:
                        other.shared = True
        return group

    def _insert(self, group: _FrameGroup, stamp: int, poses: Poses) -> None:
        self._order += 1
        group.insert(stamp, poses, self._order)
        most = max(2, limits.POSES.value // self._columns)
        group.trim(group.stamps[-1] - self._duration, most)

    def forget(self, child: str) -> None:
        """Forget the samples of a frame, as when it becomes a static one."""
        for group, _ in self._places.pop(child, ()):
            # The next message of these frames begins a new group; what the others
            # have in this one stays valid.
            for key in [key for key, known in self._groups.items() if known is group]:
                del self._groups[key]

    def latest(self, child: str) -> Sample:
        """Return the newest sample of a frame that has samples."""
        places = self._places[child]
        group, row = max(places, key=lambda at: (at[0].stamps[-1], at[0].orders[-1]))
        return group.sample(-1, row)

    def stamps(self, child: str) -> list[int]:
        """Return the times of the samples of a frame that has some [ns], ascending."""
        kept = sorted(time for group, _ in self._places[child] for time in group.stamps)
        return kept[bisect.bisect_left(kept, kept[-1] - self._duration) :]

    def at(self, child: str, time: int) -> Sample | Gap:
        """Return where a frame with samples was at a time [ns], as tf2 finds it.

        Between two samples the translation is interpolated along a line and the
        rotation along the shorter arc (slerp). Where the parent changes, the older
        sample counts.

        Returns:
            The sample, its stamp that of the older one; or why there is none.
        """
        places = self._places[child]
        latest = max(group.stamps[-1] for group, _ in places)
        earliest = latest
        before: list[Sample] = []
        after: list[Sample] = []
        for group, row in places:
            first = bisect.bisect_left(group.stamps, latest - self._duration)
            if first == len(group.stamps):
                continue
            earliest = min(earliest, group.stamps[first])
            split = bisect.bisect_right(group.stamps, time, lo=first)
            if split > first:
                before.append(group.sample(split - 1, row))
            if split < len(group.stamps):
                after.append(group.sample(split, row))
        if not before or not (after or time == latest):
            kind = "future" if before else "past"
            kind = "one" if earliest == latest else kind
            return Gap(kind, latest if before else earliest)
        older = max(before, key=lambda sample: (sample.stamp, sample.order))
        if not after or older.stamp == time:
            return older
        newer = min(after, key=lambda sample: (sample.stamp, -sample.order))
        if newer.parent != older.parent:
            return older
        share = (time - older.stamp) / (newer.stamp - older.stamp)
        return Sample(
            older.stamp, older.parent, _between(older.pose, newer.pose, share)
        )


def name_fault(parent: str, child: str) -> TransformFault | None:
    """Return why tf2 would ignore a transform between two frames, or None."""
    if parent == child:
        return "TF_SELF_TRANSFORM"
    if not child:
        return "TF_NO_CHILD_FRAME_ID"
    return None if parent else "TF_NO_FRAME_ID"


def number_faults(poses: Poses) -> dict[int, TransformFault]:
    """Find the rows that tf2 would ignore, and bring the quaternions to length 1.

    Args:
        poses: (N, 7) float64, changed in place: tf2 takes a quaternion whose length is
            wrong by up to half a percent.
    """
    lengths = np.einsum("ij,ij->i", poses[:, 3:], poses[:, 3:])
    good = np.abs(lengths - 1.0) < _LENGTH_TOLERANCE
    # The sum of all squares finds NaN and infinity fast.
    if good.all() and math.isfinite(np.vdot(poses, poses)):
        poses[:, 3:] /= np.sqrt(lengths)[:, None]
        return {}
    finite = np.isfinite(poses).sum(axis=1) == poses.shape[1]
    faults: dict[int, TransformFault] = {}
    for row in np.flatnonzero(~(good & finite)).tolist():
        faults[row] = "TF_DENORMALIZED_QUATERNION" if finite[row] else "TF_NAN_INPUT"
        poses[row] = (0, 0, 0, 0, 0, 0, 1)
        lengths[row] = 1.0
    poses[:, 3:] /= np.sqrt(lengths)[:, None]
    return faults


def _between(a: Pose, b: Pose, share: float) -> Pose:
    """The pose at a share of the way from one to the other, as tf2 interpolates."""
    (ax, ay, az), (ai, aj, ak, aw) = a
    (bx, by, bz), (bi, bj, bk, bw) = b
    xyz = (ax + (bx - ax) * share, ay + (by - ay) * share, az + (bz - az) * share)
    cosine = ai * bi + aj * bj + ak * bk + aw * bw
    sign = -1.0 if cosine < 0.0 else 1.0
    angle = math.acos(min(1.0, abs(cosine)))
    if angle < 1e-9:
        return xyz, a[1]
    sine = math.sin(angle)
    p = math.sin((1.0 - share) * angle) / sine
    q = sign * math.sin(share * angle) / sine
    return xyz, (ai * p + bi * q, aj * p + bj * q, ak * p + bk * q, aw * p + bw * q)
