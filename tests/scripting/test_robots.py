"""`viz.add_robot`: another robot in the same view, with joints of its own."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest
from inside import session_of, viser_server
from protocol_client import ProtocolClient

from sambot_viz import JointError, Robot, RobotError, UsageError, Visualizer

Protocol = Callable[..., ProtocolClient]
ARM = """<robot name="arm"><link name="base"/><link name="hand"/>
<joint name="wrist" type="continuous"><parent link="base"/><child link="hand"/>
<axis xyz="0 0 1"/></joint></robot>"""
LEFT, RIGHT = "drivewhl_l_joint", "drivewhl_r_joint"


@pytest.fixture
def client(viz: Visualizer, protocol: Protocol) -> ProtocolClient:
    client = protocol(urlsplit(viz.url).port or 0)
    client.settle(viser_server(viz))
    return client


def test_another_robot_has_its_own_joints_in_a_group(
    viz: Visualizer, client: ProtocolClient, sam_bot: Robot
) -> None:
    other = viz.add_robot(sam_bot, "other", xyz=(0.0, 1.0, 0.0))
    other.set_joint_positions({LEFT: 0.5})
    other.set_joint_positions({RIGHT: np.float32(0.25)})
    client.settle(viz.viser)
    assert session_of(viz).problems.shown.value.listed == ()
    assert other.joint_names == sam_bot.joint_names
    assert dict(other.joint_positions) == {LEFT: 0.5, RIGHT: 0.25}
    assert viz.joint_positions[LEFT] == 0.0
    assert viz.joint_positions[f"other/{LEFT}"] == 0.5
    row = client.row_named("joints", "other (2)", f"other/{LEFT}")
    assert row["value"] == 0.5
    viz.set_joint_positions([0.1, 0.2])
    other.set_joint_positions([0.3, 0.4])
    assert list(viz.joint_positions.values()) == [0.1, 0.2, 0.3, 0.4]
    client.edit(row["id"], 0.75)
    client.settle(viz.viser)
    assert other.joint_positions[LEFT] == 0.75
    there = viz.frames.lookup("base_link", "other/base_link").matrix[:3, 3]
    assert there == pytest.approx((0.0, 1.0, 0.0))
    with pytest.raises(JointError, match="needs 2 numbers"):
        other.set_joint_positions([1.0])


def test_other_robots_stay_when_the_model_is_loaded_again(
    viz: Visualizer, sam_bot: Robot
) -> None:
    arm = viz.add_robot(ARM, "arm", parent="drivewhl_l_link", xyz=(0.0, 0.0, 0.5))
    arm.set_joint_positions([0.5])
    viz.server.sessions.show_robot(sam_bot)
    assert dict(arm.joint_positions) == {"wrist": 0.5}
    T = viz.frames.lookup("drivewhl_l_link", "arm/base").matrix
    assert T[:3, 3] == pytest.approx((0.0, 0.0, 0.5))
    viz.set_static_transform("base_link", "arm/base", (1.0, 0.0, 0.0))
    T = viz.frames.lookup("base_link", "arm/base").matrix
    assert T[:3, 3] == pytest.approx((1.0, 0.0, 0.0))


def test_a_robot_is_removed_with_those_that_hang_at_it(viz: Visualizer) -> None:
    arm = viz.add_robot(ARM, "arm")
    tool = viz.add_robot(ARM, "tool", parent="arm/hand")
    assert "tool/hand" in viz.frames.frames
    arm.remove()
    assert dict(viz.joint_positions) == {LEFT: 0.0, RIGHT: 0.0}
    assert "tool/hand" not in viz.frames.frames
    for gone in (arm, tool):
        with pytest.raises(UsageError, match="was removed"):
            gone.set_joint_positions([0.0])
    again = viz.add_robot(ARM, "arm")
    assert repr(again) == "<robot 'arm' as 'arm'>"


def test_a_robot_that_has_just_moved_is_removed(
    viz: Visualizer, client: ProtocolClient
) -> None:
    arm = viz.add_robot(ARM, "arm")
    for position in (0.1, 0.2, 0.3):
        arm.set_joint_positions([position])
    arm.remove()
    viz.set_joint_positions([0.5, 0.5])
    client.settle(viz.viser)
    client.wait_until(lambda: client.shown("joints", LEFT) == 0.5)
    assert session_of(viz).problems.shown.value.listed == ()


def test_what_is_wrong_is_said(viz: Visualizer) -> None:
    viz.add_robot(ARM, "arm")
    for name in ("", "arm", "/arm", "arm/"):
        with pytest.raises(UsageError, match="is not a name, or another robot has it"):
            viz.add_robot(ARM, name)
    with pytest.raises(UsageError, match="did you mean 'base_link'"):
        viz.add_robot(ARM, "b", parent="bse_link")
    with pytest.raises(RobotError):
        viz.add_robot("<robot name='x'/>", "b")
    assert not any(name.startswith("b/") for name in viz.frames.frames)


def test_a_page_and_a_copy_have_all_robots(viz: Visualizer) -> None:
    arm = viz.add_robot(ARM, "arm")
    arm.set_joint_positions([0.5])
    copy = session_of(viz).copy()
    assert copy.positions["arm/wrist"] == 0.5
    assert copy.robot is not None and "arm/hand" in copy.robot.links


def test_private_sessions_that_come_later_have_all_robots(
    make_viz: Callable[..., Visualizer], protocol: Protocol
) -> None:
    viz = make_viz(session="private")
    viz.add_robot(ARM, "arm")
    page = protocol(urlsplit(viz.url).port or 0)
    page.settle(viser_server(viz))
    wrist: Any = page.row_named("joints", "arm (1)", "arm/wrist")
    assert wrist["value"] == 0.0
