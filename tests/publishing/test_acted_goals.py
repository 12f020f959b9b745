"""Goals of Nav2's own tool and of the command go to its action, where that is shown."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest
from action_peers import (
    ACTION,
    INNER,
    KIND,
    ActionPeer,
    FoxgloveAction,
    RosbridgeAction,
)
from inside import session_of
from live_peers import eventually
from navigator_peer import GOAL, NavigatorPeer

from sambot_viz import Visualizer
from sambot_viz.cli import main
from sambot_viz.publishing.goals import Goals
from sambot_viz.publishing.outbound import Goal, NavGoal
from sambot_viz.publishing.outcome import Outcome
from sambot_viz.publishing.publisher import Publisher
from sambot_viz.publishing.sent_message import SentMessage

ROBOTS = [FoxgloveAction, RosbridgeAction]
Capture = pytest.CaptureFixture[str]


@pytest.fixture(params=ROBOTS)
def robot(request: pytest.FixtureRequest) -> Iterator[ActionPeer]:
    made = request.param()
    yield made
    made.peer.stop()


@pytest.fixture
def publisher(robot: ActionPeer) -> Iterator[Publisher]:
    """That of a session to whose robot the action is known."""
    with Visualizer(source=robot.peer.uri, port=0, publish="") as viz:
        made = session_of(viz).publisher
        eventually(lambda: robot.peer.subscribed() or made.prepare(*PREPARED))
        source = made.robot.source if made.robot is not None else None
        assert source is not None
        eventually(lambda: source.action(ACTION, KIND))
        yield made


PREPARED: Any = ("goal", GOAL, Goal.type_name)


def goals_of(publisher: Publisher) -> Goals:
    assert publisher.goals is not None
    return publisher.goals


def words(publisher: Publisher) -> str:
    """What is said of the last goal."""
    last = goals_of(publisher).last
    return "" if last is None else last.words


def send(publisher: Publisher, told: list[Outcome], x: float = 1.0) -> str:
    """Send a goal as Nav2's tool does, when the last is some time ago."""
    sent: list[str] = []
    goal = NavGoal("map", x, 2.0, 0.0)
    eventually(lambda: sent.append(publisher.send(goal, GOAL, "me", told.append)) or 1)
    return sent[0]


def test_it_is_said_how_far_it_is_and_how_it_ends(
    robot: ActionPeer, publisher: Publisher
) -> None:
    told: list[Outcome] = []
    sent: list[SentMessage] = []
    publisher.listeners.append(sent.append)
    assert send(publisher, told) == ACTION
    eventually(lambda: robot.places() == [(1.0, 2.0)])
    assert [(one.topic, one.type_name) for one in sent] == [(ACTION, KIND)]
    robot.go(3.25)
    eventually(lambda: words(publisher) == "on the way: 3.2 m, about 12 s left")
    assert goals_of(publisher).is_on_the_way
    robot.end(4)
    eventually(lambda: told[-1] == Outcome("reached", True, True))
    assert words(publisher) == "reached"
    # Nothing went over the topic.
    assert robot.peer.came() == []


def test_another_goal_takes_its_place(robot: ActionPeer, publisher: Publisher) -> None:
    first: list[Outcome] = []
    second: list[Outcome] = []
    send(publisher, first)
    eventually(lambda: len(robot.places()) == 1)
    send(publisher, second, 5.0)
    eventually(lambda: len(robot.places()) == 2)
    count = len(first)
    robot.end(6, 206)
    why = "not reached: something is where the goal is (error 206)"
    eventually(lambda: second[-1].words == why)
    assert len(first) == count and words(publisher) == why


def test_stop_cancels_it(robot: ActionPeer, publisher: Publisher) -> None:
    send(publisher, [])
    eventually(lambda: robot.places())
    robot.go(1.0)
    eventually(lambda: words(publisher).startswith("on the way"))
    publisher.stop("me")
    eventually(lambda: robot.cancelled() >= 1)
    robot.end(5)
    eventually(lambda: words(publisher) == "cancelled")


def test_one_that_is_not_taken_says_so(robot: ActionPeer, publisher: Publisher) -> None:
    robot.reject()
    send(publisher, [])
    eventually(lambda: "reject" in words(publisher))
    assert not goals_of(publisher).is_on_the_way


@pytest.mark.parametrize(
    ("status", "code", "exit_status", "said"),
    [
        (4, 0, 0, "reached"),
        (5, 0, 1, "cancelled"),
        (6, 208, 1, "not reached: there is no way (error 208)"),
    ],
)
def test_the_command_sends_it_too(
    robot: ActionPeer,
    capsys: Capture,
    status: int,
    code: int,
    exit_status: int,
    said: str,
) -> None:
    def end() -> None:
        eventually(lambda: robot.places() == [(-1.5, 2.0)])
        robot.go(2.0)
        robot.end(status, code)

    with ThreadPoolExecutor(1) as pool:
        done = pool.submit(end)
        found = main(["goal", "-1.5", "2", "0", "--source", robot.peer.uri])
        done.result()
    out = capsys.readouterr().out.splitlines()
    assert found == exit_status
    assert out[1] == f"sent to the action {ACTION}"
    assert out[-1] == said
    assert "on the way" in out
    assert robot.peer.came() == []


@pytest.mark.parametrize("words", [["--topic", GOAL, "--for", "0.1"], ["--no-wait"]])
def test_what_nobody_follows_and_what_has_a_topic_is_a_message(
    capsys: Capture, words: list[str]
) -> None:
    robot = FoxgloveAction()
    main(["goal", "1", "2", "0", "--source", robot.peer.uri, *words])
    assert "sent to /goal_pose, which" in capsys.readouterr().out
    assert robot.places() == [] and len(robot.peer.came()) == 1
    robot.peer.stop()


def test_a_robot_that_hides_the_action_gets_the_topic() -> None:
    peer = NavigatorPeer(is_hidden=True)
    with Visualizer(source=peer.uri, port=0, publish="goal") as viz:
        publisher = session_of(viz).publisher
        eventually(lambda: "map" in session_of(viz).scene.context.tree.frames)
        eventually(lambda: peer.advertised() or publisher.prepare(*PREPARED))
        assert send(publisher, []).startswith(f"{GOAL}, which")
        eventually(lambda: [one.topic for one in peer.came()] == [GOAL])
        assert f"{INNER}/send_goal" not in peer.calls()
    peer.stop()
