"""What a page shows, as a screen reader gets it: roles, names, values and states."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from browser_input import Caller
from patience import patience

Name = str | re.Pattern[str] | None
"""An exact name, a pattern that is searched in it, or any name."""
Role = str | re.Pattern[str]
_GAP = "\u2003"
"""Stands before a line for each level above it, and between a name and a value."""


@dataclass(eq=False, slots=True)
class Thing:
    """One thing of the page, as it was when it was looked at.

    What is in it is asked for when it is needed, and then only the role that is wanted:
    the whole of a page takes the browser and Python five times as long.

    Attributes:
        role: its ARIA role, such as "button".
        name: its accessible name.
        value: what it holds; None when it holds nothing.
        states: "checked", "expanded", "pressed", "selected", "disabled", "level", …
        node: the browser's number of the element.
        number: that of the thing in the tree.
        around: the number of the thing that it is in.
        page: where it is.
    """

    role: str
    name: str
    value: Any
    states: dict[str, Any]
    node: int
    number: str
    around: str
    page: Caller
    _inside: list[Thing] | None = None

    def look_inside(self) -> Thing:
        """Get all that is in it as it is now; returns itself."""
        nodes = _nodes(self.page, self.node)
        by_id = {node["nodeId"]: node for node in nodes}
        self._inside = []
        left = [(child, self) for child in _reversed_ids(nodes[0])]
        while left:
            node_id, parent = left.pop()
            node = by_id.get(node_id)
            if node is None:
                continue
            if not node.get("ignored"):
                thing = _thing(node, self.page)
                thing._inside = []
                parent.children.append(thing)
                parent = thing
            left += [(child, parent) for child in _reversed_ids(node)]
        return self

    @property
    def children(self) -> list[Thing]:
        """What is in it."""
        if self._inside is None:
            self.look_inside()
        assert self._inside is not None
        return self._inside

    def walk(self) -> Iterator[Thing]:
        """Itself and all that is in it, in the order of the page."""
        yield self
        for child in self.children:
            yield from child.walk()

    def all(self, role: Role, name: Name = None) -> list[Thing]:
        """What is in it of a role, with a name."""
        if self._inside is None and isinstance(role, str):
            nodes = _nodes(self.page, self.node, role)
            found = [_thing(n, self.page) for n in nodes if not n.get("ignored")]
        else:
            found = [t for t in self.walk() if fits(t.role, role)]
        return [t for t in found if fits(t.name, name)]

    def one(self, role: Role, name: Name = None) -> Thing:
        """The only thing in it of a role, with a name.

        Raises:
            AssertionError: there is none, or more than one.
        """
        of_role = self.all(role)
        found = [t for t in of_role if fits(t.name, name)]
        if len(found) != 1:
            shown = getattr(name, "pattern", name)
            known = sorted({t.name for t in of_role})
            raise AssertionError(
                f"{len(found)} things of role {role} named {shown!r} in "
                f"{self.role} {self.name!r}; there are {known}"
            )
        return found[0]

    @property
    def text(self) -> str:
        """The text in it, also that of fields."""
        if self.role in ("StaticText", "textbox", "combobox", "searchbox"):
            return str(self.value if self.value is not None else self.name)
        return " ".join(part for c in self.children if (part := c.text))

    @property
    def is_on(self) -> bool:
        """Whether a box is ticked, or a button is pressed."""
        return "true" in (self.states.get("checked"), self.states.get("pressed"))

    def state(self, name: str) -> bool:
        """Whether a state of yes or no is on: "expanded", "selected", "disabled", …"""
        return self.states.get(name) in (True, "true")


def fits(name: str, wanted: Name) -> bool:
    """Whether a name is the wanted one."""
    if isinstance(wanted, re.Pattern):
        return wanted.search(name) is not None
    return wanted is None or name == wanted


def look(page: Caller) -> Thing:
    """All that a page shows; what a screen reader passes over is left out."""
    return _thing(_ask(page, "getRootAXNode")["node"], page)


def _ask(page: Caller, method: str, params: dict[str, Any] | None = None) -> Any:
    """Chromium forgets what it was asked while the page goes elsewhere.

    Who waits for something asks again then, and has the time to.
    """
    return page.call(f"Accessibility.{method}", params, patience(3.0))


def _nodes(page: Caller, node: int, role: str = "") -> list[dict[str, Any]]:
    """An element and what is in it, in the order of the page, or one role of it."""
    asked = {"backendNodeId": node} | ({"role": role} if role else {})
    return list(_ask(page, "queryAXTree", asked)["nodes"])


def _reversed_ids(node: dict[str, Any]) -> list[str]:
    return list(reversed(node.get("childIds", [])))


def _thing(node: dict[str, Any], page: Caller) -> Thing:
    return Thing(
        str(node.get("role", {}).get("value", "")),
        str(node.get("name", {}).get("value", "")),
        node.get("value", {}).get("value"),
        {p["name"]: p["value"].get("value") for p in node.get("properties", [])},
        int(node.get("backendDOMNodeId", 0)),
        str(node["nodeId"]),
        str(node.get("parentId", "")),
        page,
    )


def rows_of(grid: Thing) -> list[tuple[tuple[str, ...], Thing]]:
    """The rows of a tree grid, each with its label behind those of the rows above.

    The label is what its first cell says; where a row out of sight is a line of text,
    the part before the value. Rows that are far out of sight are lines in one thing.
    """
    first: dict[str, str] = {}
    for cell in grid.all("gridcell"):
        first.setdefault(cell.around, cell.name)
    found: list[tuple[tuple[str, ...], Thing]] = []
    above: list[str] = []
    for row in grid.all("row"):
        level = row.states.get("level")
        for line in [first.get(row.number, row.name)] if level else _lines(row):
            text = line.lstrip(_GAP)
            del above[max(0, int(level or 1 + len(line) - len(text)) - 1) :]
            above.append(text.partition(_GAP)[0])
            found.append((tuple(above), row))
    return found


def _lines(row: Thing) -> list[str]:
    """The lines of what stands for many rows; a name has no ends of lines in it."""
    return "".join(text.name for text in row.all("StaticText")).split("\n")
