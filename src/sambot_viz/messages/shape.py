"""Types of ROS as moulds: the fields of a message in any encoding become one of them.

Nothing of a message is trusted: what has another kind than its field is refused, with
the name of the field.
"""

from __future__ import annotations

import base64
import binascii
import math
from collections.abc import Callable, Mapping, Sequence
from threading import Lock
from typing import Any, TypeGuard, cast

import numpy as np
from numpy.typing import NDArray

from sambot_viz.errors import DecodeError
from sambot_viz.messages.definition import ARRAY, BASE, NAME, TypeDefinition
from sambot_viz.messages.flat_types import FORMATS

_TIMES = ("builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration")
_SECONDS = frozenset(("sec", "secs", "seconds"))
_NANOSECONDS = frozenset(("nanosec", "nsec", "nsecs", "nanos"))
"""What the parts of a time are called: in ROS 2, ROS 1, Foxglove and Protobuf."""
_BYTES = "bB?"
_WIDEST_TEXT = 400
"""No number is written with more characters."""

Fill = Callable[[Any], Any]
# rosbags' generated module lies in sys.modules while its dataclasses are made.
_register_lock = Lock()


def time_parts(value: Any) -> tuple[Any, Any]:
    """Return seconds and nanoseconds of a time or duration in any of its spellings."""
    if not is_fields(value):
        return 0, 0
    sec = nanosec = 0
    for name, part in value.items():
        if name in _SECONDS:
            sec = part
        elif name in _NANOSECONDS:
            nanosec = part
    return sec, nanosec


def is_fields(value: Any) -> TypeGuard[Mapping[str, Any]]:
    """Return whether a value has fields; to ask a dict for its class takes longer."""
    return type(value) is dict or isinstance(value, Mapping)


class MessageShape:
    """A type that is filled with fields.

    Args:
        definition: of the type.

    Attributes:
        name: of the type.
        fields: their names.
    """

    def __init__(self, definition: TypeDefinition) -> None:
        from rosbags.typesys.store import Typestore

        store = self._store = Typestore()
        with _register_lock:
            store.register({n: ([], fields) for n, fields in definition.types.items()})
        self._classes: Mapping[str, Any] = store.types
        self._types = definition.types
        self.name = definition.name
        self.fields = tuple(name for name, _ in definition.types[definition.name])
        self._fills: dict[str, Fill] = {}
        self._fill = self._of_type(definition.name)

    def filled(self, fields: Mapping[str, Any]) -> Any:
        """Return an object of the type; missing fields are zero or empty.

        Raises:
            DecodeError: a field does not fit its type.
        """
        return self._fill(fields)

    def unknown_field(self, fields: Mapping[str, Any]) -> str:
        """Return the first name that the type does not have, such as "pose.positon"."""
        return self._unknown(self.name, fields)

    def _unknown(self, type_name: str, fields: Mapping[str, Any]) -> str:
        known: dict[str, Any] = {f: k for f, k in cast("Any", self._types[type_name])}
        for name, value in fields.items():
            if name not in known:
                return name
            kind, what = known[name]
            is_message = kind == NAME and what not in _TIMES and is_fields(value)
            if is_message and (below := self._unknown(what, value)):
                return f"{name}.{below}"
        return ""

    def as_cdr(self, fields: Mapping[str, Any]) -> bytes:
        """Return a message of the type as ROS 2 writes it, little-endian.

        Raises:
            DecodeError: a field is not what its type says.
        """
        return bytes(self._store.serialize_cdr(self._fill(fields), self.name))

    def _of_type(self, name: str) -> Fill:
        known = self._fills.get(name)
        if known is not None:
            return known
        make = self._classes[name]
        parts: list[tuple[str, Fill]] = []
        for field, (kind, what) in cast("Any", self._types[name]):
            parts.append((field, self._of_field(kind, what)))
        is_time = name in _TIMES
        if is_time:
            parts = [(field, _integer("i")) for field, _ in parts]
        zero = make(*[fill(None) for _, fill in parts])

        def filled(value: Any) -> Any:
            if value is None:
                return zero
            if not is_fields(value):
                raise DecodeError(f"{_kind(value)} instead of fields")
            if is_time:
                sec, nanosec = time_parts(value)
                value = {"sec": sec, "nanosec": nanosec}
            values: list[Any] = []
            get, field = value.get, ""
            try:
                for field, fill in parts:
                    values.append(fill(get(field)))
            except DecodeError as error:
                raise DecodeError(f"{field}: {error}") from None
            return make(*values)

        self._fills[name] = filled
        return filled

    def _of_field(self, kind: int, what: Any) -> Fill:
        if kind == NAME:
            return self._of_type(what)
        if kind == BASE:
            return _of_base(what[0])
        (element_kind, element), length = what
        count = length if kind == ARRAY else None
        if element_kind == BASE and element[0] in FORMATS:
            return _numbers(FORMATS[element[0]], count)
        return _elements(self._of_field(element_kind, element), count)


def _of_base(name: str) -> Fill:
    if name in ("float32", "float64"):
        return real_number
    if name == "bool":
        return bool
    return _integer(FORMATS[name]) if name in FORMATS else _text


def _integer(letter: str) -> Fill:
    bounds = np.iinfo(np.dtype(letter))
    least, most = int(bounds.min), int(bounds.max)

    def filled(value: Any) -> int:
        if value is None:
            return 0
        if type(value) is int and least <= value <= most:
            return value
        number = _number(value)
        if not math.isfinite(number) or number != int(number):
            raise DecodeError(f"{number:g} instead of a whole number")
        if not least <= number <= most:
            raise DecodeError(f"the number {number:g} is too large")
        return int(number)

    return filled


_whole = _integer("i8")


def whole_number(value: Any) -> int:
    """Return a field that is a whole number; 0 for none.

    Raises:
        DecodeError: it is another value.
    """
    return _whole(value)


def bytes_of(value: Any) -> NDArray[np.uint8]:
    """Return a field of bytes, (N,) uint8; base64 where it is a text.

    Raises:
        DecodeError: it is another value.
    """
    return np.zeros(0, np.uint8) if value is None else _array(value, np.dtype(np.uint8))


def real_number(value: Any) -> float:
    """Return a field that is a number; 0 for none.

    Raises:
        DecodeError: it is another value.
    """
    if type(value) is float:
        return value
    return 0.0 if value is None else float(_number(value))


def _number(value: Any) -> Any:
    """Return a number; JSON of Protobuf has some as texts."""
    if isinstance(value, int | float | np.number):
        return cast("Any", value)
    if isinstance(value, str) and len(value) < _WIDEST_TEXT:
        try:
            return float(value)
        except ValueError:
            pass
    raise DecodeError(f"{_kind(value)} instead of a number")


def _text(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, str):
        return value
    raise DecodeError(f"{_kind(value)} instead of a text")


def _numbers(letter: str, count: int | None) -> Fill:
    kind = np.dtype(letter)

    def filled(value: Any) -> Any:
        if value is None:
            return np.zeros(count or 0, kind)
        found = _array(value, kind)
        if count is not None and len(found) != count:
            if not len(found):
                return np.zeros(count, kind)
            raise DecodeError(f"{len(found)} numbers instead of {count}")
        return found

    return filled


def _array(value: Any, kind: np.dtype[Any]) -> Any:
    if isinstance(value, str) and kind.char in _BYTES:
        # Bytes in JSON.
        try:
            value = base64.b64decode(value, validate=True)
        except binascii.Error:
            raise DecodeError("a text that is not base64") from None
    if isinstance(value, bytes | bytearray | memoryview):
        if kind.char not in _BYTES:
            raise DecodeError("bytes instead of numbers")
        return np.frombuffer(cast("bytes", value), kind)
    if not isinstance(value, np.ndarray | list | tuple):
        raise DecodeError(f"{_kind(value)} instead of numbers")
    try:
        with np.errstate(invalid="ignore", over="ignore"):
            found = np.asarray(cast("Any", value), kind)
    except (TypeError, ValueError, OverflowError):
        raise DecodeError("its numbers are not numbers, or too large") from None
    if found.ndim != 1:
        raise DecodeError("lists instead of numbers")
    return found


def _elements(fill: Fill, count: int | None) -> Fill:
    def filled(value: Any) -> Sequence[Any]:
        if value is None:
            return [fill(None)] * (count or 0)
        if not isinstance(value, list | tuple):
            raise DecodeError(f"{_kind(value)} instead of a list")
        given = cast("Sequence[Any]", value)
        if count is not None and len(given) != count:
            raise DecodeError(f"{len(given)} elements instead of {count}")
        return [fill(one) for one in given]

    return filled


def _kind(value: Any) -> str:
    """Describe a value for a user."""
    if isinstance(value, str):
        return "a text"
    if isinstance(value, bool | int | float | np.number):
        return "a number"
    if isinstance(value, Mapping):
        return "fields"
    if isinstance(value, bytes | bytearray | memoryview):
        return "bytes"
    return "nothing" if value is None else "a list"


def fields_of(message: Any) -> Mapping[str, Any]:
    """Return the fields of a message, whatever a decoder has made of it."""
    if isinstance(message, Mapping):
        return cast("Mapping[str, Any]", message)
    return {name: _plain(getattr(message, name)) for name in _names(message)}


def _plain(value: Any) -> Any:
    if hasattr(value, "__dataclass_fields__"):
        return fields_of(value)
    if isinstance(value, Sequence) and not isinstance(value, str | bytes | memoryview):
        return [_plain(one) for one in cast("Sequence[Any]", value)]
    return cast("Any", value)


def _names(message: Any) -> list[str]:
    names = cast("dict[str, Any]", message.__dataclass_fields__)
    return [name for name in names if not name.startswith("__")]
