"""Transforms in Protobuf are read as Google's package reads them, and quickly."""

from __future__ import annotations

import math
import random
from typing import Any

import numpy as np
import pytest
from foreign_messages import in_protobuf, recorded
from foxglove.messages import (
    FrameTransform,
    FrameTransforms,
    Quaternion,
    Timestamp,
    Vector3,
)

from sambot_viz.errors import DecodeError
from sambot_viz.messages import MessageTypes, TransformDecoder
from sambot_viz.messages.protobuf import ProtobufDecoder
from sambot_viz.sources.message import Recorded
from sambot_viz.topics.decoding import Decoding

NUMBERS = (0.0, -0.0, 1.0, math.nan, math.inf)


def sent(seed: int, frames: int = 8, seconds: int | None = None) -> FrameTransforms:
    """Transforms with numbers by chance, among them those that are left out as 0."""
    chance = random.Random(seed)

    def number() -> float:
        return chance.choice(NUMBERS) if chance.random() < 0.1 else chance.random()

    def stamp() -> Timestamp:
        nanos = chance.choice((0, 5, 10**9 - 1, chance.randrange(10**9)))
        begin = chance.choice((0, 5, 1_700_000_000)) if seconds is None else seconds
        return Timestamp(sec=begin, nsec=nanos)

    shared = stamp() if seed % 2 else None
    return FrameTransforms(
        transforms=[
            FrameTransform(
                timestamp=shared or stamp(),
                parent_frame_id="odom" if n % 3 else "",
                child_frame_id=f"frame_{n}",
                translation=Vector3(x=number(), y=number(), z=number()),
                rotation=Quaternion(x=number(), y=number(), z=number(), w=number()),
            )
            for n in range(frames)
        ]
    )


class Both:
    """Reads messages in both ways, with one decoder each for all of them."""

    def __init__(self) -> None:
        self.quick, self.slow = Decoding(MessageTypes()), Decoding(MessageTypes())
        self._sorted = TransformDecoder("protobuf")

    def by_package(self, message: Recorded) -> Any:
        return self._sorted.sorted(self.slow.decode(message).transforms)

    def compare(self, message: Recorded) -> bool:
        """Compare the two ways; returns whether the message could be read."""
        try:
            expected = self.by_package(message)
        except DecodeError:
            with pytest.raises(DecodeError):
                self.quick.transforms(message)
            return False
        found = self.quick.transforms(message)
        assert [one[:2] for one in found] == [one[:2] for one in expected]
        for (_, _, poses), (_, _, right) in zip(found, expected, strict=True):
            np.testing.assert_array_equal(poses, right)
        return True


def test_they_are_read_as_by_the_package() -> None:
    both = Both()
    for seed in range(200):
        assert both.compare(recorded(in_protobuf(sent(seed))))


@pytest.mark.parametrize("seed", range(10))
def test_what_is_damaged_or_laid_out_otherwise_too(seed: int) -> None:
    both, chance = Both(), random.Random(seed)
    schema, encoding, whole = in_protobuf(sent(seed))
    assert both.compare(recorded((schema, encoding, whole)))
    read = 0
    for _ in range(200):
        payload = bytearray(whole)
        for _ in range(chance.randint(1, 3)):
            at = chance.randrange(len(payload))
            if chance.random() < 0.3:
                del payload[at : at + chance.randint(1, 9)]
            else:
                payload[at] = chance.randrange(256)
        read += both.compare(recorded((schema, encoding, bytes(payload))))
    assert read
    # Twice the same field, one that nobody knows, and nothing at all.
    assert both.compare(recorded((schema, encoding, whole + whole)))
    both.compare(recorded((schema, encoding, whole + b"\x7a\x01a")))
    assert both.compare(recorded((schema, encoding, b"")))


def test_no_object_is_made_for_fields_of_messages_that_have_the_same_frames(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    decoded: list[object] = []
    decode = ProtobufDecoder.decode

    def counted(self: ProtobufDecoder, payload: Any, kept: Any = None) -> Any:
        decoded.append(payload)
        return decode(self, payload, kept)

    monkeypatch.setattr(ProtobufDecoder, "decode", counted)
    decoding = Decoding(MessageTypes())
    edges: set[int] = set()
    for second in range(100):
        (*_, last) = decoding.transforms(
            recorded(in_protobuf(sent(1, 30, 1_700_000_000 + second)))
        )
        edges.add(id(last[1]))
    assert decoded == []
    assert len(edges) == 1
