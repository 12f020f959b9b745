"""What a page makes of poses that move: viser's messages, as viser_poses.js."""

from __future__ import annotations

import struct
from typing import Any

MOVED = "~"
"""The name in a message with what has moved."""


class PoseTracks:
    """Remembers what each number moves."""

    def __init__(self) -> None:
        self._tracks: dict[int, tuple[str, str]] = {}

    def unpacked(self, kind: str, fields: dict[str, Any]) -> list[dict[str, Any]]:
        """The messages of viser for one that has come.

        Args:
            kind: its type, such as "SetOrientationMessage".
            fields: what it says.

        Returns:
            Their fields; with the type, as "type", where this is another one.
        """
        if fields.get("name") == MOVED:
            return [*self._moved(fields["position"])]
        if (number := fields.pop("number", None)) is not None:
            self._tracks[number] = (kind, fields["name"])
        return [fields]

    def _moved(self, content: bytes) -> list[dict[str, Any]]:
        numbers, at = _numbers(content)
        found = list[dict[str, Any]]()
        for number in numbers:
            length = 3 if number % 2 else 4
            value = list(struct.unpack_from(f"<{length}d", content, at))
            at += 8 * length
            if number in self._tracks:
                kind, name = self._tracks[number]
                key = "position" if number % 2 else "wxyz"
                found.append({"type": kind, "name": name, key: value})
        assert at == len(content)
        return found


def _numbers(content: bytes) -> tuple[list[int], int]:
    """Numbers in seven bits a byte, up to a 0, and where they end."""
    numbers, number, shift = list[int](), 0, 0
    for at, byte in enumerate(content):
        number |= (byte & 127) << shift
        shift += 7
        if byte < 128:
            if not number:
                return numbers, at + 1
            numbers.append(number)
            number = shift = 0
    raise AssertionError("no end of the numbers")
