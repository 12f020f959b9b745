"""Commands for displays: add, copy, rename, move, remove."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from sambot_viz.displays.by_topic import displays_of_topic
from sambot_viz.displays.display import Display
from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.errors import UsageError
from sambot_viz.panels.command import INTEGER, TEXT, Argument, command
from sambot_viz.panels.displays.displays_panel import DisplaysPanel
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Data, Json
from sambot_viz.rviz import DisplayConfig
from sambot_viz.rviz.declarations import row_text
from sambot_viz.session.document.display_edits import DisplayEdits
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.scene.scene import Scene
from sambot_viz.topics import reasons

TYPES: list[Json] = [
    {"kind": kind, "help": DISPLAYS.help_of(kind)} for kind in DISPLAYS
]


class DisplayCommands(Panel):
    """The types that can be added, the last added display, and the commands.

    Each page sends a mark with its request, and selects the row that comes back with
    the mark.

    Args:
        displays: the rows of the displays.
        scene: the drawn scene.
        document: the document, with the displays that no config names.
        remake: called when a display was added.
    """

    name = "add"

    def __init__(
        self,
        display_edits: DisplayEdits,
        displays: DisplaysPanel,
        scene: Scene,
        document: ShownDocument,
        remake: Callable[[Panel], None],
    ) -> None:
        self.remade_by = (document.displays, document.replaced)
        self._display_edits = display_edits
        self._displays = displays
        self._scene = scene
        self._remake = remake
        self._made: Json = None

    def data(self) -> Sequence[Data]:
        """Return what the Add dialog offers, and the last display that was made."""
        return [
            Data("displays/types", TYPES),
            Data("displays/made", self._made),
            Data("displays/unasked", self._display_edits.has_unasked),
        ]

    @command("displays/add", TEXT, TEXT, TEXT, name="Add")
    def _add(self, kind: str, name: str, mark: str) -> None:
        """Add a display at the end."""
        if kind not in DISPLAYS:
            raise UsageError(f"displays of type {row_text(kind)} cannot be added")
        made = self._display_edits.add_display(kind, name=name.strip() or None)
        self._note(made, mark)

    @command(
        "displays/add-topic",
        TEXT,
        TEXT,
        TEXT,
        TEXT,
        Argument(int, optional=True),
        TEXT,
        name="Add",
    )
    def _add_by_topic(
        self,
        kind: str,
        topic: str,
        name: str,
        group: str,
        index: int | None,
        mark: str,
    ) -> None:
        """Add a display that shows a topic.

        Args:
            kind: class of the display; empty for the one that usually shows the topic.
            topic: the topic.
            name: name of the display; empty for one after its class.
            group: the row of the group to add it to; empty for the top level.
            index: its place there; None for the end.
            mark: the mark of the requesting page.
        """
        messages = self._scene.context.messages
        type_name = "" if messages is None else messages.types().get(topic, "")
        if messages is None or not type_name:
            raise UsageError(f"there is no topic {topic}")
        if kind and kind not in DISPLAYS:
            raise UsageError(f"displays of type {row_text(kind)} cannot be added")
        display = DISPLAYS[kind] if kind else _usual_display(topic, type_name)
        values = display.topic_values(topic, type_name, messages.offered(topic))
        if values is None:
            raise UsageError(f"{row_text(kind)} does not show {type_name}")
        into = self._displays.display_of(group) if group else None
        made = self._display_edits.add_display(
            display.kind,
            name=name.strip() or None,
            values=values,
            place=None if index is None else (index, into),
        )
        self._note(made, mark)

    @command("displays/duplicate", TEXT, TEXT, name="Duplicate")
    def _duplicate(self, row_id: str, mark: str) -> None:
        """Add a copy of a display after it."""
        config = self._displays.display_of(row_id)
        self._note(self._display_edits.duplicate_display(config), mark)

    def _note(self, config: DisplayConfig, mark: str) -> None:
        self._made = {"mark": mark, "row": self._displays.id_of(config)}
        self._remake(self)

    @command("displays/remove", TEXT, name="Remove")
    def _delete(self, row_id: str) -> None:
        self._display_edits.remove_display(self._displays.display_of(row_id))

    @command("displays/only_config", name="Show only what the config says")
    def _only_config(self) -> None:
        self._display_edits.remove_unasked()

    @command("displays/rename", TEXT, TEXT, name="Rename")
    def _rename(self, row_id: str, name: str) -> None:
        if not name.strip():
            raise UsageError("a display needs a name")
        display = self._displays.display_of(row_id)
        self._display_edits.rename_display(display, name.strip())

    @command("displays/move", TEXT, TEXT, INTEGER, name="Move")
    def _move(self, row_id: str, group: str, index: int) -> None:
        into = self._displays.display_of(group) if group else None
        self._display_edits.move_display(self._displays.display_of(row_id), index, into)


def _usual_display(topic: str, type_name: str) -> type[Display]:
    """Return the class of display that usually shows a topic.

    Raises:
        UsageError: no display shows it.
    """
    found = displays_of_topic(topic, type_name)
    if not found:
        raise UsageError(f"{topic}: {reasons.no_display(type_name, ()).text}")
    return found[0]
