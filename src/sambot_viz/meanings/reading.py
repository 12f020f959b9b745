"""Read the messages of a channel in the look of their meaning."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from sambot_viz.errors import DecodeError
from sambot_viz.meanings.schema_row import SENSOR_POSE, Fields, SchemaRow
from sambot_viz.meanings.schemas import row_of
from sambot_viz.messages import Decoder, KeptElements, MessageTypes
from sambot_viz.messages.decoder import Payload
from sambot_viz.messages.shape import MessageShape, fields_of

Read = Callable[[Payload, "KeptElements | None"], Any]


def reader_of(decoder: Decoder, types: MessageTypes) -> Read:
    """Return a function that reads the messages of a decoder.

    Args:
        decoder: the decoder of a channel, which can read it.
        types: the types of all forms.

    Returns:
        A function of the bytes of a message and the elements of the last one, like
        `Decoder.decode`. Without a meaning of the schema it returns the decoder's
        result. It raises DecodeError.
    """
    row = row_of(decoder.type_name)
    if row is None or (row.look is None and decoder.is_typed):
        return decoder.decode
    return _MeaningReader(decoder, row, types)


class _MeaningReader:
    """Brings the messages of a decoder into the look of their meaning.

    Attributes of a message that ROS's type does not have: `sensor_pose`, a
    geometry_msgs/Pose, where a schema has one.
    """

    def __init__(self, decoder: Decoder, row: SchemaRow, types: MessageTypes) -> None:
        self._decoder = decoder
        self._look = row.look
        self._shape: MessageShape = types.shape(row.meaning.value)
        self._pose: MessageShape = types.shape("geometry_msgs/msg/Pose")

    def __call__(self, payload: Payload, kept: KeptElements | None = None) -> Any:
        fields = fields_of(self._decoder.decode(payload, kept))
        try:
            return self._in_look(fields)
        except DecodeError:
            raise
        except Exception as error:
            # A field of another kind than its schema has; tables do not check each.
            cause = f"its fields are not those of {self._decoder.type_name}"
            raise DecodeError(cause) from error

    def _in_look(self, fields: Fields) -> Any:
        if self._look is not None:
            fields = self._look(fields)
        elif fields.keys().isdisjoint(self._shape.fields):
            raise DecodeError(f"it has no field of {self._shape.name}")
        message = self._shape.filled(fields)
        pose = fields.get(SENSOR_POSE)
        if pose is not None:
            setattr(message, SENSOR_POSE, self._pose.filled(pose))
        return message
