"""RobotModel: the shapes of a robot at its frames."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Literal

from sambot_viz.displays.display import Display, DisplayContext
from sambot_viz.displays.entries import EntryList
from sambot_viz.displays.robot_model.description_file import (
    find_below,
    find_description,
    opened_folders,
)
from sambot_viz.displays.robot_model.link_marks import RobotMarks, Wanted
from sambot_viz.displays.robot_model.link_rows import robot_entries
from sambot_viz.displays.robot_model.link_settings import (
    ALL_ENABLED,
    LINK_TREE_PROPERTIES,
    RobotSettings,
)
from sambot_viz.displays.robot_model.second_robot import publish_frames
from sambot_viz.displays.robot_model.shape_nodes import ShapeLook, ShapeNode
from sambot_viz.displays.status import Status
from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.model import Link, Robot, Shape
from sambot_viz.robot.shape_files import asset_of
from sambot_viz.rviz import (
    BoolProperty,
    DisplayConfig,
    EnumProperty,
    FileProperty,
    FloatProperty,
    GroupProperty,
    KeptProperty,
    Property,
    StringProperty,
    TopicProperty,
)

FILE = "Description File"
OUTSIDE = "The model file must lie below the folders that were opened"
"""All that is said: a browser learns nothing about other files."""

Kind = Literal["visual", "collision"]
_ShapeKey = tuple[str, Kind, int]

ROBOT_MODEL_PROPERTIES: tuple[Property, ...] = (
    BoolProperty(
        "Visual Enabled", default=True, help="Show the visual shapes of the links."
    ),
    BoolProperty(
        "Collision Enabled",
        default=False,
        help="Show the collision shapes of the links.",
    ),
    GroupProperty(
        "Mass Properties",
        help="What the <inertial> elements say.",
        children=(
            BoolProperty(
                "Mass",
                default=False,
                help="Show each mass as a ball of lead of that mass.",
            ),
            BoolProperty(
                "Inertia",
                default=False,
                help="Show each inertia as the box that has it.",
            ),
        ),
    ),
    FloatProperty(
        "Update Interval",
        default=0.0,
        minimum=0.0,
        unit="s",
        help="Seconds between updates; joints move at once here, whatever it says.",
        support="approximate",
    ),
    FloatProperty(
        "Alpha",
        default=1.0,
        minimum=0.0,
        maximum=1.0,
        help="How opaque the links are: 0 is invisible, 1 opaque.",
    ),
    EnumProperty(
        "Description Source",
        default="Topic",
        options=("Topic", "File"),
        help="The robot that was opened, or a model file of its own.",
    ),
    FileProperty(
        FILE,
        default="",
        help="The model file to show.",
        hidden_unless=("Description Source", "File"),
    ),
    TopicProperty(
        "Description Topic",
        default="",
        help="Kept for RViz; here the robot that was opened takes its place.",
        hidden_unless=("Description Source", "Topic"),
        support="approximate",
    ),
    StringProperty(
        "TF Prefix",
        default="",
        help="The frame of a link is <prefix>/<link> when this is not empty.",
    ),
    KeptProperty(
        "Robot Description",
        support="approximate",
        note="the parameter of ROS 1; the opened robot takes its place",
    ),
    *LINK_TREE_PROPERTIES,
)


class RobotModelDisplay(Display):
    """The robot, each link at its frame.

    A link without a transform to the fixed frame is white and stands at its origin,
    as in RViz; its status says so.
    """

    kind = "rviz_default_plugins/RobotModel"
    help = "A robot, posed by its joints."
    properties = ROBOT_MODEL_PROPERTIES

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """See `Display`."""
        super().__init__(context, config, key)
        self._robot: Robot | None = None
        self._source: tuple[object, ...] = ()
        self._files: tuple[Path, ...] = ()
        self._file_status: Status | None = None
        self._looked_for: tuple[object, ...] = ()
        self._found: Path | None = None
        self._shapes: dict[_ShapeKey, tuple[str, ShapeNode]] = {}
        self._marks = RobotMarks(context, key, self.frame_of)

    def frame_of(self, link: str) -> str:
        """The TF frame of a link."""
        prefix = str(self.config.get("TF Prefix"))
        return f"{prefix}/{link}" if prefix else link

    def draw(self) -> None:
        """Draw what is missing and change what differs."""
        robot = self._take_robot()
        if robot is None:
            self._remove_shapes()
            return
        if self.publish():
            self.context.nodes.sync(self.context.tree, self.context.fixed_frame)
        settings = RobotSettings(self.config, robot)
        alpha = float(self.config.get("Alpha"))
        on: Mapping[Kind, bool] = {
            "visual": bool(self.config.get("Visual Enabled")),
            "collision": bool(self.config.get("Collision Enabled")),
        }
        wanted: set[_ShapeKey] = set()
        for link in robot.links.values():
            frame = self.frame_of(link.name)
            connected = self.context.nodes.connected(frame)
            above = self.context.nodes.path(frame) if connected else ""
            own = settings.link(link.name)
            opacity = alpha * own.alpha if connected else 1.0
            for kind, index, shape in _shapes_of(link):
                key = (link.name, kind, index)
                wanted.add(key)
                node = self._node(key, above or "", shape)
                node.draw(ShapeLook(on[kind] and own.enabled, opacity, not connected))
        for key in [key for key in self._shapes if key not in wanted]:
            self._shapes.pop(key)[1].remove()
        wanted_marks = Wanted(
            bool(self.config.get("Mass Properties/Mass")),
            bool(self.config.get("Mass Properties/Inertia")),
        )
        self._marks.draw(robot, settings, wanted_marks)
        self._report(robot)

    def _node(self, key: _ShapeKey, above: str, shape: Shape) -> ShapeNode:
        """The node of a shape, made again when its frame has moved in the tree."""
        link, kind, index = key
        at_root = ""
        if not above and self._robot is not None:
            # Names below a frame are unique by its path; here the link makes them so.
            at_root = f"{list(self._robot.links).index(link)}."
        name = f"{above}/{self.key}{at_root}{kind[0]}{index}"
        roots = None if self._robot is None else self._robot.file_roots
        asset = asset_of(shape, roots)
        known = self._shapes.get(key)
        if known is not None:
            node = known[1]
            if known[0] == name and node.shows(shape, asset) and not node.gone:
                return node
            node.remove()
        node = ShapeNode(self.context.scene, name, shape, asset, self.context.assets)
        self._shapes[key] = (name, node)
        return node

    def _take_robot(self) -> Robot | None:
        """The robot to draw: the opened one, or the one of "Description File"."""
        source: tuple[object, ...]
        if self.config.get("Description Source") == "File":
            source = ("File", *self._named_file())
        else:
            source = ("Topic", id(self.context.robot))
        if source != self._source:
            self._marks.clear()
            if (source[0], *self._source[:1]) != ("Topic", "Topic"):
                # After an edit of the opened robot, what is the same stays.
                self._remove_shapes()
                self.status.clear()
            self._source = source
            self._robot, self._files, self._file_status = None, (), None
            if source[0] == "Topic":
                self._robot = self.context.robot
            else:
                self._read_file()
        return self._robot

    def _opened(self) -> tuple[Path, ...]:
        models = self.context.models
        packages = models.package_path if models is not None else ()
        return opened_folders(self.context.robot, self.context.config_file, packages)

    def _named_file(self) -> tuple[str, bool, Path | None]:
        """What "Description File" says, whether it is trusted, and the file it means.

        The file is looked for again when a robot is opened elsewhere.
        """
        name = str(self.config.get(FILE))
        wanted = (name, name in self.context.trusted_files, self._opened())
        if wanted != self._looked_for:
            self._looked_for = wanted
            self._found = self._find(name, wanted[1]) if name else None
        return (*wanted[:2], self._found)

    def _read_file(self) -> None:
        """Start reading "Description File"; `_take_file` gets what comes of it."""
        name, trusted, path = self._named_file()
        models = self.context.models
        if not name or models is None:
            return
        if path is None:
            text = f"URDF is empty: no file '{name}'" if trusted else OUTSIDE
            self.status.set("URDF", "Error", text)
            return
        if self._robot is None:
            self.status.set("URDF", "Warn", "The model file is still being read")
        source = self._source
        self._files = tuple(dict.fromkeys((path, *self._files)))

        def done(result: Robot | RobotError) -> None:
            self.context.apply(lambda: self._take_file(source, trusted, result))

        models.read(self, path, trusted, done)

    def _find(self, name: str, trusted: bool) -> Path | None:
        opened = self._opened()
        if not trusted:
            return find_below(name, opened)
        robot = self.context.robot
        beside = [file.parent for file in robot.files[:1]] if robot else []
        return find_description(name, [*beside, *opened, Path.cwd()])

    def _take_file(
        self, source: tuple[object, ...], trusted: bool, result: Robot | RobotError
    ) -> None:
        """Show what was read, unless another robot is wanted by now."""
        if source != self._source:
            return
        if isinstance(result, Robot):
            self._robot, self._file_status = result, None
            self._files = tuple(dict.fromkeys((*self._files[:1], *result.files)))
        else:
            # A browser could name any file here: its text is not quoted.
            why = result.problems[0].message if trusted else "see `sambot-viz check`"
            status = Status("Error", f"URDF failed Model parse: {why}")
            self._file_status = status
            self.status.set("URDF", status.level, status.text)
        if self.shown and self._robot is not None:
            self.draw()

    def refusal(self, path: str, value: object) -> str | None:
        """A model file must lie below the folders that were opened."""
        if path != FILE or not isinstance(value, str) or not value:
            return None
        if value in self.context.trusted_files or self._find(value, trusted=False):
            return None
        self.status.set(FILE, "Error", OUTSIDE)
        return OUTSIDE

    @property
    def own_robot(self) -> Robot | None:
        """The robot of "Description File"."""
        return self._robot if self._source[:1] == ("File",) else None

    @property
    def files(self) -> tuple[Path, ...]:
        """What that robot is read from."""
        return self._files

    def read_again(self) -> None:
        """Read "Description File" again; the last good robot stays until then."""
        if self._source[:1] == ("File",):
            self._read_file()

    def _report(self, robot: Robot) -> None:
        rows: dict[str, Status] = {}
        rows["URDF"] = self._file_status or self._geometry_status()
        fixed = self.context.fixed_frame
        for name in robot.links:
            frame = self.frame_of(name)
            if self.context.nodes.connected(frame):
                rows[frame] = Status("Ok", "Transform OK")
            else:
                text = f"No transform from [{frame}] to [{fixed}]"
                rows[frame] = Status("Error", text)
        self.status.replace(rows)

    def _geometry_status(self) -> Status:
        waiting = sum(node.waiting for _, node in self._shapes.values())
        if waiting:
            shapes = "shape is" if waiting == 1 else "shapes are"
            return Status("Warn", f"The files of {waiting} {shapes} still being read")
        faults: dict[str, list[str]] = {}
        for (link, _, _), (_, node) in self._shapes.items():
            if node.problem is not None:
                faults.setdefault(link, []).append(node.problem)
        if not faults:
            return Status("Ok", "URDF parsed OK")
        lines = ["Errors loading geometries:"]
        for link, texts in faults.items():
            lines.append(f"• for link '{link}':")
            lines.extend(texts)
        return Status("Error", "\n".join(lines))

    def publish(self) -> bool:
        """Set the transforms of a robot from a file, unless they are set already."""
        if not self.shown or self._robot is None or self._source[0] != "File":
            return False
        new = publish_frames(self.context.tree, self._robot, self.frame_of)
        return bool(new)

    @property
    def problems(self) -> tuple[Problem, ...]:
        """What is wrong with the files of the shapes."""
        return tuple(p for _, node in self._shapes.values() for p in node.problems)

    def assets_read(self) -> None:
        """Draw what has been read."""
        if self._robot is not None:
            for _, node in self._shapes.values():
                node.draw_again()
            self._report(self._robot)

    def property_changed(self, path: str) -> None:
        """A property has a new value."""
        if path == ALL_ENABLED and self._robot is not None:
            RobotSettings(self.config, self._robot).set_all(
                bool(self.config.get(ALL_ENABLED))
            )
        super().property_changed(path)

    def entries(self) -> tuple[EntryList, ...]:
        """The links and the joints."""
        if self._robot is None:
            return ()
        return robot_entries(self.context, self.config, self._robot, self.frame_of)

    def frames_moved(self, frames: Iterable[str]) -> None:
        """The shapes hang below their frames; only trails have to follow."""
        if self.shown:
            self._marks.moved()

    def clear(self) -> None:
        """Take the robot out of the scene."""
        self._remove_shapes()
        self._source = ()

    def _remove_shapes(self) -> None:
        for _, node in self._shapes.values():
            node.remove()
        self._shapes.clear()
        self._marks.clear()


def _shapes_of(link: Link) -> Iterator[tuple[Kind, int, Shape]]:
    for index, shape in enumerate(link.visuals):
        yield "visual", index, shape
    for index, shape in enumerate(link.collisions):
        yield "collision", index, shape
