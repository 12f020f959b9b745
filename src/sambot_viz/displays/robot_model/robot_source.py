"""The robot that a RobotModel shows: the opened one, that of a topic, or of a file.

In ROS a robot_state_publisher with a frame_prefix would say where the links of a second
robot are. Here the display does, with all joints at their start values; frames that
exist already, those of the opened robot for example, stay as they are.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Literal

from sambot_viz.displays.display import DisplayContext, Status
from sambot_viz.displays.robot_display import (
    Description,
    ModelRequest,
    ModelResult,
    WantedQos,
)
from sambot_viz.displays.robot_model.description_file import (
    find_below,
    find_description,
    opened_folders,
)
from sambot_viz.errors import FrameError
from sambot_viz.frames import FrameTree, Transform
from sambot_viz.robot.kinematics import Kinematics
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import DisplayConfig

FILE = "Description File"
TOPIC = "Description Topic"

Change = Literal["none", "edited", "other"]


class RobotSource:
    """Chooses the robot of one display, and reads it when it is not the opened one.

    Args:
        context: the opened robot and the reader of models.
        config: the display.
        on_read: called when a model has been read, or could not be.

    Attributes:
        robot: the robot to draw, or None while there is none.
        is_opened: it is the one that was opened.
        files: the files that a robot of its own comes from.
        status: why there is no robot, or not the latest one; None when all is well.
        described: what "Description Topic" says; None where no messages come.
    """

    def __init__(
        self,
        context: DisplayContext,
        config: DisplayConfig,
        on_read: Callable[[], None],
    ) -> None:
        self.robot: Robot | None = None
        self.is_opened = False
        self.files: tuple[Path, ...] = ()
        self.status: Status | None = None
        self.described: Description | None = None
        self._context = context
        self._config = config
        self._on_read = on_read
        self._source: tuple[object, ...] = ()
        self._looked_for: tuple[object, ...] = ()
        self._found: Path | None = None

    @property
    def from_file(self) -> bool:
        """Return whether the robot is that of "Description File"."""
        return self._source[:1] == ("File",)

    def choose(self) -> Change:
        """Take the robot that the properties ask for.

        Returns:
            "edited" when it is another version of the opened robot, "other" when it
            is another robot.
        """
        source = self._wanted()
        if source == self._source:
            return "none"
        before, self._source = self._source, source
        was_opened, self.status = self.is_opened, None
        of_topic = before[:1] in (("Text",), ("Opened",), ("Gone",))
        if of_topic and source[0] != "Opened" and not self.from_file:
            # The last good robot stays, until the new one is read.
            if source[0] == "Text":
                self._read(self.described, trusted=False)
            return "none"
        self.robot, self.files = None, ()
        self.is_opened = source[0] == "Opened"
        if self.is_opened:
            self.robot = self._context.robot
        elif source[0] == "Text":
            self._read(self.described, trusted=False)
        elif self.from_file:
            self._read_file()
        return "edited" if self.is_opened and was_opened else "other"

    def _wanted(self) -> tuple[object, ...]:
        """Return what the properties ask for."""
        self.described = None
        if self._config.get("Description Source") == "File":
            return ("File", *self._named_file())
        topic = str(self._config.get(TOPIC))
        if self._context.descriptions is not None and topic:
            # As ROS completes the name of a node without a namespace.
            topic = f"/{topic.removeprefix('/')}"
            qos = WantedQos(
                str(self._config.get(f"{TOPIC}/Reliability Policy")),
                str(self._config.get(f"{TOPIC}/Durability Policy")),
            )
            self.described = self._context.descriptions.of(topic, qos)
            if self.described.text is not None:
                return ("Text", topic, self.described.text)
            if not self.described.is_opened:
                return ("Gone",)
        return ("Opened", id(self._context.robot))

    def forget(self) -> None:
        """Choose again from the start when the robot is next asked for."""
        self._source = ()

    def read_again(self) -> None:
        """Read "Description File" again; the last good robot stays until then."""
        if self.from_file:
            self._read_file()

    def may_name(self, name: str) -> bool:
        """Return whether a browser may set "Description File" to this path."""
        trusted = name in self._context.trusted_files
        return trusted or self._find(name, trusted=False) is not None

    def why_not(self) -> str:
        """Say where a file may be: nothing about others, so it fits both cases."""
        names = ", ".join(dict.fromkeys(folder.name for folder in self._opened()))
        return (
            f"There is no such file in or below the folders that were opened: {names}"
        )

    def _named_file(self) -> tuple[str, bool, Path | None]:
        """Return what "Description File" says, whether it is trusted, and its file.

        The file is looked for again when a robot is opened elsewhere.
        """
        name = str(self._config.get(FILE))
        trusted = name in self._context.trusted_files
        wanted = (name, trusted, self._opened())
        if wanted != self._looked_for:
            self._looked_for = wanted
            self._found = self._find(name, trusted) if name else None
        return (name, trusted, self._found)

    def _opened(self) -> tuple[Path, ...]:
        context = self._context
        packages = context.models.package_path if context.models is not None else ()
        return opened_folders(context.robot, context.config_file, packages)

    def _find(self, name: str, trusted: bool) -> Path | None:
        opened = self._opened()
        if not trusted:
            return find_below(name, opened)
        robot = self._context.robot
        beside = [file.parent for file in robot.files[:1]] if robot else []
        return find_description(name, [*beside, *opened, Path.cwd()])

    def _read_file(self) -> None:
        """Start reading "Description File"; `_take` gets the result."""
        name, trusted, path = self._named_file()
        if not name or self._context.models is None:
            return
        if path is None:
            text = f"URDF is empty: no file '{name}'" if trusted else self.why_not()
            self.status = Status("Error", text)
            return
        self.files = tuple(dict.fromkeys((path, *self.files)))
        self._read(path, trusted)

    def _read(self, model: Path | Description | None, trusted: bool) -> None:
        """Start reading a file, or what a topic has sent; `_take` gets the result."""
        models = self._context.models
        if model is None or models is None:
            return
        if self.robot is None:
            what = "file" if isinstance(model, Path) else "of the topic"
            self.status = Status("Warn", f"The model {what} is still being read")
        source = self._source

        def done(result: ModelResult) -> None:
            self._context.apply(lambda: self._take(source, trusted, result))

        models.read(ModelRequest(self, model, trusted, done))

    def _take(
        self, source: tuple[object, ...], trusted: bool, result: ModelResult
    ) -> None:
        """Keep what was read, unless another robot is wanted by now."""
        if source != self._source:
            return
        if isinstance(result, Robot):
            self.robot, self.status, self.is_opened = result, None, False
            if self.from_file:
                self.files = tuple(dict.fromkeys((*self.files[:1], *result.files)))
        else:
            # A browser could name any file: its text is not quoted. That of a topic is
            # no secret.
            told = trusted or not self.from_file
            why = result.problems[0].message if told else "see `sambot-viz check`"
            self.status = Status("Error", f"URDF failed Model parse: {why}")
        self._on_read()


def publish_frames(
    tree: FrameTree, robot: Robot, frame_of: Callable[[str], str]
) -> tuple[str, ...]:
    """Set the transforms of a second robot that are not set yet.

    Args:
        tree: the frames; the transforms are static.
        robot: whose links they are.
        frame_of: link → frame, with the TF prefix.

    Returns:
        The child frames that are new.
    """
    new: list[str] = []
    root = frame_of(robot.root)
    if not robot.joints and root not in tree:
        tree.declare(root)
        return (root,)
    missing = [j for j in robot.joints.values() if not _known(tree, frame_of(j.child))]
    if not missing:
        return ()
    kinematics = Kinematics(robot)
    positions = kinematics.positions({})
    for joint in missing:
        position = positions.get(joint.name, joint.start)
        T_parent_child = kinematics.joint_transform(joint.name, position)
        child = frame_of(joint.child)
        try:
            tree.set_static(
                frame_of(joint.parent), child, Transform.trusted(T_parent_child)
            )
        except FrameError:
            # The other robot hangs these two links the other way round; it was first.
            continue
        new.append(child)
    return tuple(new)


def _known(tree: FrameTree, frame: str) -> bool:
    return frame in tree and tree.parent(frame) is not None
