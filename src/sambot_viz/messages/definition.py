"""The definition of a message: parsed by rosbags, checked, made into functions.

A definition comes from a file or a peer that nobody vouches for, and rosbags makes
Python code of it. So only names that are plain words get that far, and no array that
would make the code, or what it makes of a small message, grow without bound. Constants
are left out: their values are nothing that a message needs to be read.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from threading import Lock
from typing import TYPE_CHECKING, Any, cast

from sambot_viz.errors import DecodeError

if TYPE_CHECKING:
    from rosbags.interfaces.typing import Fielddefs, FieldDesc
    from rosbags.typesys.store import Typestore

Types = Mapping[str, "Fielddefs"]
"""The fields of each type that a definition has, by their names."""
Lookup = Callable[[str], "Types | None"]
"""Finds types that a definition names and does not have."""

LANGUAGES = ("ros2msg", "ros2idl", "ros1msg")
"""The encodings of definitions that can be parsed."""
_LONGEST = 1 << 20
"""A longer text is none of a message: MoveIt's largest has 60 kB."""
_MOST_TYPES = 1000
_MOST_PARTS = 1000
"""Parts of fixed arrays of one type; each is lines of code."""
_MOST_EMPTY = 64
"""Values that no byte of a message stands for."""
_NAME = re.compile(r"[A-Za-z]\w*(?:/[A-Za-z]\w*)+", re.ASCII)
_WORD = re.compile(r"[A-Za-z]\w*", re.ASCII)
_DDS = re.compile(r"(\w+)::(\w+)::(?:dds_::)?(\w+?)_?", re.ASCII)
# rosbags' generated module lies in sys.modules while its dataclasses are made.
_register_lock = Lock()


def canonical_name(name: str) -> str:
    """Return the name of a type as ROS 2 says it, others as they are.

    "pkg/Name" of ROS 1 and of old recordings gets its "/msg/"; a name of DDS
    ("pkg::msg::dds_::Name_") gets slashes.
    """
    if match := _DDS.fullmatch(name):
        return "/".join(match.groups())
    parts = name.split("/")
    if len(parts) == 2 and all(map(_WORD.fullmatch, parts)):
        return f"{parts[0]}/msg/{parts[1]}"
    return name


@dataclass(frozen=True)
class TypeDefinition:
    """A type with all types that it is made of.

    Attributes:
        name: of the type, "pkg/msg/Name".
        types: the type and all that it needs.
    """

    name: str
    types: Types

    def compile(self) -> Typestore:
        """Return a store of rosbags' that has the types, and nothing else."""
        from rosbags.typesys.store import Typestore

        store = Typestore()
        types = {name: (list[Any](), fields) for name, fields in self.types.items()}
        with _register_lock:
            store.register(types)
        return store


def parse(name: str, language: str, text: str | bytes, find: Lookup) -> TypeDefinition:
    """Return the definition that a text has.

    Args:
        name: of the type, as `canonical_name` gives it.
        language: of `LANGUAGES`.
        text: the definition; an empty one is that of an empty message.
        find: finds what the text names and does not have.

    Raises:
        DecodeError: the text cannot be parsed, or what it defines cannot be read.
    """
    if isinstance(text, bytes):
        text = text.decode("utf-8", "replace")
    if len(text) > _LONGEST:
        raise DecodeError(f"the definition is longer than {_LONGEST:,} characters")
    text = text.replace("\r\n", "\n")
    try:
        types = _parsed(_inner_name(name), language, text)
    except Exception as error:
        # rosbags' parser raises what it comes upon: of its own, KeyError, ValueError.
        raise DecodeError("the definition cannot be parsed") from error
    return closed(_inner_name(name), types, find)


def _inner_name(name: str) -> str:
    parts = name.split("/")
    package = parts[0] if len(parts) > 1 else "unknown"
    folder = "action" if parts[1:-1] == ["action"] else "msg"
    return f"{package}/{folder}/{parts[-1]}"


def _parsed(name: str, language: str, text: str) -> Types:
    from rosbags.typesys import get_types_from_idl, get_types_from_msg

    if language == "ros2idl":
        types = get_types_from_idl(text)
    else:
        types = get_types_from_msg(text, name)
    return {name: fields for name, (_, fields) in types.items()}


def closed(name: str, types: Types, find: Lookup) -> TypeDefinition:
    """Return a definition with all that a type needs, and nothing that it does not.

    Raises:
        DecodeError: a type is missing or contains itself, or the definition is one
            that nobody writes.
    """
    known = dict(types)
    needed: dict[str, Fielddefs] = {}
    pending = [name]
    while pending:
        one = pending.pop()
        if one in needed:
            continue
        if one not in known:
            known |= find(one) or {}
        if one not in known:
            raise DecodeError(f"there is no definition of {one}")
        if len(needed) == _MOST_TYPES:
            raise DecodeError(f"the definition has more than {_MOST_TYPES} types")
        needed[one] = known[one]
        pending += _needs(known[one])
    _check(name, needed)
    return TypeDefinition(name, needed)


def _needs(fields: Fielddefs) -> Iterator[str]:
    for _, (kind, what) in _elements(fields):
        if kind == 2:
            yield what


def _elements(fields: Fielddefs) -> Iterator[tuple[str, tuple[int, Any]]]:
    """Yield the fields, of arrays and sequences their elements."""
    for field, desc in fields:
        inner = cast("FieldDesc", desc[1][0] if desc[0] > 2 else desc)
        yield field, (int(inner[0]), inner[1])


def _check(name: str, types: Types) -> None:
    """Refuse what must not become code, or would take unbounded time or memory."""
    for one, fields in types.items():
        if not _NAME.fullmatch(one):
            raise DecodeError("the definition has a type without a proper name")
        if not all(_WORD.fullmatch(field) for field, _ in fields):
            raise DecodeError(f"the definition of {one} has a field without a name")
    _Size(types).of(name)


@dataclass
class _Size:
    """How many values a message has at least, and how many bytes.

    Sequences are as long as a message says and are checked when it is read; all else
    is known from the definition.
    """

    types: Types

    def __post_init__(self) -> None:
        self._done: dict[str, tuple[int, int]] = {}
        self._open: set[str] = set()

    def of(self, name: str) -> tuple[int, int]:
        if name in self._done:
            return self._done[name]
        if name in self._open or len(self._open) > 100:
            raise DecodeError(f"{name} contains itself")
        self._open.add(name)
        values, size, parts = 1, 0, 0
        for (_, desc), (_, (kind, what)) in zip(
            self.types[name], _elements(self.types[name]), strict=True
        ):
            times = cast("int", desc[1][1]) if desc[0] == 3 else 1
            inner = self.of(what) if kind == 2 else (0, 1)
            is_code = kind == 2 or what[0] == "string"
            parts += times * is_code
            if desc[0] == 4:
                # Its length alone; but what it contains must be readable too.
                values, size = values + 1, size + 4
            else:
                values, size = values + times * inner[0], size + times * inner[1]
        if parts > _MOST_PARTS or (size == 0 and values > _MOST_EMPTY):
            raise DecodeError(f"the definition of {name} has too large an array")
        self._open.remove(name)
        self._done[name] = values, size
        return values, size


@cache
def standard_types(distro: str) -> Types:
    """Return the types that a distribution of ROS has by itself."""
    from rosbags.typesys import Stores, get_typestore

    fielddefs = get_typestore(Stores(distro)).fielddefs
    return {name: fields for name, (_, fields) in fielddefs.items()}
