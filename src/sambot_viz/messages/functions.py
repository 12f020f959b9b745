"""The functions that read a type, as rosbags generates them, but for alike elements."""

from __future__ import annotations

import struct
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field
from threading import Lock
from typing import TYPE_CHECKING, Any, cast

from sambot_viz.cached import cached_property
from sambot_viz.messages.definition import NAME, SEQUENCE
from sambot_viz.messages.flat_types import leaves_of
from sambot_viz.messages.kept_elements import ElementReader, KeptElements
from sambot_viz.messages.rows import ArrayReader

if TYPE_CHECKING:
    from rosbags.interfaces.typing import Fielddefs, FieldDesc

    from sambot_viz.messages.definition import Types

# rosbags' generated module lies in sys.modules while its dataclasses are made.
_register_lock = Lock()
_POSE = "geometry_msgs/msg/Pose"
_ARRAY = "[]"
"""Suffix of a type's name for arrays of it, as rosbags' code requests them."""


class Functions:
    """The functions of types, each made when it is first asked for.

    rosbags' own store makes fourteen for each type, of which reading needs one.

    Args:
        types: the fields of all types.
        root: the type of the messages; the elements of its arrays are kept for the next
            message, if its reader wants that.

    Attributes:
        max_sequence_length: limit for the elements of an array; set by the reader of a
            whole message.
        kept: elements of the last message; set by the reader of a whole message.
    """

    max_sequence_length = 0
    kept: KeptElements | None = None

    def __init__(self, types: Types, root: str) -> None:
        from rosbags.typesys.store import Typestore

        store = Typestore()
        with _register_lock:
            store.register({name: ([], fields) for name, fields in types.items()})
        found = {name: leaves_of(name, types) for name in types}
        flat = {name: leaves for name, leaves in found.items() if leaves}
        all_kept = {_element(desc) for _, desc in types[root]} - {"", *flat}
        self._types: dict[str, _TypeFunctions | _ArrayFunctions] = {}
        for name, (_, fields) in store.fielddefs.items():
            ours = flat.keys() | all_kept if name == root else flat
            changed = _with_arrays(fields, ours)
            self._types[name] = _TypeFunctions(store.types[name], changed, self)
        for name, leaves in flat.items():
            self._types[name + _ARRAY] = _FlatArrayFunctions(name, self, leaves)
        for name in all_kept:
            self._types[name + _ARRAY] = _KeptArrayFunctions(name, self)

    def get_msgdef(self, name: str) -> Any:
        """Return those of a type; rosbags' generated code asks with this name."""
        return self._types[name]


def _with_arrays(fields: Fielddefs, ours: Collection[str]) -> Fielddefs:
    """Return fields in which arrays of some types are read by us."""

    def changed(desc: FieldDesc) -> FieldDesc:
        name = _element(desc)
        if name in ours:
            return cast("FieldDesc", (desc[0].__class__(NAME), name + _ARRAY))
        return desc

    return [(name, changed(desc)) for name, desc in fields]


def _element(desc: FieldDesc) -> str:
    """Return the element type of an array; "" for other fields and for numbers."""
    kind, what = cast("tuple[int, Any]", desc)
    return str(what[0][1]) if kind == SEQUENCE and what[0][0] == NAME else ""


@dataclass
class _TypeFunctions:
    """What generated code asks for, with rosbags' names."""

    cls: type
    fields: Fielddefs
    _all: Functions = field(repr=False)

    @cached_property
    def deserialize_cdr_le(self) -> Any:
        from rosbags.serde.cdr import generate_deserialize_cdr

        return generate_deserialize_cdr(self.fields, cast("Any", self._all), "le")

    @cached_property
    def deserialize_cdr_be(self) -> Any:
        from rosbags.serde.cdr import generate_deserialize_cdr

        return generate_deserialize_cdr(self.fields, cast("Any", self._all), "be")

    @cached_property
    def deserialize_ros1(self) -> Any:
        from rosbags.serde.ros1 import generate_deserialize_ros1

        return generate_deserialize_ros1(self.fields, cast("Any", self._all))


@dataclass
class _ArrayFunctions:
    """The same for arrays of a type, whose length the message says."""

    name: str
    _all: Functions = field(repr=False)
    cls: type = field(default=list, init=False)

    @property
    def fields(self) -> Fielddefs:
        """One array; rosbags looks at how it is aligned."""
        from rosbags.interfaces import Nodetype

        element = Nodetype.NAME, self.name
        return [("rows", cast("FieldDesc", (Nodetype.SEQUENCE, (element, 0))))]

    @cached_property
    def deserialize_cdr_le(self) -> Any:
        return self._reader("deserialize_cdr_le", "<", is_aligned=True)

    @cached_property
    def deserialize_cdr_be(self) -> Any:
        return self._reader("deserialize_cdr_be", ">", is_aligned=True)

    @cached_property
    def deserialize_ros1(self) -> Any:
        return self._reader("deserialize_ros1", "<", is_aligned=False)

    def _reader(self, function: str, order: str, *, is_aligned: bool) -> Any:
        raise NotImplementedError


@dataclass
class _FlatArrayFunctions(_ArrayFunctions):
    """Those of a type that is nothing but numbers and texts."""

    leaves: Sequence[tuple[str, str]]

    def _reader(self, function: str, order: str, *, is_aligned: bool) -> Any:
        element = self._all.get_msgdef(self.name)
        read_one: Callable[..., tuple[Any, int]] = getattr(element, function)
        length = struct.Struct(f"{order}I").unpack_from

        def one(data: memoryview, at: int) -> tuple[Any, int]:
            return read_one(data, at, element.cls, self._all)

        rows = ArrayReader(one, self.leaves, order, is_aligned)

        def read(data: memoryview, at: int, *_: object) -> tuple[Any, int]:
            return rows(data, at + 4, *length(data, at))

        return read


class _KeptArrayFunctions(_ArrayFunctions):
    """Those of the arrays of a message of which the next one may have most again."""

    def _reader(self, function: str, order: str, *, is_aligned: bool) -> Any:
        from rosbags.serde.utils import align

        element = self._all.get_msgdef(self.name)
        length = struct.Struct(f"{order}I").unpack_from
        parts: list[tuple[int, Callable[..., Any]]] = []
        for fields in _parts_of(element.fields):
            alignment = align(fields[0][1], cast("Any", self._all)) if is_aligned else 1
            functions = _TypeFunctions(tuple, fields, self._all)
            parts.append((alignment, getattr(functions, function)))
        elements = ElementReader(element.cls, getattr(element, function), parts)

        def read(data: memoryview, at: int, _: object, all_: Any) -> tuple[Any, int]:
            return elements(data, at + 4, length(data, at)[0], all_)

        return read


def _parts_of(fields: Fielddefs) -> list[Fielddefs]:
    """Return the fields of a type in parts: a pose is one, as it is what changes."""
    parts: list[Fielddefs] = [[]]
    for one in fields:
        is_pose = one[1][1] == _POSE
        if is_pose and parts[-1]:
            parts.append([])
        parts[-1].append(one)
        if is_pose:
            parts.append([])
    return [part for part in parts if part]
