"""The Selection panel: facts about the selected links and frames."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import viser

from sambot_viz.displays.entries import numbers
from sambot_viz.errors import Place
from sambot_viz.frames import FrameTree, LookupRefused
from sambot_viz.frames.distance import distance_between
from sambot_viz.panels.tools import follow_browsers
from sambot_viz.panels.widgets import Input, add_property, frame_choices
from sambot_viz.robot.joint import Joint
from sambot_viz.robot.model import Box, Geometry, Link, MeshFile, Sphere
from sambot_viz.rviz import FIXED_FRAME, ColorProperty, TfFrameProperty, ToolConfig
from sambot_viz.session import Event, Session
from sambot_viz.session.throttle import Throttle
from sambot_viz.text import html_text, text
from sambot_viz.tools.picking.hit import Selectable
from sambot_viz.tools.registry import TOOLS
from sambot_viz.tools.tool import Tool

REFRESH = 0.2
"""Shortest time between two updates of the poses, as in RViz [s]."""
SHOWN = 30
"""At most this many selected items are listed."""
NOTHING = (
    '<p class="sambot-note">Nothing is selected. Choose Select (S), then click on a '
    "link or a frame, or drag a rectangle.</p>"
)
Fact = tuple[str, str]


class SelectionPanel:
    """Lists the selection, and the settings of the tools.

    Args:
        session: the session whose selection this is.
        container: the tab to fill.
    """

    def __init__(self, session: Session, container: viser.GuiTabHandle) -> None:
        self._session = session
        self._frame = FIXED_FRAME
        self._property = TfFrameProperty(
            "Poses in", default=FIXED_FRAME, help="The frame in which poses are shown."
        )
        gui = session.audience.gui
        with container:
            self._choice = add_property(
                self._session,
                self._property,
                lambda: self._frame,
                self._set_frame,
                self._frames(),
            )
            self._list = gui.add_html(NOTHING)
            self._settings = [
                _ColorSetting(session, tool, prop)
                for tool in TOOLS.values()
                for prop in tool.properties
                if isinstance(prop, ColorProperty)
            ]
        self._pacer = Throttle(session.worker, REFRESH, self._write)
        session.listeners.append(self._hear)
        follow_browsers(session, self._hear)

    def close(self) -> None:
        """Stop following the session."""
        self._session.listeners.remove(self._hear)
        self._pacer.close()

    def _selection(self) -> list[Selectable]:
        # The panels of one browser are rows of its own soon; until then, the first.
        browser = next(iter(self._session.browsers.values()), None)
        return [] if browser is None else list(browser.tools.selection)

    def _frames(self) -> Sequence[str]:
        return sorted(self._session.tree.frames)

    def _set_frame(self, frame: object) -> None:
        self._frame = self._property.coerce(frame)
        self._write()

    def _hear(self, event: Event) -> None:
        if event in ("frames", "robot") and isinstance(
            self._choice, viser.GuiDropdownHandle
        ):
            offered = frame_choices(self._property, self._frames(), self._frame)
            if self._choice.options != offered:
                self._choice.options = offered
                self._choice.value = text(self._frame)
        if event in ("tools", "config"):
            for setting in self._settings:
                setting.show()
        if event == "tools" or (
            self._selection() and event in ("joints", "frames", "robot")
        ):
            self._pacer.request()

    def _write(self) -> None:
        with self._session.lock:
            items = self._selection()
            content = NOTHING if not items else ""
            for item in items[:SHOWN]:
                content += item_html(item, facts(self._session, item, self._frame))
            if len(items) == 2:
                content += note_html(apart(self._session.tree, *items))
            if len(items) > SHOWN:
                content += note_html(f"and {len(items) - SHOWN} more")
            if self._list.content != content:
                self._list.content = content


class _ColorSetting:
    """A colour of a tool; hidden while the document does not list the tool."""

    def __init__(self, session: Session, tool: type[Tool], prop: ColorProperty) -> None:
        self._session, self._kind, self._prop = session, tool.kind, prop
        gui = session.audience.gui
        self._folder = gui.add_folder(tool.label, expand_by_default=False)
        with self._folder:
            self._input: Input = add_property(
                session, prop, lambda: self._value, self._set
            )
        self.show()

    def show(self) -> None:
        """Show the value that holds; the document may be another one now."""
        listed = self._config is not None
        if self._folder.visible != listed:
            self._folder.visible = listed
        if self._input.value != self._value:
            self._input.value = self._value

    @property
    def _config(self) -> ToolConfig | None:
        tools = self._session.config.tools
        return next((tool for tool in tools if tool.kind == self._kind), None)

    @property
    def _value(self) -> Any:
        config = self._config
        return self._prop.default if config is None else config.get(self._prop.name)

    def _set(self, value: Any) -> None:
        self._session.set_tool_property(self._kind, self._prop.name, value)


def item_html(item: Selectable, rows: Sequence[Fact]) -> str:
    """One selected item with its facts."""
    title = f"{item.kind.capitalize()} {item.name}"
    lines = "".join(f"<li><b>{html_text(k)}</b> {html_text(v)}</li>" for k, v in rows)
    return (
        f'<details class="sambot-status" open><summary>{html_text(title)}</summary>'
        f"<ul>{lines}</ul></details>"
    )


def note_html(sentence: str) -> str:
    """A sentence between the items."""
    return f'<p class="sambot-note">{html_text(sentence)}</p>'


def apart(tree: FrameTree, first: Selectable, second: Selectable) -> str:
    """How far two selected items are from each other, in a sentence."""
    try:
        distance = distance_between(tree, first.name, second.name)
    except LookupRefused as refused:
        return refused.rviz_text
    return (
        f"{distance.length:.6g} m from {first.name} to {second.name}: "
        f"{numbers(distance.offset)} along the axes of {first.name}"
    )


def facts(session: Session, item: Selectable, frame: str) -> list[Fact]:
    """What is known about a selected link or frame: key, text.

    Args:
        session: where it is shown.
        item: the link or frame.
        frame: the frame in which its pose is given.
    """
    return [
        *_pose(session, item.name, session.context.frame(frame)),
        *_written(session, item.name),
    ]


def _pose(session: Session, name: str, frame: str) -> Iterator[Fact]:
    tree = session.tree
    parent = tree.parent(name) if name in tree.frames else None
    if parent is not None:
        yield "Parent", parent
    try:
        transform = tree.lookup(frame, name)
    except LookupRefused as refused:
        yield "Pose", refused.rviz_text
        return
    yield "Position", numbers(transform.translation.tolist())
    yield "Orientation", numbers(transform.rotation_xyzw.tolist())


def _written(session: Session, name: str) -> Iterator[Fact]:
    """What the model file says about a link, and where."""
    robot = session.robot
    link = None if robot is None else robot.links.get(name)
    if robot is None or link is None:
        return
    yield from _link(link)
    for joint in robot.joints.values():
        if joint.child == name:
            yield from _joint(session, joint)
    children = [joint.name for joint in robot.joints.values() if joint.parent == name]
    if children:
        yield "Joints to its children", ", ".join(children)


def _link(link: Link) -> Iterator[Fact]:
    if link.place is not None:
        yield "Written at", place_text(link.place)
    for title, shapes in (("Visual", link.visuals), ("Collision", link.collisions)):
        for shape in shapes:
            at = "" if shape.place is None else f", {place_text(shape.place)}"
            yield title, f"{geometry_text(shape.geometry)}{at}"
    if link.inertial is not None:
        yield "Mass", f"{link.inertial.mass:.5g} kg"


def _joint(session: Session, joint: Joint) -> Iterator[Fact]:
    at = "" if joint.place is None else f", {place_text(joint.place)}"
    yield "Joint", f"{joint.name} ({joint.type}){at}"
    if not joint.movable or session.joints is None:
        return
    unit = "m" if joint.type == "prismatic" else "rad"
    position = session.joints.all_positions().get(joint.name, joint.start)
    lower, upper = joint.range
    yield "Joint position", f"{position:.5g} {unit}, {lower:.5g} … {upper:.5g}"
    yield "Joint axis", numbers(joint.axis)


def geometry_text(geometry: Geometry) -> str:
    """A shape in a few words, such as "Box 0.42; 0.31; 0.18 m"."""
    if isinstance(geometry, MeshFile):
        return f"Mesh {geometry.filename}"
    if isinstance(geometry, Box):
        return f"Box {numbers(geometry.size)} m"
    if isinstance(geometry, Sphere):
        return f"Sphere of radius {geometry.radius:.5g} m"
    kind = type(geometry).__name__
    return f"{kind} of radius {geometry.radius:.5g} m, length {geometry.length:.5g} m"


def place_text(place: Place) -> str:
    """A place as file:line, with the name of the file alone."""
    return f"{place.file.rpartition('/')[2]}:{place.line}"
