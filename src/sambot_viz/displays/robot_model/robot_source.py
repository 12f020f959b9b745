"""The robot that a RobotModel shows: the opened one, that of a topic, or of a file.

In ROS a robot_state_publisher with a frame_prefix would say where the links of a second
robot are. Here the display does, with all joints at their start values; frames that
exist already, those of the opened robot for example, stay as they are.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from sambot_viz.displays.display import DisplayContext, Status
from sambot_viz.displays.robot_display import ModelResult, WantedQos
from sambot_viz.displays.robot_model.described_robot import Change, DescribedRobot
from sambot_viz.displays.robot_model.description_file import (
    find_below,
    find_description,
    opened_folders,
)
from sambot_viz.errors import FrameError
from sambot_viz.frames import FrameTree, Transform
from sambot_viz.robot.joint_tree import free_positions
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import DisplayConfig

FILE = "Description File"
TOPIC = "Description Topic"


class RobotSource(DescribedRobot):
    """Chooses the robot of a RobotModel, and reads it when it is not the opened one.

    Args:
        context: the opened robot and the reader of models.
        config: the display.
        on_read: called when a model has been read, or could not be.

    Attributes:
        files: the files that its own robot comes from.
    """

    def __init__(
        self,
        context: DisplayContext,
        config: DisplayConfig,
        on_read: Callable[[], None],
    ) -> None:
        super().__init__(context, self._named_topic, on_read)
        self.files: tuple[Path, ...] = ()
        self._config = config
        self._looked_for: tuple[object, ...] = ()
        self._found: Path | None = None

    @property
    def topic(self) -> str:
        """The topic of the robot; "" for one that no topic describes."""
        return "" if self.from_file else super().topic

    @property
    def from_file(self) -> bool:
        """Return whether the robot is that of "Description File"."""
        return self._source[:1] == ("File",)

    def choose(self) -> Change:
        """Take the robot that the properties ask for (see `DescribedRobot.choose`)."""
        change = super().choose()
        if change != "none":
            self.files = ()
            if self.from_file:
                self._read_file()
        return change

    def _wanted(self) -> tuple[object, ...]:
        if self._config.get("Description Source") == "File":
            self.described = None
            return ("File", *self._named_file())
        return super()._wanted()

    def _named_topic(self) -> tuple[str, WantedQos]:
        get = self._config.get
        qos = WantedQos(
            str(get(f"{TOPIC}/Reliability Policy")),
            str(get(f"{TOPIC}/Durability Policy")),
        )
        return str(get(TOPIC)), qos

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

    def _take(
        self, source: tuple[object, ...], trusted: bool, result: ModelResult
    ) -> None:
        if source == self._source and self.from_file and isinstance(result, Robot):
            self.files = tuple(dict.fromkeys((*self.files[:1], *result.files)))
        super()._take(source, trusted, result)

    def _may_quote(self, trusted: bool) -> bool:
        # A browser could name any file.
        return trusted or not self.from_file


def publish_frames(
    tree: FrameTree,
    robot: Robot,
    frame_of: Callable[[str], str],
    given: Mapping[str, float] | None = None,
) -> tuple[str, ...]:
    """Set the transforms of a second robot that are not set yet.

    Args:
        tree: the frames; the transforms are static.
        robot: whose links they are.
        frame_of: link → frame, with the TF prefix.
        given: joint → position [rad or m]; the others have their start values.

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
    kinematics = robot.kinematics
    positions = kinematics.positions(free_positions(robot, given or {}))
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
