"""Links and frames as a program uses them: colours, and nodes that move with them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from sambot_viz.displays.display import Display, DisplayContext
from sambot_viz.errors import FrameError, UsageError, did_you_mean
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.rviz import ColorProperty
from sambot_viz.scripting.displays import first, for_all, plain_value
from sambot_viz.server.sessions import Sessions
from sambot_viz.session import Session
from sambot_viz.session.scene.anchors import anchor_name

Rgb = tuple[int, int, int]
"""Red, green and blue, 0 to 255."""

_COLOR = ColorProperty("color", default=(255, 255, 255))


class FrameControl:
    """One frame, for nodes of viser that are to move with it.

    Attributes:
        name: the name of the frame.
        node: the name of a node of viser that moves with it: nodes whose names begin
            with it and "/" do too, and are hidden while the frame has no place in the
            picture. It stays when the frame is hung elsewhere and when the model is
            loaded again. Private copies do not show it.
    """

    def __init__(self, name: str, node: str) -> None:
        self.name = name
        self.node = node

    def __repr__(self) -> str:
        return f"<{type(self).__name__.removesuffix('Control').lower()} '{self.name}'>"


class LinkControl(FrameControl):
    """One link of the robot: ``viz.link("laser").color = (255, 0, 0)``.

    `visible` and `alpha` are the rows of the link in the Displays panel, and are saved
    with the config; `color` and `highlight` are not. All apply to the sessions of all
    browsers, and survive a reload of the model; private copies that are opened later
    have them too.

    Setting raises UsageError if the model no longer has the link, and no RobotModel
    display shows it.
    """

    def __init__(self, sessions: Sessions, name: str, node: str) -> None:
        super().__init__(name, node)
        self._sessions = sessions

    @property
    def visible(self) -> bool:
        """Its box in the Displays panel."""
        return bool(self._read("Value"))

    @visible.setter
    def visible(self, visible: bool) -> None:
        self._set("Value", bool(visible))

    @property
    def alpha(self) -> float:
        """How opaque it is, from 0 (invisible) to 1, on top of the robot's own."""
        return float(self._read("Alpha"))

    @alpha.setter
    def alpha(self, alpha: float) -> None:
        self._set("Alpha", plain_value(alpha))

    @property
    def color(self) -> Rgb | None:
        """Red, green and blue, 0 to 255, in place of all its colours and textures.

        None is its own look.
        """
        session = first(self._sessions)
        with session.lock:
            return session.scene.context.link_colors.get(self.name)

    @color.setter
    def color(self, color: Rgb | None) -> None:
        checked = None if color is None else _COLOR.coerce(plain_value(color))

        def change(context: DisplayContext) -> None:
            if checked is None:
                context.link_colors.pop(self.name, None)
            else:
                context.link_colors[self.name] = checked

        self._paint(change)

    def highlight(self, on: bool = True) -> None:
        """Draw it in a bright yellow, whatever its colour is, or no longer."""

        def change(context: DisplayContext) -> None:
            (context.highlighted.add if on else context.highlighted.discard)(self.name)

        self._paint(change)

    def _paint(self, change: Callable[[DisplayContext], None]) -> None:
        def paint(session: Session) -> None:
            change(session.scene.context)
            session.scene.redraw()

        for_all(self._sessions, paint)

    def _set(self, path: str, value: object) -> None:
        def change(session: Session) -> None:
            for display in self._displays(session):
                session.display_edits.set_entry(
                    display, "Links", self.name, path, value
                )

        for_all(self._sessions, change)

    def _read(self, path: str) -> Any:
        session = first(self._sessions)
        with session.lock:
            display = self._displays(session)[0]
            links = next(e for e in display.entries() if e.title == "Links")
            return links.item(self.name).get(path)

    def _displays(self, session: Session) -> list[Display]:
        """Return the displays that show the robot, with this link."""
        found = [*_showing(session, self.name)]
        if not found:
            raise UsageError(f"no RobotModel shows a link '{self.name}'")
        return found


def _showing(session: Session, link: str) -> Iterator[Display]:
    for display in session.scene.displays:
        robot = display.robot_display
        if robot is not None and robot.own_robot is None:
            if any(link in e.names for e in display.entries() if e.title == "Links"):
                yield display


class Links:
    """Finds links and frames, and keeps anchors for those that were asked for."""

    def __init__(self, sessions: Sessions) -> None:
        self._sessions = sessions
        self._frames: dict[str, None] = {}
        sessions.follow(self._begin)

    def link(self, name: str) -> LinkControl:
        """Return a link of the robot.

        Raises:
            UsageError: the robot has no such link.
        """
        robot = self._sessions.robot
        links = () if robot is None else tuple(robot.links)
        if name not in links:
            raise UsageError(f"no link '{name}'; {did_you_mean(name, links)}")
        return LinkControl(self._sessions, name, self._anchor(plain_name(name)))

    def frame(self, name: str) -> FrameControl:
        """Return a frame.

        Raises:
            FrameError: there is no such frame.
        """
        session = first(self._sessions)
        with session.lock:
            frames = session.frames.tree.frames
            if name not in frames:
                near = did_you_mean(name, frames)
                raise FrameError(f"no frame '{name}'; {near}")
        return FrameControl(name, self._anchor(name))

    def _anchor(self, frame: str) -> str:
        if frame not in self._frames:
            self._frames[frame] = None
            for session in self._sessions.all(copies=False):
                self._add(session, [frame])
        return anchor_name(frame)

    def _begin(self, session: Session) -> None:
        self._add(session, list(self._frames))

    @staticmethod
    def _add(session: Session, frames: list[str]) -> None:
        with session.change():
            for frame in frames:
                session.scene.anchors.add(frame)
