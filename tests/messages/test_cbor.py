"""CBOR as rosbridge sends it, and as a liar does."""

from __future__ import annotations

import math
import random

import pytest
from rosbridge_peer import cbor

from sambot_viz.messages.cbor import CborError, read_cbor


def plain(value: object) -> object:
    """The same with bytes in place of views."""
    if isinstance(value, memoryview):
        return bytes(value)
    if isinstance(value, list):
        return [plain(one) for one in value]
    if isinstance(value, dict):
        return {key: plain(one) for key, one in value.items()}
    return value


@pytest.mark.parametrize(
    ("words", "value"),
    [
        # From appendix A of RFC 8949.
        ("00", 0),
        ("17", 23),
        ("1818", 24),
        ("1903e8", 1000),
        ("1a000f4240", 1_000_000),
        ("1bffffffffffffffff", 2**64 - 1),
        ("20", -1),
        ("3903e7", -1000),
        ("f90000", 0.0),
        ("f93e00", 1.5),
        ("fa47c35000", 100_000.0),
        ("fb3ff199999999999a", 1.1),
        ("f97c00", math.inf),
        ("f4", False),
        ("f5", True),
        ("f6", None),
        ("f7", None),
        ("c11a514b67b0", 1_363_896_240),
        ("40", b""),
        ("4401020304", b"\1\2\3\4"),
        ("60", ""),
        ("62c3bc", "ü"),
        ("80", []),
        ("8301820203820405", [1, [2, 3], [4, 5]]),
        ("a0", {}),
        ("a26161016162820203", {"a": 1, "b": [2, 3]}),
        ("5f42010243030405ff", b"\1\2\3\4\5"),
        ("7f657374726561646d696e67ff", "streaming"),
        ("9f018202039f0405ffff", [1, [2, 3], [4, 5]]),
        ("bf61610161629f0203ffff", {"a": 1, "b": [2, 3]}),
    ],
)
def test_values_of_the_standard_are_read(words: str, value: object) -> None:
    assert plain(read_cbor(bytes.fromhex(words))) == value


def test_bytes_are_a_view_of_the_frame() -> None:
    frame = cbor({"op": "publish", "msg": {"bytes": bytes(100_000)}})
    value = read_cbor(frame)
    assert isinstance(value, dict)
    message = value["msg"]
    assert isinstance(message, dict)
    view = message["bytes"]
    assert isinstance(view, memoryview)
    assert view.obj is frame
    assert len(view) == 100_000


@pytest.mark.parametrize(
    "words",
    [
        "",
        "18",
        "5bffffffffffffffff00",
        "7b7fffffffffffffff61",
        "9bffffffffffffffff00",
        "9a0fffffff00",
        "bbffffffffffffffff00",
        "1c",
        "f8ff",
        "ff",
        "9f01",
        "5f01ff",
        "7f4101ff",
        "a1810101",
        "a1a00101",
        "61ff",
        "0000",
        "81" * 100_000,
        "c1" * 100_000,
    ],
)
def test_what_is_cut_or_lies_about_its_length_is_refused(words: str) -> None:
    with pytest.raises(CborError):
        read_cbor(bytes.fromhex(words))


def test_damaged_frames_raise_nothing_else() -> None:
    chance = random.Random(17)
    good = cbor({"op": "publish", "topic": "/a", "msg": {"secs": 1, "bytes": b"abc"}})
    for _ in range(3000):
        frame = bytearray(good)
        for _ in range(chance.randint(1, 4)):
            frame[chance.randrange(len(frame))] = chance.randrange(256)
        try:
            read_cbor(bytes(frame[: chance.randint(0, len(frame))]))
        except CborError:
            pass
