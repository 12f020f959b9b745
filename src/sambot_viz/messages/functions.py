"""The functions that read a type, as rosbags generates them."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from threading import Lock
from typing import TYPE_CHECKING, Any, cast

if TYPE_CHECKING:
    from rosbags.interfaces.typing import Fielddefs

    from sambot_viz.messages.definition import Types

# rosbags' generated module lies in sys.modules while its dataclasses are made.
_register_lock = Lock()


class Functions:
    """The functions of types, each made when it is first asked for.

    rosbags' own store makes fourteen for each type, of which reading needs one.
    """

    def __init__(self, types: Types) -> None:
        from rosbags.typesys.store import Typestore

        store = Typestore()
        with _register_lock:
            store.register({name: ([], fields) for name, fields in types.items()})
        self._types = {
            name: _TypeFunctions(store.types[name], fields, self)
            for name, (_, fields) in store.fielddefs.items()
        }

    def get_msgdef(self, name: str) -> _TypeFunctions:
        """Return those of a type; rosbags' generated code asks with this name."""
        return self._types[name]


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
