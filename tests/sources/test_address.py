"""Addresses of live sources, as users write them."""

from __future__ import annotations

import pytest

from sambot_viz.errors import UsageError
from sambot_viz.sources.live.address import parse_address, without_secrets
from sambot_viz.sources.registry import is_live, open_source


@pytest.mark.parametrize(
    ("uri", "websocket", "label"),
    [
        ("foxglove://robot", "ws://robot:8765/", "robot:8765"),
        ("foxglove://robot:9000/a/b", "ws://robot:9000/a/b", "robot:9000"),
        ("FOXGLOVE+WS://Robot", "ws://robot:8765/", "robot:8765"),
        ("foxglove+wss://lab.org/r", "wss://lab.org:443/r", "lab.org:443"),
        ("ws://robot:1", "ws://robot:1/", "robot:1"),
        ("wss://robot", "wss://robot:443/", "robot:443"),
        ("rosbridge://10.0.0.7", "ws://10.0.0.7:9090/", "10.0.0.7:9090"),
        ("rosbridge+wss://lab", "wss://lab:443/", "lab:443"),
        ("foxglove://[::1]:5", "ws://[::1]:5/", "[::1]:5"),
        (
            "foxglove+wss://user:secret@lab/?token=abc",
            "wss://user:secret@lab:443/?token=abc",
            "lab:443",
        ),
    ],
)
def test_an_address_names_a_websocket(uri: str, websocket: str, label: str) -> None:
    address = parse_address(uri)
    assert address.websocket == websocket
    assert address.label == label
    assert is_live(uri)


@pytest.mark.parametrize(
    ("uri", "shown"),
    [
        ("foxglove+wss://user:secret@lab/a?token=abc", "foxglove+wss://lab/a"),
        ("rosbridge://secret@robot:1", "rosbridge://robot:1"),
        ("ws://[::1]:5/?secret", "ws://[::1]:5/"),
        ("zenoh://lab:1?domain=7", "zenoh://lab:1?domain=7"),
        ("dds:?domain=0&peer=a,b", "dds:?domain=0&peer=a,b"),
        ("my robot", "my robot"),
    ],
)
def test_the_name_of_a_source_has_no_secret(uri: str, shown: str) -> None:
    assert without_secrets(uri) == shown


def test_what_is_shown_has_no_secret() -> None:
    address = parse_address("foxglove+wss://user:secret@lab/?token=abc")
    shown = (
        address.label,
        address.with_protocol("rosbridge"),
        address.with_tls(False),
    )
    assert not any("secret" in words or "abc" in words for words in shown)
    assert address.with_protocol("rosbridge") == "rosbridge+wss://lab:443"


@pytest.mark.parametrize(
    ("uri", "words"),
    [
        ("foxglove:robot", "no host is named; write foxglove://HOST:8765"),
        ("foxglove://", "no host is named"),
        ("rosbridge://:9090", "no host is named; write rosbridge://HOST:9090"),
        ("foxglove://robot:99999", "from 1 to 65535; write foxglove://HOST:8765"),
        ("foxglove://robot:port", "from 1 to 65535; write foxglove://HOST:8765"),
        ("foxglove+tcp://robot", "unknown kind of source 'foxglove\\+tcp'"),
        ("foxglove://[::1", "write foxglove://HOST:8765"),
        (
            "rclpy:",
            "rclpy comes later; known: FILE or folder of a recording, foxglove://HOST",
        ),
        ("http://robot", "unknown kind of source; known: FILE"),
        ("robot", "unknown kind of source"),
        ("", "unknown kind of source"),
    ],
)
def test_an_address_that_makes_no_sense_is_refused(uri: str, words: str) -> None:
    with pytest.raises(UsageError, match=words):
        open_source(uri)


def test_a_name_that_nobody_knows_costs_one_sentence() -> None:
    import socket

    from sambot_viz.sources.websocket.trouble import explain

    address = parse_address("foxglove://robto:8765")
    sentence = explain(socket.gaierror(-2, "Name or service not known"), address)
    assert sentence.startswith("The name robto is not known here: write the robot's")
