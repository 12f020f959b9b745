"""Compare frames in the files around a model with its links and each other."""

from __future__ import annotations

import math
from collections.abc import Iterator

from sambot_viz.checks.around.files.gazebo import (
    SENSOR_FRAMES,
    Fact,
    Plugin,
    facts,
    sensors,
)
from sambot_viz.checks.around.frames.exchanged_ends import exchanged_ends
from sambot_viz.checks.around.parameters.navigation import (
    StateFilter,
    bare_frame,
    filters,
    is_open,
)
from sambot_viz.checks.around.place import where, without_item
from sambot_viz.checks.around.running.bridge_entries import bare
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.exchanged_joint import joint_of_part
from sambot_viz.checks.rule import listed
from sambot_viz.edits import write
from sambot_viz.errors import Place, Problem, nearest
from sambot_viz.robot.model import Robot

_BASES: dict[str, tuple[str, ...]] = {
    "robot_base_frame": ("",),
    "base_frame_id": ("amcl", "collision_monitor"),
    "base_frame": ("slam_toolbox",),
}
_WHEELS = "left_wheel_names"
"""Controllers with this parameter also have a base_frame_id."""
"""Parameter for a frame of the robot → the nodes that have it; "" for any."""

_ODOMS: dict[str, tuple[str, ...]] = {
    "odom_frame_id": ("amcl", "collision_monitor"),
    "odom_frame": ("slam_toolbox",),
    "global_frame": ("local_costmap",),
    "local_frame": ("behavior_server",),
}
"""Parameter for the frame of odometry → the nodes that have it."""

DRIVE_BASES = ("robot_base_frame", "robotBaseFrame", "child_frame_id")
DRIVE_ODOMS = ("odometry_frame", "odometryFrame", "frame_id")
"""Elements in which a drive names the frame of odometry."""
_NO_BASE = frozenset({"map", "odom", "world"})
"""Frames outside the robot; sensors may report in them."""
_MISSPELT = 0.8
"""Similarity of a misspelt link; a less similar frame may have other axes."""


def unknown_frames(around: Surroundings) -> Iterator[Problem]:
    """Report frames that the robot does not have."""
    if around.namespaced:
        return
    links = around.robot.links
    named = {s.get("name") for _, s in sensors(around.robot.gazebo)}
    joints = around.robot.joints.keys()
    prefixed = {link.rpartition("/")[2] for link in links}
    for fact, user, meant in _robot_frames(around):
        name = bare_frame(fact.value)
        if (
            name in prefixed
            or is_open(name)
            or "/" in name
            or (around.said_elsewhere(name) and name not in (named | joints))
        ):
            continue
        near = _turned(name, meant, around.robot) or meant or nearest(name, links)
        near = near if near and near in links else around.robot.root
        yield Problem.at(
            fact.place,
            "warning",
            "frame-unknown",
            f"{user} uses the frame {name}, which is not a link of the model: it has "
            f"{near} ({where(links[near].place, fact.place)})",
            write(fact.place, fact.value, near)
            # Odometry can move only the root.
            if near == nearest(name, links, _MISSPELT)
            or (not meant and near == around.robot.root)
            else f"write {near}",
        )


def _turned(name: str, link: str, robot: Robot) -> str | None:
    """Return the link with the axes of a camera image at a link, for such a name."""
    for joint in robot.joints.values() if "optical" in name else ():
        quarters = [a for a in joint.origin.rpy if abs(abs(a) - math.pi / 2) < 0.01]
        if joint.parent == link and len(quarters) == 2:
            return joint.child
    return None


def _robot_frames(around: Surroundings) -> Iterator[tuple[Fact, str, str]]:
    """Yield each frame of the robot, the place that names it, and its probable link."""
    for plugin in around.plugins:
        for fact in plugin.all(*(DRIVE_BASES if plugin.is_drive else ())):
            yield fact, f"the plugin {plugin.filename}", plugin.link
        for fact in plugin.all(*(SENSOR_FRAMES if plugin.sensor else ())):
            if bare_frame(fact.value) not in _NO_BASE:
                yield fact, f"the plugin {plugin.filename}", plugin.link
    for link, sensor in sensors(around.robot.gazebo):
        named = [(fact, link) for fact in facts(sensor, *SENSOR_FRAMES)]
        for camera in sensor.find_all("camera"):
            # The frame of an image is another one than the link of the sensor.
            named += [(fact, "") for fact in facts(camera, "optical_frame_id")]
        for fact, its_link in named:
            if bare_frame(fact.value) not in _NO_BASE:
                yield fact, f"the sensor {sensor.get('name')}", its_link
    for one in filters(around):
        if "base_link_frame" in one.given:
            yield one.given["base_link_frame"].fact, one.node, ""
    drives = {p.node for p in around.parameters if p.name == _WHEELS}
    for parameter in around.parameters:
        of_drive = parameter.name == "base_frame_id" and parameter.node in drives
        if of_drive or _has(_BASES, parameter.node, parameter.name):
            yield parameter.fact, parameter.node, ""


def _has(table: dict[str, tuple[str, ...]], node: str, name: str) -> bool:
    return any(not n or n in node.split("/") for n in table.get(name, ()))


def two_parents(around: Surroundings) -> Iterator[Problem]:
    """Report a base frame that has a parent in the model and one in odometry."""
    parents = {joint.child: joint for joint in around.robot.joints.values()}
    if around.namespaced or around.robot.root in _NO_BASE:
        return
    said: set[Problem] = set()
    part = joint_of_part(around.robot)
    for fact, user, odom in _moved_bases(around):
        joint = parents.get(bare_frame(fact.value))
        if joint is not None and joint is part:
            continue
        exchanged = joint and exchanged_ends(around.robot, joint, fact, user)
        if exchanged and not said:
            said.add(exchanged)
            yield exchanged
        elif joint is not None and not exchanged:
            yield Problem.at(
                fact.place,
                "warning",
                "frame-two-parents",
                f"{user} publishes the transform from {odom} to "
                f"{joint.child}, but in the model {joint.child} hangs at "
                f"{joint.parent} ({where(joint.place, fact.place)}): a frame has only "
                "one parent, and the robot flickers between both",
                write(
                    fact.place, fact.value, around.robot.root, ", the root of the model"
                ),
            )


def _moved_bases(around: Surroundings) -> Iterator[tuple[Fact, str, str]]:
    """Yield each frame that odometry moves, the moving program and the parent frame."""
    for one in filters(around):
        base = one.given.get("base_link_frame")
        if base is not None and one.moves_base:
            yield base.fact, one.node, one.world_frame
    for plugin in around.plugins:
        fact = plugin.one(*DRIVE_BASES) if plugin.is_drive else None
        if fact is not None and drive_tf(around, plugin) is not None:
            odom = plugin.one(*DRIVE_ODOMS)
            name = bare_frame(odom.value) if odom is not None else "odom"
            yield fact, f"the plugin {plugin.filename}", name


def moved_twice(around: Surroundings) -> Iterator[Problem]:
    """Report a base that both Gazebo and robot_localization move."""
    moving = [one for one in filters(around) if one.started and one.moves_base]
    for plugin in around.plugins if moving else ():
        told = drive_tf(around, plugin) if plugin.is_drive else None
        base = plugin.one(*DRIVE_BASES)
        if told is None or base is None:
            continue
        for one in moving:
            if one.frame("base_link_frame", "base_link") != bare_frame(base.value):
                continue
            other = _line_of(one)
            yield Problem.at(
                told.place,
                "warning",
                "transform-twice",
                f"the transform from {one.world_frame} to {base.value} is published "
                f"twice: by {plugin.filename} because of this line, and by {one.node} "
                f"({where(other, told.place)}): the robot jumps between both",
                write(told.place, told.value, "false")
                if plugin.generation == "classic"
                else without_item(told.place, "delete this entry of the bridge"),
            )


def _line_of(one: StateFilter) -> Place:
    """Return the line that makes a filter publish its transform."""
    for name in ("publish_tf", "base_link_frame", "world_frame"):
        if name in one.given:
            return one.given[name].place
    return next(iter(one.given.values())).place


def odometry_frames(around: Surroundings) -> Iterator[Problem]:
    """Report odometry frames that differ from the published one."""
    published = list(_published_odoms(around))
    names = {bare_frame(fact.value): fact for fact, _ in reversed(published)}
    if around.namespaced or not names:
        return
    for fact, user in _used_odoms(around):
        name = bare_frame(fact.value)
        if name in names or is_open(name) or around.said_elsewhere(name):
            continue
        right, source = published[0]
        yield Problem.at(
            fact.place,
            "warning",
            "frame-odom",
            f"{user} takes {name} for the frame of odometry, but {source} publishes "
            f"it as {bare_frame(right.value)} ({where(right.place, fact.place)})",
            write(fact.place, fact.value, bare_frame(right.value)),
        )


def _published_odoms(around: Surroundings) -> Iterator[tuple[Fact, str]]:
    for one in filters(around):
        if one.moves_base and "odom_frame" in one.given and not _is_odd(around, one):
            yield one.given["odom_frame"].fact, one.node
    for plugin in around.plugins:
        fact = plugin.one(*DRIVE_ODOMS) if plugin.is_drive else None
        if fact is not None and drive_tf(around, plugin) is not None:
            yield fact, f"the plugin {plugin.filename}"


def _used_odoms(around: Surroundings) -> Iterator[tuple[Fact, str]]:
    maps = {one.map_frame for one in filters(around)} | {"map"}
    for parameter in around.parameters:
        if _has(_ODOMS, parameter.node, parameter.name):
            if bare_frame(parameter.fact.value) not in maps:
                yield parameter.fact, parameter.node
    for one in filters(around):
        fused = (p for p in one.inputs("odom") if one.fuses(p, range(6)))
        for plugin in around.plugins if any(fused) else ():
            fact = plugin.one(*DRIVE_ODOMS) if plugin.is_drive else None
            if fact is not None and one.started:
                yield fact, f"the plugin {plugin.filename}"


def world_frames(around: Surroundings) -> Iterator[Problem]:
    """Report a world_frame of a filter that is neither its odom nor its map frame."""
    for one in filters(around):
        world = one.given.get("world_frame")
        if world is None or one.world_frame in (one.odom_frame, one.map_frame):
            continue
        if one.odom_frame == one.map_frame:
            # Another rule decides between the two.
            continue
        other = one.given.get("odom_frame")
        if other is not None and _is_odd(around, one):
            users = [user for _, user in _used_odoms(around)]
            yield Problem.at(
                other.place,
                "warning",
                "ekf-world-frame",
                f"odom_frame is {one.odom_frame}, but world_frame is {one.world_frame} "
                f"({where(world.place, other.place)}), and so it is for "
                f"{listed(dict.fromkeys(users))}: {one.node} publishes no transform",
                write(other.place, other.fact.value, one.world_frame),
            )
            continue
        what = where(other.place, world.place) if other else "the default"
        yield Problem.at(
            world.place,
            "warning",
            "ekf-world-frame",
            f"world_frame is {one.world_frame}, but it has to be the odom_frame "
            f"{one.odom_frame} ({what}) or the map_frame {one.map_frame}: {one.node} "
            "publishes no transform",
            write(world.place, world.fact.value, one.odom_frame),
        )


def _is_odd(around: Surroundings, one: StateFilter) -> bool:
    """Return whether all others use the name in world_frame for the odometry frame."""
    if "world_frame" not in one.given:
        return False
    if one.world_frame in (one.odom_frame, one.map_frame):
        return False
    used = {bare_frame(fact.value) for fact, _ in _used_odoms(around)}
    return used == {one.world_frame}


def planes(around: Surroundings) -> Iterator[Problem]:
    """Report a file with two_d_mode in one filter and not in another.

    A single filter may use either with any sensors: two_d_mode overrules them.
    """
    first: dict[str, StateFilter] = {}
    for one in filters(around):
        if one.planar:
            first.setdefault(one.file, one)
    for one in filters(around):
        planar = first.get(one.file)
        if one.planar or planar is None:
            continue
        mode = one.given.get("two_d_mode")
        place = mode.place if mode else _line_of(one)
        other = planar.given["two_d_mode"].place
        hint = "write two_d_mode: true"
        yield Problem.at(
            place,
            "warning",
            "ekf-two-d-mode",
            f"{one.node} may leave the floor, because its two_d_mode is false"
            f"{'' if mode else ' by default'}, but that of {planar.node} is true "
            f"({where(other, place)}): the robot tilts between both",
            write(place, mode.fact.value, "true", hint=hint) if mode else hint,
        )


_ODOM_TF = ("publish_odom_tf", "publishOdomTF", "publishTf")


def drive_tf(around: Surroundings, plugin: Plugin) -> Fact | None:
    """Return the setting that makes a drive publish the transform of the base to ROS.

    A drive of Gazebo publishes it when a bridge carries its tf_topic.
    """
    if plugin.generation == "classic":
        told = plugin.one(*_ODOM_TF)
        return told if told and told.value.lower() in ("true", "1") else None
    topic = plugin.one("tf_topic")
    if topic is None:
        return None
    for entry in around.bridged:
        if bare(entry.gz.value) == bare(topic.value) and entry.kind == "Pose_V":
            if bare(entry.ros.value) == "tf" and entry.reaches_ros:
                return entry.ros
    return None
