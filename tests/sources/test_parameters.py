"""Parameters of nodes, over every transport: read, set, or it is said why not."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import pytest
from live_peers import LivePeer, eventually
from parameter_messages import message, read, reply, value
from rosbridge_peer import RosbridgePeer

from sambot_viz.messages import MessageTypes
from sambot_viz.publishing.parameters import Value, get_parameters, set_parameter
from sambot_viz.sources.source import Source

NODE = "/robot_state_publisher"


@pytest.fixture
def source(peer: LivePeer, opened: Callable[[str], Source]) -> Source:
    peer.serve(f"{NODE}/set_parameters")
    peer.serve(f"{NODE}/get_parameters")
    made = opened(peer.uri)
    eventually(lambda: made.status.is_connected)
    return made


def put(source: Source, given: Value) -> str:
    """Set a parameter; return why it was not set."""
    told: list[str] = []
    types = MessageTypes()
    set_parameter(source, NODE, "robot_description", given, types, told.append)
    eventually(lambda: len(told) == 1)
    return told[0]


@pytest.mark.parametrize(
    ("given", "kind", "field"),
    [
        (True, 1, "bool_value"),
        (7, 2, "integer_value"),
        (1.5, 3, "double_value"),
        ("<robot/>", 4, "string_value"),
    ],
)
@pytest.mark.parametrize("why", ["", "it does not parse"])
def test_a_parameter_is_set_or_refused_in_the_words_of_the_node(
    peer: LivePeer, source: Source, given: Value, kind: int, field: str, why: str
) -> None:
    result: Mapping[str, Any] = {"successful": not why, "reason": why}
    made = [message("SetParametersResult", **result)]
    answer = reply(peer, "was_set", "results", made, [result])
    peer.serve(f"{NODE}/set_parameters", reply=answer)
    # The services may be told of a moment after the connection is there.
    eventually(lambda: put(source, given) == why)
    asked = peer.requests[-1]
    if isinstance(asked, bytes):
        (found,) = read(asked, "set").parameters
        told = found.name, int(found.value.type), getattr(found.value, field)
    else:
        (found,) = asked["parameters"]
        told = found["name"], found["value"]["type"], found["value"][field]
    assert told == ("robot_description", kind, given)


def test_parameters_are_read(peer: LivePeer, source: Source) -> None:
    made = [value(3, double_value=1.5), value(0)]
    plain = [{"type": 3, "double_value": 1.5}, {"type": 0}]
    answer = reply(peer, "values", "values", made, plain)
    peer.serve(f"{NODE}/get_parameters", reply=answer)
    told: list[tuple[list[Any], str]] = []

    def ask() -> bool:
        get_parameters(
            source,
            NODE,
            ["rate", "none", "missing"],
            MessageTypes(),
            lambda values, why: told.append(([*values], why)),
        )
        return told[-1] == ([1.5, None, None], "")

    eventually(ask)


def test_a_node_that_is_not_there_says_so(source: Source) -> None:
    told: list[str] = []
    set_parameter(source, "/nobody", "a", 1, MessageTypes(), told.append)
    eventually(lambda: len(told) == 1)
    assert "/nobody/set_parameters" in told[0]


def test_an_answer_without_sense_is_said(peer: LivePeer, source: Source) -> None:
    nothing = 7 if isinstance(peer, RosbridgePeer) else b"\0\1\0\0\xff\xff\xff\xff"
    peer.serve(f"{NODE}/set_parameters", reply=nothing)
    eventually(lambda: "makes no sense" in put(source, 1))
