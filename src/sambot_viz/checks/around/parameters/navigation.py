"""Find the nodes of robot_localization and Nav2 with parameters in a package."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from sambot_viz.checks.around.files.parameters import Parameter
from sambot_viz.checks.around.surroundings import Surroundings

_INPUT = re.compile(r"(odom|imu|pose|twist)\d+")
_OPEN = re.compile(r"[$<{}]")


class StateFilter(NamedTuple):
    """An ekf_node or ukf_node with its parameters.

    Attributes:
        node: its name.
        given: its parameters, by name.
        started: a launch file of the packages starts it.
        file: the file with its parameters.
    """

    node: str
    given: Mapping[str, Parameter]
    started: bool
    file: str

    def frame(self, name: str, default: str) -> str:
        """Return a frame, or the default of robot_localization for it."""
        parameter = self.given.get(name)
        return bare_frame(parameter.fact.value) if parameter else default

    @property
    def odom_frame(self) -> str:
        """The frame of odometry."""
        return self.frame("odom_frame", "odom")

    @property
    def map_frame(self) -> str:
        """The frame of the map."""
        return self.frame("map_frame", "map")

    @property
    def world_frame(self) -> str:
        """The frame in which it estimates the pose."""
        return self.frame("world_frame", self.odom_frame)

    @property
    def planar(self) -> bool:
        """True when it keeps the robot on the floor."""
        mode = self.given.get("two_d_mode")
        return mode is not None and mode.flag is True

    @property
    def moves_base(self) -> bool:
        """True when it publishes the transform to base_link_frame."""
        publishes = self.given.get("publish_tf")
        told_not = publishes is not None and publishes.flag is False
        return not told_not and self.world_frame != self.map_frame

    def inputs(self, kind: str) -> Iterator[Parameter]:
        """Yield the topics that it reads: kind is "odom", "imu", "pose" or "twist"."""
        for name, parameter in self.given.items():
            match = _INPUT.fullmatch(name)
            if match is not None and match[1] == kind:
                yield parameter

    def fuses(self, parameter: Parameter, values: range) -> bool:
        """Return whether the filter uses one of these values of an input, by number."""
        config = self.given.get(f"{parameter.name}_config")
        used = config.values if config else ()
        return any(used[i].lower() == "true" for i in values if i < len(used))


def filters(around: Surroundings) -> list[StateFilter]:
    """Return the filters of robot_localization that have parameters in the package."""
    named = {
        node.name
        for node in around.running.nodes
        if node.package == "robot_localization" and node.starts == "yes"
    }
    found: list[StateFilter] = []
    for file in around.yaml_files:
        for node in file.nodes:
            given = file.of(node)
            if any(_INPUT.fullmatch(name) for name in given):
                started = node.rpartition("/")[2] in named
                found.append(StateFilter(node, given, started, file.shown))
    return found


def bare_frame(name: str) -> str:
    """Return a frame without the leading slash that ROS 1 allowed."""
    return name.strip().lstrip("/")


def is_open(name: str) -> bool:
    """Return whether a name has a substitution, and so is not final."""
    return not name or _OPEN.search(name) is not None
