"""The joints of an Effort display: which there are, their boxes and their circles."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from sambot_viz.displays.data.cloud.colors import rainbow
from sambot_viz.displays.display import EntryList, numbers
from sambot_viz.displays.scene.rings import Ring
from sambot_viz.geometry import Matrix, rotation_from_xyzw, wxyz_from_z
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint
from sambot_viz.rviz import BoolProperty, DisplayConfig, EntryItem

JOINTS = "Joints"
BOX = "Value"
_PROPERTIES = (BoolProperty(BOX, default=True, help="Show the effort of the joint."),)
_LISTED = ("revolute", "continuous")
_POINTS = 30
"""Of each circle: from 33.75° to 360°."""


class EffortJoints:
    """The joints of a robot that have an effort and a limit of it.

    Args:
        config: the display.
        robot: whose joints they are.

    Attributes:
        joints: name → joint, in the order of the alphabet, as RViz lists them.
        efforts: name → what the newest message said [N m].
    """

    def __init__(self, config: DisplayConfig, robot: Robot) -> None:
        self._config = config
        self._items: dict[str, EntryItem] = {}
        self.joints = {
            name: joint
            for name, joint in sorted(robot.joints.items())
            if joint.type in _LISTED and joint.limit is not None
        }
        self.efforts: dict[str, float] = {}

    def is_on(self, name: str) -> bool:
        """Return whether the box of a joint is ticked."""
        return bool(self._item(name).get(BOX))

    def entries(self) -> EntryList:
        """Return the rows of the joints."""

        def set_box(name: str, path: str, value: Any) -> Any:
            return self._item(name).set(path, value)

        return EntryList(
            JOINTS, "joint", tuple(self.joints), self._item, set_box, self._facts
        )

    def _item(self, name: str) -> EntryItem:
        found = self._items.get(name)
        if found is None:
            found = EntryItem(self._config, (JOINTS, name), _PROPERTIES)
            self._items[name] = found
        return found

    def _facts(self, name: str) -> Mapping[str, str]:
        effort = self.efforts.get(name)
        return {
            "Effort": "none yet" if effort is None else numbers((effort,)),
            "Max Effort": numbers((max_effort(self.joints[name]),)),
        }


def max_effort(joint: Joint) -> float:
    """Return the limit of the effort of a joint [N m]; 0 where there is none."""
    return 0.0 if joint.limit is None else joint.limit.effort


@dataclass(frozen=True, slots=True, eq=False)
class JointEffort:
    """The effort of a joint at one time.

    Attributes:
        joint: its name.
        effort: [N m].
        most: the limit of it, 0 for none [N m].
        T_fixed_ring: (4, 4), its circle is in the plane of x and y of this.
    """

    joint: str
    effort: float
    most: float
    T_fixed_ring: Matrix

    def ring(self, scale: float, width: float) -> Ring:
        """Return its circle.

        Args:
            scale: how large it is.
            width: of its line [m].
        """
        size = abs(self.effort)
        if self.most > 0.0:
            size = min(size / self.most, 1.0)
        size += 0.05
        radius = 0.05 + size * scale / 2
        way = 1.0 if self.effort > 0.0 else -1.0
        x, y = self.T_fixed_ring[:3, 0], self.T_fixed_ring[:3, 1]
        red, green, blue = rainbow(np.array([size]))[0].tolist()
        return Ring(
            self.T_fixed_ring[:3, 3],
            y * radius,
            x * (-way * radius),
            _POINTS,
            (2 * width, 4 * width),
            (red, green, blue),
            1.0,
        )


def placed_ring(joint: Joint, T_fixed_link: Matrix) -> Matrix:
    """Return the pose of the circle of a joint, T_fixed_ring, (4, 4).

    RViz turns the axis of the joint into z, where z should be turned into the axis: the
    circle is about the axis with x and y negated, and about z for one along −z.

    Args:
        joint: the joint.
        T_fixed_link: (4, 4), of its child link.
    """
    x, y, _ = joint.axis
    T = np.array(T_fixed_link)
    if x or y:
        w, *xyz = wxyz_from_z(joint.axis)
        R = np.array(rotation_from_xyzw((xyz[0], xyz[1], xyz[2], w)))
        T[:3, :3] = T[:3, :3] @ np.transpose(R)
    return T
