"""A pose explained step by step, and its absence explained in words."""

from __future__ import annotations

import math

import pytest
from close import is_close

from sambot_viz.frames import FrameTree, LookupRefused, Transform
from sambot_viz.frames.robot_frames import distance_between, explain, robot_frames
from sambot_viz.robot.model import Robot


def test_the_hops_lead_from_the_source_to_the_target(robot: Robot) -> None:
    found = explain(robot_frames(robot), "wheel", "lamp", robot)
    assert [hop.words for hop in found.hops] == [
        "lamp is a child of mast (fixed joint lamp_joint)",
        "mast is a child of base_link (fixed joint mast_joint)",
        "base_link is the parent of wheel (continuous joint wheel_joint)",
    ]
    assert [(hop.start, hop.end, hop.static) for hop in found.hops] == [
        ("lamp", "mast", True),
        ("mast", "base_link", True),
        ("base_link", "wheel", False),
    ]
    assert found.reason == ""


def test_the_product_of_the_hops_is_the_answer(robot: Robot) -> None:
    tree = robot_frames(robot, {"wheel_joint": 0.7})
    found = explain(tree, "wheel", "lamp", robot)
    product = Transform.identity()
    for hop in found.hops:
        product = hop.step @ product
    assert found.transform is not None
    assert is_close(product, found.transform, 1e-15)
    assert found.transform == tree.lookup("wheel", "lamp")


def test_a_transform_without_a_joint_is_named_for_what_it_is(robot: Robot) -> None:
    tree = robot_frames(robot)
    tree.set_static("base_link", "base_laser", Transform.from_xyz_rpy((0.1, 0, 0.2)))
    tree.set("odom", "base_link", Transform.identity())
    found = explain(tree, "/odom", "/base_laser", robot)
    assert (found.target, found.source) == ("odom", "base_laser")
    assert [hop.words for hop in found.hops] == [
        "base_laser is a child of base_link (static transform)",
        "base_link is a child of odom (transform)",
    ]


def test_a_frame_in_itself_needs_no_hop() -> None:
    found = explain(FrameTree(), "base_link", "base_link")
    assert (found.hops, found.transform) == ((), Transform.identity())


def test_an_unknown_frame_is_told_with_its_neighbour(robot: Robot) -> None:
    found = explain(robot_frames(robot), "base_link", "lampe", robot)
    assert found.transform is None
    assert found.reason == "no frame 'lampe'; did you mean 'lamp'?"
    assert found.refused is not None
    assert found.refused.rviz_text == "For frame [lampe]: Frame [lampe] does not exist"


def test_without_any_frame_that_is_the_reason() -> None:
    found = explain(FrameTree(), "map", "base_link")
    assert found.reason == "there are no frames at all, so 'map' is not known"


def test_separate_trees_are_told_with_their_roots(robot: Robot) -> None:
    tree = robot_frames(robot)
    tree.set_static("camera", "lens", Transform.identity())
    assert explain(tree, "lamp", "lens", robot).reason == (
        "'lens' belongs to the tree below 'camera', 'lamp' to the tree below "
        "'base_link', and no transform joins the two; add one from a frame of the one "
        "tree to the root of the other"
    )


@pytest.mark.parametrize(
    ("target", "source"), [("base_link", "flag"), ("flag", "base_link")]
)
def test_a_floating_joint_is_the_reason_for_what_hangs_below_it(
    robot: Robot, target: str, source: str
) -> None:
    assert explain(robot_frames(robot), target, source, robot).reason == (
        "'flag' is below 'buoy', which is held by the floating joint 'buoy_joint', "
        "and ROS publishes no transform for it; something else has to say where "
        "'buoy' is in 'base_link'"
    )


def test_a_floating_joint_is_the_reason_for_its_own_child(robot: Robot) -> None:
    tree = robot_frames(robot)
    tree.remove("flag")
    assert explain(tree, "base_link", "buoy", robot).reason.startswith(
        "'buoy' is held by the floating joint 'buoy_joint', and ROS publishes"
    )


def test_the_offset_is_along_the_axes_of_the_first_frame() -> None:
    tree = FrameTree()
    quarter = (0.0, 0.0, math.pi / 2)
    tree.set_static("base", "left", Transform.from_xyz_rpy((0, 0.2, 0.1), quarter))
    tree.set_static("base", "right", Transform.from_xyz_rpy((0.3, -0.2, 0.1)))
    found = distance_between(tree, "left", "right")
    assert found.length == pytest.approx(0.5)
    assert found.offset == pytest.approx((-0.4, -0.3, 0.0))
    back = distance_between(tree, "right", "left")
    assert back.length == pytest.approx(0.5)
    assert back.offset == pytest.approx((-0.3, 0.4, 0.0))


def test_frames_without_a_connection_are_refused() -> None:
    tree = FrameTree()
    tree.set_static("base", "left", Transform.from_xyz_rpy((0, 0.2, 0.1)))
    with pytest.raises(LookupRefused, match="nowhere"):
        distance_between(tree, "left", "nowhere")
