"""Arrays that come again and again: what is the same is read once, and all is right."""

from __future__ import annotations

import random
import tracemalloc
from typing import Any

import pytest
from decoded import calls_of, decoder_of, values_of
from random_messages import random_message

from sambot_viz.errors import DecodeError
from sambot_viz.messages import KeptElements

MARKER, ARRAY = "visualization_msgs/msg/Marker", "visualization_msgs/msg/MarkerArray"
TIMES = "made/msg/Times"


@pytest.fixture(scope="module")
def store() -> Any:
    """ROS 2's types, with a message that has two arrays and something behind them."""
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    made = get_typestore(Stores.ROS2_HUMBLE)
    made.register(get_types_from_msg("uint8 a\nstring[] texts\nbool b", "made/msg/Odd"))
    text = (
        "string before\nmade/Odd[] odd\nvisualization_msgs/Marker[] markers\nint8 end"
    )
    made.register(get_types_from_msg(text, TIMES))
    return made


def written(store: Any, message: Any, name: str, encoding: str) -> bytes:
    if encoding == "ros1":
        return bytes(store.serialize_ros1(message, name))
    is_little = encoding == "little"
    return bytes(store.serialize_cdr(message, name, little_endian=is_little))


def array_of(store: Any, count: int) -> Any:
    rows = [random_message(store, MARKER, seed) for seed in range(count)]
    return store.types[ARRAY](rows)


def changed(store: Any, message: Any, chance: random.Random) -> None:
    """Change some elements of a message as programs do, and as none does."""
    for markers in (message.markers,):
        for one in markers:
            if chance.random() < 0.3:
                one.pose.position.x = chance.random()
            if chance.random() < 0.1:
                one.header.stamp.sec = chance.randrange(2**30)
            if chance.random() < 0.1:
                one.ns = "n" * chance.randrange(9)
            if chance.random() < 0.1:
                one.text = "t" * chance.randrange(9)
        if chance.random() < 0.2 and markers:
            markers.pop(chance.randrange(len(markers)))
        if chance.random() < 0.3:
            seed = chance.randrange(99)
            at = chance.randrange(len(markers) + 1)
            markers.insert(at, random_message(store, MARKER, seed))
    if chance.random() < 0.3:
        message.before = "b" * chance.randrange(9)
    if chance.random() < 0.3:
        message.odd.append(random_message(store, "made/msg/Odd", chance.randrange(9)))


@pytest.mark.parametrize("encoding", ["little", "big", "ros1"])
def test_messages_are_the_same_as_without(store: Any, encoding: str) -> None:
    decoder = decoder_of(store, TIMES, "ros1" if encoding == "ros1" else "cdr")
    chance, kept, again = random.Random(encoding), KeptElements(), 0
    message = random_message(store, TIMES, 5)
    before: list[Any] = []
    for _ in range(150):
        payload = written(store, message, TIMES, encoding)
        found = decoder.decode(payload, kept)
        assert values_of(found) == values_of(message)
        assert values_of(found) == values_of(decoder.decode(payload))
        again += sum(any(one is other for other in before) for one in found.markers)
        before = list(found.markers)
        changed(store, message, chance)
    assert again > 50


def test_what_is_the_same_is_the_same_object(store: Any) -> None:
    decoder, kept = decoder_of(store, ARRAY), KeptElements()
    message = array_of(store, 5)
    first = decoder.decode(written(store, message, ARRAY, "little"), kept).markers
    message.markers[2].pose.position.x += 1.0
    message.markers[3].color.r = 0.5
    second = decoder.decode(written(store, message, ARRAY, "little"), kept).markers
    same = [one is other for one, other in zip(first, second, strict=True)]
    assert same == [True, True, False, False, True]
    # What has moved has all the rest again.
    assert second[2].pose is not first[2].pose
    assert second[2].header is first[2].header
    assert second[2].points is first[2].points
    assert second[3].pose is first[3].pose
    assert second[3].points is not first[3].points


def test_what_is_the_same_takes_a_fraction_of_the_calls(store: Any) -> None:
    decoder, kept = decoder_of(store, ARRAY), KeptElements()
    message = array_of(store, 100)
    payload = written(store, message, ARRAY, "little")
    all_of_it = calls_of(lambda: decoder.decode(payload, kept))
    assert calls_of(lambda: decoder.decode(payload, kept)) < all_of_it / 10
    for one in message.markers:
        one.pose.orientation.w += 1.0
    moved = written(store, message, ARRAY, "little")
    assert calls_of(lambda: decoder.decode(moved, kept)) < all_of_it / 2


def test_a_message_that_is_cut_off_is_refused_and_the_next_one_read(store: Any) -> None:
    decoder, kept = decoder_of(store, ARRAY), KeptElements()
    message = array_of(store, 3)
    payload = written(store, message, ARRAY, "little")
    for end in range(0, len(payload), 101):
        decoder.decode(payload, kept)
        with pytest.raises(DecodeError):
            decoder.decode(payload[:end], kept)
    assert values_of(decoder.decode(payload, kept)) == values_of(message)


def test_lengths_are_not_trusted(store: Any) -> None:
    decoder, kept = decoder_of(store, ARRAY), KeptElements()
    payload = bytearray(written(store, array_of(store, 3), ARRAY, "little"))
    decoder.decode(payload, kept)
    for count in (4, 1000, 2**31, 2**32 - 1):
        payload[4:8] = count.to_bytes(4, "little")
        with pytest.raises(DecodeError):
            decoder.decode(payload, kept)


def test_old_messages_are_let_go(store: Any) -> None:
    decoder, kept = decoder_of(store, ARRAY), KeptElements()
    message = array_of(store, 50)
    message.markers[0].text = "x" * 1_000_000
    tracemalloc.start()
    try:
        for number in range(60):
            # Each message has one element that is only in it.
            message.markers[1 + number % 49].color.r = number / 60
            payload = written(store, message, ARRAY, "little")
            found = decoder.decode(payload, kept)
        assert tracemalloc.get_traced_memory()[0] < 30_000_000
    finally:
        tracemalloc.stop()
    assert len(found.markers) == 50
