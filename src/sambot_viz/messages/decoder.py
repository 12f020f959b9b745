"""Decoders: from the bytes of a message to its fields.

rosbags generates a function for each type; these are called with what it takes to be
tolerant of trailing bytes and never to trust a length.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz.errors import DecodeError
from sambot_viz.messages.definition import TypeDefinition
from sambot_viz.messages.functions import Functions
from sambot_viz.messages.kept_elements import KeptElements
from sambot_viz.messages.reason import Reason

Edges = tuple[tuple[str, str], ...]
"""(parent, child) of each transform."""
ReadTransforms = tuple[list[int], Edges, npt.NDArray[np.float64]]
"""The stamps of transforms [ns], their frames, and their (N, 7) poses."""
Payload = bytes | bytearray | memoryview
_XCDR2 = tuple(bytes((0, number)) for number in range(6, 12))
"""How messages in the newer CDR of DDS begin."""
_PADDING = 3
"""CDR pads messages to four bytes."""
_ZEROS = 8
"""The zeros that rclpy.serialize_message adds after a message."""


class Decoder:
    """Reads the messages of all channels with one definition and encoding.

    This one reads nothing and has the reason; the others derive from it.

    Attributes:
        type_name: of the messages, "pkg/msg/Name" for those of ROS.
        encoding: of the messages: "cdr", "ros1", "json", ….
        reason: why they cannot be read; None when they can.
        note: what to know about those that are read; may come with a message.
        is_typed: messages are objects of ROS's types; else dicts of fields.
    """

    is_typed = False

    def __init__(
        self, type_name: str, encoding: str, reason: Reason | None = None
    ) -> None:
        self.type_name = type_name
        self.encoding = encoding
        self.reason = reason
        self.note: Reason | None = None

    def decode(self, payload: Payload, kept: KeptElements | None = None) -> Any:
        """Decode a message.

        Args:
            payload: its bytes.
            kept: the elements of the last message of its topic: elements with the same
                bytes become the same objects.

        Returns:
            An object with the fields as attributes; arrays of numbers are read-only
            views of the payload. For messages that are not of ROS, a dict of fields.

        Raises:
            DecodeError: the bytes do not fit the type; with a short cause.
        """
        raise DecodeError(self.reason.text if self.reason else "it cannot be read")

    def transforms(self, payload: Payload) -> ReadTransforms | None:
        """Return transforms without making objects; None if they must be decoded."""
        del payload
        return None


class _Store:
    """Stands in for rosbags' store in the generated functions, for one message.

    No sequence can have more elements than the message has bytes; rosbags would
    count up to any number where elements take none.
    """

    __slots__ = ("get_msgdef", "kept", "max_sequence_length")

    def __init__(
        self, get_msgdef: Callable[[str], Any], length: int, kept: KeptElements | None
    ) -> None:
        self.get_msgdef = get_msgdef
        self.max_sequence_length = length
        self.kept = kept


class _Layout:
    """One definition, made into functions when the first message comes."""

    def __init__(self, definition: TypeDefinition, encoding: str) -> None:
        self.definition = definition
        self._is_ros1 = encoding == "ros1"
        self._functions: Functions | None = None

    def read(self, payload: memoryview, kept: KeptElements | None) -> tuple[Any, int]:
        """Return a message, and how many bytes are left over.

        Raises:
            DecodeError: the bytes are no such message.
        """
        try:
            return self._read(payload, kept)
        except DecodeError:
            raise
        except Exception as error:
            # Generated code: struct.error, ValueError, IndexError, SerdeError, ….
            raise DecodeError(_cause(error)) from error

    def _read(self, payload: memoryview, kept: KeptElements | None) -> tuple[Any, int]:
        if self._functions is None:
            self._functions = Functions(self.definition.types, self.definition.name)
        get_msgdef = self._functions.get_msgdef
        own = get_msgdef(self.definition.name)
        store = _Store(get_msgdef, len(payload), kept)
        if self._is_ros1:
            function = own.deserialize_ros1
        else:
            head = bytes(payload[:2])
            if len(payload) < 4 or head not in (b"\0\0", b"\0\1"):
                raise DecodeError(_not_cdr(head))
            function = own.deserialize_cdr_le if head[1] else own.deserialize_cdr_be
            payload = payload[4:]
            if not payload and self.definition.is_empty:
                # A writer that leaves out the byte that means nothing.
                payload = memoryview(b"\0")
        message, end = function(payload, 0, own.cls, store)
        if end > len(payload):
            raise DecodeError("it is cut off")
        return message, len(payload) - end


class FieldDecoder(Decoder):
    """Reads CDR and ROS 1 messages by their definition.

    The definition of a file may be wrong. It is when a message does not fit it, and
    fits another one of that name, such as the standard one; that is used from then on.

    Args:
        type_name: of the messages.
        encoding: of the messages, "cdr" or "ros1".
        definitions: the first one is tried first.
        others: gives more definitions, asked when a message does not fit.
    """

    is_typed = True

    def __init__(
        self,
        type_name: str,
        encoding: str,
        definitions: Sequence[TypeDefinition],
        others: Callable[[], Sequence[TypeDefinition]] | None = None,
    ) -> None:
        super().__init__(type_name, encoding)
        self._layouts = tuple(_Layout(one, encoding) for one in definitions)
        self._others = others
        self._own = definitions[0] if others is not None else None

    def decode(self, payload: Payload, kept: KeptElements | None = None) -> Any:
        """Return a message."""
        view = memoryview(payload).toreadonly().cast("B")
        # Replaced as a whole and never changed: several players read at a time.
        layouts = self._layouts
        try:
            message, left = layouts[0].read(view, kept)
        except DecodeError:
            if (better := self._fitting(layouts, view)) is None:
                raise
            return better[0]
        if left <= _PADDING or (left <= _ZEROS and not any(view[-left:])):
            return message
        better = self._fitting(layouts, view)
        return message if better is None else better[0]

    def _fitting(
        self, layouts: tuple[_Layout, ...], view: memoryview
    ) -> tuple[Any] | None:
        """Return the message by another definition that it fits to its last byte."""
        if (others := self._others) is not None:
            more = (one for one in others() if one != self._own)
            layouts = (*layouts, *(_Layout(one, self.encoding) for one in more))
            self._layouts, self._others = layouts, None
        for layout in layouts[1:]:
            try:
                message, left = layout.read(view, None)
            except DecodeError:
                continue
            if left <= _PADDING:
                rest = (one for one in layouts if one is not layout)
                self._layouts = (layout, *rest)
                if self._own is not None and layout.definition != self._own:
                    self.note = definition_wrong(
                        "does not fit its messages", self.type_name
                    )
                return (message,)
        return None


def definition_wrong(fault: str, type_name: str) -> Reason:
    """Return the note of messages that are read by another definition than theirs."""
    return Reason(
        "definition-wrong",
        f"the definition that came with it {fault}, so the standard {type_name} is "
        "used; record with the same version of the package as the publisher",
    )


def _not_cdr(head: bytes) -> str:
    found = f"it begins with {head.hex() or 'nothing'}, not CDR"
    if head in _XCDR2:
        return f"{found} but XCDR2; have its writer use XCDR1"
    return found


def _cause(error: Exception) -> str:
    text = str(error)
    if "sequence length" in text:
        return "an array longer than its message"
    if "string length" in text:
        return "a text longer than its message"
    return "it is cut off or of another type"
