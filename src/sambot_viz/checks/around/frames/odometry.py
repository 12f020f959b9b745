"""Check the transform from odometry to the base, which one node must publish."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from sambot_viz.checks.around.files.gazebo import Plugin
from sambot_viz.checks.around.files.parameters import Parameter
from sambot_viz.checks.around.frames.names import drive_tf
from sambot_viz.checks.around.parameters.navigation import (
    StateFilter,
    bare_frame,
    filters,
    is_open,
)
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.bridge_entries import bare
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import write
from sambot_viz.errors import Fix, Place, Problem

_FRAMES = {"map_frame": "map", "odom_frame": "odom", "base_link_frame": "base_link"}
"""Frames of a filter, all different → their defaults."""


def unpublished_odometry(around: Surroundings) -> Iterator[Problem]:
    """Report an odometry frame that nodes need and no node publishes.

    The finding is at the parameter that stops a filter from publishing it, where only
    that filter could; else at the first node that needs it.
    """
    if around.namespaced or _others_publish(around):
        return
    started = [one for one in filters(around) if one.started]
    twice = _maps_twice(around, started[0]) if len(started) == 1 else None
    if twice is not None:
        yield twice
        return
    if not around.simulates_only_known:
        return
    for one in started[:1] if len(started) == 1 else ():
        user, found = _user(around, one.odom_frame), _reason(one)
        is_shared = one.odom_frame == one.map_frame
        if user is None or found is None or one.moves_base or is_shared:
            return
        reason, hint = found
        base = one.frame("base_link_frame", "base_link")
        user_name = user.node.rpartition("/")[2]
        yield Problem.at(
            reason.value_place,
            "warning",
            "odometry-unpublished",
            f"no node publishes the transform from {one.odom_frame} to {base}, which "
            f"{user_name} needs ({where(user.place, reason.place)}): {one.node} does "
            f"not, because {reason.name} is {reason.fact.value}",
            hint,
        )
    if not started:
        yield from _without_filter(around)


def _maps_twice(around: Surroundings, one: StateFilter) -> Problem | None:
    """Report a filter in the frame of the map, beside a node that localizes there."""
    world = one.given.get("world_frame")
    running = [node for node in around.running.started if node.starts == "yes"]
    sent = {
        (each.parent, each.child): node
        for node in running
        for each in node.transforms
        if node.package != "robot_localization"
    }
    other = sent.get((one.map_frame, one.odom_frame))
    has_odometry = any(parent == one.odom_frame for parent, _ in sent)
    if world is None or one.world_frame != one.map_frame or other is None:
        return None
    if has_odometry or one.odom_frame == one.map_frame:
        return None
    base = one.frame("base_link_frame", "base_link")
    return Problem.at(
        world.value_place,
        "warning",
        "odometry-unpublished",
        f"{one.node} publishes the transform from {one.map_frame} to {one.odom_frame}, "
        f"because world_frame is {world.fact.value}, but {other.name} "
        f"({where(other.place, world.place)}) does so too, and no node publishes that "
        f"from {one.odom_frame} to {base}",
        write(world.place, world.fact.value, one.odom_frame),
    )


def _without_filter(around: Surroundings) -> Iterator[Problem]:
    running = [node for node in around.running.started if node.starts == "yes"]
    published = {one.parent for node in running for one in node.transforms}
    # A map below the frame of odometry is useless without it.
    known = {*around.links, *(published - {"map"})}
    for node in running:
        for need in node.needs:
            if need.name in known or around.said_elsewhere(need.name):
                continue
            yield Problem.at(
                need.place,
                "warning",
                "odometry-unpublished",
                f"no node publishes the transform from {need.name} to "
                f"{around.robot.root}, which {node.name} needs",
                "start ekf_node of robot_localization, or let the bridge carry the "
                "<tf_topic> of the drive to /tf",
            )
            return


def _reason(one: StateFilter) -> tuple[Parameter, Fix] | None:
    publishes, world = one.given.get("publish_tf"), one.given.get("world_frame")
    if publishes is not None and publishes.flag is False:
        return publishes, write(publishes.value_place, publishes.fact.value, "true")
    if world is None:
        return None
    return world, write(world.place, world.fact.value, one.odom_frame)


def _user(around: Surroundings, odom: str) -> Parameter | None:
    """Return the parameter of a local costmap in the frame of odometry."""
    for parameter in around.parameters:
        if parameter.name == "global_frame" and "local_costmap" in parameter.node:
            if bare_frame(parameter.fact.value) == odom:
                return parameter
    return None


def _others_publish(around: Surroundings) -> bool:
    if any(_may_publish(around, plugin) for plugin in around.plugins):
        return True
    return any(
        entry.kind == "Pose_V" and bare(entry.ros.value) in ("tf", "tf_static")
        for entry in around.bridged
    )


def _may_publish(around: Surroundings, plugin: Plugin) -> bool:
    if plugin.is_drive:
        return drive_tf(around, plugin) is not None
    return plugin.generation != "gz" and "planar" in plugin.filename


def frames_from_themselves(around: Surroundings) -> Iterator[Problem]:
    """Report transforms from a frame to itself, by parameters that name it twice."""
    shared = shared_frames(around)
    done = {Place(p.file or "", p.line or 0, p.column) for p in shared}
    for node in around.running.started:
        for one in node.transforms:
            if one.parent == one.child and one.place not in done:
                done.add(one.place)
                yield Problem.at(
                    one.place,
                    "warning",
                    "frame-two-parents",
                    f"{node.path.strip('/')} publishes the transform from {one.parent} "
                    "to itself, which tf refuses: two of its frames have one name",
                    "write another frame for one of the two",
                )


def shared_frames(around: Surroundings) -> Iterator[Problem]:
    """Report a filter with one name for two of its three frames."""
    for one in filters(around):
        for (first, usual), (second, other) in combinations(_FRAMES.items(), 2):
            frame = one.frame(first, usual)
            if is_open(frame) or frame != one.frame(second, other):
                continue
            names = [n for n in (second, first) if n in one.given]
            # The frame without its usual name is the changed one.
            names.sort(key=lambda name: one.frame(name, "") == _FRAMES[name])
            wrong = one.given[names[0]]
            yield Problem.at(
                wrong.value_place,
                "warning",
                "ekf-world-frame",
                f"{first} and {second} are both {frame}, and {one.node} needs two "
                "frames: it publishes no transform",
                write(wrong.value_place, wrong.fact.value, _FRAMES[names[0]]),
            )
