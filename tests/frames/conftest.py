"""A robot for the tests that draw and explain."""

from __future__ import annotations

import pytest

from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint, Link, Origin


@pytest.fixture
def robot() -> Robot:
    """base_link with a wheel, a mast with a lamp, and a floating buoy with a flag."""
    joints = (
        Joint(
            "wheel_joint",
            "continuous",
            "base_link",
            "wheel",
            Origin((-0.12, 0.18, -0.05), (0, 0, 1.5)),
            (0.0, 1.0, 0.0),
        ),
        Joint("mast_joint", "fixed", "base_link", "mast", Origin((0, 0, 0.5))),
        Joint("lamp_joint", "fixed", "mast", "lamp", Origin((0, 0, 1.0))),
        Joint("buoy_joint", "floating", "base_link", "buoy"),
        Joint("flag_joint", "fixed", "buoy", "flag"),
    )
    names = ("base_link", "wheel", "mast", "lamp", "buoy", "flag")
    return Robot(
        name="robot",
        root="base_link",
        links={name: Link(name) for name in names},
        joints={joint.name: joint for joint in joints},
    )
