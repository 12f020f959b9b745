"""Decoders: which are made for a channel, and what they read."""

from __future__ import annotations

import numpy as np
import pytest

from sambot_viz.errors import DecodeError
from sambot_viz.messages import MessageTypes, Schema


@pytest.fixture(scope="module")
def types() -> MessageTypes:
    return MessageTypes()


def test_a_message_is_read_by_the_definition_of_its_file(types: MessageTypes) -> None:
    schema = Schema("my_lab/msg/Grip", "ros2msg", "string name\nfloat32[] force\n")
    decoder = types.decoder(schema, "cdr")
    assert (decoder.type_name, decoder.encoding) == ("my_lab/msg/Grip", "cdr")
    assert decoder.reason is None and decoder.note is None
    payload = b"\0\1\0\0\2\0\0\0a\0\0\0\2\0\0\0" + np.float32([1.5, 2]).tobytes()
    message = decoder.decode(payload)
    assert message.name == "a"
    assert message.force.tolist() == [1.5, 2.0]


def test_a_type_without_a_definition_is_one_of_the_standard(
    types: MessageTypes,
) -> None:
    decoder = types.decoder(Schema("std_msgs/String"), "cdr")
    assert decoder.type_name == "std_msgs/msg/String"
    assert decoder.decode(b"\0\1\0\0\3\0\0\0hi\0").data == "hi"


def test_a_type_that_nobody_knows_has_a_reason(types: MessageTypes) -> None:
    decoder = types.decoder(Schema("my_lab_msgs/msg/Gripper"), "cdr")
    assert decoder.reason is not None and decoder.reason.code == "type-unknown"
    assert "my_lab_msgs/msg/Gripper" in decoder.reason.text
    with pytest.raises(DecodeError):
        decoder.decode(b"\0\1\0\0")


def test_an_encoding_that_nobody_knows_has_a_reason(types: MessageTypes) -> None:
    decoder = types.decoder(Schema("lab.Blob"), "x-lab")
    assert decoder.reason is not None and decoder.reason.code == "encoding"
    assert "x-lab" in decoder.reason.text
