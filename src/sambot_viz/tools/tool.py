"""The base of all RViz tools: what the mouse does in the 3D view."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal, Protocol

import viser

from sambot_viz.displays.picking.aim import Aim
from sambot_viz.displays.picking.handle import Handle, MenuEntry
from sambot_viz.displays.picking.rays import Array
from sambot_viz.displays.picking.selectable import Hit, Selectable, Selection
from sambot_viz.publishing.outbound import Kind, Outbound
from sambot_viz.rviz import Property, ToolConfig

Key = Literal["I", "M", "S", "C", "N", "P", "G", "U"]


@dataclass(frozen=True, slots=True, eq=False)
class Click(Aim):
    """A click into the 3D view, or where the mouse is over it; in the fixed frame.

    Attributes:
        modifier: held keys as viser names them ("shift", "cmd/ctrl"), or None.
    """

    modifier: str | None = None


class ToolContext(Protocol):
    """Services of a browser for its tool; implemented by `session.tool_control`."""

    @property
    def scene(self) -> viser.SceneApi:
        """The scene to draw in."""
        ...

    def frame_origins(self) -> Mapping[str, Array]:
        """Return where the frames are: name → (3,) in the fixed frame [m]."""
        ...

    def select(self, items: Selection, modifier: str | None) -> None:
        """Replace the selection, add to it (Shift) or remove from it (Ctrl)."""
        ...

    def look_at(self, point: Array) -> None:
        """Turn the camera to a point of the fixed frame, (3,) [m]."""
        ...

    def finish(self) -> None:
        """Go back to the default tool."""
        ...

    def show_status(self, status: str) -> None:
        """Show a sentence below the toolbar; an empty one shows the tool's help."""
        ...

    @property
    def fixed_frame(self) -> str:
        """The fixed frame, in which clicks are."""
        ...

    def publish_refusal(self, kind: Kind) -> str:
        """Return why this user may send nothing of a kind; empty when he may."""
        ...

    def prepare(self, kind: Kind, topic: str, type_name: str) -> None:
        """Let the robot know of a topic before something is sent on it."""
        ...

    def publish(self, message: Outbound, topic: str, *, leave: bool = True) -> None:
        """Send a message to the robot once, and show its progress.

        Args:
            message: the message.
            topic: the topic.
            leave: whether to switch to the default tool after sending.
        """
        ...

    @property
    def has_handles(self) -> bool:
        """Whether something is shown that a hand can move."""
        ...

    def handle(self, item: Selectable) -> Handle | None:
        """Return the movable marker that a ray has hit; None without one."""
        ...

    def tell_program(
        self, messages: Sequence[Outbound], topic: str, *, follows: bool = False
    ) -> bool:
        """Send the events of a marker together; return whether they were sent.

        A refusal is shown, unless they only come too soon.

        Args:
            messages: the messages.
            topic: the topic.
            follows: whether they may follow the last messages at once.
        """
        ...

    def show_menu(self, title: str, entries: Sequence[MenuEntry]) -> None:
        """Show a menu where the pointer is."""
        ...


class Tool:
    """Base of all tools. Its methods are called with the session locked.

    Attributes:
        kind: the ROS 2 class id.
        label: the text of its button.
        key: the key that chooses it.
        help: how to use it; shown while it is current.
        touch: the same for fingers.
        clicks: whether it uses clicks. Only then does the page send them: with any
            other tool a press of the mouse moves the camera.
        rectangles: whether dragging with the left button draws a rectangle.
        drags: whether it follows a drag with the left button itself.
        takes_pose: whether a pose can be typed for it.
        takes_handles: whether rays of its pointer hit movable markers; a press on one
            is a drag of the tool.
        only_listed: whether it has a button only where the config lists it.
        sends: whether it sends something to a robot.
        properties: its settings.
    """

    kind: ClassVar[str]
    label: ClassVar[str]
    key: ClassVar[Key]
    help: ClassVar[str]
    touch: ClassVar[str]
    clicks: ClassVar[bool] = False
    rectangles: ClassVar[bool] = False
    drags: ClassVar[bool] = False
    takes_pose: ClassVar[bool] = False
    takes_handles: ClassVar[bool] = False
    only_listed: ClassVar[bool] = False
    sends: ClassVar[bool] = False
    properties: ClassVar[tuple[Property, ...]] = ()

    def __init__(self, context: ToolContext, config: ToolConfig | None) -> None:
        """Make the tool.

        Args:
            context: the services it may use.
            config: its place in the document; None when the file does not list it.
        """
        self.context = context
        self.config = config

    def click(self, click: Click, hit: Hit) -> None:
        """A user clicked into the 3D view."""
        del click, hit

    def aim(self, begin: Click, click: Click) -> None:
        """A user pressed the left button, or drags; only with `drags`.

        Args:
            begin: where the button was pressed; of a drag, any move may be left out.
            click: where the pointer is.
        """
        del begin, click

    def drop(self, begin: Click, click: Click) -> None:
        """A user released the left button there; only with `drags`."""
        del begin, click

    def place(self, x: float, y: float, yaw: float, *, sends: bool) -> None:
        """A user typed a pose; only with `takes_pose`.

        Args:
            x: on the ground of the fixed frame [m].
            y: the same.
            yaw: the heading [rad].
            sends: whether it is meant; else it is only shown.
        """
        del x, y, yaw, sends

    def rectangle(self, items: Selection, modifier: str | None) -> None:
        """A user drew a rectangle; `items` are the things visible in it."""
        del items, modifier

    @property
    def wants_hover(self) -> bool:
        """Return whether the page should report where the mouse is."""
        return False

    def hover(self, click: Click, hit: Hit) -> None:
        """The mouse has moved over the 3D view; only called while `wants_hover`."""
        del click, hit

    @property
    def holds(self) -> bool:
        """Whether a press where the mouse is now is a drag; with `takes_handles`."""
        return False

    def open_menu(self) -> bool:
        """Show the menu of the marker under the mouse; return whether there is one."""
        return False

    def choose_entry(self, number: int) -> None:
        """A user chose an entry of the menu that was shown."""
        del number

    def chosen(self) -> None:
        """A user chose it."""

    def left(self) -> None:
        """A user chose another tool."""

    def cancel(self) -> None:
        """A user pressed Esc or clicked with the right button."""

    def property_changed(self) -> None:
        """One of its properties has a new value."""
