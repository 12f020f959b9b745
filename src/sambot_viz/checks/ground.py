"""Wheels that do not stand on the ground plane of base_footprint."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from sambot_viz.checks.rule import Finding, Rule, Subject
from sambot_viz.geometry import Matrix
from sambot_viz.robot.model import Cylinder, Joint, Link, Sphere

_SMALLEST = 0.003
_SHARE_OF_RADIUS = 0.05


def _ground(subject: Subject) -> Iterator[Finding]:
    robot = subject.robot
    if robot is None:
        return
    footprint = next((n for n in robot.links if n.endswith("base_footprint")), None)
    if footprint is None:
        return
    poses = robot.forward_kinematics()
    T_footprint_root = np.linalg.inv(poses[footprint])
    for joint in robot.joints.values():
        link = robot.links[joint.child]
        round_part = _wheel(joint, link, T_footprint_root @ poses[link.name])
        if round_part is None:
            continue
        lowest, radius = round_part
        if abs(lowest) <= max(_SMALLEST, _SHARE_OF_RADIUS * radius):
            continue
        where = "above" if lowest > 0 else "below"
        yield Finding(
            f"the wheel {link.name} ends {abs(lowest):.3g} m {where} the ground: "
            f"{footprint} should lie where the wheels touch the floor",
            f"move {footprint} by {-lowest if lowest < 0 else lowest:.3g} m "
            f"{'up' if lowest > 0 else 'down'}, or correct the height or radius of the "
            "wheel",
            joint.place,
        )


def _wheel(
    joint: Joint, link: Link, T_footprint_link: Matrix
) -> tuple[float, float] | None:
    """Height of the lowest point [m] and radius [m] of a wheel, else None.

    A wheel turns without end about a level axis, and is a sphere or a cylinder
    about that axis. Wheels that are meshes are not judged.
    """
    if joint.type != "continuous":
        return None
    axis = T_footprint_link[:3, :3] @ np.array(joint.axis)
    if abs(axis[2]) > 0.1:
        return None
    for shape in (*link.collisions, *link.visuals):
        T = T_footprint_link @ shape.origin.matrix
        geometry = shape.geometry
        if isinstance(geometry, Sphere):
            return float(T[2, 3]) - geometry.radius, geometry.radius
        if isinstance(geometry, Cylinder) and abs(float(T[:3, 2] @ axis)) > 0.99:
            return float(T[2, 3]) - geometry.radius, geometry.radius
    return None


WHEEL_NOT_ON_GROUND = Rule(
    code="wheel-not-on-ground",
    severity="warning",
    title="A wheel that does not touch the ground",
    why="base_footprint is the robot's shadow on the floor: navigation places it at "
    "height 0. A wheel above it floats, a wheel below it is sunk in the floor.",
    example="""\
<robot name="r">
  <link name="base_footprint"/>
  <link name="wheel">
    <visual>
      <origin rpy="1.5708 0 0"/>
      <geometry><cylinder radius="0.1" length="0.02"/></geometry>
    </visual>
  </link>
  <joint name="wheel_joint" type="continuous">
    <parent link="base_footprint"/>
    <child link="wheel"/>
    <origin xyz="0 0.2 0.05"/>
    <axis xyz="0 1 0"/>
  </joint>
</robot>
""",
    find=_ground,
)
