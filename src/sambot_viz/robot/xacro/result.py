"""Why and where an expansion failed, as the xacro child reports it."""

from __future__ import annotations

from dataclasses import dataclass

from sambot_viz.robot.packages.package_index import Lookup
from sambot_viz.robot.xml.decode import XmlFault


@dataclass(frozen=True, slots=True)
class Definition:
    """A macro, property or argument that was defined before xacro failed.

    Attributes:
        kind: "macro", "property" or "arg".
        name: its name without the prefix ``xacro:``.
        file: the file that defines it, as the user would write it.
        line: line of the defining element, from 1.
        params: the parameter text of a macro, else empty.
    """

    kind: str
    name: str
    file: str
    line: int
    params: str = ""


@dataclass(frozen=True, slots=True)
class XacroCall:
    """One macro call on the way to an element: what was called, and from where."""

    macro: str
    file: str
    line: int


@dataclass(frozen=True, slots=True)
class XacroFailure:
    """The cause of a failed expansion, as xacro and the child process report it.

    Attributes:
        kind: class name of the underlying exception ("NameError", "SyntaxError",
            "ZeroDivisionError", "XacroException", "ArgException" for an argument
            without a value, "PackageNotFoundError", "FileNotFoundError",
            "RecursionError", "MemoryError", …), or a kind of this package: "Timeout",
            "OutputLimit", "Refused" (the untrusted mode forbids it), "NotXml" (the
            output cannot be written as XML), "Crash".
        text: the underlying exception's own text, without location lines.
        file: the file being processed when it failed.
        line: line of the element being processed in `file`, from 1, or None. Inside
            a macro that is the line in the macro's body.
        column: its column, from 1, or None.
        expressions: the nested ``${…}`` texts, innermost first.
        element: tag of the element being processed ("xacro:wheell"), or None.
        macros: macros being expanded, innermost first, as (name, file of the macro).
        calls: the same chain as places of the calls, innermost first.
        includes: files being read, innermost first; the last is the main file.
        missing_package: the failed look-up of ``$(find name)``, or None.
        definitions: what was defined so far, for near names.
        files: the files that were read or looked for, beside the model.
    """

    kind: str
    text: str
    file: str
    line: int | None = None
    column: int | None = None
    expressions: tuple[str, ...] = ()
    element: str | None = None
    macros: tuple[tuple[str, str], ...] = ()
    calls: tuple[XacroCall, ...] = ()
    includes: tuple[str, ...] = ()
    missing_package: Lookup | None = None
    definitions: tuple[Definition, ...] = ()
    files: tuple[str, ...] = ()


class ExpansionError(Exception):
    """The expansion failed; `failure` has the cause."""

    def __init__(self, failure: XacroFailure) -> None:
        super().__init__(failure.text)
        self.failure = failure


class ExpansionXmlError(Exception):
    """A file that xacro reads is not XML: `file`, and the `fault` in it.

    `files` are those that were read or looked for, beside the model.
    """

    def __init__(self, file: str, fault: XmlFault, files: tuple[str, ...] = ()) -> None:
        super().__init__(str(fault))
        self.file = file
        self.fault = fault
        self.files = files
