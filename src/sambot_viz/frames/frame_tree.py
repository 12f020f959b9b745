"""The tree of frames: the pose of any frame in any other.

The rules are tf2's: a look-up from a frame to itself always works, even without any
data. A transform set here is the present one and holds at all times; a separate history
has the earlier poses of moving frames.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from sambot_viz.frames.frame_errors import LookupRefused, TransformRefused
from sambot_viz.frames.hierarchy import Edge, FrameHierarchy, plain_name
from sambot_viz.frames.history import FrameHistory
from sambot_viz.frames.samples import Sample
from sambot_viz.frames.transform import Transform, compose
from sambot_viz.geometry import Matrix
from sambot_viz.matrices import stacked

_SEEN_LIMIT = 4096
"""Upper bound of the look-up cache."""


@dataclass(frozen=True, slots=True)
class Hop:
    """One step of a chain, walked from the source towards the target.

    Attributes:
        parent: the upper frame of the transform that is crossed.
        child: its lower frame.
        up: True when the step goes from the child to the parent, False when it goes
            down (then the inverse of the transform takes part).
        transform: the pose of the child in the parent.
        static: whether it was set as a static transform.
        stamp: time of the latest value [s]; 0.0 when static.
    """

    parent: str
    child: str
    up: bool
    transform: Transform
    static: bool
    stamp: float

    @property
    def start(self) -> str:
        """The frame that the step leaves."""
        return self.child if self.up else self.parent

    @property
    def end(self) -> str:
        """The frame that the step reaches."""
        return self.parent if self.up else self.child

    @property
    def step(self) -> Transform:
        """The pose of `start` in `end`: what the step contributes to the product."""
        return self.transform if self.up else self.transform.inverse()


class FrameTree(FrameHierarchy):
    """Frames and the transforms between them.

    Names are taken as tf2 takes them: one leading slash is stripped. Not thread-safe:
    the session that owns it holds the lock.

    Args:
        history: frames of live data or of a recording, which are looked up together
            with those of the tree. It wins where both have a frame.

    Attributes:
        version: grows when a frame of the tree appears, disappears or gets another
            parent.
        history: as given; None for a robot that only sliders move.

    Frames may be set ahead of their first message, so that a picture of the very start
    of a recording is whole. Look-ups know nothing of them.
    """

    def __init__(self, history: FrameHistory | None = None) -> None:
        super().__init__()
        self.history = history
        # The answers since the last change: asking twice costs once.
        self._seen: dict[tuple[str, str], Transform] = {}
        self._ahead: set[str] = set()

    # Setting

    def set_static(self, parent: str, child: str, transform: Transform) -> None:
        """Set a transform that holds for all times.

        Args:
            parent: the frame in which the pose is given.
            child: the frame whose pose it is; it leaves its former parent.
            transform: T_parent_child.

        Raises:
            TransformRefused: an empty name, or parent and child are the same.
            FrameCycleError: the parent is a descendant of the child.
        """
        edge = self._edge_for(parent, child)
        edge.transform, edge.static, edge.stamp = transform, True, 0.0
        self._arrived(edge)

    def set(
        self, parent: str, child: str, transform: Transform, stamp: float = 0.0
    ) -> None:
        """Set the latest value of a transform that changes.

        Args:
            parent: the frame in which the pose is given.
            child: the frame whose pose it is; it leaves its former parent.
            transform: T_parent_child.
            stamp: the time of the value [s].

        Raises:
            TransformRefused: an empty name, or parent and child are the same.
            FrameCycleError: the parent is a descendant of the child.
        """
        edge = self._edge_for(parent, child)
        edge.transform, edge.static, edge.stamp = transform, False, stamp
        self._arrived(edge)

    def set_ahead(self, parent: str, child: str, transform: Transform) -> None:
        """Set a preliminary pose of a frame, where it is drawn until it is set.

        Args:
            parent: the frame in which the pose is given.
            child: the frame whose pose it is; one that has a parent stays where it is.
            transform: T_parent_child.

        Raises:
            TransformRefused: an empty name, or parent and child are the same.
            FrameCycleError: the parent is a descendant of the child.
        """
        if self.parent(child) is None:
            edge = self._edge_for(parent, child)
            edge.transform = transform
            self._ahead.add(edge.child)
            self._seen.clear()

    def update(self, transforms: Mapping[str, Matrix], stamp: float = 0.0) -> None:
        """Set new values of transforms that exist already: the fast way for joints.

        Either all values are taken or, after an error, none.

        Args:
            transforms: child frame → (4, 4) float64, T_parent_child.
            stamp: the time of the values [s].

        Raises:
            FrameError: a child that has no parent yet.
            TransformRefused: a number that is not finite (TF_NAN_INPUT).
        """
        known = self._edges
        edges = [known.get(child) or self._edge_of(child) for child in transforms]
        for child, matrix in transforms.items():
            if matrix.shape != (4, 4):
                raise _refused(child)
        if not edges:
            return
        # One array: its numbers are looked at together, and nobody else has it.
        matrices = stacked(transforms.values())
        if not np.isfinite(matrices).all():
            is_bad = (c for c, T in transforms.items() if not np.isfinite(T).all())
            raise _refused(next(is_bad))
        matrices.flags.writeable = False
        for edge, matrix in zip(edges, matrices, strict=True):
            edge.move(matrix, stamp)
        self._seen.clear()

    def remove(self, child: str) -> None:
        """Take a frame from its parent; frames below it stay below it.

        Raises:
            FrameError: the frame does not exist or has no parent.
        """
        edge = self._edge_of(child)
        self._detach(edge)
        self._ahead.discard(edge.child)
        self._seen.clear()

    def clear(self) -> None:
        """Forget all frames."""
        self._edges.clear()
        self._children.clear()
        self._declared.clear()
        self._ahead.clear()
        self._restructured()
        self._seen.clear()

    # Asking

    def hop(self, child: str) -> Hop:
        """Return the transform that holds a frame at its parent.

        Raises:
            FrameError: the frame does not exist or has no parent.
        """
        return _hop(self._edge_of(child), up=True)

    def lookup(self, target: str, source: str, time_ns: int | None = None) -> Transform:
        """Return the pose of the source frame in the target frame, T_target_source.

        It takes coordinates of the source to the target, and is what
        ``tf2_echo TARGET SOURCE`` prints. The same name twice needs no data.

        Args:
            target: the frame in which the pose is wanted.
            source: the frame whose pose is wanted.
            time_ns: the time [ns], for frames of the history; None is now: the latest
                time at which all of them are known.

        Raises:
            LookupRefused: a frame that does not exist (the target is tested first),
                frames of separate trees, or a time of which the history knows
                nothing; with the texts of tf2 and RViz.
        """
        if self.history is not None:
            return self.history.lookup(target, source, time_ns, self)
        seen = self._seen.get((target, source))
        if seen is None:
            if len(self._seen) >= _SEEN_LIMIT:
                self._seen.clear()
            seen = self._seen[target, source] = self._look(target, source)
        return seen

    def can_lookup(self, target: str, source: str, time_ns: int | None = None) -> bool:
        """Return whether `lookup` has an answer."""
        try:
            if self.history is not None:
                self.history.lookup(target, source, time_ns, self)
            else:
                self._path(target, source)
        except LookupRefused:
            return False
        return True

    def is_ahead(self, frame: str) -> bool:
        """Return whether a frame is only drawn where it will be first."""
        return plain_name(frame) in self._ahead

    def drawn(self, target: str, source: str) -> Transform:
        """Return T_target_source as it is drawn, with frames that are set ahead.

        Raises:
            LookupRefused: as `lookup`.
        """
        if self._ahead:
            return self._look(target, source)
        return self.lookup(target, source)

    def root_of(self, frame: str) -> str:
        """Return the root of the tree of a frame, without preliminary transforms.

        Raises:
            LookupRefused: the frame does not exist.
        """
        name = plain_name(frame)
        self._require(name, name)
        while name in self._edges and name not in self._ahead:
            name = self._edges[name].parent
        return name

    def latest_common_time(self, target: str, source: str) -> float:
        """Return the oldest of the latest stamps of a chain [s]; 0.0 for static ones.

        Raises:
            LookupRefused: as `lookup`.
        """
        if self.history is not None:
            time_ns = self.history.latest_common_time(target, source, self)
            return (time_ns or 0) * 1e-9
        below, above = self._path(target, source)
        return min((e.stamp for e in (*below, *above) if not e.static), default=0.0)

    def chain(self, target: str, source: str) -> tuple[Hop, ...]:
        """Return the steps from the source to the target, in walking order.

        Raises:
            LookupRefused: as `lookup`.
        """
        below, above = self._path(target, source)
        ups = [_hop(edge, up=True) for edge in below]
        downs = [_hop(edge, up=False) for edge in reversed(above)]
        return (*ups, *downs)

    def held(self, child: str) -> Sample | None:
        """Return where a frame of the tree is now; None for a root."""
        edge = self._edges.get(plain_name(child))
        if edge is None or edge.child in self._ahead:
            return None
        x, y, z = edge.transform.translation.tolist()
        qx, qy, qz, qw = edge.transform.rotation_xyzw.tolist()
        stamp = round(edge.stamp * 1e9)
        return Sample(stamp, edge.parent, ((x, y, z), (qx, qy, qz, qw)))

    # Inside

    def _arrived(self, edge: Edge) -> None:
        self._seen.clear()
        if edge.child in self._ahead:
            self._ahead.remove(edge.child)
            # What is said of the frame is otherwise now.
            self._restructured()

    def _look(self, target: str, source: str) -> Transform:
        below, above = self._path(target, source)
        if not above and len(below) == 1:
            return below[0].transform
        # A list inside tuple() is faster than a generator here.
        return compose(
            tuple([edge.transform for edge in below]),
            tuple([edge.transform for edge in above]),
        )


def _refused(child: str) -> TransformRefused:
    return TransformRefused(
        "TF_NAN_INPUT",
        f"the transform of frame '{child}' is not a finite (4, 4) matrix",
    )


def _hop(edge: Edge, *, up: bool) -> Hop:
    return Hop(edge.parent, edge.child, up, edge.transform, edge.static, edge.stamp)
