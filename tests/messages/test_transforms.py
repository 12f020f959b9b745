"""The decoder of transforms: equal to rosbags', and the same frames as one object."""

from __future__ import annotations

import struct

import numpy as np
import pytest

from sambot_viz.errors import DecodeError
from sambot_viz.messages import TransformDecoder


def message(*rows: tuple[int, str, str], order: str = "<") -> bytes:
    """A TFMessage in CDR whose x is the row's number."""
    data = bytearray(struct.pack(order + "I", len(rows)))

    def align(size: int) -> None:
        data.extend(bytes(-len(data) % size))

    for x, (stamp, parent, child) in enumerate(rows):
        align(4)
        data.extend(struct.pack(order + "iI", stamp // 10**9, stamp % 10**9))
        for name in (parent, child):
            align(4)
            text = name.encode() + b"\0"
            data.extend(struct.pack(order + "I", len(text)) + text)
        align(8)
        data.extend(struct.pack(order + "7d", x, 0, 0, 0, 0, 0, 1))
    return bytes([0, order == "<", 0, 0]) + bytes(data)


def message_ros1(*rows: tuple[int, str, str]) -> bytes:
    """The same for ROS 1."""
    data = struct.pack("<I", len(rows))
    for x, (stamp, parent, child) in enumerate(rows):
        data += struct.pack("<III", x, stamp // 10**9, stamp % 10**9)
        for name in (parent, child):
            data += struct.pack("<I", len(name.encode())) + name.encode()
        data += struct.pack("<7d", x, 0, 0, 0, 0, 0, 1)
    return data


ROWS = ((5 * 10**9 + 7, "odom", "base_link"), (5 * 10**9 + 7, "base_link", "wheel"))


@pytest.mark.parametrize(
    ("encoding", "payload"),
    [
        ("cdr", message(*ROWS)),
        ("cdr", message(*ROWS, order=">")),
        ("ros1", message_ros1(*ROWS)),
    ],
    ids=["cdr", "cdr, big-endian", "ros1"],
)
def test_transforms_are_read_and_their_frames_are_one_object(
    encoding: str, payload: bytes
) -> None:
    decoder = TransformDecoder(encoding)
    ((stamp, edges, poses),) = decoder.decode(payload)
    assert stamp == 5_000_000_007
    assert edges == (("odom", "base_link"), ("base_link", "wheel"))
    assert poses.dtype == np.float64
    assert poses.tolist() == [[0, 0, 0, 0, 0, 0, 1], [1, 0, 0, 0, 0, 0, 1]]
    assert decoder.decode(memoryview(payload))[0][1] is edges


def test_each_stamp_has_an_entry() -> None:
    decoder = TransformDecoder("cdr")
    found = decoder.decode(message((1, "a", "b"), (2, "a", "c"), (1, "a", "d")))
    assert [(stamp, edges) for stamp, edges, _ in found] == [
        (1, (("a", "b"), ("a", "d"))),
        (2, (("a", "c"),)),
    ]
    assert [poses[:, 0].tolist() for *_, poses in found] == [[0, 2], [1]]


@pytest.mark.parametrize("encoding", ["cdr", "ros1"])
def test_any_cut_is_refused(encoding: str) -> None:
    decoder = TransformDecoder(encoding)
    payload = message(*ROWS) if encoding == "cdr" else message_ros1(*ROWS)
    for end in range(len(payload)):
        with pytest.raises(DecodeError):
            decoder.decode(payload[:end])


def test_an_announced_length_costs_nothing() -> None:
    with pytest.raises(DecodeError, match="longer than its message"):
        TransformDecoder("cdr").decode(b"\0\1\0\0" + b"\xff" * 200)
