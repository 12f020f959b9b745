"""Types of the JSON that the parent process and the xacro child exchange.

Tuples arrive as lists, which unpack in the same way.
"""

from __future__ import annotations

from typing import TypedDict

Node = tuple[str, dict[str, str], str, int]
"""An element: tag, attributes, text, number of child elements."""
NodePlace = tuple[int, int, int, int, int]
"""Place of an element: number of its file, line, column; number of the file and line of
the outermost macro call that created it, or -1 twice."""
Call = tuple[str, str, int]
"""A macro, and the file and line of its call."""
DefinitionRow = tuple[str, str, str, int, str]
"""Kind ("macro", "property", "arg"), name, file, line and parameters of a macro."""
WarningRow = tuple[str, str, "int | None", "int | None"]
"""xacro's message, and the file, line and column."""
UnprefixedRow = tuple[str, bool, str, int, int]
"""An element without its prefix: tag, whether a macro has that name, and the place."""


class Job(TypedDict):
    """The model to expand, and how; see `expand_model`."""

    file: str
    text: str
    folder: str | None
    arguments: dict[str, str]
    package_path: list[str]
    environment: dict[str, str]
    untrusted: bool
    megabytes: int
    seconds: int
    output_limit: int
    edited: dict[str, str]
    working_folder: str


class ExpandedAnswer(TypedDict):
    """The expanded model: elements in document order, and xacro's messages."""

    xml: str
    nodes: list[Node]
    places: list[NodePlace]
    names: list[str]
    files: list[str]
    warnings: list[WarningRow]
    unprefixed: list[UnprefixedRow]
    macros: list[str]


class NotXmlAnswer(TypedDict):
    """A file that is not XML: the fields of an `XmlFault`, and the files read."""

    message: str
    line: int
    column: int
    code: int
    text: str
    file: str
    files: list[str]


class FailureAnswer(TypedDict):
    """The fields of `XacroFailure`."""

    kind: str
    text: str
    file: str
    line: int | None
    column: int | None
    expressions: list[str]
    element: str | None
    macros: list[tuple[str, str]]
    calls: list[Call]
    includes: list[str]
    missing_package: tuple[str, list[str], list[str]] | None
    definitions: list[DefinitionRow]
    files: list[str]


class ChildAnswer(TypedDict):
    """The outcome of a job: one of the three."""

    expanded: ExpandedAnswer | None
    not_xml: NotXmlAnswer | None
    failure: FailureAnswer | None
