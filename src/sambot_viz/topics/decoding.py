"""Decode the messages of a source, each by the definition of its channel."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from operator import attrgetter
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from sambot_viz.errors import DecodeError
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.frames.samples import FramePair
from sambot_viz.meanings import has_ros_look, reader_of
from sambot_viz.meanings.reading import Read
from sambot_viz.messages import (
    Decoder,
    KeptElements,
    MessageTypes,
    Rows,
    TransformDecoder,
)
from sambot_viz.sources.message import Recorded
from sambot_viz.topics.name_spaces import NameSpaces
from sambot_viz.topics.transforms import Transforms

_MOST_KEPT = 1000
_FRAMES = ("frame_id", "child_frame_id")
_HAVE_FRAMES = ("header", "markers", "poses", "transforms", "erases")
"""Fields of messages that have frames, or elements with frames, in them."""


class Decoding:
    """Decodes messages of any topic, and transforms in a faster way.

    Not thread-safe: each session has its own.

    Args:
        types: of all sources.
        spaces: name the frames of robots with name spaces.
    """

    def __init__(self, types: MessageTypes, spaces: NameSpaces | None = None) -> None:
        self.types = types
        self.spaces = NameSpaces() if spaces is None else spaces
        self._transforms: dict[str, TransformDecoder] = {}
        self._readers: dict[Decoder, Read] = {}
        self._prefixed: dict[tuple[str, int], tuple[object, tuple[FramePair, ...]]] = {}

    def decode(self, message: Recorded, kept: KeptElements | None = None) -> Any:
        """Return a message in the look of its meaning (see `Meaning`).

        The frames of its headers get their names in the tree. A message of an unknown
        schema is a dict of its fields, or an object with them.

        Args:
            message: the bytes of the message.
            kept: state of the message before; equal elements of arrays are the same
                objects.

        Raises:
            DecodeError: the bytes do not fit the type, or the type is not read.
        """
        read = self._read(message, kept)
        if self.spaces:
            self.spaces.name_frames(message.topic, read)
        return read

    def _read(self, message: Recorded, kept: KeptElements | None = None) -> Any:
        channel = message.channel
        decoder = self.types.decoder(channel.schema, channel.message_encoding)
        if decoder.reason is not None:
            raise DecodeError(decoder.reason.text)
        read = self._readers.get(decoder)
        if read is None:
            read = self._readers[decoder] = reader_of(decoder, self.types)
        value = read(message.payload, kept)
        if channel.frame_prefix:
            put_prefix(value, channel.frame_prefix)
        return value

    def in_turn(self) -> Callable[[Recorded], Any]:
        """Return what decodes messages that come one after the other, as `decode`."""
        return partial(self.decode, kept=KeptElements())

    def text(self, message: Recorded) -> str:
        """Return the text of a std_msgs/String; empty when it cannot be read."""
        try:
            data = self.decode(message).data
        except (DecodeError, AttributeError):
            return ""
        return str(data) if data else ""

    def transforms(self, message: Recorded) -> Transforms:
        """Return the transforms of a message of /tf.

        Raises:
            DecodeError: as `decode`.
        """
        encoding = message.channel.message_encoding
        decoder = self._transforms.get(encoding)
        if decoder is None:
            decoder = self._transforms[encoding] = TransformDecoder(encoding)
        found = self._quick(message, decoder)
        if found is None:
            found = decoder.sorted(self._read(message).transforms)
        elif message.channel.frame_prefix:
            found = self._with_prefix(found, message.channel.frame_prefix)
        return self.spaces.transforms(message.topic, found) if self.spaces else found

    def _quick(self, message: Recorded, made: TransformDecoder) -> Transforms | None:
        """Return the transforms of a message that needs no objects for its fields."""
        channel = message.channel
        if made.is_fast and has_ros_look(channel.schema.name):
            return made.decode(message.payload)
        decoder = self.types.decoder(channel.schema, channel.message_encoding)
        read = decoder.transforms(message.payload)
        return None if read is None else made.rows(read)

    def _with_prefix(self, transforms: Transforms, prefix: str) -> Transforms:
        """Return transforms with other names, the same tuple for the same frames."""
        found: list[tuple[int, tuple[FramePair, ...], Any]] = []
        for stamp, edges, poses in transforms:
            key = (prefix, id(edges))
            # The decoder's tuple is kept too, so that no other one gets its id.
            if key not in self._prefixed or self._prefixed[key][0] is not edges:
                if len(self._prefixed) >= _MOST_KEPT:
                    self._prefixed.clear()
                named = tuple(
                    (prefixed(one, prefix), prefixed(other, prefix))
                    for one, other in edges
                )
                self._prefixed[key] = edges, named
            found.append((stamp, self._prefixed[key][1], poses))
        return found


def prefixed(frame: str, prefix: str) -> str:
    """Return the name of a frame with a prefix; add it only if it is missing."""
    frame = plain_name(frame)
    has_it = not frame or frame.startswith(f"{prefix}/")
    return frame if has_it else f"{prefix}/{frame}"


def put_prefix(value: Any, prefix: str) -> None:
    """Put a prefix before the frames of a message, and of the elements of its arrays.

    Args:
        value: the decoded message; parts shared with other messages are changed once.
        prefix: the prefix, without a slash at its end.
    """
    for name in _FRAMES:
        frame = getattr(value, name, None)
        if isinstance(frame, str):
            setattr(value, name, prefixed(frame, prefix))
    for name in _HAVE_FRAMES:
        below = getattr(value, name, None)
        if isinstance(below, list):
            for one in cast("list[Any]", below):
                put_prefix(one, prefix)
        elif below is not None and not isinstance(below, Rows):
            put_prefix(below, prefix)


def frame_and_stamp(message: Any) -> tuple[str, int | None]:
    """Return frame and stamp [ns] of a header; None for 0, the latest time.

    Raises:
        DecodeError: the message has no header.
    """
    try:
        header = message.header
        stamp = header.stamp.sec * 1_000_000_000 + header.stamp.nanosec
        return plain_name(str(header.frame_id)), stamp or None
    except AttributeError:
        raise DecodeError("it has no header") from None


def numbers_of(elements: Sequence[Any], *paths: str) -> npt.NDArray[np.float64]:
    """Return fields of all elements of an array, (N, number of paths).

    Args:
        elements: of a message.
        paths: of the fields, such as "pose.position.x".
    """
    if isinstance(elements, Rows):
        return elements.numbers(*paths)
    get = attrgetter(*paths)
    found = np.array([get(one) for one in elements], np.float64)
    return np.reshape(found, (-1, len(paths)))
