"""The toolbar of one browser, and RViz's Tool Properties panel."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from sambot_viz.displays.picking.handle import MenuEntry
from sambot_viz.displays.picking.selectable import labels
from sambot_viz.errors import UsageError
from sambot_viz.panels.command import INTEGER, NUMBER, TEXT, Argument, command
from sambot_viz.panels.joints.joint_rows import joint_id
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.property_rows import property_rows
from sambot_viz.panels.rows.row import Answer, Data, Json, Row
from sambot_viz.session.clients.client import Client
from sambot_viz.session.clients.clients import Clients
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.scene import Scene
from sambot_viz.text import capitalized, text
from sambot_viz.tools.tool import Tool

_PLACE = Argument(float, optional=True)
"""Of the mouse in the view, 0 to 1 from left or top; None when it is not there."""

_MODIFIER = Argument(str, optional=True)
"""A key that is held; None for none."""


class ToolsPanel(Panel):
    """The tools, the current one, its hint, and the commands of keys and buttons.

    "tools/choose" always chooses a tool. "tools/press" follows RViz's rule for keys:
    pressed again, it goes back to the default tool.

    Args:
        client: the owner of the tools.
        scene: drawn again by Reset.
        clients: their pointer shows the selection to everyone.
        robot: has the joints of double-clicked links.
    """

    name = "tools"

    def __init__(
        self, client: Client, scene: Scene, clients: Clients, robot: RobotState
    ) -> None:
        self.remade_by = (client.tools.changed,)
        self._client = client
        self._scene = scene
        self._pointer = clients.pointer
        self._robot = robot

    def data(self) -> Sequence[Data]:
        """Return the tools, the hint of the current one, and the selection."""
        tools = self._client.tools
        hint = tools.status or tools.current.help
        touch = hint.replace(tools.current.help, tools.current.touch)
        return [
            Data("tools/list", [self._tool(tool) for tool in tools.offered]),
            Data("tools/controls", tools.shows_controls),
            Data("tools/frame", tools.fixed_frame),
            Data("tools/hint", {"text": hint, "touch": touch}),
            Data("tools/pose_refusal", capitalized(tools.pose_refusal)),
            Data("tools/wants_map", tools.wants_map),
            Data("tools/selected", [*labels(tools.selection)]),
            Data("tools/pointed", self._pointed()),
            Data("tools/over", self._over()),
            Data("tools/menu", self._menu()),
        ]

    def _over(self) -> Json:
        """Return where the mouse was last, and whether a press there is a drag."""
        (x, y), holds = self._client.tools.over
        return {"x": x, "y": y, "holds": holds}

    def _menu(self) -> Json:
        """Return the menu that was shown last."""
        number, title, entries = self._client.tools.menu
        return {
            "number": number,
            "title": text(title, 120),
            "entries": [_entry(one) for one in entries],
        }

    def _pointed(self) -> Json:
        """Return the row of the joint that moves the link clicked on twice."""
        item, count = self._client.tools.pointed
        if item is not None and item.is_data:
            item = None
        joint = None if item is None else self._robot.joint_of(item.name)
        return {
            "number": count,
            "link": None if item is None else item.name,
            "row": None if joint is None else joint_id(joint.name),
        }

    def _tool(self, tool: Tool) -> Json:
        current = tool is self._client.tools.current
        return {
            "name": tool.label,
            "key": tool.key.lower(),
            "help": tool.help,
            "current": current,
            "first": tool is self._client.tools.default,
            "hover": current and tool.wants_hover,
            "clicks": tool.clicks,
            "rectangles": tool.rectangles,
            "drags": tool.drags,
            "handles": tool.takes_handles,
            "poses": tool.takes_pose,
        }

    def _kind(self, label: str) -> str:
        for tool in self._client.tools.tools:
            if tool.label == label:
                return tool.kind
        raise UsageError(f"there is no tool '{label}'")

    @command("tools/reset", name="Reset")
    def _reset(self) -> None:
        """Draw the scene again for everyone."""
        self._scene.refresh()

    @command("tools/point", name="Point at the selection")
    def _point(self) -> Answer:
        """Show the selection to everyone."""
        items = self._client.tools.selection
        if not items:
            raise UsageError("select what to point at first, with the tool Select")
        self._pointer.show(items)
        return Answer("All pages show what you have selected")

    @command("tools/choose", TEXT, client_local=True)
    def _choose(self, label: str) -> None:
        self._client.tools.choose(self._kind(label))

    @command("tools/press", TEXT, client_local=True)
    def _press(self, label: str) -> None:
        self._client.tools.press(self._kind(label))

    @command("tools/escape", client_local=True)
    def _escape(self) -> None:
        self._client.tools.escape()

    @command("tools/hover", NUMBER, NUMBER, client_local=True)
    def _hover(self, x: float, y: float) -> None:
        self._client.tools.hover((x, y))

    # Of the moves of a drag that wait only the last one counts: each has its beginning.
    @command("tools/drag", *[NUMBER] * 4, _MODIFIER, client_local=True)
    def _drag(
        self, from_x: float, from_y: float, x: float, y: float, held: str | None
    ) -> None:
        self._client.tools.drag((from_x, from_y), (x, y), held)

    @command("tools/drop", *[NUMBER] * 4, _MODIFIER, client_local=True)
    def _drop(
        self, from_x: float, from_y: float, x: float, y: float, held: str | None
    ) -> None:
        self._client.tools.drag((from_x, from_y), (x, y), held, ends=True)

    @command("tools/open_menu", client_local=True)
    def _open_menu(self) -> None:
        self._client.tools.open_menu()

    @command("tools/entry", INTEGER, client_local=True)
    def _choose_entry(self, number: int) -> None:
        self._client.tools.choose_entry(number)

    @command("tools/preview", *[NUMBER] * 3, client_local=True)
    def _preview(self, x: float, y: float, yaw: float) -> None:
        self._client.tools.place(x, y, yaw)

    @command("tools/send", *[NUMBER] * 3, client_local=True)
    def _send(self, x: float, y: float, yaw: float) -> None:
        self._client.tools.place(x, y, yaw, sends=True)

    @command("tools/use_map", name="Use map")
    def _use_map(self) -> None:
        self._client.tools.use_map()

    @command("tools/double_click", NUMBER, NUMBER, client_local=True)
    def _double_click(self, x: float, y: float) -> None:
        self._client.tools.double_click((x, y))

    @command("tools/right_click", client_local=True)
    def _right_click(self) -> None:
        self._client.tools.right_click()

    @command("tools/focus", _PLACE, _PLACE, client_local=True)
    def _focus(self, x: float | None, y: float | None) -> None:
        self._client.tools.focus(None if x is None or y is None else (x, y))

    @command("tools/zero", client_local=True)
    def _zero(self) -> None:
        self._client.view.zero()


class ToolPropertiesPanel(Panel):
    """The settings of the tools that the document lists, as in RViz.

    Args:
        client: whose tools these are.
        document: keeps their settings.
    """

    name = "tool_properties"

    def __init__(self, client: Client, document: ShownDocument) -> None:
        self.remade_by = (client.tools.changed,)
        self._client = client
        self._document = document

    def rows(self) -> Sequence[Row]:
        """Return a group per tool that has settings."""
        made = [row for tool in self._client.tools.tools for row in self._of(tool)]
        return made or [Row("tool_properties/none", "", "note", value=_NO_SETTINGS)]

    def _of(self, tool: Tool) -> Sequence[Row]:
        if tool.config is None:
            return ()
        group = f"tool_properties/{tool.label}"
        change = partial(self._document.set_tool_property, tool.kind)
        below = [*property_rows(tool.config, group, change)]
        head = Row(
            group,
            "",
            "group",
            tool.label,
            icon=tool.label,
            help=tool.help,
            expanded=True,
        )
        return [head, *below] if below else ()


_NO_SETTINGS = "No tool of this config has settings."


def _entry(entry: MenuEntry) -> Json:
    return {
        "id": entry.id,
        "title": entry.title,
        "runs": entry.runs,
        "entries": [_entry(one) for one in entry.entries],
    }
