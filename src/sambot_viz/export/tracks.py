"""Motion in an exported page: for each node, its values over time.

A page can go to any time at once: it takes from each track the last value before it.
"""

from __future__ import annotations

import base64
import gzip
import json
from collections.abc import Sequence
from typing import Any, cast

Json = dict[str, Any]

_VALUES = {
    "SetPositionMessage": "position",
    "SetOrientationMessage": "wxyz",
    "SetSceneNodeVisibilityMessage": "visible",
}
"""Type of a message → the field with what it sets."""
_FIRST = {"position": (0.0, 0.0, 0.0), "wxyz": (1.0, 0.0, 0.0, 0.0), "visible": True}
"""The values of a node before anything is set."""
_UPDATE, _REMOVE = "SceneNodeUpdateMessage", "RemoveSceneNodeMessage"
_DIGITS = 6
"""Decimals of a number: micrometres, and as fine a part of a turn."""

Key = tuple[str, str, str]
"""Type of message, name of node, and the property that is set."""


class Tracks:
    """Collects messages of viser; those of the first picture give the first values.

    Attributes:
        time: of the messages that come now [s]; None while the first picture is drawn.
    """

    def __init__(self) -> None:
        self.time: float | None = None
        self._first: dict[Key, Any] = {}
        self._created: dict[str, tuple[Json, Sequence[memoryview]]] = {}
        self._tracks: dict[Key, tuple[list[int], list[Any]]] = {}

    def take(self, message: Json, arrays: Sequence[memoryview]) -> None:
        """Take a message; what is in no scene is left out."""
        kind, name = str(message["type"]), str(message.get("name", ""))
        if kind in _VALUES:
            field = _VALUES[kind]
            self._add((kind, name, field), _value(message[field], arrays))
        elif kind == _UPDATE:
            for prop, value in message["updates"].items():
                self._add((kind, name, prop), _value(value, arrays))
        elif kind == _REMOVE:
            self._add(("", name, ""), None)
        elif "props" in message and name:
            if self.time is None:
                self._created[name] = (message, arrays)
            else:
                self._add(("", name, ""), _value(message, arrays))

    def packed(self) -> str:
        """Return all tracks, as base64 of gzipped JSON."""
        found = [self._track(key, *track) for key, track in self._tracks.items()]
        data = json.dumps(found, separators=(",", ":"), ensure_ascii=True)
        return base64.b64encode(gzip.compress(data.encode(), 9, mtime=0)).decode()

    def _add(self, key: Key, value: Any) -> None:
        if self.time is None:
            self._first[key] = value
            return
        times, values = self._tracks.setdefault(key, ([], []))
        now = round(self.time * 1000.0)
        if times and times[-1] == now:
            times.pop()
            values.pop()
        times.append(now)
        values.append(value)

    def _track(self, key: Key, times: list[int], values: list[Any]) -> Json:
        kind, name, prop = key
        first = self._before(key)
        since = [b - a for a, b in zip([0, *times], times, strict=False)]
        made = {"name": name, "first": first, "since": since, "values": values}
        return {"type": kind, "prop": prop, **made}

    def _before(self, key: Key) -> Any:
        kind, name, prop = key
        if key in self._first:
            return self._first[key]
        created = self._created.get(name)
        if not kind:
            return None if created is None else _value(*created)
        if kind == _UPDATE and created is not None:
            message, arrays = created
            return _value(message["props"].get(prop), arrays)
        return _FIRST.get(prop)


def _value(value: Any, arrays: Sequence[memoryview]) -> Any:
    """Return a value for JSON: short numbers, and arrays as base64."""
    if isinstance(value, float):
        return round(value, _DIGITS)
    if isinstance(value, list | tuple):
        return [_value(part, arrays) for part in cast("Sequence[Any]", value)]
    if isinstance(value, bytes):
        return {"dtype": "|u1", "base64": base64.b64encode(value).decode()}
    if isinstance(value, dict):
        parts = cast(Json, value)
        if "__binary_index" in parts:
            array: memoryview = arrays[int(parts["__binary_index"])]
            packed = base64.b64encode(array).decode()
            return {"dtype": parts["dtype"], "base64": packed}
        return {key: _value(part, arrays) for key, part in parts.items()}
    return value
