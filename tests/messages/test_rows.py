"""Arrays of elements that are alike: they are read as one by one, at a lower cost."""

from __future__ import annotations

import random
from dataclasses import replace
from operator import attrgetter
from typing import Any

import pytest
from decoded import calls_of, decoder_of, values_of
from random_messages import random_message

from sambot_viz.errors import DecodeError
from sambot_viz.messages import Rows

PATH, STAMPED = "nav_msgs/msg/Path", "geometry_msgs/msg/PoseStamped"
POSE = [f"pose.position.{axis}" for axis in "xyz"]
LISTS = {
    "wide_last": "float64 a\nfloat32 b",
    "narrow_first": "uint8 a\nfloat64 b",
    "bytes": "uint8 a\nint8 b\nbool c",
    "text_first": "string a\nfloat64 b\nuint16 c",
    "text_last": "float64 a\nstring b",
    "texts": "string a\nstring b",
    "nested": "geometry_msgs/Pose a\nstd_msgs/Header b\nint64 c",
}


@pytest.fixture(scope="module")
def store() -> Any:
    """ROS 2's types, with lists of elements whose fields are aligned in many ways."""
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    made = get_typestore(Stores.ROS2_HUMBLE)
    for name, text in LISTS.items():
        made.register(get_types_from_msg(text, f"made/msg/{name}"))
        behind = f"string before\n{name}[] rows\nfloat64 behind"
        made.register(get_types_from_msg(behind, f"made/msg/{name}_list"))
    return made


def path_of(store: Any, count: int, frames: tuple[str, ...] = ("map",)) -> Any:
    poses = [random_message(store, STAMPED, seed) for seed in range(count)]
    for number, one in enumerate(poses):
        one.header.frame_id = frames[number % len(frames)]
    return replace(random_message(store, PATH, 0), poses=poses)


@pytest.mark.parametrize("kind", LISTS)
@pytest.mark.parametrize("encoding", ["little", "big", "ros1"])
def test_elements_are_those_that_rosbags_reads(
    store: Any, kind: str, encoding: str
) -> None:
    name, element = f"made/msg/{kind}_list", f"made/msg/{kind}"
    decoder = decoder_of(store, name, "ros1" if encoding == "ros1" else "cdr")
    chance, as_rows = random.Random(kind), 0
    for seed in range(120):
        count = chance.choice([0, 1, 2, 7, 8, 9, 30])
        first = random_message(store, element, seed)
        rows = [random_message(store, element, seed + n) for n in range(count)]
        if chance.random() < 0.7:
            texts = {k: v for k, v in vars(first).items() if isinstance(v, str)}
            rows = [replace(row, **texts) for row in rows]
            for row in rows if kind == "nested" else ():
                row.b.frame_id = first.b.frame_id
        message = store.types[name]("x" * chance.randrange(9), rows, 0.5)
        if encoding == "ros1":
            payload = store.serialize_ros1(message, name)
        else:
            is_little = encoding == "little"
            payload = store.serialize_cdr(message, name, little_endian=is_little)
        found = decoder.decode(payload)
        assert values_of(found) == values_of(message), seed
        as_rows += isinstance(found.rows, Rows)
    assert as_rows > 10


def test_numbers_are_those_of_the_elements(store: Any) -> None:
    decoder = decoder_of(store, PATH)
    for little in (True, False):
        # The stamps and the texts put the first element at other places than the rest.
        for before in ("", "map", "a_frame"):
            path = path_of(store, 20)
            path.header.frame_id = before
            payload = store.serialize_cdr(path, PATH, little_endian=little)
            poses = decoder.decode(payload).poses
            assert isinstance(poses, Rows)
            wanted = [attrgetter(*POSE)(one) for one in path.poses]
            assert poses.numbers(*POSE).tolist() == [list(row) for row in wanted]
            assert poses.numbers("header.stamp.sec").tolist() == [
                [one.header.stamp.sec] for one in path.poses
            ]
            with pytest.raises(AttributeError):
                poses.numbers("header.frame_id")
            with pytest.raises(IndexError):
                poses[20]
            assert values_of(poses[-1]) == values_of(path.poses[-1])
            assert values_of(poses[3:5]) == values_of(path.poses[3:5])


@pytest.mark.parametrize("frames", [("map", "odom"), ("map", "mat"), ("map", "")])
def test_elements_with_other_texts_are_read_one_by_one(
    store: Any, frames: tuple[str, ...]
) -> None:
    path = path_of(store, 20, frames)
    found = decoder_of(store, PATH).decode(store.serialize_cdr(path, PATH))
    assert isinstance(found.poses, list)
    assert values_of(found) == values_of(path)


def test_a_message_that_is_cut_off_is_refused(store: Any) -> None:
    path = path_of(store, 9)
    payload = bytes(store.serialize_cdr(path, PATH))
    decoder = decoder_of(store, PATH)
    assert values_of(decoder.decode(payload)) == values_of(path)
    for end in range(len(payload)):
        with pytest.raises(DecodeError):
            decoder.decode(payload[:end])


def test_lengths_are_not_trusted(store: Any) -> None:
    path = path_of(store, 9)
    path.header.frame_id = "map"
    payload = bytearray(store.serialize_cdr(path, PATH))
    # The head, a stamp, and a text of four bytes with its length come before.
    place = 4 + 8 + 8
    assert payload[place : place + 4] == (9).to_bytes(4, "little")
    for count in (10, 1000, 2**31, 2**32 - 1):
        payload[place : place + 4] = count.to_bytes(4, "little")
        with pytest.raises(DecodeError):
            decoder_of(store, PATH).decode(payload)


def test_ten_times_the_poses_take_no_more_calls(store: Any) -> None:
    decoder = decoder_of(store, PATH)
    few, many = (store.serialize_cdr(path_of(store, n), PATH) for n in (50, 500))
    decoder.decode(few)
    assert calls_of(lambda: decoder.decode(few)) == calls_of(
        lambda: decoder.decode(many)
    )
    rows = decoder.decode(few).poses, decoder.decode(many).poses
    assert calls_of(lambda: rows[0].numbers(*POSE)) == calls_of(
        lambda: rows[1].numbers(*POSE)
    )
