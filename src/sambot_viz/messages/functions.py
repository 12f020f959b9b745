"""The functions that read types, each made when it is first needed."""

from __future__ import annotations

from collections.abc import Mapping
from threading import Lock
from typing import TYPE_CHECKING

from sambot_viz.messages.flat_types import leaves_of
from sambot_viz.messages.reader_code import ReaderCode
from sambot_viz.messages.rows import ArrayReader, Read

if TYPE_CHECKING:
    from sambot_viz.messages.definition import Types

# rosbags' generated module lies in sys.modules while its dataclasses are made.
_register_lock = Lock()


class Functions:
    """The functions that read the types of one definition, written in one way.

    Args:
        types: all that the definition needs.
        order: of the bytes, "<" or ">".
        aligned: whether fields are aligned to their size, as in CDR and not in ROS 1.

    Attributes:
        types: as given; so are `order` and `aligned`.
        classes: of the objects, by the names of their types.
    """

    def __init__(self, types: Types, order: str, aligned: bool) -> None:
        from rosbags.typesys.store import Typestore

        store = Typestore()
        with _register_lock:
            store.register({name: ([], fields) for name, fields in types.items()})
        self.types, self.order, self.aligned = types, order, aligned
        self.classes: Mapping[str, type] = {name: store.types[name] for name in types}
        self._made: dict[str, Read] = {}

    def reader(self, name: str) -> Read:
        """Return what reads a type."""
        if (known := self._made.get(name)) is None:
            known = self._made[name] = ReaderCode(self).function(name)
        return known

    def array_reader(self, name: str) -> ArrayReader:
        """Return what reads arrays of a type."""
        leaves = leaves_of(name, self.types)
        return ArrayReader(self.reader(name), leaves, self.order, self.aligned)
