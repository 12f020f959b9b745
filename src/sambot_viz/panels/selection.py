"""The Selection panel of one browser: facts about the selected links and frames."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

from sambot_viz.displays.picking.pick_geometry import Selectable
from sambot_viz.errors import Place
from sambot_viz.frames import FrameTree, LookupRefused
from sambot_viz.frames.robot_frames import distance_between
from sambot_viz.panels.frames.frame_answer import shown_numbers
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Json, Row
from sambot_viz.robot.parts import Box, Geometry, Joint, Link, MeshFile, Sphere
from sambot_viz.rviz import FIXED_FRAME, TfFrameProperty
from sambot_viz.session.clients.client import Client
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Signal

SHOWN = 30
"""At most this many selected items are listed."""
SHORT = 3
"""The rows of so many items, or more, come folded."""
IN_TABLE = 10
"""At most this many items are in the table of distances."""
_FRAME = TfFrameProperty(
    "Relative to", default=FIXED_FRAME, help="The frame in which poses are shown."
)
Fact = tuple[str, str]
"""A name and a text."""


class SelectionPanel(Panel):
    """Lists the selection, and how far the selected items are apart.

    Args:
        client: whose selection it is.
        remake: called when another frame was chosen.
    """

    name = "selection"
    # As often as RViz.
    period = 0.2

    def __init__(
        self,
        client: Client,
        scene: Scene,
        robot: RobotState,
        remake: Callable[[Panel], None],
    ) -> None:
        self.remade_by = (scene.frames, robot.changed, client.tools.changed)
        self._client = client
        self._context = scene.context
        self._robot = robot
        self._remake = remake
        self._frame: str = FIXED_FRAME

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        """The poses of what is selected."""
        return (self._robot.positions,) if self._client.tools.selection else ()

    def rows(self) -> Sequence[Row]:
        """Return the frame of the poses, then a row per item with its facts."""
        items = list(self._client.tools.selection)
        if not items:
            return [Row("selection/none", "", "note", value=_NOTHING)]
        made = [self._frame_row()]
        made.extend(self._distances(items))
        for item in items[:SHOWN]:
            head = _id(item)
            made.append(
                Row(
                    head,
                    "",
                    "group",
                    f"{item.kind.capitalize()} {item.name}",
                    icon=item.kind,
                    expanded=len(items) < SHORT,
                )
            )
            made.extend(_fact_rows(head, head, self._facts(item)))
        if len(items) > SHOWN:
            more = f"and {len(items) - SHOWN} more"
            made.append(Row("selection/more", "", "note", value=more))
        return made

    def values(self) -> dict[str, Json]:
        """Return what a motion may have changed."""
        items = list(self._client.tools.selection)
        made = [*self._distances(items)]
        for item in items[:SHOWN]:
            made.extend(_fact_rows(_id(item), "", self._facts(item)))
        return {row.id: row.value for row in made}

    def _frame_row(self) -> Row:
        return Row(
            "selection/frame",
            "",
            "frame",
            _FRAME.name,
            value=self._frame,
            options=(FIXED_FRAME,),
            help=_FRAME.help,
            client_local=True,
            set=self._set_frame,
        )

    def _set_frame(self, frame: str) -> None:
        self._frame = _FRAME.coerce(frame)
        self._remake(self)

    def _facts(self, item: Selectable) -> Sequence[Fact]:
        context = self._context
        frame = context.frame(self._frame)
        return facts_of(context.tree, self._robot, item.name, frame)

    def _distances(self, items: Sequence[Selectable]) -> Iterator[Row]:
        """Yield how far two items are apart, or a table of more of them."""
        if len(items) == 2:
            yield from _fact_rows("apart", "", self._apart(items[0], items[1]))
        if len(items) < SHORT:
            return
        yield Row("apart", "", "group", "Distances [m]", expanded=True)
        # A link and its frame are at one place.
        names = list(dict.fromkeys(item.name for item in items[:IN_TABLE]))
        table = self._table(names)
        copied = {"copy": True}
        yield Row("apart/table", "apart", "lines", "Distances", table, extra=copied)
        if len(items) > IN_TABLE:
            said = f"of the first {IN_TABLE} items"
            yield Row("apart/more", "apart", "note", value=said)

    def _table(self, names: Sequence[str]) -> str:
        """Return the distances of all pairs [m], the columns by number."""
        width = max(len(name) for name in names)
        heads = [f"{number:>7}" for number in range(1, len(names) + 1)]
        lines = [" " * (width + 3) + "".join(heads)]
        for number, name in enumerate(names, 1):
            parts = [f"{self._length(name, other):>7}" for other in names]
            lines.append(f"{number:>2} {name:<{width}}{''.join(parts)}")
        return "\n".join(lines)

    def _length(self, first: str, second: str) -> str:
        if first == second:
            return "-"
        try:
            found = distance_between(self._context.tree, first, second)
        except LookupRefused:
            return "?"
        return f"{found.length:.4g}"

    def _apart(self, first: Selectable, second: Selectable) -> Iterator[Fact]:
        try:
            found = distance_between(self._context.tree, first.name, second.name)
        except LookupRefused as refused:
            yield "Distance", refused.rviz_text
            return
        yield "Distance", f"{found.length:.6g} m, from {first.name} to {second.name}"
        axes = f"along the axes of {first.name}"
        yield "Offset", f"{shown_numbers(found.offset)} m, {axes}"


def _id(item: Selectable) -> str:
    return f"selected/{item.kind}/{item.name}"


def _fact_rows(prefix: str, parent: str, facts: Iterable[Fact]) -> Iterator[Row]:
    """Yield the rows of some facts; names such as "Visual" may occur twice."""
    for number, (name, value) in enumerate(facts):
        yield Row(f"{prefix}/{number}", parent, "readonly", name, value)


def facts_of(tree: FrameTree, robot: RobotState, name: str, frame: str) -> list[Fact]:
    """Return what is known about a link or frame.

    Args:
        tree: where it may be.
        robot: what is shown.
        name: the link or frame.
        frame: the frame in which its pose is given.
    """
    return [
        *_pose(tree, name, frame),
        *_relations(tree, name),
        *_written(robot, name),
    ]


def _pose(tree: FrameTree, name: str, frame: str) -> Iterator[Fact]:
    try:
        transform = tree.lookup(frame, name)
    except LookupRefused as refused:
        yield "Pose", refused.rviz_text
        return
    rpy = transform.rpy
    yield "Position", f"{shown_numbers(transform.translation.tolist())} m"
    yield "Orientation", f"{shown_numbers(transform.rotation_xyzw.tolist())} (xyzw)"
    degrees = shown_numbers([math.degrees(angle) for angle in rpy], 3)
    yield "RPY", f"{shown_numbers(rpy)} rad ({degrees} °)"


def _relations(tree: FrameTree, name: str) -> Iterator[Fact]:
    parent = tree.parent(name) if name in tree.frames else None
    if parent is not None:
        yield "Parent", parent
    if children := tree.children(name):
        yield "Children", ", ".join(children)


def _written(shown: RobotState, name: str) -> Iterator[Fact]:
    """Yield what the model file says about a link, and where."""
    robot = shown.model
    link = None if robot is None else robot.links.get(name)
    if robot is None or link is None:
        return
    for joint in robot.joints.values():
        if joint.child == name:
            yield from _joint(shown, joint)
    below = [joint.name for joint in robot.joints.values() if joint.parent == name]
    if below:
        yield "Child joints", ", ".join(below)
    yield from _link(link)


def _link(link: Link) -> Iterator[Fact]:
    for title, shapes in (("Visual", link.visuals), ("Collision", link.collisions)):
        for shape in shapes:
            at = "" if shape.place is None else f", {place_text(shape.place)}"
            yield title, f"{geometry_text(shape.geometry)}{at}"
    if link.inertial is not None:
        yield "Mass", f"{link.inertial.mass:.5g} kg"
    if link.place is not None:
        yield "Defined at", place_text(link.place)


def _joint(robot: RobotState, joint: Joint) -> Iterator[Fact]:
    at = "" if joint.place is None else f", {place_text(joint.place)}"
    yield "Joint", f"{joint.name} ({joint.type}){at}"
    if not joint.movable or robot.joints is None:
        return
    unit = "m" if joint.type == "prismatic" else "rad"
    position = robot.joints.all_positions().get(joint.name, joint.start)
    lower, upper = joint.range
    limits = f"{lower:.5g} … {upper:.5g}"
    if joint.type == "continuous":
        limits = "turns without limits"
    yield "Joint position", f"{position:.5g} {unit}, {limits}"
    yield "Joint axis", shown_numbers(joint.axis)


def geometry_text(geometry: Geometry) -> str:
    """Return a shape in a few words, such as "Box 0.42; 0.31; 0.18 m"."""
    if isinstance(geometry, MeshFile):
        return f"Mesh {geometry.filename}"
    if isinstance(geometry, Box):
        return f"Box {shown_numbers(geometry.size)} m"
    if isinstance(geometry, Sphere):
        return f"Sphere of radius {geometry.radius:.5g} m"
    kind = type(geometry).__name__
    return f"{kind} of radius {geometry.radius:.5g} m, length {geometry.length:.5g} m"


def place_text(place: Place) -> str:
    """Return a place as file:line, with the name of the file alone."""
    return f"{place.file.rpartition('/')[2]}:{place.line}"


_NOTHING = (
    "Nothing is selected. Choose Select (S), then click on a link or a frame, or drag "
    "a rectangle. Shift adds, Ctrl takes away."
)
