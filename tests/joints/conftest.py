"""Robots built in Python, so that these tests need no reader."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint, Limit, Link, Mimic

MakeRobot = Callable[..., Robot]


@pytest.fixture
def make_robot() -> MakeRobot:
    """Joints → a robot whose links are a chain in the order of the joints."""

    def make(*joints: Joint) -> Robot:
        names = dict.fromkeys(name for j in joints for name in (j.parent, j.child))
        names = names or {"base_link": None}
        return Robot(
            name="robot",
            root=next(iter(names)),
            links={name: Link(name) for name in names},
            joints={j.name: j for j in joints},
        )

    return make


@pytest.fixture
def arm(make_robot: MakeRobot) -> Robot:
    """One joint of every kind; l mimics k mimics j."""
    return make_robot(
        Joint("mast", "fixed", "base_link", "mast"),
        Joint("l", "revolute", "base_link", "c", mimic=Mimic("k", -1.0)),
        Joint("wheel", "continuous", "base_link", "d", limit=Limit(-1, 1)),
        Joint("k", "revolute", "a", "b", mimic=Mimic("j", offset=0.1)),
        Joint("j", "revolute", "base_link", "a", limit=Limit(-2, 2)),
        Joint("lift", "prismatic", "base_link", "e", limit=Limit(1, 3)),
        Joint("stuck", "revolute", "base_link", "f", limit=Limit(0.5, 0.5)),
        Joint("free", "floating", "base_link", "g"),
        Joint("table", "planar", "base_link", "h"),
    )
