"""Read permalinks, which are names and values, and write values short and exact."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, cast

from sambot_viz.errors import UsageError
from sambot_viz.panels.rows.row import Answer, Json, Row
from sambot_viz.session.people.roles import VIEW_ONLY
from sambot_viz.text import text

VERSION = "1"
MOST_NAMED = 4
"""Maximum number of listed names that this robot does not have."""
ON, OFF = "1", "0"

Pair = tuple[str, str]


@dataclass
class PermalinkParts:
    """The contents of a permalink, and the parts that cannot be shown here.

    Attributes:
        kind: the type of the view, such as "Orbit".
        robot: the name of the robot.
        time: time of a recording, from its first message [s].
        fixed: the fixed frame, if it is not that of the config.
        view: property of the view → value.
        joints: joint → position [rad or m].
        switches: name → whether the display is on (see `session.switches`).
        selected: kind and name of the selection, such as "link:base_link".
        elsewhere: whether the robot here is another one.
        watching: whether this browser may only change its own view.
        kept: whether joints or switches are unchanged for that reason.
        missing: the parts that do not exist here.
        refused: why some of the values are refused.
    """

    kind: str = ""
    robot: str | None = None
    time: str = ""
    fixed: str | None = None
    view: dict[str, str] = field(default_factory=dict[str, str])
    joints: dict[str, str] = field(default_factory=dict[str, str])
    switches: dict[str, bool] = field(default_factory=dict[str, bool])
    selected: list[str] = field(default_factory=list[str])
    elsewhere: bool = False
    watching: bool = False
    kept: bool = False
    missing: Missing = field(default_factory=lambda: Missing())
    refused: list[str] = field(default_factory=list[str])

    @classmethod
    def read(cls, names: list[Any], values: list[Any]) -> PermalinkParts:
        """Read the parts of a link.

        Raises:
            UsageError: a part is missing, or it is no link of this program.
        """
        pairs = list(zip(names, values, strict=False))
        whole = len(names) == len(values) and all(
            isinstance(part, str) for part in (*names, *values)
        )
        if not whole or not pairs or names[-1] != "v":
            raise UsageError(
                "this link is incomplete and was not opened: copy it again"
            )
        if values[-1] != VERSION:
            raise UsageError(
                "this link was made by another version of sambot-viz and was not opened"
            )
        link = cls()
        for name, value in cast("list[Pair]", pairs[:-1]):
            link._take(name, value)
        return link

    def refuse(self, why: str) -> None:
        """Note a value that is refused, or something that cannot be done here."""
        if why not in self.refused:
            self.refused.append(why)

    def answer(self) -> Answer:
        """Return the notice: all is as in the link, or what differs."""
        said = [self.missing.sentence(), *self.refused[:MOST_NAMED]]
        if self.kept:
            kept = f"{'time, ' if self.time else ''}joints and displays"
            said.append(f"{kept} stay as they are: {VIEW_ONLY}")
        trouble = "; ".join(part for part in said if part)
        if not trouble and not self.elsewhere:
            return Answer("Opened the link")
        begin = "Opened the link, but not all of it"
        if self.elsewhere:
            begin = f"Opened a link of the robot '{text(self.robot or '', 60)}'"
        return Answer(f"{begin}: {trouble}" if trouble else begin, level="warn")

    def _take(self, name: str, value: str) -> None:
        head, _, rest = name.partition(".")
        if name == "view":
            self.kind = value
        elif name == "robot":
            self.robot = value
        elif name == "time":
            self.time = value
        elif name == "fixed":
            self.fixed = value
        elif name == "select":
            self.selected.append(value)
        elif head == "view":
            self.view[rest] = value
        elif head == "j":
            self.joints[rest] = value
        elif head == "show" and value in (ON, OFF):
            self.switches[rest] = value == ON
        else:
            self.missing["part of the link"] += [name]


class Missing(dict[str, list[str]]):
    """Kind of item → the names that do not exist here."""

    def __missing__(self, kind: str) -> list[str]:
        return []

    def sentence(self) -> str:
        """Return in words what does not exist."""
        parts: list[str] = []
        for kind, names in self.items():
            shown = [f"'{text(name, 60)}'" for name in names[:MOST_NAMED]]
            if len(names) > MOST_NAMED:
                shown.append(f"{len(names) - MOST_NAMED} more")
            if names:
                parts.append(f"no {kind} {', '.join(shown)}")
        return "; ".join(parts)


def written(value: Json) -> str:
    """Return a value of a row as a text of a permalink."""
    if isinstance(value, bool):
        return ON if value else OFF
    if isinstance(value, list | tuple):
        return ",".join(written(part) for part in cast("Sequence[Json]", value))
    return f"{value:.7g}" if isinstance(value, float) else str(value)


def short(row: Row, position: float) -> str:
    """Return a position with few digits, if it is inside the limits then too."""
    rounded = f"{position:.6g}"
    low, high = row.least, row.most
    inside = (low is None or low <= float(rounded)) and (
        high is None or float(rounded) <= high
    )
    return rounded if inside else repr(position)


def read(row: Row, given: str) -> Json:
    """Return a text of a permalink as the value of a row, to be validated."""
    if row.kind == "bool":
        return {ON: True, OFF: False}.get(given, given)
    if row.kind in ("int", "float"):
        return number(given)
    if row.kind == "vector":
        return [number(part) for part in given.split(",")]
    return given


def number(given: str) -> Json:
    """Return a number, or the text itself, which no row for numbers takes."""
    try:
        return float(given)
    except ValueError:
        return given
