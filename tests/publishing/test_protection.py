"""What stops a robot without us is found, with after how long by its parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from base_peer import CMD_VEL, BasePeer
from live_peers import eventually
from parameter_messages import reply, value

from sambot_viz.messages import MessageTypes
from sambot_viz.publishing import protection
from sambot_viz.publishing.protection import Protection
from sambot_viz.sources.registry import open_source
from sambot_viz.sources.source import Receivers
from sambot_viz.topics.source_robot import SourceRobot


@pytest.fixture
def peer() -> Iterator[BasePeer]:
    made = BasePeer()
    yield made
    made.stop()


@pytest.fixture
def robot(peer: BasePeer) -> Iterator[SourceRobot]:
    source = open_source(peer.uri)
    source.open()
    eventually(lambda: CMD_VEL in source.topics())
    yield SourceRobot(source, MessageTypes())
    source.close()


def found(robot: SourceRobot, *nodes: str) -> Callable[[], str]:
    """What is said when such nodes take the velocities."""
    made = Protection(robot, lambda: None)
    return lambda: made.words(Receivers(nodes))


def test_nothing_seen_is_said(robot: SourceRobot) -> None:
    assert "may keep its last speed" in found(robot, "/base")()


@pytest.mark.parametrize(
    ("seconds", "said"), [(1.5, " (after 1.5 s) of"), (0.0, " (off now) of")]
)
def test_a_node_says_after_how_long(
    peer: BasePeer,
    robot: SourceRobot,
    seconds: float,
    said: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made: list[Any] = [value(3, double_value=seconds)]
    service = "/velocity_smoother/get_parameters"
    peer.serve(service, reply=reply(peer, "values", "values", made, None))
    # It may be told of a moment after the connection is there: it is asked once.
    eventually(lambda: found(robot, "/velocity_smoother")() and service in peer.calls())
    words = found(robot, "/velocity_smoother")
    eventually(lambda: f"/velocity_smoother{said}" in words())
    # What was asked above may come to the peer only now.
    asked: list[Any] = []
    monkeypatch.setattr(protection, "get_parameters", lambda *one: asked.append(one))
    assert said in words() and asked == []


def test_a_node_that_says_nothing_is_named(robot: SourceRobot) -> None:
    words = found(robot, "/collision_monitor", "/base")
    assert words().startswith("/collision_monitor of the robot can stop it")
