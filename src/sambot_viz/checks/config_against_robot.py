"""What keeps a robot out of the picture of an RViz config (spec/ros-nodes.md §7.4).

The config is right as YAML, and RViz says nothing or too little: a fixed frame that
nobody publishes, a robot description that RViz will miss.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

import yaml

from sambot_viz.errors import Problem, did_you_mean
from sambot_viz.robot.model import Robot

_DESCRIPTION = "robot_description"
_MANAGER = "Visualization Manager"


class DisplayLike(Protocol):
    """What is needed of a display of an `RvizConfig`."""

    @property
    def class_id(self) -> str:
        """RViz's class name, such as "rviz_default_plugins/RobotModel"."""
        ...

    @property
    def name(self) -> str:
        """The display's name."""
        ...

    @property
    def enabled(self) -> bool:
        """Whether it is switched on."""
        ...

    @property
    def raw(self) -> Mapping[str, Any]:
        """What the file says, as text."""
        ...

    @property
    def displays(self) -> Sequence[DisplayLike]:
        """The members of a group."""
        ...


class ItemLike(Protocol):
    """What is needed of the Global Options."""

    def get(self, path: str, /) -> Any:
        """The value of a property."""
        ...


class ConfigLike(Protocol):
    """What is needed of an `RvizConfig`."""

    @property
    def displays(self) -> Sequence[DisplayLike]:
        """The displays at the top."""
        ...

    @property
    def global_options(self) -> ItemLike:
        """The first row of the displays."""
        ...

    @property
    def file(self) -> str | None:
        """The file it was read from."""
        ...


def check_setup(robot: Robot, config: ConfigLike) -> list[Problem]:
    """Say what of a config will not work with this robot.

    Args:
        robot: the robot to be shown.
        config: an `RvizConfig`; its file gives the lines.

    Returns:
        Warnings and notes, in the order of the file.
    """
    lines = _Lines(config.file)
    problems = list(_fixed_frame(robot, config, lines))
    models = [d for d in _all(config.displays) if _is_robot_model(d)]
    for display in models:
        problems += _description(display, lines)
    if not any(display.enabled for display in models):
        problems.append(_no_robot_model(lines, switched_off=bool(models)))
    return sorted(problems, key=lambda p: p.line or 0)


def _no_robot_model(lines: _Lines, *, switched_off: bool) -> Problem:
    which = "switched off" if switched_off else "missing"
    return lines.problem(
        "info",
        "setup-no-robot-model",
        f"the RobotModel display is {which}: of the robot only frames can be seen",
        "switch it on in the Displays panel"
        if switched_off
        else "add a display of the class rviz_default_plugins/RobotModel",
        (_MANAGER, "Displays"),
    )


def _all(displays: Sequence[DisplayLike]) -> Iterator[DisplayLike]:
    for display in displays:
        yield display
        yield from _all(display.displays)


def _is_robot_model(display: DisplayLike) -> bool:
    return display.class_id.rpartition("/")[2] == "RobotModel"


def _fixed_frame(robot: Robot, config: ConfigLike, lines: _Lines) -> Iterator[Problem]:
    frame = str(config.global_options.get("Fixed Frame")).lstrip("/")
    if not frame or frame in robot.links:
        return
    near = did_you_mean(frame, robot.links)
    better = f"{near}; " if near.startswith("did you mean") else ""
    yield lines.problem(
        "warning",
        "setup-fixed-frame",
        f"the fixed frame {frame} does not exist: nobody publishes it for a robot "
        "that stands alone",
        f"{better}choose {robot.root}, the root of this robot",
        (_MANAGER, "Global Options", "Fixed Frame"),
    )


def _description(display: DisplayLike, lines: _Lines) -> Iterator[Problem]:
    written = lines.display(display.name, display.class_id)
    topic = display.raw.get("Description Topic")
    if topic is None or display.raw.get("Description Source", "Topic") == "File":
        return
    fields: Mapping[str, Any] = {"Value": topic} if isinstance(topic, str) else topic
    name = str(fields.get("Value") or "").strip()
    durability = fields.get("Durability Policy")
    where = (*written, "Description Topic")
    if name and name.rpartition("/")[2] != _DESCRIPTION:
        yield lines.problem(
            "warning",
            "setup-description-topic",
            f"the display {display.name} reads the robot from the topic {name}, but "
            f"robot_state_publisher publishes it on /{_DESCRIPTION}",
            f"write Value: /{_DESCRIPTION}",
            (*where, "Value"),
        )
    if durability == "Volatile":
        yield lines.problem(
            "warning",
            "setup-description-volatile",
            f"the display {display.name} reads the robot with the Durability Policy "
            "Volatile: in RViz it misses the description, which is published only "
            "once, and shows nothing without a word",
            "write Durability Policy: Transient Local",
            (*where, "Durability Policy"),
        )


class _Lines:
    """Where keys stand in the config's text; everything None without a text."""

    def __init__(self, file: str | None) -> None:
        self.file = file
        self._root: Any = None
        if file is not None:
            try:
                text = Path(file).read_text("utf-8", "replace")
                self._root = _compose(text)
            except (OSError, yaml.YAMLError):
                # The reader of configs tells of these; here only lines are lost.
                self._root = None

    def problem(
        self,
        severity: Any,
        code: str,
        message: str,
        hint: str,
        path: tuple[str | int, ...],
    ) -> Problem:
        node = self._find(path)
        line = node.start_mark.line + 1 if node is not None and path else None
        column = node.start_mark.column + 1 if node is not None and path else None
        return Problem(severity, code, message, hint, self.file, line, column)

    def display(self, name: str, class_id: str) -> tuple[str | int, ...]:
        """The path of the display with that name and class."""
        return self._display((_MANAGER, "Displays"), name, class_id) or (_MANAGER,)

    def _display(
        self, path: tuple[str | int, ...], name: str, class_id: str
    ) -> tuple[str | int, ...] | None:
        listed = self._value(path)
        for index in range(len(listed.value) if listed is not None else 0):
            here = (*path, index)
            node = self._value((*here, "Class"))
            label = self._value((*here, "Name"))
            if node is not None and node.value == class_id:
                if label is None or label.value == name:
                    return here
            inner = self._display((*here, "Displays"), name, class_id)
            if inner is not None:
                return inner
        return None

    def _find(self, path: tuple[str | int, ...]) -> Any:
        """The node of the last key (or the entry of a list)."""
        node, key = self._root, self._root
        for step in path:
            key, node = _step(node, step)
            if node is None:
                return None
        return key

    def _value(self, path: tuple[str | int, ...]) -> Any:
        node = self._root
        for step in path:
            _, node = _step(node, step)
            if node is None:
                return None
        return node


def _step(node: Any, step: str | int) -> tuple[Any, Any]:
    if isinstance(step, int):
        if isinstance(node, yaml.SequenceNode):
            return node.value[step], node.value[step]
        return None, None
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            if key.value == step:
                return key, value
    return None, None


def _compose(text: str) -> Any:
    """The tree of a YAML text, with marks; by the C parser where there is one."""
    module: Any = yaml
    return module.compose(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
