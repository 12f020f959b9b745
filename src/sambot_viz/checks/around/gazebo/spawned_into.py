"""Report a robot that is put into Gazebo where another model stands."""

from __future__ import annotations

import math
from collections.abc import Iterator

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.gazebo.spawning import spawned_with
from sambot_viz.checks.around.gazebo.world_systems import elements_of_worlds
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.errors import Problem
from sambot_viz.geometry import PlainPose, Vector3, xyzw_from_rpy
from sambot_viz.robot.xml.element import Element

_CLEAR = 0.1
"""Depth at which a point counts as inside a shape [m]; Gazebo pushes a robot out of a
thick floor."""


def spawned_into(around: Surroundings) -> Iterator[Problem]:
    """Report models whose collision shapes contain the pose of a spawned robot.

    Only the models of the world file itself: included ones are in other files.
    """
    spawns = list(_spawns(around))
    worlds = elements_of_worlds(around) if spawns else ()
    for world in worlds:
        for model in world.children if world.tag == "world" else ():
            if model.tag != "model":
                continue
            for fact, at in spawns:
                if any(_is_in(at, model, shape) for shape in _shapes(model)):
                    name, place = model.get("name"), (model.find("pose") or model).place
                    there = " ".join(f"{value:g}" for value in at)
                    yield Problem.at(
                        place,
                        "warning",
                        "world-value",
                        f"the model {name} stands where the robot is spawned, at "
                        f"{there} ({where(fact.place, place)}): they push each other "
                        "away, or the robot is stuck in it",
                        f"move {name} by its <pose>, or give the robot another -x and "
                        "-y",
                    )
                    break


def _spawns(around: Surroundings) -> Iterator[tuple[Fact, Vector3]]:
    """Yield where launch files spawn the robot, each with one of its numbers."""
    for launch in around.launches:
        given = [list(spawned_with(launch, axis)) for axis in "xyz"]
        # Of several robots it is not known which numbers belong together.
        if not any(given) or any(len(facts) > 1 for facts in given):
            continue
        numbers = [facts[0].number if facts else 0.0 for facts in given]
        x, y, z = (math.nan if number is None else number for number in numbers)
        if not math.isnan(x + y + z):
            yield next(facts[0] for facts in given if facts), (x, y, z)


def _shapes(model: Element) -> Iterator[tuple[PlainPose, Element]]:
    """Yield the collision shapes of a model, each with its pose in the world."""
    for link in model.find_all("link"):
        for collision in link.find_all("collision"):
            poses = [_pose(element) for element in (model, link, collision)]
            geometry = collision.find("geometry")
            for shape in geometry.children if geometry is not None else ():
                T_world_model, T_model_link, T_link_shape = poses
                if T_world_model and T_model_link and T_link_shape:
                    yield T_world_model @ T_model_link @ T_link_shape, shape


def _pose(element: Element) -> PlainPose | None:
    """Return the pose of an element; None for one that is relative to another."""
    pose = element.find("pose")
    if pose is None or not pose.text.strip():
        return PlainPose()
    try:
        x, y, z, *rpy = map(float, pose.text.split())
        roll, pitch, yaw = rpy
    except ValueError:
        return None
    return (
        None
        if pose.attributes
        else PlainPose(xyzw_from_rpy(roll, pitch, yaw), (x, y, z))
    )


def _is_in(point: Vector3, model: Element, placed: tuple[PlainPose, Element]) -> bool:
    """Return whether a point of the world is clearly inside a shape."""
    T_world_shape, shape = placed
    x, y, z = map(abs, T_world_shape.inverse().of(point))
    try:
        if shape.tag == "box":
            size = shape.find("size")
            a, b, c = (float(edge) / 2 for edge in (size or model).text.split())
            return min(a - x, b - y, c - z) > _CLEAR
        if shape.tag not in ("cylinder", "sphere"):
            return False
        radius = float((shape.find("radius") or model).text)
        if shape.tag == "sphere":
            return radius - math.hypot(x, y, z) > _CLEAR
        half = float((shape.find("length") or model).text) / 2
        return min(radius - math.hypot(x, y), half - z) > _CLEAR
    except ValueError:
        return False
