"""The tools of one client: the current one, its clicks and keys, and the selection.

Only the current tool gets clicks, and only if it uses them: otherwise a press of the
mouse moves the camera. Drawings of tools are visible to their own client only.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence, Set
from typing import Any

import viser

from sambot_viz.displays.picking.handle import Handle, MenuEntry
from sambot_viz.displays.picking.rays import Array, RayGrid
from sambot_viz.displays.picking.selectable import (
    Hit,
    Selectable,
    Selection,
    merged,
)
from sambot_viz.displays.picking.selected import SelectedData
from sambot_viz.errors import (
    PublishError,
    PublishFrameError,
    PublishPaceError,
    SourceError,
    UsageError,
)
from sambot_viz.publishing.outbound import MAP, Kind, Outbound
from sambot_viz.publishing.outcome import Outcome
from sambot_viz.publishing.publisher import Publisher
from sambot_viz.session.clients.client_view import ClientView
from sambot_viz.session.clients.pointer_events import listen, pointed_at
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.people.roles import VIEW_ONLY, Roles
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.picker import Picker
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Change, Listening, Signal, connect
from sambot_viz.session.worker import Worker
from sambot_viz.text import capitalized
from sambot_viz.tools.interact import InteractTool
from sambot_viz.tools.move_camera import MoveCameraTool
from sambot_viz.tools.picking.pixel_rays import ScreenPoint
from sambot_viz.tools.picking.selection_boxes import SelectionBoxes
from sambot_viz.tools.publish import PoseTool
from sambot_viz.tools.registry import TOOLS
from sambot_viz.tools.select import SelectTool
from sambot_viz.tools.tool import Click, Tool

NOWHERE: ScreenPoint = (-1.0, -1.0)
"""Where the mouse is before it was over the view."""


class ClientTools:
    """Switches tools, gives them clicks and rectangles, and keeps the selection.

    Implements `tools.tool.ToolContext`.

    Args:
        client: the owner of the tools.
        change: sends their drawings to this client.
        view: the camera that they turn.
        document: lists tools, with their settings.
        scene: the drawn scene.
        robot: the selection moves with it.
        picker: follows the rays of clicks.
        worker: acts on clicks.
        selected: called with the number of the client and its selection.
        publisher: sends goals, poses and points to a robot.
        roles: knows which clients may publish.

    Attributes:
        changed: emitted when the tools, the selection or the status change.
        status: the report of the current tool; empty shows its help.
        wants_map: whether the last refusal would not hold with the fixed frame map.
        selection: the selected things, in the order of selection.
        pointed: the target of the last double click, and the number of double clicks.
        over: the last place of the mouse, and whether a press there is the tool's.
        menu: the number of menus shown, the title of the last one and its entries.
        tools: those of the document first, then the others.
        current: the tool that gets clicks.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        change: Change,
        view: ClientView,
        document: ShownDocument,
        scene: Scene,
        robot: RobotState,
        picker: Picker,
        worker: Worker,
        selected: Callable[[int, Selection], None],
        publisher: Publisher,
        roles: Roles,
    ) -> None:
        self.changed = Signal(change, None)
        self.status = ""
        self.wants_map = False
        self.selection: Selection = {}
        self.pointed: tuple[Selectable | None, int] = (None, 0)
        self.over: tuple[ScreenPoint, bool] = NOWHERE, False
        self.menu: tuple[int, str, Sequence[MenuEntry]] = (0, "", ())
        self._client = client
        self._change = change
        self._view = view
        self._document = document
        self._scene = scene
        self._picker = picker
        self._worker = worker
        self._selected = selected
        self._publisher, self._roles = publisher, roles
        self._boxes = SelectionBoxes(client.scene)
        self._config: object = None
        self._settings: dict[str, dict[str, Any]] = {}
        self._mouse: ScreenPoint = (0.5, 0.5)
        self._hovering = False
        self.tools: tuple[Tool, ...] = ()
        self.current: Tool = MoveCameraTool(self, None)
        self._take_config()
        shapes = [scene.frames, scene.statuses, scene.data, document.values]
        self._drawn = (robot.positions, robot.changed, *shapes)
        self._moving = Listening(self._move_boxes)
        facts = [document.replaced, document.tools]
        self._disconnect = connect(facts, self._take_document)

    def close(self) -> None:
        """Follow the session no longer: the page was closed."""
        self.current.cancel()
        self._disconnect()
        self._moving.to()

    # The tools

    @property
    def default(self) -> Tool:
        """The first tool of the file that is known here, as in RViz."""
        for item in self._document.config.tools:
            for tool in self.tools:
                if tool.kind == item.kind:
                    return tool
        return self.tool(MoveCameraTool.kind)

    def tool(self, kind: str) -> Tool:
        """The tool of a class id.

        Raises:
            UsageError: an unknown tool.
        """
        for tool in self.tools:
            if tool.kind == kind:
                return tool
        raise UsageError(f"there is no tool '{kind}'; there are {', '.join(TOOLS)}")

    @property
    def offered(self) -> Sequence[Tool]:
        """Those for which there are buttons: to send something takes a live robot."""
        is_live = self._publisher.robot is not None
        there = (t for t in self.tools if t.config is not None or not t.only_listed)
        return [tool for tool in there if is_live or not tool.sends]

    @property
    def shows_controls(self) -> bool:
        """Whether the controls of interactive markers are visible."""
        interact = (tool for tool in self.tools if isinstance(tool, InteractTool))
        return any(self.current is one or not one.hides_controls for one in interact)

    def choose(self, kind: str) -> None:
        """Make a tool current, whichever was before.

        Raises:
            UsageError: an unknown tool.
        """
        with self._change(self.changed):
            self._switch(self.tool(kind))

    def press(self, kind: str) -> None:
        """The key of a tool was pressed: choose the tool, or leave it again.

        In RViz the keys of other tools do nothing while Select is current; here they
        choose their tool.

        Raises:
            UsageError: an unknown tool.
        """
        if self.current.kind == kind:
            self.finish()
        else:
            self.choose(kind)

    def escape(self) -> None:
        """Esc: stop what the current tool does, and go back to the default tool."""
        with self._change(self.changed):
            self.current.cancel()
            self._switch(self.default)

    def hover(self, at: ScreenPoint) -> None:
        """The mouse is over the 3D view, with no button held.

        Only the last position is followed when they come faster than rays do.

        Args:
            at: from 0 (left, top) to 1 (right, bottom) of the picture.
        """
        self._mouse = at
        if not self._hovering and self.current.wants_hover:
            self._follow_mouse(self.current)

    def drag(
        self,
        begin: ScreenPoint,
        at: ScreenPoint,
        modifier: str | None = None,
        *,
        ends: bool = False,
    ) -> None:
        """The left button is held in the 3D view, by a tool that drags.

        Args:
            begin: where it was pressed, from 0 (left, top) to 1 (right, bottom) of the
                picture.
            at: where the pointer is.
            modifier: a held key ("shift", "cmd/ctrl"), or None.
            ends: whether it is released there.
        """
        pressed = pointed_at(self._client, begin)
        click = pointed_at(self._client, at, modifier)
        tool = self.current
        if not (tool.drags or tool.takes_handles):
            return
        with self._change(self.changed):
            if pressed is None or click is None:
                tool.cancel()
            elif ends:
                tool.drop(pressed, click)
            else:
                tool.aim(pressed, click)

    def place(self, x: float, y: float, yaw: float, *, sends: bool = False) -> None:
        """A user typed a pose for the tool: show it, or take it; see `Tool.place`."""
        if self.current.takes_pose:
            with self._change(self.changed):
                self.current.place(x, y, yaw, sends=sends)

    def double_click(self, at: ScreenPoint) -> None:
        """Note what is under the mouse; a tool that takes clicks gets them alone.

        Args:
            at: from 0 (left, top) to 1 (right, bottom) of the picture.
        """
        click = pointed_at(self._client, at)
        if click is None or (
            self.current.clicks and not isinstance(self.current, SelectTool)
        ):
            return

        def then(hit: Hit) -> None:
            with self._change(self.changed):
                self.pointed = hit.item, self.pointed[1] + 1

        self._follow("double", click, then)

    def right_click(self) -> None:
        """A click with the right button: start again what the current tool does."""
        with self._change(self.changed):
            self.current.cancel()

    def open_menu(self) -> None:
        """A click with the right button on what has a menu: show it."""
        with self._change(self.changed):
            self.current.open_menu()

    def choose_entry(self, number: int) -> None:
        """An entry of the menu that was shown was chosen."""
        with self._change(self.changed):
            self.current.choose_entry(number)

    def focus(self, at: ScreenPoint | None = None) -> None:
        """Look at the thing under the mouse (key F), or show the whole robot.

        As in RViz, Select looks at the selection; so does any tool while the mouse is
        not over the picture. Unlike in RViz, the selection then fills the picture.

        Args:
            at: place of the mouse, from 0 (left, top) to 1 (right, bottom) of the
                picture; None when the mouse is not over it.
        """
        click = None if at is None else pointed_at(self._client, at)
        if click is None or isinstance(self.current, SelectTool):
            with self._change.lock:
                box = self._picker.box_of(self.selection)
            if box is not None:
                self._view.fit(box)
                return
        if click is None:
            self._view.fit()
            return

        def then(hit: Hit) -> None:
            if hit.point is None:
                self._view.fit()
            else:
                self.look_at(hit.point)

        self._follow("focus", click, then)

    # What tools may use (tools.tool.ToolContext)

    @property
    def scene(self) -> viser.SceneApi:
        """Where to draw."""
        return self._client.scene

    def frame_origins(self) -> Mapping[str, Array]:
        """Return where the frames are: name → (3,) in the fixed frame [m]."""
        tree, fixed = self._scene.context.tree, self._scene.context.fixed_frame
        there = (name for name in tree.frames if tree.can_lookup(fixed, name))
        return {name: tree.lookup(fixed, name).translation for name in there}

    def select(self, items: Selection | Set[Selectable], modifier: str | None) -> None:
        """Replace the selection, add to it (Shift) or remove from it (Ctrl)."""
        given = items if isinstance(items, Mapping) else dict.fromkeys(items)
        with self._change(self.changed):
            self._take_selection(merged(self.selection, given, modifier))
        self._selected(self._client.client_id, self.selection)

    def _take_selection(self, selection: Selection) -> None:
        self.selection = selection
        self._draw_boxes()
        # A step of a joint costs nothing while nothing is selected.
        self._moving.to(*(self._drawn if selection else ()))

    def data_of(self, item: Selectable) -> SelectedData | None:
        """Return the details of selected data; None if they are no longer drawn."""
        return self._picker.data_of(item)

    def look_at(self, point: Array) -> None:
        """Turn the camera to a point of the fixed frame, (3,) [m]."""
        self._view.look_at(point)

    def finish(self) -> None:
        """Go back to the default tool."""
        self.choose(self.default.kind)

    def show_status(self, status: str) -> None:
        """Show a sentence below the toolbar; an empty one shows the tool's help."""
        with self._change(self.changed):
            self.status, self.wants_map = status, False

    def use_map(self) -> None:
        """Make the map the fixed frame, for everyone, as the last refusal asked for."""
        with self._change(self.changed):
            self._document.set_option("Fixed Frame", MAP)
            self.status, self.wants_map = "", False

    @property
    def fixed_frame(self) -> str:
        """The fixed frame, in which clicks are."""
        return self._scene.context.fixed_frame

    def publish_refusal(self, kind: Kind) -> str:
        """Return why this user may send nothing of a kind; empty when he may."""
        if not self._roles.may_edit(self._client.client_id):
            return VIEW_ONLY
        return self._publisher.refusal(kind)

    @property
    def pose_refusal(self) -> str:
        """The reason why the current tool may not publish; empty if it may.

        Control is not checked here: the page knows who has it.
        """
        tool = self.current
        sends = isinstance(tool, PoseTool)
        return self._publisher.refusal(tool.message.kind) if sends else ""

    def prepare(self, kind: Kind, topic: str, type_name: str) -> None:
        """Let the robot know of a topic before something is sent on it."""
        if not self.publish_refusal(kind):
            self._publisher.prepare(kind, topic, type_name)

    def publish(self, message: Outbound, topic: str, *, leave: bool = True) -> None:
        """Send a message to the robot once, and show what becomes of it."""
        with self._change(self.changed):
            self.wants_map = False
            try:
                if why := self.publish_refusal(message.kind):
                    raise PublishError(why)
                told = self._publisher.send(message, topic, self._name, self._tell)
            except (PublishError, SourceError) as error:
                self.status = f"{capitalized(str(error))}."
                is_wrong = isinstance(error, PublishFrameError)
                known = self._scene.context.tree.frames
                self.wants_map = is_wrong and MAP in known
                return
            if leave:
                self._switch(self.default)
            self.status = f"Sent to {told}."

    @property
    def has_handles(self) -> bool:
        """Whether something is shown that a hand can move."""
        return self._publisher.robot is not None and self._picker.has_handles

    def handle(self, item: Selectable) -> Handle | None:
        """Return the movable marker that a ray has hit; None without one."""
        return self._picker.handle(item)

    def tell_program(
        self, messages: Sequence[Outbound], topic: str, *, follows: bool = False
    ) -> bool:
        """Send the events of a marker together; return whether they were sent."""
        try:
            for number, message in enumerate(messages):
                if why := self.publish_refusal(message.kind):
                    raise PublishError(why)
                behind = follows or number > 0
                self._publisher.send(message, topic, self._name, follows=behind)
        except PublishPaceError:
            return False
        except (PublishError, SourceError) as error:
            self.show_status(f"{capitalized(str(error))}.")
            return False
        return True

    def show_menu(self, title: str, entries: Sequence[MenuEntry]) -> None:
        """Show a menu where the pointer is."""
        with self._change(self.changed):
            self.menu = self.menu[0] + 1, title, entries

    # Inside

    @property
    def _name(self) -> str:
        """What its user is called."""
        person = self._roles.people.get(self._client.client_id)
        return "" if person is None else person.name

    def _tell(self, outcome: Outcome) -> None:
        """Show what has become of a goal; in the thread of the source."""

        def show() -> None:
            self.show_status(f"{capitalized(outcome.words)}.")

        self._worker.post(show, client=self._client.client_id)

    def _follow(
        self,
        what: str,
        click: Click,
        then: Callable[[Hit], None],
        *,
        handles: bool = False,
    ) -> None:
        ray = click.origin, click.direction, click.pixel, click.up
        facing = click.facing if handles else None
        self._picker.follow((self, what), lambda s: s.first_hit(*ray), then, facing)

    def _follow_mouse(self, tool: Tool) -> None:
        """Give a tool the hits under the mouse, and again if the mouse has moved."""
        click = pointed_at(self._client, self._mouse)
        if click is None:
            return
        followed, self._hovering = self._mouse, True

        def then(hit: Hit) -> None:
            self._hovering = False
            with self._change(self.changed):
                if self.current is tool and tool.wants_hover:
                    tool.hover(click, hit)
                self.over = followed, self.current is tool and tool.holds
            if self._mouse != followed:
                self.hover(self._mouse)

        self._follow("hover", click, then, handles=tool.takes_handles)

    def _take_config(self) -> None:
        """The tools of the document, then the others, each with its settings."""
        config = self._document.config
        if self._config is config:
            return
        self._config = config
        items = {item.kind: item for item in config.tools if item.kind in TOOLS}
        kinds = [*items, *(kind for kind in TOOLS if kind not in items)]
        self.current.cancel()
        self.tools = tuple(TOOLS[kind](self, items.get(kind)) for kind in kinds)
        self.current = self.default
        self._settings = self._read_settings()
        self._listen()

    def _take_settings(self) -> None:
        """Let the tools draw with the settings that the document has now."""
        before, self._settings = self._settings, self._read_settings()
        for tool in self.tools:
            if self._settings.get(tool.kind) != before.get(tool.kind):
                tool.property_changed()

    def _read_settings(self) -> dict[str, dict[str, Any]]:
        return {t.kind: dict(t.config.properties) for t in self.tools if t.config}

    def _switch(self, tool: Tool) -> None:
        if tool is not self.current:
            self.current.left()
            self.current = tool
            self.status, self.wants_map = "", False
            self.over = NOWHERE, False
            self._listen()
            tool.chosen()

    def _listen(self) -> None:
        """Get what the current tool uses of the mouse, and nothing else."""
        client, tool = self._client, self.current
        listen(client, tool, self._worker, self._click, self._rectangle)

    def _click(self, tool: Tool, click: Click) -> None:
        def then(hit: Hit) -> None:
            with self._change(self.changed):
                # The tool may have changed meanwhile.
                if self.current is tool:
                    tool.click(click, hit)

        self._follow("click", click, then)

    def _rectangle(self, tool: Tool, rays: RayGrid, modifier: str | None) -> None:
        def then(items: Selection) -> None:
            with self._change(self.changed):
                if self.current is tool:
                    tool.rectangle(items, modifier)

        self._picker.follow((self, "box"), lambda s: s.items_met(rays), then)

    def _take_document(self) -> None:
        with self._change(self.changed):
            self._take_config()
            self._take_settings()

    def _move_boxes(self) -> None:
        kept = self._picker.kept(self.selection)
        if len(kept) < len(self.selection):
            with self._change(self.changed):
                self._take_selection(kept)
            return
        with self._change():
            self._draw_boxes()

    def _draw_boxes(self) -> None:
        self._boxes.draw(self._picker.boxes_of(self.selection))
