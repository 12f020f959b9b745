"""What the page can call: each command is declared once, with what its method takes."""

from __future__ import annotations

import inspect
import json
from collections import Counter
from collections.abc import Iterator

import pytest

from sambot_viz.panels import window
from sambot_viz.panels.command import (
    FLAG,
    NUMBER,
    TEXT,
    Command,
    command,
    declared_commands,
)
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Data, Row

# The window imports every panel.
assert window


def panels(kind: type[Panel] = Panel) -> Iterator[type[Panel]]:
    """The classes of all panels of the program."""
    for one in kind.__subclasses__():
        if one.__module__.startswith("sambot_viz."):
            yield one
            yield from panels(one)


DECLARED = [found for kind in panels() for found in declared_commands(kind)]


@pytest.mark.parametrize("declared", DECLARED, ids=lambda found: found.id)
def test_a_method_takes_what_its_declaration_says(declared: Command) -> None:
    _, *parameters = inspect.signature(declared.run).parameters.values()
    if declared.at_once:
        # The number of the client comes first.
        del parameters[0]
    taken = [str(parameter.annotation) for parameter in parameters]
    assert len(taken) == len(declared.arguments)
    for annotation, argument in zip(taken, declared.arguments, strict=True):
        named = argument.type.__name__ + (" | None" if argument.optional else "")
        assert annotation == named or annotation.startswith(f"{named}[")


def test_a_command_is_declared_once() -> None:
    assert len(DECLARED) > 40
    assert max(Counter(found.id for found in DECLARED).values()) == 1


def test_few_commands_are_for_viewers_too() -> None:
    """A new one is here only when others see nothing of what it changes."""
    local = {found.id for found in DECLARED if found.client_local}
    assert local == {
        # What somebody did as a viewer.
        *("edit/undo", "edit/redo", "edit/resume"),
        *("file/download", "file/page", "file/picture", "frames/show", "graph/show"),
        *("images/show", "joints/copy", "model/show"),
        *("model/find", "model/open", "model/call", "model/expand", "model/number"),
        "numbers/show",
        # What is drawn or listed in one page alone.
        *("add_by_topic/show", "poses/show", "tools/double_click"),
        *("permalink/copy", "permalink/open"),
        *(
            "role/request",
            "role/release",
            "role/give",
            "role/decline",
            "role/take-back",
        ),
        # These ask themselves whether a presenter calls them.
        *("role/decline-all", "role/remove", "role/rename", "people/invite"),
        "role/greet",
        *("topics/show", "topics/find", "topics/choose"),
        *("tools/choose", "tools/escape", "tools/focus", "tools/hover"),
        "drive/find",
        # Letting go, and STOP, are for everyone.
        *("live/release", "live/stop"),
        *("tools/press", "tools/right_click", "tools/zero", "tools/drag"),
        # What is sent to a robot asks for control itself.
        *("tools/drop", "tools/preview", "tools/send", "tools/entry"),
        "tools/open_menu",
        *("views/first", "views/restore", "views/use"),
        *("views/side", "views/press_side"),
    }


class Doors(Panel):
    name = "doors"

    def __init__(self) -> None:
        self.open = True
        self.heard: list[object] = []

    def rows(self) -> list[Row]:
        return [Row("door", "", "bool", "Door", self.open)]

    def data(self) -> list[Data]:
        return [Data("doors/names", ["front"])]

    def offers(self, command_id: str) -> bool:
        return command_id != "doors/close" or self.open

    @command("doors/close")
    def _close(self) -> None:
        self.open = False

    @command("doors/knock", TEXT, NUMBER, FLAG, client_local=True)
    def _knock(self, who: str, hard: float, twice: bool) -> None:
        self.heard.append((who, hard, twice))


def test_a_panel_gives_rows_data_and_the_commands_that_it_offers_now() -> None:
    doors = Doors()
    assert [item.json()["kind"] for item in doors.items()] == [
        *("bool", "data", "command", "command")
    ]
    close, knock = doors.commands()
    knock.run("Ann", 1.0, False)
    assert doors.heard == [("Ann", 1.0, False)]
    close.run()
    assert [found.id for found in doors.commands()] == ["doors/knock"]


def test_the_page_gets_of_data_and_commands_only_what_it_needs() -> None:
    assert [item.json() for item in Doors().items()[1:]] == [
        {"id": "doors/names", "in": "", "kind": "data", "value": ["front"]},
        {"id": "doors/close", "in": "", "kind": "command"},
        {"id": "doors/knock", "in": "", "kind": "command", "local": True},
    ]
    assert Data("none").json() == {"id": "none", "in": "", "kind": "data"}
    shown = json.dumps(Data("odd", ["\ud800"]).json())
    assert "ud800" not in shown


def test_the_types_of_arguments_are_those_of_json() -> None:
    kinds = {argument.type for found in DECLARED for argument in found.arguments}
    assert kinds <= {str, float, int, bool, list}
