"""Forward kinematics as robot_state_publisher computes it."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from sambot_viz.errors import JointError, did_you_mean
from sambot_viz.geometry import Matrix, finite, rotation_from_axis, rotations_from_axes
from sambot_viz.robot.parts import Joint, Mimic, mimic_chain

_Ints = npt.NDArray[np.int64]
_Floats = npt.NDArray[np.float64]
_SPINNING = ("revolute", "continuous")


class JointTree(Protocol):
    """The parts of a robot that its kinematics needs."""

    @property
    def root(self) -> str:
        """The name of the root link."""
        ...

    @property
    def joints(self) -> Mapping[str, Joint]:
        """The joints by name."""
        ...


@dataclass(frozen=True, slots=True)
class _Level:
    """The links at one depth: a slice of the order, and their parents' rows."""

    rows: slice
    parents: _Ints


@dataclass(frozen=True, slots=True)
class _Follow:
    """One mimic joint: row = multiplier · leader + offset."""

    row: int
    leader: int
    multiplier: float
    offset: float


FEW = 12
"""Up to this many joints are computed one by one, more with the whole robot."""


class Kinematics:
    """Link poses from joint positions: prepared once per robot, then asked often.

    Attributes:
        links: link names, the root first, then by depth.
        joints: joint names; the joint at `joints[i]` holds the link at
            ``links[i + 1]``.
    """

    def __init__(self, robot: JointTree) -> None:
        order, parents, starts = _by_depth(robot)
        self.links: tuple[str, ...] = (robot.root, *(j.child for j in order))
        self.joints: tuple[str, ...] = tuple(joint.name for joint in order)
        self._order = order
        self._row = {name: row for row, name in enumerate(self.joints)}
        bounds = itertools.pairwise([*starts, len(order)])
        self._levels = [
            _Level(slice(a + 1, b + 1), np.array(parents[a:b], np.int64))
            for a, b in bounds
        ]
        count = len(order)
        self._origins: _Floats = np.empty((count, 4, 4))
        for row, joint in enumerate(order):
            self._origins[row] = joint.origin.matrix
        self._start: _Floats = np.array([_start(joint) for joint in order], np.float64)
        self._follows = _follows(order, self._row)
        self._spin = _rows(order, _SPINNING)
        self._slide = _rows(order, ("prismatic",))
        axes: _Floats = np.zeros((count, 3))
        for row, joint in enumerate(order):
            axes[row] = joint.axis
        self._spins = axes[self._spin]
        self._slides = axes[self._slide]

    def positions(self, given: Mapping[str, float]) -> dict[str, float]:
        """Return the position of every joint [rad or m].

        Args:
            given: joint name → position. A joint that is not given has its start
                value, a mimic joint follows its leader.

        Raises:
            JointError: an unknown joint, or a value that is not finite.
        """
        values: list[float] = self._filled(given).tolist()
        return dict(zip(self.joints, values, strict=True))

    def forward(self, given: Mapping[str, float]) -> dict[str, Matrix]:
        """Poses of all links in the root link: link name → (4, 4), T_root_link.

        Raises:
            JointError: an unknown joint, or a value that is not finite.
        """
        return dict(zip(self.links, self.poses(given), strict=True))

    def poses(self, given: Mapping[str, float]) -> Matrix:
        """Like `forward`, as one (N, 4, 4) array in the order of `links`."""
        T_parent_child = self._transforms(self._filled(given))
        T_root_link = np.empty((len(self.links), 4, 4))
        T_root_link[0] = np.eye(4)
        for level in self._levels:
            own = slice(level.rows.start - 1, level.rows.stop - 1)
            np.matmul(
                T_root_link[level.parents],
                T_parent_child[own],
                out=T_root_link[level.rows],
            )
        return T_root_link

    def joint_transform(self, joint: str, position: float) -> Matrix:
        """T_parent_child (4, 4) of one joint, without the rest of the robot.

        Args:
            joint: its name.
            position: its position [rad or m]; of no effect on joints that ROS does
                not move (fixed, floating, planar).

        Raises:
            JointError: an unknown joint, or a position that is not finite.
        """
        row = self._row_of(joint)
        q = _finite(joint, position)
        this = self._order[row]
        T = self._origins[row].copy()
        x, y, z = this.axis
        if this.type == "prismatic":
            T[:3, 3] += T[:3, :3] @ np.array([x * q, y * q, z * q])
        elif this.type in _SPINNING and (x or y or z):
            T[:3, :3] = T[:3, :3] @ np.array(rotation_from_axis(this.axis, q))
        return T

    def joint_transforms(
        self, names: Iterable[str], positions: Mapping[str, float]
    ) -> dict[str, Matrix]:
        """T_parent_child (4, 4) of some joints.

        Args:
            names: the joints.
            positions: the positions of all joints [rad or m].

        Raises:
            JointError: an unknown joint, or a position that is not finite.
        """
        wanted = list(names)
        if len(wanted) <= FEW:
            return {n: self.joint_transform(n, positions[n]) for n in wanted}
        T_parent_child = self._transforms(self._filled(positions))
        return {name: T_parent_child[self._row_of(name)] for name in wanted}

    def _row_of(self, joint: str) -> int:
        row = self._row.get(joint)
        if row is None:
            near = did_you_mean(joint, self.joints)
            raise JointError(f"no joint '{joint}'; {near}")
        return row

    def _filled(self, given: Mapping[str, float]) -> _Floats:
        q: _Floats = np.array(self._start)
        known, rows, values = self._row, list[int](), list[float]()
        for name, value in given.items():
            rows.append(known[name] if name in known else self._row_of(name))
            values.append(_finite(name, value))
        q[rows] = values
        moved = set(rows)
        for follow in self._follows:
            if follow.row not in moved:
                led = follow.multiplier * q[follow.leader] + follow.offset
                q[follow.row] = min(max(led, -_FARTHEST), _FARTHEST)
        return q

    def _transforms(self, q: _Floats) -> Matrix:
        T: _Floats = np.array(self._origins)
        if self._spin.size:
            turned = rotations_from_axes(self._spins, q[self._spin])
            T[self._spin, :3, :3] = T[self._spin, :3, :3] @ turned
        if self._slide.size:
            shift = self._slides * q[self._slide, None]
            R: _Floats = T[self._slide, :3, :3]
            T[self._slide, :3, 3] += np.einsum("nij,nj->ni", R, shift)
        return T


def _by_depth(robot: JointTree) -> tuple[list[Joint], list[int], list[int]]:
    """Joints by depth, the row of each one's parent link, where each depth begins."""
    children: dict[str, list[Joint]] = {}
    for joint in robot.joints.values():
        children.setdefault(joint.parent, []).append(joint)
    order: list[Joint] = []
    parents: list[int] = []
    starts: list[int] = []
    level: list[tuple[str, int]] = [(robot.root, 0)]
    while True:
        found = [(j, row) for link, row in level for j in children.get(link, ())]
        if not found:
            return order, parents, starts
        starts.append(len(order))
        level = []
        for joint, row in found:
            order.append(joint)
            parents.append(row)
            level.append((joint.child, len(order)))


def _follows(order: Iterable[Joint], rows: Mapping[str, int]) -> list[_Follow]:
    """The mimic joints, leaders first; rings and unknown leaders keep start values.

    joint_state_publisher ends at those with an exception; here a Problem names them.
    """
    joints = {joint.name: joint for joint in order}
    chains = [mimic_chain(joint, joints) for joint in joints.values()]
    follows: list[_Follow] = []
    for chain in sorted(chains, key=lambda chain: len(chain.joints)):
        if len(chain.joints) == 1 or chain.end == "ring":
            continue
        joint, leader = chain.joints[:2]
        mimic = joint.mimic or Mimic(leader.name)
        row, leader_row = rows[joint.name], rows[leader.name]
        follows.append(_Follow(row, leader_row, mimic.multiplier, mimic.offset))
    return follows


def _start(joint: Joint) -> float:
    return joint.start if joint.movable else 0.0


def _rows(order: Iterable[Joint], types: Iterable[str]) -> _Ints:
    wanted = frozenset(types)
    found = [
        row
        for row, joint in enumerate(order)
        if joint.type in wanted and any(joint.axis)
    ]
    return np.array(found, np.int64)


_FARTHEST = 1e30
"""A chain of mimic joints with large factors stops growing here."""


def _finite(joint: str, value: float) -> float:
    number = finite(value)
    if number is None:
        raise JointError(f"joint '{joint}': {value!r} is not a finite number")
    return number
