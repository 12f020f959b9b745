"""The functions that read a type, as rosbags generates them, but for alike elements."""

from __future__ import annotations

import struct
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from threading import Lock
from typing import TYPE_CHECKING, Any, cast

from sambot_viz.messages.definition import NAME, SEQUENCE
from sambot_viz.messages.flat_types import leaves_of
from sambot_viz.messages.rows import ArrayReader

if TYPE_CHECKING:
    from rosbags.interfaces.typing import Fielddefs, FieldDesc

    from sambot_viz.messages.definition import Types

# rosbags' generated module lies in sys.modules while its dataclasses are made.
_register_lock = Lock()
_ARRAY = "[]"
"""Behind the name of a type: arrays of it, as a type that rosbags' code asks us for."""


class Functions:
    """The functions of types, each made when it is first asked for.

    rosbags' own store makes fourteen for each type, of which reading needs one.

    Attributes:
        max_sequence_length: no array may have more elements; one that reads a whole
            message says how many.
    """

    max_sequence_length = 0

    def __init__(self, types: Types) -> None:
        from rosbags.typesys.store import Typestore

        store = Typestore()
        with _register_lock:
            store.register({name: ([], fields) for name, fields in types.items()})
        found = {name: leaves_of(name, types) for name in types}
        flat = {name: leaves for name, leaves in found.items() if leaves}
        self._types: dict[str, _TypeFunctions | _ArrayFunctions] = {
            name: _TypeFunctions(store.types[name], _with_arrays(fields, flat), self)
            for name, (_, fields) in store.fielddefs.items()
        }
        for name, leaves in flat.items():
            self._types[name + _ARRAY] = _ArrayFunctions(name, leaves, self)

    def get_msgdef(self, name: str) -> Any:
        """Return those of a type; rosbags' generated code asks with this name."""
        return self._types[name]


def _with_arrays(fields: Fielddefs, flat: Collection[str]) -> Fielddefs:
    """Return fields in which arrays of flat types are read by us."""

    def changed(desc: FieldDesc) -> FieldDesc:
        kind, what = cast("tuple[int, Any]", desc)
        if kind == SEQUENCE and what[0][0] == NAME and what[0][1] in flat:
            return cast("FieldDesc", (desc[0].__class__(NAME), what[0][1] + _ARRAY))
        return desc

    return [(name, changed(desc)) for name, desc in fields]


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
    """The same for arrays of a flat type, whose length the message says."""

    name: str
    leaves: Sequence[tuple[str, str]]
    _all: Functions = field(repr=False)
    cls: type = list

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
        element = self._all.get_msgdef(self.name)
        read_one: Callable[..., tuple[Any, int]] = getattr(element, function)
        length = struct.Struct(f"{order}I").unpack_from

        def one(data: memoryview, at: int) -> tuple[Any, int]:
            return read_one(data, at, element.cls, self._all)

        rows = ArrayReader(one, self.leaves, order, is_aligned)

        def read(data: memoryview, at: int, *_: object) -> tuple[Any, int]:
            return rows(data, at + 4, *length(data, at))

        return read
