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


def many(
    count: int, second: int = 5, word: str = "frame"
) -> tuple[tuple[int, str, str], ...]:
    """Rows with frames of all lengths, so that CDR aligns in all ways."""
    names = [word + "x" * (i % 9) + str(i) for i in range(count + 1)]
    return tuple((second * 10**9 + 7, names[i], names[i + 1]) for i in range(count))


WRITERS = {
    "cdr": ("cdr", message),
    "cdr, big-endian": ("cdr", lambda *rows: message(*rows, order=">")),
    "ros1": ("ros1", message_ros1),
}


@pytest.mark.parametrize("how", WRITERS)
def test_the_second_message_with_the_same_frames_is_read_as_the_first(how: str) -> None:
    encoding, write = WRITERS[how]
    decoder = TransformDecoder(encoding)
    ((_, edges, poses),) = decoder.decode(write(*many(50)))
    for second in (-6, 1_750_000_000) if encoding == "cdr" else (0, 4_000_000_000):
        ((stamp, again, same),) = decoder.decode(write(*many(50, second)))
        assert stamp == second * 10**9 + 7
        assert again is edges
        assert same.dtype == np.float64 and same.dtype.isnative
        assert same.tolist() == poses.tolist()


@pytest.mark.parametrize("how", WRITERS)
def test_a_message_as_long_with_other_frames_is_not_mistaken(how: str) -> None:
    encoding, write = WRITERS[how]
    decoder = TransformDecoder(encoding)
    words = ("frame", "phase", "flame", "stage", "place", "plane")
    for word in (*words, *words):
        rows = many(20, word=word)
        ((_, edges, _),) = decoder.decode(write(*rows))
        assert edges == tuple(row[1:] for row in rows)


@pytest.mark.parametrize("how", WRITERS)
def test_stamps_that_part_are_told_apart_by_a_template_too(how: str) -> None:
    encoding, write = WRITERS[how]
    decoder = TransformDecoder(encoding)
    decoder.decode(write(*many(9)))
    rows = [(i % 2 * 10**9, *row[1:]) for i, row in enumerate(many(9))]
    first, second = decoder.decode(write(*rows))
    assert (first[0], second[0]) == (0, 10**9)
    assert first[1] == tuple(row[1:] for row in rows[::2])
    assert second[2][:, 0].tolist() == [1, 3, 5, 7]


@pytest.mark.parametrize("how", WRITERS)
def test_a_template_reads_what_a_new_decoder_reads(how: str) -> None:
    """Whatever byte of a message is changed: the same transforms, or refused."""
    encoding, write = WRITERS[how]
    payload = write(*many(7))
    trained = TransformDecoder(encoding)
    trained.decode(payload)

    def outcome(decoder: TransformDecoder, data: bytes) -> object:
        try:
            found = decoder.decode(data)
        except DecodeError:
            return None
        return [(stamp, edges, poses.tobytes()) for stamp, edges, poses in found]

    for place in range(len(payload)):
        for flip in (1, 0x80, 0xFF):
            data = bytearray(payload)
            data[place] ^= flip
            expected = outcome(TransformDecoder(encoding), data)
            assert outcome(trained, data) == expected, (place, flip)


def test_zeros_behind_a_message_are_tolerated_and_more_is_not() -> None:
    decoder, payload = TransformDecoder("cdr"), message(*many(8))
    for _ in range(2):
        assert decoder.decode(payload + bytes(8))[0][0] == 5_000_000_007
        assert decoder.decode(payload + b"abc")[0][0] == 5_000_000_007
        for more in (b"abcd", bytes(9)):
            with pytest.raises(DecodeError, match="longer than its transforms"):
                decoder.decode(payload + more)


def test_frames_that_change_for_ever_fill_no_memory() -> None:
    decoder = TransformDecoder("cdr")
    for number in range(1000):
        decoder.decode(message(*many(6, word=f"{number}" + "y" * (number % 60))))
    assert len(decoder._templates) <= 32
    for number in range(100):
        decoder.decode(message(*many(500, word=f"{number}")))
    assert sum(map(len, decoder._edges)) <= 21_000
