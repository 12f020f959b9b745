"""Frames that messages bring no more fade to grey, and vanish."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from inside import session_of
from protocol_client import ProtocolClient

from sambot_viz import Transform, Visualizer
from sambot_viz.displays.tf.ageing import FRESH, GONE, FrameAges, FrameLook, look_at_age
from sambot_viz.frames import FrameTree


@pytest.mark.parametrize(
    ("age", "look"),
    [
        (0.0, FRESH),
        (5.0, FRESH),
        (7.5, FrameLook(0.625)),
        (9.9, FrameLook(0.125)),
        (10.1, FrameLook(0.0, 1.0)),
        (12.5, FrameLook(0.0, 0.625)),
        (14.9, FrameLook(0.0, 0.125)),
        (15.1, GONE),
    ],
)
def test_a_frame_is_grey_after_two_thirds_and_gone_after_all(
    age: float, look: FrameLook
) -> None:
    assert look_at_age(age, 15.0) == look


def test_the_colours_are_within_a_step_of_those_of_rviz() -> None:
    for age in np.linspace(0.0, 15.0, 151):
        shown = look_at_age(float(age), 15.0)
        left = min(1.0, max(0.0, (10.0 - float(age)) / 5.0))
        assert left <= shown.color <= min(1.0, left + 1 / 8) or age == 15.0
        for channel, color in zip(
            shown.of((204, 204, 76)), (204, 204, 76), strict=True
        ):
            assert abs(channel - (left * color + (1 - left) * 178.5)) < 14


@dataclass
class Context:
    """What ages are made of."""

    tree: FrameTree = field(default_factory=FrameTree)
    fixed_frame: str = "odom"
    time: float = 1e6

    def is_paced(self, frame: str) -> bool:
        del frame
        return False

    def now(self) -> float:
        return self.time

    def move(self, child: str) -> None:
        self.tree.set("odom", child, Transform.identity(), self.time)


@pytest.fixture
def context() -> Context:
    return Context()


@pytest.fixture
def ages(context: Context) -> FrameAges:
    made: Any = context
    return FrameAges(made)


def pass_time(context: Context, ages: FrameAges, seconds: float) -> int:
    """Let time go on by half seconds; returns how often something looked otherwise."""
    changes = 0
    for _ in range(round(seconds / 0.5)):
        context.time += 0.5
        changes += ages.look(("a", "b", "c"), 15.0)
    return changes


def test_what_is_silent_vanishes_and_what_moves_and_what_is_static_stays(
    context: Context, ages: FrameAges
) -> None:
    context.tree.set_static("a", "c", Transform.identity())
    context.move("a")
    context.move("b")
    assert not ages.look(("a", "b", "c"), 15.0)
    for _ in range(40):
        context.move("a")
        pass_time(context, ages, 0.5)
    assert ages.looks == {"b": GONE}
    context.move("b")
    assert pass_time(context, ages, 0.5) == 1
    assert ages.looks == {}


def test_a_frame_changes_its_look_seventeen_times(
    context: Context, ages: FrameAges
) -> None:
    for child in "ab":
        context.move(child)
    context.tree.set_static("odom", "c", Transform.identity())
    ages.look(("a", "b", "c"), 15.0)
    assert pass_time(context, ages, 30.0) <= 17
    assert pass_time(context, ages, 10.0) == 0


def test_after_a_jump_the_stamps_say_how_old_a_frame_is(
    context: Context, ages: FrameAges
) -> None:
    context.move("a")
    context.tree.set("odom", "b", Transform.identity(), 5.0)  # of another clock
    context.tree.set_static("odom", "c", Transform.identity())
    ages.look(("a", "b", "c"), 15.0)
    context.time += 16.0
    ages.look(("a", "b", "c"), 15.0)
    assert ages.looks == {"a": GONE}
    context.time -= 16.0
    ages.look(("a", "b", "c"), 15.0)
    assert ages.looks == {}


def test_the_axes_of_a_silent_frame_go_and_come_back(
    repository: Path, protocol: Callable[..., ProtocolClient]
) -> None:
    with Visualizer(repository / "assets" / "square.mcap", port=0) as viz:
        client = protocol(viz.viser.get_port())
        client.settle(viz.viser)
        session = session_of(viz)
        assert session.data is not None and session.data.player is not None
        player, scene = session.data.player, session.scene
        player.pause()
        viz.displays["TF"].set("Show Names", True)
        client.settle(viz.viser)
        mark = client.mark()
        scene.time_passed()
        client.settle(viz.viser)
        assert "RemoveSceneNodeMessage" not in client.types(mark)

        now = player.time_ns * 1e-9
        scene.context.now = lambda: now + 30.0
        scene.time_passed()
        client.settle(viz.viser)
        gone = client.types(mark)["RemoveSceneNodeMessage"]
        assert gone > 0
        mark = client.mark()
        scene.time_passed()
        client.settle(viz.viser)
        assert not client.types(mark)["RemoveSceneNodeMessage"]
        scene.context.now = lambda: now
        scene.time_passed()
        client.settle(viz.viser)
        assert client.types(mark)["LabelMessage"] > 0
