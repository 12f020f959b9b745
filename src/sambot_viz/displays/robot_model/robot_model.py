"""RobotModel: the shapes of a robot at its frames."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Literal

from sambot_viz.displays.display import DisplayContext, EntryList, Status
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.displays.robot_display import Repair, RobotDisplay, WantedQos
from sambot_viz.displays.robot_model.balance_facts import (
    balance_facts,
    balance_status,
    weigh,
)
from sambot_viz.displays.robot_model.balance_mark import BalanceMark
from sambot_viz.displays.robot_model.followed_joints import FollowedJoints
from sambot_viz.displays.robot_model.link_overlays import LinkOverlays, Wanted
from sambot_viz.displays.robot_model.robot_entries import (
    BOX,
    RobotEntries,
    collision_note,
    robot_lists,
)
from sambot_viz.displays.robot_model.robot_properties import (
    ALL_ENABLED,
    BALANCE,
    COLLISIONS,
    MASS_PROPERTIES,
    ROBOT_MODEL_PROPERTIES,
)
from sambot_viz.displays.robot_model.robot_source import (
    FILE,
    TOPIC,
    RobotSource,
    publish_frames,
)
from sambot_viz.displays.robot_model.shape_nodes import ShapeNode
from sambot_viz.displays.robot_model.shape_solids import ShapeLook
from sambot_viz.displays.robot_model.status_repairs import (
    PREFIX,
    meant_prefix,
    prefix_status,
    repairs,
    topic_status,
)
from sambot_viz.displays.topic_messages import values_of_topic
from sambot_viz.displays.triangle_display import DrawnTriangles, TriangleDisplay
from sambot_viz.errors import Problem
from sambot_viz.meanings import Meaning, meaning_of
from sambot_viz.robot.joint_tree import free_positions
from sambot_viz.robot.model import Robot, asset_of
from sambot_viz.robot.parts import Link, Shape
from sambot_viz.rviz import DisplayConfig
from sambot_viz.topics.reasons import TopicReason
from sambot_viz.topics.robot_topics import describes_robot

Kind = Literal["visual", "collision"]
_ShapeKey = tuple[str, Kind, int]


class RobotModelDisplay(TriangleDisplay):
    """The robot, each link at its frame.

    A link without a transform to the fixed frame is white and is drawn at its origin,
    as in RViz; its status says so.
    """

    kind = "rviz_default_plugins/RobotModel"
    differs = (
        "Where a mesh has a second texture, such as one for its bumps, RViz multiplies "
        "its colours by themselves; here they are those of the file."
    )
    properties = ROBOT_MODEL_PROPERTIES

    def __init__(self, context: DisplayContext, config: DisplayConfig, key: str):
        """Make the display; nothing is drawn before `draw`."""
        super().__init__(context, config, key)
        self._entries: RobotEntries | None = None
        self._source = RobotSource(context, config, self._file_read)
        self._shapes: dict[_ShapeKey, tuple[str, ShapeNode]] = {}
        self._overlays = LinkOverlays(context, key, self.frame_of)
        self._mark = BalanceMark(context, key)
        self._joints = FollowedJoints(context, self._joints_moved)
        self._hung: set[str] = set()
        self._found_prefix = ""

    @classmethod
    def topic_values(
        cls, topic: str, type_name: str, qos: WantedQos | None
    ) -> Mapping[str, object] | None:
        """Return the values for a display of a description, or one moved by joints."""
        if meaning_of(type_name) is Meaning.JOINTS:
            return {}
        if not describes_robot(topic, type_name):
            return None
        return values_of_topic(TOPIC, topic, qos)

    def frame_of(self, link: str) -> str:
        """Return the TF frame of a link."""
        prefix = str(self.config.get(PREFIX)) or self._found_prefix
        return self._source.frame_of(link, prefix)

    def draw(self) -> None:
        """Add missing nodes, and update others."""
        robot = self._take_robot()
        if robot is None:
            self._remove_shapes()
            missing = Status("Error", "There is no robot to show")
            self.status.replace(
                {**topic_status(self._source), "URDF": self._source.status or missing}
            )
            return
        self._find_prefix()
        self._listen()
        if self._publish():
            self.context.nodes.sync(self.context.tree, self.context.fixed_frame)
        entries = self.entries_of(robot)
        alpha = float(self.config.get("Alpha"))
        on: Mapping[Kind, bool] = {
            "visual": bool(self.config.get("Visual Enabled")),
            "collision": bool(self.config.get(COLLISIONS)),
        }
        wanted: set[_ShapeKey] = set()
        for number, link in enumerate(robot.links.values()):
            frame = self.frame_of(link.name)
            connected = self.context.nodes.connected(frame)
            above = self.context.nodes.path(frame) if connected else ""
            # Names below a frame are unique by its path; here the link makes them so.
            place = f"{above}/{self.key}" if above else f"/{self.key}{number}."
            own = entries.link(link.name)
            opacity = alpha * own.get("Alpha") if connected else 1.0
            color = None if self.own_robot else self.context.color_of(link.name)
            for kind, index, shape in _shapes_of(link):
                key = (link.name, kind, index)
                wanted.add(key)
                node = self._node(key, place, shape)
                shown = on[kind] and own.get(BOX)
                node.draw(ShapeLook(shown, opacity, not connected, color))
        for key in [key for key in self._shapes if key not in wanted]:
            self._shapes.pop(key)[1].remove()
        wanted_overlays = Wanted(
            bool(self.config.get("Mass Properties/Mass")),
            bool(self.config.get("Mass Properties/Inertia")),
        )
        self._overlays.draw(robot, entries, wanted_overlays)
        self._report(robot)
        self._draw_balance(robot)

    def _draw_balance(self, robot: Robot) -> None:
        """Draw the centre of mass, and report whether the robot stands."""
        if not self.config.get(BALANCE):
            self._mark.remove()
            return
        found = weigh(self.context, robot, self.frame_of)
        self._mark.draw(self.frame_of(robot.root), found)
        status = balance_status(found)
        self.status.set("Balance", status.level, status.text)

    def _node(self, key: _ShapeKey, place: str, shape: Shape) -> ShapeNode:
        """The node of a shape, made again when its frame has moved in the tree."""
        _, kind, index = key
        name = f"{place}{kind[0]}{index}"
        roots = None if self._source.robot is None else self._source.robot.file_roots
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
        """Return the robot to draw; what was drawn of another one is taken out."""
        change = self._source.choose()
        if change != "none":
            self._overlays.clear()
        if change == "other":
            # After an edit of the opened robot, what is the same stays.
            self._remove_shapes()
            self.status.clear()
            self._write_source_status()
        return self._source.robot

    def _write_source_status(self) -> None:
        status = self._source.status
        if status is not None:
            self.status.set("URDF", status.level, status.text)

    def _file_read(self) -> None:
        self._write_source_status()
        if self.shown and self._source.robot is not None:
            self.draw()

    @property
    def robot_display(self) -> RobotDisplay:
        """This display: it shows a robot."""
        return self

    def unseen_topics(self) -> Iterator[tuple[str, TopicReason]]:
        """Yield its topic, if the robot has no place, or that of another one."""
        described = self._source.described
        if described is not None and described.reason is not None:
            yield described.topic, described.reason

    def refusal(self, path: str, value: object) -> str | None:
        """Refuse a model file that lies outside the folders that were opened."""
        if path != FILE or not isinstance(value, str) or not value:
            return None
        if self._source.may_name(value):
            return None
        why = self._source.why_not()
        self.status.set(FILE, "Error", why)
        return why

    @property
    def own_robot(self) -> Robot | None:
        """The robot of "Description File", or of a topic that is not the opened one."""
        return None if self._source.is_opened else self._source.robot

    @property
    def files(self) -> tuple[Path, ...]:
        """The files that this robot is read from."""
        return self._source.files

    def read_again(self) -> None:
        """Read "Description File" again; the last good robot stays until then."""
        self._source.read_again()
        self._write_source_status()

    def _report(self, robot: Robot) -> None:
        rows = topic_status(self._source)
        prefix = self._meant_prefix()
        if prefix is not None:
            rows[PREFIX] = prefix_status(self.config, robot.root, prefix)
        rows["URDF"] = self._source.status or self._geometry_status()
        for name in robot.links:
            frame = self.frame_of(name)
            rows[frame] = self.context.transform_status(frame, "Error")
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
        """Set the transforms of a robot from a file in a tree that was cleared."""
        # What another robot has by now is moved by its joints.
        self._hung.clear()
        return self._publish()

    def _publish(self) -> bool:
        """Set the transforms of a robot from a file, unless they are set already."""
        robot = self.own_robot
        if not self.shown or robot is None:
            return False
        if self._source.described is not None:
            # Messages hold its links; one of which they say nothing has no place.
            if self._has_place(robot) or self._meant_prefix() is not None:
                return False
        tree, given = self.context.tree, self._joints.last
        new = publish_frames(tree, robot, self.frame_of, given)
        self._hung.update(new)
        return bool(new)

    def _find_prefix(self) -> None:
        """Take the name space of the topic as prefix where the frames carry it."""
        self._found_prefix = ""
        space = self._source.topic.rpartition("/")[0].removeprefix("/")
        if space and not self.config.get(PREFIX) and self._meant_prefix() == space:
            self._found_prefix = space

    def _listen(self) -> None:
        """Listen to the joints of a further robot, while it is shown."""
        descriptions = self.context.descriptions
        is_further = descriptions is not None and self.own_robot is not None
        topic = self._source.topic if is_further and self.shown else ""
        topics = descriptions.joint_topics(topic) if descriptions and topic else ()
        self._joints.listen(topics)

    def _joints_moved(self) -> None:
        """Move the links of a further robot that hang by its joints."""
        robot, tree = self.own_robot, self.context.tree
        if robot is None or not self.shown:
            return
        kinematics, history = robot.kinematics, tree.history
        positions = kinematics.positions(free_positions(robot, self._joints.last))
        by_frame = {self.frame_of(j.child): j for j in robot.joints.values()}
        moved = {
            frame: kinematics.joint_transform(joint.name, positions[joint.name])
            for frame, joint in by_frame.items()
            if frame in self._hung
            and joint.movable
            and joint.name in positions
            and frame in tree
            and tree.parent(frame) == self.frame_of(joint.parent)
            and (history is None or history.latest(frame) is None)
        }
        if moved:
            tree.update(moved)
            self.context.place(moved.keys())

    def _has_place(self, robot: Robot) -> bool:
        tree = self.context.tree
        children = (self.frame_of(joint.child) for joint in robot.joints.values())
        return any(frame in tree and tree.parent(frame) for frame in children)

    def options(self) -> Mapping[str, Sequence[str]]:
        """Return the topics that describe robots."""
        descriptions = self.context.descriptions
        return {} if descriptions is None else {TOPIC: descriptions.topics()}

    def repairs(self) -> Mapping[str, Repair]:
        """Offer the topic and the prefix that were probably meant."""
        return repairs(self._meant_prefix(), self._source)

    def _meant_prefix(self) -> str | None:
        return meant_prefix(self.context, self._source, self.frame_of)

    @property
    def problems(self) -> tuple[Problem, ...]:
        """Problems of the files of the shapes."""
        return tuple(p for _, node in self._shapes.values() for p in node.problems)

    def assets_read(self) -> None:
        """Draw what has been read."""
        if self.shown and self._source.robot is not None:
            for _, node in self._shapes.values():
                node.draw_again()
            self._report(self._source.robot)
            self._draw_balance(self._source.robot)

    def property_changed(self, path: str) -> None:
        """A property has a new value."""
        robot = self._source.robot
        if path == ALL_ENABLED and robot is not None:
            self.entries_of(robot).set_all(bool(self.config.get(ALL_ENABLED)))
        super().property_changed(path)

    def values_put_back(self) -> None:
        """Read the links and joints again, and draw them."""
        self._entries = None
        super().values_put_back()

    def entries(self) -> tuple[EntryList, ...]:
        """Return the links and the joints."""
        robot = self._source.robot
        if robot is None:
            return ()
        entries = self.entries_of(robot)
        return robot_lists(self.context, entries, robot, self.frame_of)

    def notes(self) -> Mapping[str, str]:
        """Name the links that lack the collision shapes to be shown."""
        robot = self._source.robot
        wanted = robot is not None and self.shown and self.config.get(COLLISIONS)
        note = collision_note(robot) if robot is not None and wanted else ""
        return {COLLISIONS: note} if note else {}

    def facts(self) -> Mapping[str, Callable[[], Mapping[str, str]]]:
        """Return the mass of the robot, and what it takes to tip it over."""
        robot = self._source.robot
        if robot is None or not self.shown:
            return {}
        return {
            MASS_PROPERTIES: lambda: balance_facts(
                robot, weigh(self.context, robot, self.frame_of)
            )
        }

    def entries_of(self, robot: Robot) -> RobotEntries:
        """Return the links and joints of a robot as items of the document."""
        if self._entries is None or not self._entries.holds_for(robot):
            self._entries = RobotEntries(self.config, robot)
        return self._entries

    def frames_moved(self, frames: Iterable[str]) -> None:
        """The shapes hang below their frames; trails and the balance follow."""
        if self.shown:
            self._overlays.moved()
            if self._source.robot is not None:
                self._draw_balance(self._source.robot)

    def drawn(self) -> Iterator[DrawnTriangles]:
        """Yield the shapes of links, and overlays, which select nothing, as in RViz."""
        yield from self._overlays.drawn()
        for (link, _, _), (_, node) in self._shapes.items():
            frame = self.frame_of(link)
            # A link of another robot is found by its frame, not in the opened robot.
            name = link if self.own_robot is None else frame
            placed = frame if self.context.nodes.connected(frame) else None
            yield from node.drawn(placed, Selectable("link", name))

    def clear(self) -> None:
        """Take the robot out of the scene."""
        self._remove_shapes()
        self._joints.listen(())
        self._source.forget()

    def _remove_shapes(self) -> None:
        for _, node in self._shapes.values():
            node.remove()
        self._shapes.clear()
        self._overlays.clear()
        self._mark.remove()


def _shapes_of(link: Link) -> Iterator[tuple[Kind, int, Shape]]:
    for index, shape in enumerate(link.visuals):
        yield "visual", index, shape
    for index, shape in enumerate(link.collisions):
        yield "collision", index, shape
