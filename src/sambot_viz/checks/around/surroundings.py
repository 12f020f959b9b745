"""A model with the files around it, each read once when a rule asks for it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from sambot_viz import limits
from sambot_viz.checks.around.files.cmake import CMakeFile
from sambot_viz.checks.around.files.gazebo import Plugin, plugins
from sambot_viz.checks.around.files.launch import LaunchFile, read_launch
from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.files.parameters import Parameter, YamlFile, read_yaml
from sambot_viz.checks.around.files.setup_py import SetupFile, read_setup
from sambot_viz.checks.around.files.text_files import PackageFiles
from sambot_viz.robot.model import Robot
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.element import Element, parse_xml

_SOURCES = (".py", ".cpp", ".hpp", ".h", ".ino", ".xml", ".lua")
_MODELS = (".xacro", ".urdf", ".sdf", ".gazebo")
_YAML = (".yaml", ".yml")
_AS_TOPIC = r"(?<!frame)(?<!frame_id)[\"'> ]/?"
_WITHOUT_PARAMETERS = re.compile(r"(^|/)(maps?|meshes)/")


@dataclass(frozen=True)
class Surroundings:
    """A robot, and the package that its model is in.

    Attributes:
        robot: the robot.
        files: the files of its package.
    """

    robot: Robot
    files: PackageFiles

    @cached_property
    def plugins(self) -> tuple[Plugin, ...]:
        """The Gazebo plugins of the model."""
        return tuple(plugins(self.robot.gazebo))

    @cached_property
    def launches(self) -> tuple[LaunchFile, ...]:
        """The Python launch files."""
        return tuple(self._launches())

    def _launches(self) -> Iterator[LaunchFile]:
        for path in self.files.ending("launch.py"):
            text = self.files.text(path)
            read = read_launch(text, path, self.files.shown(path)) if text else None
            if read is not None:
                yield read

    @cached_property
    def yaml_files(self) -> tuple[YamlFile, ...]:
        """The YAML files."""
        return tuple(self._yaml_files())

    def _yaml_files(self) -> Iterator[YamlFile]:
        for path in self.files.ending(*_YAML):
            text = None if _WITHOUT_PARAMETERS.search(path) else self.files.text(path)
            read = read_yaml(text, path, self.files.shown(path)) if text else None
            if read is not None:
                yield read

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """All parameters in all YAML files."""
        return tuple(p for file in self.yaml_files for p in file.parameters)

    @cached_property
    def manifest(self) -> Element | None:
        """The root of package.xml; None when there is none that is XML."""
        name = "package.xml"
        try:
            return parse_xml(self.files.text(name) or "", name)
        except XmlFault:
            return None

    @cached_property
    def is_ros1(self) -> bool:
        """True when catkin alone builds the package: it is not for ROS 2."""
        root = self.manifest
        tools = [] if root is None else root.find_all("buildtool_depend")
        return {tool.text.strip() for tool in tools} == {"catkin"}

    @cached_property
    def cmake(self) -> CMakeFile | None:
        """CMakeLists.txt; None when there is none, or a very long one."""
        name = "CMakeLists.txt"
        text = self.files.text(name)
        if text is None or len(text) > limits.BUILD_FILE.value:
            return None
        return CMakeFile(text, self.files.shown(name))

    @cached_property
    def setup(self) -> SetupFile | None:
        """setup.py; None when there is none that is Python, or a very long one."""
        name = "setup.py"
        text = self.files.text(name) if name in self.files.paths else None
        if text is None or len(text) > limits.BUILD_FILE.value:
            return None
        shown, folder = self.files.shown(name), self.files.folder
        return read_setup(text, shown, folder, trusted=self.files.trusted)

    @cached_property
    def namespaced(self) -> bool:
        """True when launch files or the model put names below others.

        Names of topics and frames in the files are then not the final ones.
        """
        marks = {"frame_prefix", "namespace", "tf_prefix"}
        return any(
            not marks.isdisjoint(launch.strings)
            or any(
                "namespace" in (k.arg or "") for c in launch.calls for k in c.keywords
            )
            for launch in self.launches
        )

    def own(self, path: str) -> str | None:
        """Return a path below the share folder of this package; None for others."""
        head = f"{SHARE}{self.files.name}/"
        below = path.removeprefix(head).strip("/")
        return below if path.startswith(head) and below else None

    @cached_property
    def _unlaunched(self) -> frozenset[str]:
        """Other models that no launch file names, where one names this one."""
        said = [text for launch in self.launches for text in launch.strings]
        own = {file.name for file in self.robot.files}
        if not any(text.endswith(tuple(own)) for text in said if own):
            return frozenset()
        return frozenset(
            path
            for path in self.files.ending(*_MODELS)
            if not any(path.rpartition("/")[2] in text for text in said)
        )

    def said_elsewhere(
        self, name: str, *, as_topic: bool = False, launched: bool = False
    ) -> bool:
        """Tell whether a launch file, a program or another model says this name.

        A node or a robot that is not looked at may then have it.

        Args:
            name: of a topic, a node or a frame.
            as_topic: of a model count only topics, whole: neither the frame of a
                <frame_id>, nor the end of a longer topic.
            launched: leave out models that no launch file names.
        """
        bare = name.strip("/")
        if any(
            bare in (word.strip("/") for word in text.split())
            for launch in self.launches
            for text in launch.strings
        ):
            return True
        end = rf"{re.escape(bare)}[\"'< ]"
        in_program = re.compile(rf"[\"'>/ ]{end}")
        in_model = re.compile(rf"{_AS_TOPIC}{end}") if as_topic else in_program
        own = {file.name for file in self.robot.files}
        for path in self.files.ending(*_SOURCES, *_MODELS):
            is_model = path.endswith(_MODELS)
            if launched and path in self._unlaunched:
                continue
            if path.endswith("launch.py") or (
                is_model and path.rpartition("/")[2] in own
            ):
                continue
            text = self.files.text(path)
            quoted = in_model if is_model else in_program
            if text is not None and quoted.search(text):
                return True
        return False
