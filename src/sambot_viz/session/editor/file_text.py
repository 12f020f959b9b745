"""A file as text for an editor, with a line feed at the end of each line.

Parts that no user has changed keep their encoding, byte order mark and line ends.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from sambot_viz import limits
from sambot_viz.edits import decoded
from sambot_viz.files import FileTooLargeError, read_limited, reason_of

_END = re.compile(r"\r\n|\r|\n")


@dataclass(frozen=True, slots=True)
class FileText:
    """The contents of a file.

    Attributes:
        data: its bytes; None when the file does not exist or cannot be read.
        text: its text with line feeds at the ends of lines; "" for a binary file.
        encoding: encoding of `data`.
        why: reason why the file cannot be shown as text; "" when it can.
    """

    data: bytes | None
    text: str = ""
    encoding: str = "utf-8"
    why: str = ""

    def encoded(self, text: str) -> bytes:
        """Encode another text the way this file is encoded.

        Raises:
            UnicodeEncodeError: the encoding lacks a character of the text.
        """
        before = "" if self.data is None else self.data.decode(self.encoding)
        return _with_ends(text, before).encode(self.encoding)


def read_file_text(path: Path) -> FileText:
    """Read a file for an editor; `why` gives the reason if it cannot be shown."""
    try:
        data = read_limited(path, limits.EDITED_TEXT.value)
    except FileTooLargeError as error:
        return FileText(None, why=reason_of(error))
    except (OSError, ValueError) as error:
        return FileText(None, why=reason_of(error))
    try:
        source = decoded(data)
    except (ValueError, LookupError):
        return FileText(data, why="it is not text in the encoding that it claims")
    if "\0" in source.text:
        return FileText(data, why="it is not a text")
    return FileText(data, _END.sub("\n", source.text), source.encoding)


def _with_ends(text: str, before: str) -> str:
    """End old lines as before, and new lines as most of the old ones end."""
    ends = _END.findall(before)
    kinds = dict.fromkeys(ends)
    if not set(kinds) - {"\n"}:
        return text
    common = max(kinds, key=ends.count)
    if len(kinds) == 1:
        return text.replace("\n", common)
    old, new = _END.split(before), text.split("\n")
    shortest = min(len(old), len(new))
    first = next((i for i in range(shortest) if old[i] != new[i]), shortest)
    left = shortest - first
    last = next((i for i in range(left) if old[-1 - i] != new[-1 - i]), left)
    added = len(new) - len(old)
    made: list[str] = []
    for number, line in enumerate(new[:-1]):
        if number < first and number < len(ends):
            end = ends[number]
        elif number >= len(new) - last:
            end = ends[number - added]
        else:
            end = common
        made += line, end
    return "".join([*made, new[-1]])


def from_units(text: str, units: int) -> int:
    """Convert an offset in UTF-16 units, as browsers count, to one in characters.

    Args:
        text: the text.
        units: the offset; an offset past the end of the text becomes its end.
    """
    if text.isascii():
        return min(units, len(text))
    return len(text.encode("utf-16-le")[: 2 * units].decode("utf-16-le", "ignore"))


def to_units(text: str, offset: int) -> int:
    """Convert an offset in characters to one in UTF-16 units."""
    if text.isascii():
        return offset
    return len(text[:offset].encode("utf-16-le")) // 2
