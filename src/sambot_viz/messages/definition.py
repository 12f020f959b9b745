"""The definition of a message: a type with all types that it is made of.

A definition comes from an untrusted file or peer, and rosbags turns it into Python
code. So it may contain only plain words as names, and no array that would make the
code, or the result of a small message, grow without bound.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

from sambot_viz import limits
from sambot_viz.errors import DecodeError

if TYPE_CHECKING:
    from rosbags.interfaces.typing import Fielddefs

Types = Mapping[str, "Fielddefs"]
"""The fields of each type that a definition has, by their names."""
Lookup = Callable[[str], "Types | None"]
"""Finds types that a definition names and does not have."""

BASE, NAME, ARRAY, SEQUENCE = 1, 2, 3, 4
"""rosbags' kinds of fields."""
_UNREADABLE = {"wstring", "wchar", "float128", "fixed"}
DUMMY = "structure_needs_at_least_one_member"
"""The field of types without fields, of which ROS 1 writes nothing."""
_TYPE = re.compile(r"[A-Za-z]\w*(?:/[A-Za-z]\w*)+", re.ASCII)
_WORD = re.compile(r"[A-Za-z]\w*", re.ASCII)


class UnreadFieldError(DecodeError):
    """A definition has a field that is not read here, so that no other text helps."""


@dataclass(frozen=True)
class TypeDefinition:
    """A type with all types that it is made of, and no others.

    Attributes:
        name: of the type, "pkg/msg/Name".
        types: the type and all that it needs.
    """

    name: str
    types: Types

    @property
    def is_empty(self) -> bool:
        """Whether it has no field but the dummy that rosidl adds."""
        return all(field == DUMMY for field, _ in self.types[self.name])


def closed(name: str, types: Types, find: Lookup) -> TypeDefinition:
    """Return a definition with all types that a type needs.

    Args:
        name: the type.
        types: the defined types.
        find: finds the others.

    Raises:
        UnreadFieldError: a field is of a kind that is not read.
        DecodeError: a type is missing or contains itself, or the definition is beyond
            all that is in use.
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
            of_field = "" if one == name else ", the type of a field"
            raise DecodeError(f"no definition of {one}{of_field}")
        if len(needed) == limits.DEFINITION_TYPES.value:
            raise DecodeError(
                f"the definition has more than {limits.DEFINITION_TYPES.value} types"
            )
        needed[one] = known[one]
        for part in _parts(known[one]):
            # rosbags' parser of .msg takes a word that it does not know for a type of
            # the same package.
            word = part.what.rpartition("/")[2]
            if word in _UNREADABLE and part.what not in known:
                raise UnreadFieldError(f"{one} has a {word}, which is not read yet")
            if part.kind == NAME:
                pending.append(part.what)
    if sum(map(len, needed.values())) > limits.DEFINITION_FIELDS.value:
        raise DecodeError(
            f"the definition has more than {limits.DEFINITION_FIELDS.value:,} fields"
        )
    for one, fields in needed.items():
        _check(one, fields)
    _Size(needed).of(name)
    return TypeDefinition(name, needed)


@dataclass(frozen=True, slots=True)
class _Part:
    """A field, or the elements of a field.

    Attributes:
        kind: BASE or NAME.
        what: the name of a type, in full or of the base types.
        times: how often it is there; None when a message says so.
    """

    kind: int
    what: str
    times: int | None


def _parts(fields: Fielddefs) -> Iterator[_Part]:
    for _, desc in fields:
        # The unions that rosbags declares cannot be told apart by their first item.
        kind, what = cast("tuple[int, Any]", desc)
        times: int | None = 1
        if kind in (ARRAY, SEQUENCE):
            (inner, of), count = what
            times = count if kind == ARRAY else None
            kind, what = inner, of
        yield _Part(int(kind), what if kind == NAME else what[0], times)


def _check(name: str, fields: Fielddefs) -> None:
    """Refuse what must not become code."""
    if not _TYPE.fullmatch(name):
        raise DecodeError("the definition has a type without a proper name")
    if not all(_WORD.fullmatch(field) for field, _ in fields):
        raise DecodeError(f"the definition of {name} has a field without a proper name")


class _Size:
    """How many values a message has at least, and how many bytes.

    Sequences are as long as a message says, which is checked when it is read; all else
    is known from the definition.
    """

    def __init__(self, types: Types) -> None:
        self._types = types
        self._done: dict[str, tuple[int, int]] = {}
        self._open: list[str] = []

    def of(self, name: str) -> tuple[int, int]:
        if name in self._done:
            return self._done[name]
        if name in self._open:
            raise DecodeError(f"{name} contains itself")
        if len(self._open) == limits.DEFINITION_DEPTH.value:
            raise DecodeError(
                "the definition has types in types, more than "
                f"{limits.DEFINITION_DEPTH.value} deep"
            )
        self._open.append(name)
        values, size, lines = 1, 0, 0
        for part in _parts(self._types[name]):
            inner = self.of(part.what) if part.kind == NAME else (0, 1)
            if part.times is None:
                values, size = values + 1, size + 4
                continue
            if part.kind == NAME or part.what == "string":
                lines += part.times
            values, size = values + part.times * inner[0], size + part.times * inner[1]
        for row, found in (
            (limits.DEFINITION_ARRAYS, lines),
            (limits.DEFINITION_EMPTY, 0 if size else values),
        ):
            if found > row.value:
                said = f"with {row.said(found)}"
                raise DecodeError(f"the definition of {name} has an array {said}")
        self._open.pop()
        self._done[name] = values, size
        return values, size
