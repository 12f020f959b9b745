"""Walk through a message in CDR field by field: what decoders of one type build on."""

from __future__ import annotations

import struct

from sambot_viz.errors import DecodeError

HEAD = 4
"""Length of the header [bytes]; the fields are aligned from its end."""


class CdrReader:
    """Finds fields: numbers are aligned to their size, texts end with a zero.

    Positions count from the end of the header.

    Args:
        data: the message.

    Attributes:
        data: the fields, without the header.
        order: the byte order, "<" or ">".
        gaps: (start, end) of skipped padding in the message.

    Raises:
        DecodeError: the message is not in CDR.
    """

    def __init__(self, data: bytes) -> None:
        if len(data) < HEAD or data[:2] not in (b"\0\0", b"\0\1"):
            raise DecodeError(f"it begins with {data[:2].hex() or 'nothing'}, not CDR")
        self.order = "<" if data[1] else ">"
        self.data = data[HEAD:]
        # Two bytes of the header are options, which are not used.
        self.gaps: list[tuple[int, int]] = [(2, HEAD)]
        self._length = struct.Struct(self.order + "I").unpack_from

    def aligned(self, position: int, size: int) -> int:
        """Return where a field of some size begins that comes next."""
        end = (position + size - 1) & -size
        if end > position:
            self.gaps.append((position + HEAD, end + HEAD))
        return end

    def length(self, position: int) -> int:
        """Return the length of an array, which is not checked.

        Raises:
            struct.error: the message is cut off.
        """
        found: int = self._length(self.data, position)[0]
        return found

    def text(self, position: int) -> tuple[str, int]:
        """Return a text, and the position of its end.

        Raises:
            DecodeError: the text is longer than the message.
            UnicodeDecodeError: the text is not UTF-8.
            struct.error: the message is truncated.
        """
        end = position + 4 + self.length(position)
        if end > len(self.data):
            raise DecodeError("a text longer than its message")
        return self.data[position + 4 : end].rstrip(b"\0").decode(), end
