"""Wheels that keep turning, and the robot that drives in odom."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from urllib.parse import urlsplit

import pytest
from hand_clock import HandClock
from inside import node_of, session_of, viser_server
from protocol_client import ProtocolClient

from sambot_viz import JointError, Visualizer
from sambot_viz.session import Session
from sambot_viz.session.robot.motion import Motion

LEFT, RIGHT = "drivewhl_l_joint", "drivewhl_r_joint"
TRANSFORMS = ("SetOrientationMessage", "SetPositionMessage")


@pytest.fixture
def motion(session: Session) -> Iterator[Motion]:
    """The motion, with steps that only the test takes."""
    session.motion._ticking = True  # pyright: ignore[reportPrivateUsage]
    yield session.motion


def pose_in_odom(viz: Visualizer, session: Session) -> tuple[float, float, float]:
    """x, y [m] and yaw [rad] of base_footprint in odom."""
    session.robot.draw_moved()
    T = viz.frames.lookup("odom", "base_footprint")
    assert T.translation[2] == pytest.approx(0.0)
    return (float(T.translation[0]), float(T.translation[1]), T.rpy[2])


def test_a_wheel_turns_at_its_rate_until_the_time_is_up(
    viz: Visualizer, motion: Motion
) -> None:
    motion.turn(LEFT, 2.0, seconds=0.5)
    motion.advance(0.25)
    assert viz.joint_positions[LEFT] == pytest.approx(0.5)
    assert motion.turns(LEFT)
    motion.advance(0.5)
    assert viz.joint_positions[LEFT] == pytest.approx(1.0)
    assert not motion.moving
    assert viz.joint_positions[RIGHT] == 0


def test_a_wheel_goes_on_past_half_a_turn(viz: Visualizer, motion: Motion) -> None:
    motion.turn(LEFT, 3.0)
    for _ in range(10):
        motion.advance(0.2)
    assert viz.joint_positions[LEFT] == pytest.approx(6.0 - 2 * math.pi)
    motion.turn(LEFT, 0.0)
    assert not motion.moving


def test_the_robot_drives_a_square_and_is_back_at_the_start(
    viz: Visualizer, session: Session, motion: Motion
) -> None:
    for _ in range(4):
        session.drive.set_velocity(0.5, 0.0)
        motion.advance(2.0)
        session.drive.set_velocity(0.0, math.pi / 2)
        motion.advance(1.0)
    # It turns about the point between its wheels, and so comes back to the start.
    x, y, yaw = pose_in_odom(viz, session)
    assert (x, y) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert math.remainder(yaw, 2 * math.pi) == pytest.approx(0.0, abs=1e-9)
    corners = [(round(px, 3), round(py, 3)) for px, py in session.drive.trail]
    assert (1.0 - 0.12, 1.0) in corners


def test_an_arc_is_exact_whatever_the_step(
    viz: Visualizer, session: Session, motion: Motion
) -> None:
    session.drive.set_velocity(0.3, 0.7)
    for dt in (0.1, 0.45, 0.7, 0.75):
        motion.advance(dt)
    x, y, yaw = pose_in_odom(viz, session)
    # The wheels of sam_bot are 0.12 m behind base_link.
    radius = 0.3 / 0.7
    middle_x, middle_y = radius * math.sin(1.4), radius * (1 - math.cos(1.4))
    assert yaw == pytest.approx(1.4)
    assert x == pytest.approx(middle_x + 0.12 * math.cos(1.4) - 0.12)
    assert y == pytest.approx(middle_y + 0.12 * math.sin(1.4))


def test_driving_turns_the_wheels_by_the_way_they_roll(
    viz: Visualizer, motion: Motion, session: Session
) -> None:
    session.drive.set_velocity(0.1, 0.0)
    motion.advance(1.0)
    wheels = session.drive.wheels
    assert wheels is not None
    for joint in (LEFT, RIGHT):
        assert viz.joint_positions[joint] == pytest.approx(0.1 / wheels.radius)


def test_reset_goes_back_and_odom_stays(
    viz: Visualizer, session: Session, motion: Motion
) -> None:
    session.drive.set_velocity(1.0, 0.5)
    motion.advance(1.0)
    session.drive.reset()
    assert pose_in_odom(viz, session) == pytest.approx((0.0, 0.0, 0.0))
    assert len(session.drive.trail) == 1
    assert viz.joint_positions[LEFT] == viz.joint_positions[RIGHT] == 0
    assert not motion.moving


def test_a_reload_of_the_robot_keeps_it_where_it_drove(
    viz: Visualizer, session: Session, motion: Motion
) -> None:
    session.drive.set_velocity(1.0, 0.0)
    motion.advance(1.5)
    before = pose_in_odom(viz, session)
    assert session.robot.model is not None
    session.show_robot(session.robot.model)
    assert pose_in_odom(viz, session) == before == pytest.approx((1.5, 0.0, 0.0))


def test_a_velocity_that_is_no_number_is_refused(
    motion: Motion, session: Session
) -> None:
    with pytest.raises(JointError, match="cannot drive with v=nan"):
        session.drive.set_velocity(math.nan, 0.0)


def test_a_turning_wheel_sends_its_pose_alone_and_nothing_when_it_stands(
    hand_clock: HandClock,
    viz: Visualizer,
    session: Session,
    protocol: Callable[[int], ProtocolClient],
) -> None:
    client = protocol(urlsplit(viz.url).port or 0)
    client.settle(viser_server(viz))
    mark = client.mark()
    session.motion.turn(LEFT, 1.0, seconds=0.2)
    for _ in range(30):
        hand_clock.advance(0.01)
        client.settle(viser_server(viz))
    assert not session.motion.moving
    moved = [m for m in client.since(mark) if m.type in TRANSFORMS]
    assert moved
    wheel = node_of(viz, "drivewhl_l_link")
    assert {m.fields["name"] for m in moved} == {wheel}
    assert client.shown("joints", LEFT) == pytest.approx(viz.joint_positions[LEFT])
    mark = client.mark()
    for _ in range(20):
        hand_clock.advance(60.0)
        client.settle(viser_server(viz))
    assert client.since(mark) == []


def test_the_trail_is_drawn_without_panels(
    protocol: Callable[..., ProtocolClient],
) -> None:
    def trails(client: ProtocolClient) -> list[str]:
        names = (str(message.fields.get("name")) for message in client.messages)
        return [name for name in names if name.endswith("/~drive0")]

    with Visualizer(port=0, panels=False) as viz:
        client = protocol(viz.viser.get_port())
        session_of(viz).drive.set_velocity(0.5, 0.0)
        client.wait_until(lambda: bool(trails(client)))
