"""The links of a reference to draw as a ghost beside a robot, and their places.

The ghost omits a link with the same look and place as the robot's: it would only cover
the robot. A link hangs below one of the robot's links if both robots have that link at
the same place for all joint positions, so that it moves with the robot. Otherwise it
hangs by its own joint.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from sambot_viz.geometry import Matrix
from sambot_viz.matrices import inverse_matrix
from sambot_viz.robot.difference import same_shapes
from sambot_viz.robot.joint_tree import free_positions
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint, Link

_MOVED = (None, 0.3, -0.7)
"""Places are compared at the start, and with all joints moved this far [rad or m]."""
_SAME = 1e-6
"""Poses whose numbers differ by less are equal."""


@dataclass(frozen=True, slots=True)
class GhostLink:
    """A link of a reference, and its parent.

    Attributes:
        link: the reference's link.
        above: link that it hangs below.
        of_ghost: whether `above` belongs to the ghost, not to the robot.
        joint: joint that holds it; None where the matrix does.
        T_above_link: (4, 4), without a joint.
        drawn: whether its shapes are drawn; otherwise it only holds others.
    """

    link: Link
    above: str
    of_ghost: bool = False
    joint: Joint | None = None
    T_above_link: Matrix = field(default_factory=lambda: np.eye(4), compare=False)
    drawn: bool = True


def ghost_links(mine: Robot, theirs: Robot) -> list[GhostLink]:
    """Return the drawn links of a reference, each after the link that holds it.

    The two robots meet at the robot's root link; at the reference's root if only that
    is a link of both; otherwise root at root.

    Args:
        mine: the robot.
        theirs: the reference.
    """
    ends = _ends(mine, theirs)
    same = _same_places(mine, theirs, ends)
    joints = {joint.child: joint for joint in theirs.joints.values()}
    needed: set[str] = set()
    found: list[GhostLink] = []
    # Parents come first in the kinematics.
    for name in reversed(theirs.kinematics.links):
        link, own = theirs.links[name], mine.links.get(name)
        is_there = name in same
        looks_alike = own is not None and same_shapes(own, link)
        drawn = bool(link.visuals) and not (is_there and looks_alike)
        if not drawn and (is_there or name not in needed):
            continue
        joint = joints.get(name)
        if is_there:
            found.append(GhostLink(link, name))
        elif joint is None:
            T_end_root = inverse_matrix(theirs.forward_kinematics()[ends[1]])
            found.append(GhostLink(link, ends[0], False, None, T_end_root, drawn))
        else:
            of_ghost = joint.parent not in same
            needed.update({joint.parent} if of_ghost else ())
            found.append(GhostLink(link, joint.parent, of_ghost, joint, drawn=drawn))
    return found[::-1]


def _ends(mine: Robot, theirs: Robot) -> tuple[str, str]:
    """Return the link of each robot that lies at the other's place."""
    for root in (mine.root, theirs.root):
        if root in mine.links and root in theirs.links:
            return root, root
    return mine.root, theirs.root


def _same_places(mine: Robot, theirs: Robot, ends: tuple[str, str]) -> set[str]:
    """Return the links that share a place in both robots, for all joint positions."""
    same = mine.links.keys() & theirs.links.keys()
    for far in _MOVED:
        given = dict[str, float]() if far is None else _moved(mine, far)
        places = [
            _places(robot, end, given)
            for robot, end in zip((mine, theirs), ends, strict=True)
        ]
        same = {n for n in same if np.allclose(*(p[n] for p in places), 0.0, _SAME)}
    return same


def _moved(robot: Robot, far: float) -> dict[str, float]:
    """Return positions that differ from joint to joint."""
    return {n: far * (1.0 + 0.1 * i) for i, n in enumerate(robot.joints)}


def _places(robot: Robot, end: str, given: Mapping[str, float]) -> dict[str, Matrix]:
    """Return the poses of all links in one of them: (4, 4) T_end_link."""
    poses = robot.kinematics.forward(free_positions(robot, given))
    T_end_root = inverse_matrix(poses[end])
    return {name: T_end_root @ T for name, T in poses.items()}
