"""Interact: handles of interactive markers are moved; else the camera is."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sambot_viz.displays.picking.handle import Handle, HandlePose, MenuEntry
from sambot_viz.displays.picking.rays import Array
from sambot_viz.displays.picking.selectable import Hit
from sambot_viz.publishing.marker_feedback import FeedbackEvent, MarkerFeedback
from sambot_viz.rviz import BoolProperty, ToolConfig
from sambot_viz.tools.move_camera import MoveCameraTool
from sambot_viz.tools.tool import Click, Tool, ToolContext

HIDE = "Hide Inactive Objects"


class InteractTool(Tool):
    """Moves handles as RViz does, and shows the controls of interactive markers."""

    kind = "rviz_default_plugins/Interact"
    label = "Interact"
    key = "I"
    help = MoveCameraTool.help
    touch = MoveCameraTool.touch
    takes_handles = True
    properties = (
        BoolProperty(
            HIDE,
            default=True,
            help="Hide the controls of interactive markers while another tool is "
            "chosen.",
        ),
    )

    def __init__(self, context: ToolContext, config: ToolConfig | None) -> None:
        """Nothing is held at first."""
        super().__init__(context, config)
        self._over: Handle | None = None
        self._point: Array | None = None
        self._held: Handle | None = None
        self._moved = False
        self._menu: tuple[Handle, Array | None] | None = None

    @property
    def hides_controls(self) -> bool:
        """Whether the controls are hidden while another tool is chosen."""
        return self.config is None or bool(self.config.get(HIDE))

    @property
    def wants_hover(self) -> bool:
        """Whether there are handles that the pointer may meet."""
        return self.context.has_handles and not self.context.publish_refusal("markers")

    @property
    def holds(self) -> bool:
        """Whether a press where the mouse is now is a drag."""
        return self._over is not None

    def hover(self, click: Click, hit: Hit) -> None:
        """Say what can be done with the handle under the mouse."""
        del click
        if self._held is not None:
            return
        before = self._over
        self._over = None if hit.item is None else self.context.handle(hit.item)
        self._point = hit.point
        known = before and (before.marker, before.control)
        now = self._over and (self._over.marker, self._over.control)
        if known == now:
            return
        over = self._over
        self.context.show_status(f"{over.marker}: {over.hint}" if over else "")
        if over is not None:
            type_name = MarkerFeedback.type_name
            self.context.prepare("markers", over.topic, type_name)

    def aim(self, begin: Click, click: Click) -> None:
        """Take the handle under the mouse, and follow the pointer."""
        held = self._holding(begin)
        if held is not None and self._follow(held, click):
            self._moved = not self._tell("POSE_UPDATE")

    def drop(self, begin: Click, click: Click) -> None:
        """Release the marker: a pressed button acts now."""
        held = self._holding(begin)
        if held is None:
            return
        self._follow(held, click)
        pressed: tuple[FeedbackEvent, ...] = ("BUTTON_CLICK",) if held.is_button else ()
        self._tell(*pressed, "POSE_UPDATE", "MOUSE_UP", ends=True)
        self._leave()
        if held.opens_menu:
            self._show_menu(held, self._point)

    def _holding(self, begin: Click) -> Handle | None:
        """Return the held handle, or take the one here; None if that is not allowed."""
        if why := self.context.publish_refusal("markers"):
            # Control was lost in the middle of a drag.
            if self._held is not None:
                self._leave()
                self.context.show_status(why)
            return None
        if self._held is None:
            self._take(begin)
        return self._held

    def _take(self, begin: Click) -> None:
        handle, point = self._over, self._point
        if handle is None or point is None or not handle.is_there:
            return
        if not handle.grab(point, begin):
            self.context.show_status(f"{handle.marker} is in another hand.")
            return
        self._held = handle
        if not self._tell("POSE_UPDATE", "MOUSE_DOWN"):
            self._leave()
            # Why is shown; the rest of this drag is not tried again.
            self._over = None

    def _follow(self, held: Handle, click: Click) -> bool:
        shift, ctrl = click.modifier == "shift", click.modifier == "cmd/ctrl"
        return held.drag(click, shift=shift, ctrl=ctrl) or self._moved

    def _leave(self) -> None:
        if self._held is not None:
            self._held.release()
        self._held, self._moved = None, False

    def left(self) -> None:
        """Release the held handle."""
        self.cancel()
        self._over = None

    def cancel(self) -> None:
        """Release the held handle at its place."""
        if self._held is not None:
            self._tell("POSE_UPDATE", "MOUSE_UP", ends=True)
            self._leave()
        self._menu = None

    # Its menu

    def open_menu(self) -> bool:
        """Show the menu of the marker under the mouse; return whether there is one."""
        over = self._over
        if over is None or self._held is not None or not over.menu:
            return False
        self._show_menu(over, self._point)
        return True

    def _show_menu(self, handle: Handle, point: Array | None) -> None:
        if handle.menu:
            self._menu = handle, point
            self.context.show_menu(handle.marker, handle.menu)

    def choose_entry(self, number: int) -> None:
        """Tell the program which entry was chosen."""
        if self._menu is None:
            return
        (handle, point), self._menu = self._menu, None
        if number not in _choices(handle.menu):
            return
        if handle.is_there and (pose := handle.pose(point)) is not None:
            made = _feedback(handle, pose, "MENU_SELECT", number)
            self.context.tell_program([made], handle.topic)

    def _tell(self, *events: FeedbackEvent, ends: bool = False) -> bool:
        """Send feedback about the held handle to its program."""
        held = self._held
        if held is None or not held.is_there:
            return False
        begins = "MOUSE_DOWN" in events
        pose = held.pose(self._point if begins or ends else None)
        if pose is None:
            return False
        made = [_feedback(held, pose, event) for event in events]
        return self.context.tell_program(made, held.topic, follows=ends)


def _choices(entries: Sequence[MenuEntry]) -> Iterator[int]:
    """Yield the ids of what can be chosen: neither menus nor commands for a shell."""
    for one in entries:
        if one.entries:
            yield from _choices(one.entries)
        elif one.id and not one.runs:
            yield one.id


def _feedback(
    handle: Handle, pose: HandlePose, event: FeedbackEvent, entry: int = 0
) -> MarkerFeedback:
    return MarkerFeedback(
        pose.frame,
        event,
        handle.marker,
        handle.control,
        pose.stamp_ns,
        pose.position,
        pose.xyzw,
        entry,
        pose.mouse_point,
    )
