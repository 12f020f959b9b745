"""What a page shows, as a screen reader gets it: roles, names, values and states."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from browser_input import Caller

Name = str | re.Pattern[str] | None
"""An exact name, a pattern that is searched in it, or any name."""
Role = str | re.Pattern[str]


@dataclass(eq=False, slots=True)
class Thing:
    """One thing of the page, as it was when it was looked at.

    Attributes:
        role: its ARIA role, such as "button".
        name: its accessible name.
        value: what it holds; None when it holds nothing.
        states: "checked", "expanded", "pressed", "selected", "disabled", "level", …
        node: the browser's number of the element.
        parent: what it is in.
        children: what is in it.
    """

    role: str
    name: str
    value: Any
    states: dict[str, Any]
    node: int
    parent: Thing | None = None
    children: list[Thing] = field(default_factory=list["Thing"])

    def walk(self) -> Iterator[Thing]:
        """Itself and all that is in it, in the order of the page."""
        yield self
        for child in self.children:
            yield from child.walk()

    def all(self, role: Role, name: Name = None) -> list[Thing]:
        """What is in it of a role, with a name."""
        return [t for t in self.walk() if fits(t.role, role) and fits(t.name, name)]

    def one(self, role: Role, name: Name = None) -> Thing:
        """The only thing in it of a role, with a name.

        Raises:
            AssertionError: there is none, or more than one.
        """
        found = self.all(role, name)
        if len(found) != 1:
            shown = getattr(name, "pattern", name)
            known = sorted({t.name for t in self.walk() if fits(t.role, role)})
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
    """All that a page shows now; what a screen reader passes over is left out."""
    nodes: list[dict[str, Any]] = page.call("Accessibility.getFullAXTree")["nodes"]
    by_id = {node["nodeId"]: node for node in nodes}
    root = _thing(nodes[0])
    left = [(child, root) for child in reversed(nodes[0].get("childIds", []))]
    while left:
        node_id, parent = left.pop()
        node = by_id.get(node_id)
        if node is None:
            continue
        if not node.get("ignored"):
            thing = _thing(node)
            thing.parent = parent
            parent.children.append(thing)
            parent = thing
        left += [(child, parent) for child in reversed(node.get("childIds", []))]
    return root


def _thing(node: dict[str, Any]) -> Thing:
    return Thing(
        str(node.get("role", {}).get("value", "")),
        str(node.get("name", {}).get("value", "")),
        node.get("value", {}).get("value"),
        {p["name"]: p["value"].get("value") for p in node.get("properties", [])},
        int(node.get("backendDOMNodeId", 0)),
    )


def row_label(row: Thing) -> str:
    """The name of a row of a tree grid: what is in its first cell."""
    cells = row.all("gridcell")
    return cells[0].name if cells else row.name


def rows_of(grid: Thing) -> list[tuple[tuple[str, ...], Thing]]:
    """The rows of a tree grid, each with its label behind those of the rows above."""
    found: list[tuple[tuple[str, ...], Thing]] = []
    above: list[str] = []
    for row in grid.all("row"):
        del above[max(0, int(row.states.get("level", 1)) - 1) :]
        above.append(row_label(row))
        found.append((tuple(above), row))
    return found
