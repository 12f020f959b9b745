"""Read messages in Protobuf by the descriptor that comes with their channel.

The package of Google reads them; it is imported when the first message comes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from sambot_viz import limits
from sambot_viz.errors import DecodeError
from sambot_viz.messages.decoder import Decoder, Payload, ReadTransforms
from sambot_viz.messages.kept_elements import KeptElements
from sambot_viz.messages.plain_fields import within_limit
from sambot_viz.messages.protobuf_transforms import ProtobufTransforms
from sambot_viz.messages.schema import Schema

if TYPE_CHECKING:
    from google.protobuf.descriptor import Descriptor, FieldDescriptor
    from google.protobuf.descriptor_pb2 import FileDescriptorProto
    from google.protobuf.descriptor_pool import DescriptorPool
    from google.protobuf.message import Message

Get = Callable[[Any], Any]

_NUMPY = {
    **{1: "f8", 2: "f4", 3: "i8", 4: "u8", 5: "i4", 6: "u8", 7: "u4", 8: "?"},
    **{13: "u4", 14: "i4", 15: "i4", 16: "i8", 17: "i4", 18: "i8"},
}
"""Protobuf's number of a type of fields → numpy's."""
_GOOGLE = "google/protobuf/"


class ProtobufDecoder(Decoder):
    """Reads the messages of one type.

    Args:
        schema: with the descriptor, a FileDescriptorSet.

    Raises:
        DecodeError: the descriptor does not describe the type.
    """

    def __init__(self, schema: Schema) -> None:
        super().__init__(schema.name, "protobuf")
        descriptor = _descriptor(schema)
        from google.protobuf.message_factory import GetMessageClass

        self._class: Any = GetMessageClass(descriptor)
        self._readers: dict[str, list[tuple[str, Get]]] = {}
        self._type = descriptor
        self._transforms = ProtobufTransforms(descriptor)

    def transforms(self, payload: Payload) -> ReadTransforms | None:
        """Return transforms in their usual layout; None if they must be decoded."""
        return self._transforms.read(within_limit(payload))

    def decode(
        self, payload: Payload, kept: KeptElements | None = None
    ) -> dict[str, Any]:
        """Return the fields of a message, without those that are not set."""
        from google.protobuf.message import DecodeError as CannotDecodeError

        message = self._class()
        try:
            message.ParseFromString(within_limit(payload))
        except CannotDecodeError:
            raise DecodeError("it is cut off or of another type") from None
        return self._fields(message, self._type)

    def _fields(self, message: Message, kind: Descriptor) -> dict[str, Any]:
        readers = self._readers.get(kind.full_name)
        if readers is None:
            made = [(one.name, self._reader(one)) for one in kind.fields]
            readers = self._readers[kind.full_name] = made
        found: dict[str, Any] = {}
        for name, get in readers:
            value = get(message)
            if value is not None:
                found[name] = value
        return found

    def _reader(self, field: FieldDescriptor) -> Get:
        """Return the reader of a field of a message; it returns None if not set."""
        name, inner = field.name, field.message_type
        if field.is_repeated:
            if inner is not None and inner.GetOptions().map_entry:
                return self._map_reader(name, inner)
            if inner is not None:
                return lambda m: [self._fields(one, inner) for one in getattr(m, name)]
            kind = _NUMPY.get(field.type)
            if kind is not None:
                return lambda m: np.array(getattr(m, name), kind)
            return lambda m: list(getattr(m, name))
        if inner is not None:
            return lambda m: (
                self._fields(getattr(m, name), inner) if m.HasField(name) else None
            )
        if field.has_presence:
            return lambda m: getattr(m, name) if m.HasField(name) else None
        return lambda m: getattr(m, name)

    def _map_reader(self, name: str, entry: Descriptor) -> Get:
        value = entry.fields_by_name["value"].message_type

        def read(message: Any) -> Mapping[str, Any]:
            pairs = getattr(message, name).items()
            if value is None:
                return {str(key): one for key, one in pairs}
            return {str(key): self._fields(one, value) for key, one in pairs}

        return read


def _descriptor(schema: Schema) -> Descriptor:
    """Return the descriptor of the type that a schema names."""
    from google.protobuf.descriptor_pb2 import FileDescriptorSet
    from google.protobuf.descriptor_pool import DescriptorPool
    from google.protobuf.message import DecodeError as CannotDecodeError

    data = schema.text
    if not isinstance(data, bytes) or not data:
        raise DecodeError("its messages are protobuf, and have no descriptor")
    if len(data) > limits.DEFINITION.value:
        raise DecodeError(f"its descriptor has {limits.DEFINITION.said(len(data))}")
    try:
        files = FileDescriptorSet.FromString(data).file
    except CannotDecodeError:
        raise DecodeError("its descriptor is damaged") from None
    pool = DescriptorPool()
    _add(pool, {one.name: one for one in files})
    try:
        return pool.FindMessageTypeByName(schema.name)
    except KeyError:
        raise DecodeError(f"its descriptor has no {schema.name}") from None


def _add(pool: DescriptorPool, files: Mapping[str, FileDescriptorProto]) -> None:
    """Add files to a pool, each after those that it names."""
    waiting: list[Any] = list(files.values())
    added = set[str]()
    while waiting:
        ready = [one for one in waiting if added.issuperset(one.dependency)]
        if not ready:
            missing = _missing(waiting, added)
            if not missing:
                raise DecodeError("its descriptor lacks a file that it names")
            waiting += missing
            continue
        for one in ready:
            try:
                pool.AddSerializedFile(one.SerializeToString())
            except Exception as error:
                # Of several kinds, by the way in which a descriptor is wrong.
                raise DecodeError("its descriptor contradicts itself") from error
            added.add(one.name)
        waiting = [one for one in waiting if one.name not in added]


def _missing(waiting: list[Any], added: set[str]) -> list[Any]:
    """Return Google's own files that are named and not there."""
    from google.protobuf import descriptor_pb2, descriptor_pool

    there = added | {one.name for one in waiting}
    named = {name for one in waiting for name in one.dependency} - there
    found: list[Any] = []
    for name in sorted(name for name in named if name.startswith(_GOOGLE)):
        try:
            known = descriptor_pool.Default().FindFileByName(name)
        except KeyError:
            continue
        proto = descriptor_pb2.FileDescriptorProto()
        known.CopyToProto(proto)
        found.append(proto)
    return found
