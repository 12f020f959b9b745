"""The facts about a selected link or frame."""

from __future__ import annotations

import math
from collections.abc import Iterator

from sambot_viz.displays.picking.selected import Fact
from sambot_viz.errors import Place
from sambot_viz.frames import FrameTree, LookupRefused
from sambot_viz.panels.frames.frame_answer import shown_numbers
from sambot_viz.robot.parts import Box, Geometry, Joint, Link, MeshFile, Sphere
from sambot_viz.session.robot.robot_state import RobotState


def facts_of(tree: FrameTree, robot: RobotState, name: str, frame: str) -> list[Fact]:
    """Return the facts about a link or frame.

    Args:
        tree: the tree of frames.
        robot: the shown robot.
        name: the link or frame.
        frame: the frame in which its pose is given.
    """
    return [
        *_pose(tree, name, frame),
        *_relations(tree, name),
        *_written(robot, name),
    ]


def _pose(tree: FrameTree, name: str, frame: str) -> Iterator[Fact]:
    try:
        transform = tree.lookup(frame, name)
    except LookupRefused as refused:
        yield "Pose", refused.rviz_text
        return
    rpy = transform.rpy
    yield "Position", f"{shown_numbers(transform.translation.tolist())} m"
    yield "Orientation", f"{shown_numbers(transform.rotation_xyzw.tolist())} (xyzw)"
    degrees = shown_numbers([math.degrees(angle) for angle in rpy], 3)
    yield "RPY", f"{shown_numbers(rpy)} rad ({degrees} °)"


def _relations(tree: FrameTree, name: str) -> Iterator[Fact]:
    parent = tree.parent(name) if name in tree.frames else None
    if parent is not None:
        yield "Parent", parent
    if children := tree.children(name):
        yield "Children", ", ".join(children)


def _written(shown: RobotState, name: str) -> Iterator[Fact]:
    """Yield what the model file says about a link, and where."""
    robot = shown.model
    link = None if robot is None else robot.links.get(name)
    if robot is None or link is None:
        return
    for joint in robot.joints.values():
        if joint.child == name:
            yield from _joint(shown, joint)
    below = [joint.name for joint in robot.joints.values() if joint.parent == name]
    if below:
        yield "Child joints", ", ".join(below)
    yield from _link(link)


def _link(link: Link) -> Iterator[Fact]:
    for title, shapes in (("Visual", link.visuals), ("Collision", link.collisions)):
        for shape in shapes:
            at = "" if shape.place is None else f", {place_text(shape.place)}"
            yield title, f"{geometry_text(shape.geometry)}{at}"
    if link.inertial is not None:
        yield "Mass", f"{link.inertial.mass:.5g} kg"
    if link.place is not None:
        yield "Defined at", place_text(link.place)


def _joint(robot: RobotState, joint: Joint) -> Iterator[Fact]:
    at = "" if joint.place is None else f", {place_text(joint.place)}"
    yield "Joint", f"{joint.name} ({joint.type}){at}"
    if not joint.movable or robot.joints is None:
        return
    unit = "m" if joint.type == "prismatic" else "rad"
    position = robot.joints.all_positions().get(joint.name, joint.start)
    lower, upper = joint.range
    limits = f"{lower:.5g} … {upper:.5g}"
    if joint.endless:
        limits = "no limits"
    yield "Joint position", f"{position:.5g} {unit}, {limits}"
    yield "Joint axis", shown_numbers(joint.axis)


def geometry_text(geometry: Geometry) -> str:
    """Return a shape in a few words, such as "Box 0.42; 0.31; 0.18 m"."""
    if isinstance(geometry, MeshFile):
        return f"Mesh {geometry.filename}"
    if isinstance(geometry, Box):
        return f"Box {shown_numbers(geometry.size)} m"
    if isinstance(geometry, Sphere):
        return f"Sphere of radius {geometry.radius:.5g} m"
    kind = type(geometry).__name__
    return f"{kind} of radius {geometry.radius:.5g} m, length {geometry.length:.5g} m"


def place_text(place: Place) -> str:
    """Return a place as file:line, with the name of the file alone."""
    return f"{place.file.rpartition('/')[2]}:{place.line}"
