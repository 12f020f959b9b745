"""Nodes of viser: one for each TF frame, below its parent's, and others below these.

Frames are the scene tree: everything drawn at a frame is a child of its node, so a
joint that moves is one message, whatever the size of the robot. The node of a root
frame carries the fixed frame: its pose is T_fixed_root.
"""

from __future__ import annotations

import string
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TypeVar, cast

import numpy as np
import viser

from sambot_viz import viser_private
from sambot_viz.frames import FrameTree
from sambot_viz.geometry import (
    IDENTITY,
    ORIGIN,
    Matrix,
    Vector3,
    Wxyz,
    unit_wxyz,
    wxyz_from_matrix,
)
from sambot_viz.matrices import inverse_matrix, stacked, wxyzs_from_matrices
from sambot_viz.viser_private import is_removed, set_poses

Pose = tuple[Wxyz, Vector3]
"""Rotation and position [m] in the frame of the node above."""
_AS_CREATED: Pose = (IDENTITY, ORIGIN)
"""The pose of a node that was just added."""
_FEW = 8
"""Up to this many matrices are taken apart one by one."""
_DIGITS = string.digits + string.ascii_lowercase


def short_id(number: int) -> str:
    """Return a number in base 36: node names travel in every message."""
    text = _DIGITS[number % 36]
    while number := number // 36:
        text = _DIGITS[number % 36] + text
    return text


class FrameNodes:
    """The frames of one session as viser nodes.

    A frame whose tree does not contain the fixed frame has no place in the picture;
    its node is hidden, and `connected` says so.
    """

    def __init__(self, scene: viser.SceneApi) -> None:
        self._scene = scene
        self._handles: dict[str, viser.FrameHandle] = {}
        self._paths: dict[str, str] = {}
        self._sent: dict[str, Pose] = {}
        self._ids: dict[str, str] = {}
        self._root_of: dict[str, str] = {}
        self._fixed_root: str | None = None

    def path(self, frame: str) -> str | None:
        """Return the name of the frame's node, or None for an unknown frame."""
        return self._paths.get(frame)

    def connected(self, frame: str) -> bool:
        """Return whether the frame can be placed in the fixed frame."""
        return frame in self._root_of and self._root_of[frame] == self._fixed_root

    def sync(self, tree: FrameTree, fixed_frame: str) -> None:
        """Bring the nodes in line with the tree: new, gone and re-hung frames."""
        wanted = self._wanted_paths(tree)
        for frame in [f for f, path in self._paths.items() if wanted.get(f) != path]:
            del self._paths[frame]
            self._sent.pop(frame, None)
            handle = self._handles.pop(frame)
            # A node that hung below another one has gone with it.
            if not is_removed(handle):
                handle.remove()
        self._fixed_root = self._root_of.get(fixed_frame)
        for frame, path in wanted.items():
            if frame not in self._handles:
                self._paths[frame] = path
                self._handles[frame] = self._scene.add_frame(path, show_axes=False)
        self.place(tree, fixed_frame, wanted)

    def place(self, tree: FrameTree, fixed_frame: str, frames: Iterable[str]) -> None:
        """Send the poses of some frames (and of the roots, if they changed)."""
        # The latest sample of a single step is what tf2 answers for it.
        matrices = tree.matrices_of(frames)
        poses = dict(zip(matrices, _poses(list(matrices.values())), strict=True))
        for root in tree.roots:
            connected = root == self._fixed_root
            self._handles[root].visible = connected
            if connected:
                poses[root] = _AS_CREATED
                if fixed_frame != root:
                    T_root_fixed = tree.drawn(root, fixed_frame).matrix
                    poses[root] = _pose(inverse_matrix(T_root_fixed))
        self._send(poses)

    def _send(self, poses: Mapping[str, Pose]) -> None:
        """Send the poses of nodes; what has not changed is not sent again."""
        moved: list[tuple[Handle, Wxyz | None, Vector3 | None]] = []
        for frame, now in poses.items():
            before = self._sent.get(frame, _AS_CREATED)
            if now != before:
                self._sent[frame] = now
                wxyz = None if now[0] == before[0] else now[0]
                position = None if now[1] == before[1] else now[1]
                moved.append((self._handles[frame], wxyz, position))
        set_poses(moved)

    def _wanted_paths(self, tree: FrameTree) -> dict[str, str]:
        paths: dict[str, str] = {}
        self._root_of = {}
        pending = [(root, "", root) for root in reversed(list(tree.roots))]
        while pending:
            frame, above, root = pending.pop()
            if frame not in self._ids:
                self._ids[frame] = short_id(len(self._ids))
            paths[frame] = f"{above}/{self._ids[frame]}"
            self._root_of[frame] = root
            children = list(tree.children(frame))
            pending.extend((c, paths[frame], root) for c in reversed(children))
        return paths


def _poses(matrices: Sequence[Matrix]) -> list[Pose]:
    """Return the poses of (4, 4) matrices."""
    if len(matrices) <= _FEW:
        return [_pose(T) for T in matrices]
    all_of_them = stacked(matrices)
    positions = all_of_them[:, :3, 3]
    if not np.abs(positions).max() < FARTHEST:
        return [_pose(T) for T in matrices]
    rows: list[list[float]] = positions.tolist()
    turns = wxyzs_from_matrices(all_of_them)
    return [(wxyz, (x, y, z)) for wxyz, (x, y, z) in zip(turns, rows, strict=True)]


def _pose(T: Matrix) -> Pose:
    return wxyz_from_matrix(T), position_of(T)


FARTHEST = 1e30
"""The largest distance [m]: browsers compute with 32 bits, where more is infinite."""


def position_of(T: Matrix) -> Vector3:
    """Return the translation of a (4, 4) matrix [m], always finite.

    viser keeps what it is given for every browser that comes later, so this is the
    last place where an absurd number can be stopped.
    """
    x, y, z = T[:3, 3].tolist()
    return (_shown(x), _shown(y), _shown(z))


def placed(wxyz: Sequence[float], position: Sequence[float]) -> tuple[Wxyz, Vector3]:
    """Return a pose that may be sent: finite, without a rotation where it has none."""
    turn = unit_wxyz([float(value) for value in wxyz])
    return turn, (_shown(position[0]), _shown(position[1]), _shown(position[2]))


def _shown(metres: float) -> float:
    """Return a finite coordinate; NaN (of two infinities) becomes 0."""
    # A comparison with NaN is never true.
    return (
        float(metres)
        if -FARTHEST < metres < FARTHEST
        else FARTHEST
        if metres > 0
        else -FARTHEST
        if metres < 0
        else 0.0
    )


Handle = viser.SceneNodeHandle
H = TypeVar("H", bound=viser.SceneNodeHandle)


class NodeCache:
    """A few nodes, and what they were made from."""

    def __init__(self) -> None:
        self._state: object = None
        self.handles: tuple[Handle, ...] = ()

    def show(self, state: object, make: Callable[[], Iterable[H]]) -> Sequence[H]:
        """Make the nodes, unless they were made from the same state and still exist.

        Args:
            state: everything that `make` depends on, the nodes' names included.
            make: adds the nodes to the scene.

        Returns:
            The nodes, made now or before.
        """
        if state != self._state or any_gone(self.handles):
            self.remove()
            self.handles = tuple(make())
            self._state = state
        return cast("Sequence[H]", self.handles)

    def remove(self) -> None:
        """Take the nodes out of the scene."""
        remove_all(self.handles)
        self._state, self.handles = None, ()


def remove_all(handles: Iterable[Handle]) -> None:
    """Take nodes out of the scene, also when their parent is already gone."""
    for handle in handles:
        if not viser_private.is_removed(handle):
            handle.remove()


def any_gone(handles: Iterable[Handle]) -> bool:
    """Return whether some of the nodes were removed together with a node above them."""
    return any(viser_private.is_removed(handle) for handle in handles)
