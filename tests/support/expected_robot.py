"""Compare a robot with what sdformat_urdf made of the same file."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from sambot_viz.geometry import Matrix, rotation_from_xyzw
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import (
    Box,
    Cylinder,
    Joint,
    Link,
    MeshFile,
    Origin,
    Shape,
    Sphere,
)

TOLERANCE = 1e-9


def assert_as_expected(robot: Robot, expected: dict[str, Any]) -> None:
    """Compare root, joints, links and poses; those that the file leaves out too."""
    assert robot.root == expected["root"]
    if "count" in expected:
        assert len(robot.links) == expected["count"]["links"]
        assert len(robot.joints) == expected["count"]["joints"]
    assert set(robot.joints) == set(expected.get("joints", {}))
    for name, joint in expected.get("joints", {}).items():
        _assert_joint(robot.joints[name], joint)
    for name, link in robot.links.items():
        _assert_link(link, expected.get("links", {}).get(name, {}))
    poses = robot.forward_kinematics({name: 0.0 for name in robot.joint_names})
    for name, rows in expected.get("T_root_link", {}).items():
        np.testing.assert_allclose(
            poses[name][:3].ravel(), rows, atol=TOLERANCE, err_msg=name
        )


def _assert_joint(joint: Joint, expected: dict[str, Any]) -> None:
    assert joint.type == expected["type"]
    assert (joint.parent, joint.child) == (expected["parent"], expected["child"])
    _assert_pose(joint.origin, expected["origin"])
    if "axis" in expected:
        np.testing.assert_allclose(joint.axis, expected["axis"], atol=TOLERANCE)
    assert (joint.limit is None) == ("limit" not in expected)
    for name, value in expected.get("limit", {}).items():
        np.testing.assert_allclose(getattr(joint.limit, name), value, rtol=1e-11)
    if "dynamics" in expected:
        assert joint.dynamics is not None
        for name, value in expected["dynamics"].items():
            assert getattr(joint.dynamics, name) == value


def _assert_link(link: Link, expected: dict[str, Any]) -> None:
    assert link.inertial is not None
    assert link.inertial.mass == expected.get("mass", 1)
    for shapes, key in ((link.visuals, "visuals"), (link.collisions, "collisions")):
        wanted = expected.get(key, [])
        assert [shape.name for shape in shapes] == [one["name"] for one in wanted]
        for shape, one in zip(shapes, wanted, strict=True):
            _assert_shape(shape, one)


def _assert_shape(shape: Shape, expected: dict[str, Any]) -> None:
    _assert_pose(shape.origin, expected["origin"])
    if shape.material is None:
        assert "rgba" not in expected
    else:
        assert shape.material.rgba is not None
        rgba = np.array(shape.material.rgba)
        np.testing.assert_allclose(rgba, expected["rgba"], atol=TOLERANCE)
    geometry = shape.geometry
    match geometry:
        case Box(size):
            numbers, wanted = size, expected["box"]
        case Sphere(radius):
            numbers, wanted = (radius,), [expected["sphere"]["radius"]]
        case Cylinder(radius, length):
            solid = expected["cylinder"]
            numbers, wanted = (radius, length), [solid["radius"], solid["length"]]
        case MeshFile(filename, scale):
            assert filename == expected["mesh"]
            numbers, wanted = scale, expected["scale"]
        case _:
            raise AssertionError(geometry)
    # A length that is no number cannot be drawn: it is shown as 0, with a warning.
    wanted = [0.0 if math.isnan(number) else number for number in wanted]
    np.testing.assert_allclose(numbers, wanted, atol=TOLERANCE)


def _assert_pose(origin: Origin, expected: list[float]) -> None:
    wanted: Matrix = np.eye(4)
    wanted[:3, 3] = expected[:3]
    x, y, z, w = expected[3:]
    if any((x, y, z, w)):
        # ROS keeps a quaternion of another length, which means the same rotation.
        wanted[:3, :3] = rotation_from_xyzw((x, y, z, w))
    np.testing.assert_allclose(origin.matrix, wanted, atol=TOLERANCE)
