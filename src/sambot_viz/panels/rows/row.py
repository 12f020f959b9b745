"""What panels send to the page: rows, which a tree shows, and data, which scripts read.

The third are commands, which the page may call (`panels.command`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias, cast

from sambot_viz.text import text

Json: TypeAlias = Any
"""What `json.dumps` takes: numbers, texts, lists, dictionaries, None."""

Kind = Literal[
    "group",  # only a name, with rows below
    "display",  # a display, group or list entry: its value is its box
    "bool",
    "int",
    "float",
    "slider",  # a number with a handle, such as a joint
    "text",
    "enum",
    "frame",
    "file",
    "color",
    "vector",
    "status",
    "readonly",  # a name and a text
    "note",  # a sentence over the whole width
    "lines",  # several lines of text, in a fixed-width font
]
Level = Literal["ok", "warn", "error", "info"]

LONGEST_NAME = 200
LONGEST_TEXT = 2000


class LongText(str):
    """A text whose lines may have any length, such as one for the clipboard."""

    __slots__ = ()


class FileContent(str):
    """The text of a file in an editor, which comes back as it is.

    Invisible characters are kept: the editor marks them.
    """

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class Answer:
    """The answer to the client that sent a value, from a row's `set` or a command.

    Attributes:
        say: a sentence for its status bar; with a text to copy, the name of that text.
        copy: a text for its clipboard.
        level: the level of the sentence.
    """

    say: str = ""
    copy: str = ""
    level: Level = "ok"


@dataclass(frozen=True, slots=True)
class Row:
    """A row of a panel's tree.

    Attributes:
        id: unique in the window, and the same as long as the row means the same.
        parent: the id of the row above it; empty at the top of its panel.
        kind: decides how it is drawn, and which values it takes.
        name: its label.
        value: the shown value, of the type for its `kind`.
        unit: written beside the value.
        least: lowest value that may be set.
        most: highest value that may be set.
        step: the step of an arrow key.
        options: the choices.
        editable: whether texts other than the options may be typed.
        help: a sentence or more about it.
        icon: the name of its picture.
        level: the level of a status.
        expanded: whether the rows below it are shown when the page is opened.
        bold: whether its name is bold, as RViz shows displays and values of a file.
        client_local: whether setting it changes only what this client shows, so that
            viewers may set it too.
        extra: more for the page, by name.
        set: called with a checked value, in the session's worker and with its lock
            held; None for a row that can only be read. It raises SambotVizError to
            refuse the value, and may return an `Answer`.
    """

    id: str
    parent: str
    kind: Kind
    name: str = ""
    value: Json = None
    unit: str = ""
    least: float | None = None
    most: float | None = None
    step: float | None = None
    options: Sequence[str] = ()
    editable: bool = False
    help: str = ""
    icon: str = ""
    level: Level | None = None
    expanded: bool = False
    bold: bool = False
    client_local: bool = False
    extra: dict[str, Json] | None = None
    set: Callable[[Any], object] | None = field(default=None, compare=False)

    def json(self) -> dict[str, Json]:
        """What the page gets: only what differs from the defaults, all texts safe."""
        values: dict[str, Json] = {
            "id": self.id,
            "in": self.parent,
            "kind": self.kind,
            "name": text(self.name, LONGEST_NAME),
            "value": safe(self.value),
            "unit": self.unit,
            "min": self.least,
            "max": self.most,
            "step": self.step,
            "options": [text(option, LONGEST_NAME) for option in self.options],
            "editable": self.editable,
            "help": text(self.help, LONGEST_TEXT),
            "icon": self.icon,
            "level": self.level,
            "fixed": self.set is None,
            "open": self.expanded,
            "bold": self.bold,
            "local": self.client_local and self.set is not None,
            **(safe(self.extra) or {}),
        }
        kept = ("id", "in", "kind")
        return {
            key: value
            for key, value in values.items()
            if key in kept
            or (value is not None and value is not False and value not in ("", []))
            # A box that is off is a value all the same.
            or (key == "value" and value is not None)
        }


@dataclass(frozen=True, slots=True)
class Data:
    """A value that scripts of the page read, such as names to offer.

    Attributes:
        id: unique in the window.
        value: what they read.
    """

    id: str
    value: Json = None

    def json(self) -> dict[str, Json]:
        """What the page gets."""
        shown = {} if self.value is None else {"value": safe(self.value)}
        return {"id": self.id, "in": "", "kind": "data", **shown}


def safe(value: Json) -> Json:
    """Make the texts of a value such that any browser can show them; lines stay."""
    if type(value) is float:
        # Most values are numbers.
        return value
    if isinstance(value, FileContent):
        return str(value)
    if isinstance(value, str):
        longest = len(value) if isinstance(value, LongText) else LONGEST_TEXT
        return "\n".join(text(line, longest) for line in value.split("\n"))
    if isinstance(value, dict):
        parts = cast("dict[str, Json]", value)
        return {text(key): safe(part) for key, part in parts.items()}
    if isinstance(value, list | tuple):
        return [safe(part) for part in cast("Sequence[Json]", value)]
    return value
