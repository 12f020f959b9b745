"""Combine a model with the files of the packages around it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from sambot_viz.cached import cached_property
from sambot_viz.checks.around.files.cmake import CMakeFile
from sambot_viz.checks.around.files.gazebo import Plugin, plugins
from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.files.parameters import Parameter, YamlFile
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.ownership import Ownership, ownership
from sambot_viz.checks.around.running.assemble import system_of
from sambot_viz.checks.around.running.bridge_entries import BridgeEntry
from sambot_viz.checks.around.running.endpoints import entries_of
from sambot_viz.checks.around.running.simulated import simulated
from sambot_viz.checks.around.running.system import RunningSystem
from sambot_viz.checks.around.workspace import Package
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Link
from sambot_viz.robot.xml.element import Element

if TYPE_CHECKING:
    from sambot_viz.checks.around.setup_file import SetupFile

_SOURCES = (".py", ".cpp", ".hpp", ".h", ".ino", ".xml", ".lua")
_MODELS = (".xacro", ".urdf", ".sdf", ".gazebo")
_PARAMETERS = (".yaml", ".yml")
_AS_TOPIC = r"(?<!frame)(?<!frame_id)[\"'> ]/?"


@dataclass(frozen=True, eq=False)
class Surroundings:
    """A robot, and the packages that belong to it.

    Attributes:
        known: the robot; None for packages without one.
        packages: first the model's, then those that start it or have its parameters.
        left_out: parameter files and launch files of other robots.
    """

    known: Robot | None
    packages: tuple[Package, ...]
    left_out: frozenset[str] = frozenset()

    @property
    def robot(self) -> Robot:
        """The robot, for rules that run only with one."""
        if self.known is None:
            raise LookupError("these packages are checked without a robot")
        return self.known

    @property
    def links(self) -> Mapping[str, Link]:
        """The links of the robot; empty without one."""
        return self.known.links if self.known is not None else {}

    @property
    def files(self) -> Package:
        """The package, for rules that look at one at a time."""
        return self.packages[0]

    @cached_property
    def ownership(self) -> Ownership:
        """The files that belong to this robot, or to others of the packages."""
        if self.known is None:
            return Ownership()
        return ownership(self.known, self.packages)

    @cached_property
    def of_robot(self) -> Surroundings:
        """The robot with the files that belong to it, or may."""
        foreign = self.ownership.foreign - self.left_out
        return replace(self, left_out=self.ownership.foreign) if foreign else self

    @cached_property
    def plugins(self) -> tuple[Plugin, ...]:
        """The Gazebo plugins of the model."""
        return tuple(plugins(self.known.gazebo if self.known is not None else ()))

    @cached_property
    def launches(self) -> tuple[LaunchFile, ...]:
        """The Python launch files."""
        files = (file for each in self.packages for file in each.launches)
        return tuple(file for file in files if file.shown not in self.left_out)

    @cached_property
    def running(self) -> RunningSystem:
        """The system that the launch files start."""
        packages = {package.name: package for package in self.packages}
        files = [
            (each, path)
            for each in self.packages
            for path in each.launch_paths
            if each.shown(path) not in self.left_out
        ]
        parts = self.known.gazebo if self.known is not None else ()
        return system_of(
            files,
            self.packages,
            packages.get,
            simulated=simulated(parts),
            left_out=self.left_out,
        )

    @cached_property
    def bridged(self) -> tuple[BridgeEntry, ...]:
        """The topics that bridges between Gazebo and ROS carry."""
        packages = {package.name: package for package in self.packages}
        found = (
            entry
            for node in self.running.started
            if node.is_bridge
            for entry in entries_of(node, packages.get)
        )
        return tuple(dict.fromkeys(found))

    @property
    def simulates_only_known(self) -> bool:
        """True when Gazebo starts, and no nodes with unknown topics."""
        return self.running.simulates and self.running.is_known

    def launch_texts(self) -> Iterator[tuple[LaunchFile, str]]:
        """Yield the Python launch files with their texts."""
        for package in self.packages:
            for launch in package.launches:
                if launch.shown not in self.left_out:
                    yield launch, package.text(launch.path) or ""

    @cached_property
    def yaml_files(self) -> tuple[YamlFile, ...]:
        """The YAML files."""
        files = (file for each in self.packages for file in each.yaml_files)
        return tuple(file for file in files if file.shown not in self.left_out)

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """All parameters in all YAML files."""
        return tuple(p for file in self.yaml_files for p in file.parameters)

    @property
    def manifest(self) -> Element | None:
        """The root of package.xml; None for a missing or broken one."""
        return self.files.manifest

    @property
    def is_ros1(self) -> bool:
        """True when only catkin builds the package: it is not for ROS 2."""
        return self.files.is_ros1

    @property
    def cmake(self) -> CMakeFile | None:
        """CMakeLists.txt; None for a missing or very long one."""
        return self.files.cmake

    @cached_property
    def names(self) -> frozenset[str]:
        """The names of the packages."""
        return frozenset(package.name for package in self.packages)

    @property
    def setup(self) -> SetupFile | None:
        """setup.py; None for a missing, broken or very long one."""
        return self.files.setup

    @cached_property
    def namespaced(self) -> bool:
        """True when launch files or the model put names below others.

        Then the files do not have the final names of topics and frames.
        """
        marks = {"frame_prefix", "namespace", "tf_prefix"}
        return any(
            not marks.isdisjoint(launch.strings)
            or any(
                "namespace" in (k.arg or "")
                for c in launch.calls
                for k in c.node.keywords
            )
            for launch in self.launches
        )

    def own(self, path: str) -> str | None:
        """Return a path below the share folder of the package; None for other paths."""
        package, below = self.named(path) or (None, None)
        return below if package is self.files else None

    def named(self, path: str) -> tuple[Package, str] | None:
        """Return which of the packages a path is in, and the path below its folder."""
        name, _, below = path.removeprefix(SHARE).partition("/")
        below = below.strip("/")
        for package in self.packages if path.startswith(SHARE) and below else ():
            if package.name == name:
                return package, below
        return None

    def shown(self, path: str) -> str | None:
        """Return how the user would write a path in a package; None for others."""
        named = self.named(path)
        return None if named is None else named[0].shown(named[1])

    def text(self, path: str) -> str | None:
        """Return the text of a file in one of the packages; None for others."""
        named = self.named(path)
        return None if named is None else named[0].text(named[1])

    @cached_property
    def _own_names(self) -> frozenset[str]:
        """The names of the files of the robot."""
        files = self.known.files if self.known is not None else ()
        return frozenset(file.name for file in files)

    @cached_property
    def _unlaunched(self) -> frozenset[tuple[Package, str]]:
        """Other models that no launch file names, if a launch file names this one."""
        said = [text for launch in self.launches for text in launch.strings]
        if not any(text.endswith(tuple(self._own_names)) for text in said):
            return frozenset()
        return frozenset(
            (package, path)
            for package in self.packages
            for path in package.ending(*_MODELS)
            if not any(path.rpartition("/")[2] in text for text in said)
        )

    def said_elsewhere(
        self, name: str, *, as_topic: bool = False, launched: bool = False
    ) -> bool:
        """Return whether a launch file, a program or another model has this name.

        A node or a robot outside the check may then have it.

        Args:
            name: of a topic, a node or a frame.
            as_topic: only complete topics of a model count, neither the frame in a
                <frame_id> nor the end of a longer topic.
            launched: leave out models that no launch file names.
        """
        bare = name.strip("/")
        if any(
            bare in (word.strip("/") for word in text.split())
            for launch in self.launches
            for text in launch.said
        ):
            return True
        end = rf"{re.escape(bare)}[\"'< ]"
        in_program = re.compile(rf"[\"'>/ ]{end}")
        in_model = re.compile(rf"{_AS_TOPIC}{end}") if as_topic else in_program
        for package in self.packages:
            for path in package.ending(*_SOURCES, *_MODELS):
                is_model = path.endswith(_MODELS)
                if launched and (package, path) in self._unlaunched:
                    continue
                if path.endswith("launch.py") or (
                    is_model and path.rpartition("/")[2] in self._own_names
                ):
                    continue
                text = package.text(path)
                quoted = in_model if is_model else in_program
                if text is not None and quoted.search(text):
                    return True
        return self._said_in_used(re.compile(rf"[\"'>/ ]{re.escape(bare)}(?![\w/])"))

    def _said_in_used(self, name: re.Pattern[str]) -> bool:
        """Return whether a package that starts together with these has the name."""
        used = {p for package in self.packages for p in package.used}
        return any(
            name.search(package.text(path) or "")
            for package in used.difference(self.packages)
            for path in package.ending(*_SOURCES, *_MODELS, *_PARAMETERS)
        )
