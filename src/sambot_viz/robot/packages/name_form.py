r"""Recognise forms of file names that ROS does not read, and the intended names.

Names with ``\``, with a shell's ``~`` or with too few slashes come from other programs
and other systems. The xacro child imports this module, so it uses only the standard
library.
"""

from __future__ import annotations

import os.path
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

_KNOWN = ("package", "model", "file", "http", "https")


class NameForm(NamedTuple):
    """A form that ROS does not read.

    Attributes:
        cause: fault of the name.
        hint: correct notation.
        right: intended name.
    """

    cause: str
    hint: str
    right: str


@dataclass(frozen=True, slots=True)
class _Row:
    """One form: the text that identifies it, and its replacement."""

    pattern: re.Pattern[str]
    meant: str | Callable[[re.Match[str]], str]
    cause: str
    hint: str


_BY_PACKAGE = "write package://PACKAGE/…, with the name of the package"

_ROWS = (
    _Row(
        re.compile(r"^\s+|\s+$"),
        "",
        "a blank is before or after the name",
        "delete the blank",
    ),
    _Row(
        re.compile(r"""^(["'])(.*)\1$"""),
        r"\2",
        "the name has quotation marks inside the quotation marks",
        "delete the inner ones",
    ),
    _Row(
        re.compile(r"^(?:file://)?(?:\(|\$)?find\s+([\w.-]+)\)?(?=/)"),
        r"package://\1",
        "find is a word of xacro, which it reads only in $( and )",
        "write $(find PACKAGE)/…, or package://PACKAGE/…",
    ),
    _Row(re.compile(r"\\"), "/", "it has \\ in place of /", "write / for each \\"),
    _Row(
        re.compile(r"^(package|model)(:/?(?!/)|//+)"),
        r"\1://",
        "a colon and two slashes follow the word package",
        _BY_PACKAGE,
    ),
    _Row(
        re.compile(rf"^(?!(?:{'|'.join(_KNOWN)})://)[A-Za-z_]\w*:/+"),
        lambda found: _scheme(found[0].partition(":")[0]),
        "ROS knows package:// and file://, in small letters",
        _BY_PACKAGE,
    ),
    _Row(
        re.compile(
            r"^(?:file://)?(?:~|\$HOME|\$\{HOME\}|\$\(env HOME\)|%\w+%)(?=/)",
            re.IGNORECASE,
        ),
        lambda _: os.path.expanduser("~"),
        "only a shell replaces ~, $HOME and %…% by a folder",
        f"{_BY_PACKAGE}: it is found on every machine",
    ),
    _Row(
        re.compile(r"^file:(?://)?(?!/|[A-Za-z]:)"),
        "",
        "file:// is followed by a relative path, whose first part is read as the name "
        "of a computer",
        f"{_BY_PACKAGE}, or file:// and the whole path",
    ),
)


def _scheme(written: str) -> str:
    """Return the scheme for a misspelt one."""
    lower = written.lower()
    return f"{lower}://" if lower in _KNOWN else "package://"


def name_form(name: str) -> NameForm | None:
    """Return the fault in the form of a file name; None where there is none.

    Args:
        name: name of a mesh, a texture or an included file, as written.
    """
    right = name
    found: list[_Row] = []
    for row in _ROWS:
        changed = row.pattern.sub(row.meant, right)
        if changed != right:
            right = changed
            found.append(row)
    if not found:
        return None
    causes = ", and ".join(row.cause for row in found)
    return NameForm(causes, ", and ".join(row.hint for row in found), right)
