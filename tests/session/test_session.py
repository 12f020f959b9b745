"""A session under many hands: threads of the program, browsers, saves, failures."""

from __future__ import annotations

import logging
import math
import threading
from collections.abc import Callable
from pathlib import Path

import pytest
from inside import session_of
from patience import patience
from protocol_client import ProtocolClient

from sambot_viz import FrameError, JointError, Visualizer, load_robot
from sambot_viz.frames import Transform
from sambot_viz.session import Session
from sambot_viz.session.signals import connect

LEFT, RIGHT = "drivewhl_l_joint", "drivewhl_r_joint"
ARM = """<robot name="arm">
  <link name="base"/><link name="upper"/><link name="hand"/>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="wrist" type="revolute">
    <parent link="upper"/><child link="hand"/><origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>"""


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    model = tmp_path / "arm.urdf"
    model.write_text(ARM, "utf-8")
    return model


def in_threads(*actions: Callable[[], object]) -> list[BaseException]:
    """Run actions at the same time; returns what they raised."""
    raised: list[BaseException] = []

    def run(action: Callable[[], object]) -> None:
        try:
            action()
        except BaseException as error:
            raised.append(error)

    threads = [threading.Thread(target=run, args=(action,)) for action in actions]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(30)
        assert not thread.is_alive(), "a thread hangs"
    return raised


def test_threads_a_browser_and_reloads_together_end_in_one_state(
    viz: Visualizer, session: Session, protocol: Callable[..., ProtocolClient]
) -> None:
    client = protocol(viz.viser.get_port())
    client.settle(viz.viser)
    right = client.id_of("joints", RIGHT)
    robot = session.robot.model
    assert robot is not None

    def move() -> None:
        for step in range(100):
            viz.set_joint_positions({LEFT: 0.01 * step})

    def drag() -> None:
        for step in range(1, 101):
            client.edit(right, round(0.01 * step, 6), gesture=1)

    def reload() -> None:
        for _ in range(5):
            session.show_robot(robot)

    def look() -> None:
        for _ in range(200):
            T = viz.frames.lookup("base_link", "drivewhl_l_link")
            assert math.isfinite(T.matrix.sum())

    assert in_threads(move, drag, reload, look) == []
    client.settle(viz.viser)
    assert viz.joint_positions[LEFT] == pytest.approx(0.99)
    assert viz.joint_positions[RIGHT] == pytest.approx(1.0)
    # The last of many positions is held back for a moment.
    client.wait_until(lambda: client.shown("joints", RIGHT) == pytest.approx(1.0))
    assert session.problems.of_saves == {}


def test_a_listener_that_fails_is_shown_and_the_others_are_called(
    viz: Visualizer, session: Session, caplog: pytest.LogCaptureFixture
) -> None:
    heard: list[int] = []

    def fail() -> None:
        raise RuntimeError("the panel is broken")

    session.robot.positions.listeners.insert(0, fail)
    connect([session.robot.positions], lambda: heard.append(1))
    with caplog.at_level(logging.ERROR):
        viz.set_joint_positions({LEFT: 0.5})
        viz.set_joint_positions({LEFT: 0.6})
    assert heard
    (problem,) = session.problems.of_saves["fault"]
    assert (problem.severity, problem.code) == ("error", "internal-error")
    assert problem.message == "internal error: RuntimeError: the panel is broken"
    assert len(caplog.records) == 1, "the same error is logged once"


def test_a_refused_call_changes_nothing(viz: Visualizer, session: Session) -> None:
    with pytest.raises(JointError, match="no joint 'x'"):
        viz.set_joint_positions({LEFT: 1.0, "x": 1.0})
    with pytest.raises(FrameError):
        viz.set_static_transform("drivewhl_l_link", "base_link")
    assert viz.joint_positions[LEFT] == 0.0
    viz.set_joint_positions({LEFT: 1.0})
    assert viz.joint_positions[LEFT] == 1.0
    assert session.problems.of_saves == {}


def test_stopping_ends_motion_and_waits_for_no_lock(
    viz: Visualizer, session: Session
) -> None:
    session.motion.turn(LEFT, 1.0)
    with session.lock:
        viz.stop()
    assert not session.worker.is_alive()
    viz.stop()


def test_what_waits_for_its_turn_is_not_drawn_after_the_end(
    viz: Visualizer, session: Session
) -> None:
    drawn: list[str] = []
    apply, began = session.scene.context.apply, threading.Event()

    def bring() -> None:
        began.set()
        apply(lambda: drawn.append("late"))

    with session.lock:
        thread = threading.Thread(target=bring)
        thread.start()
        assert began.wait(patience(10.0))
        session.scene.close()
    thread.join(patience(10.0))
    assert not thread.is_alive() and drawn == []


def test_a_listener_may_stop_the_viewer(viz: Visualizer, session: Session) -> None:
    stopped = threading.Event()

    def stop() -> None:
        if not stopped.is_set():
            stopped.set()
            viz.stop()

    connect([session.robot.positions], stop)
    session.worker.post(lambda: session.robot.set_positions({LEFT: 1.0}))
    assert stopped.wait(patience(10.0))
    session.worker.join(10)
    assert not session.worker.is_alive()


def test_a_step_of_motion_that_fails_stops_the_motion_and_is_shown(
    viz: Visualizer, session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown = threading.Event()

    def broken(dt: float) -> None:
        raise ZeroDivisionError("no time at all")

    connect([session.problems.shown], shown.set)
    with monkeypatch.context() as patch:
        patch.setattr(session.motion, "advance", broken)
        session.motion.turn(LEFT, 1.0)
        assert shown.wait(patience(10.0))
    assert not session.motion.moving
    moved = threading.Event()
    connect([session.robot.positions], moved.set)
    session.motion.turn(LEFT, 1.0)
    assert moved.wait(patience(10.0)), "what is started later moves again"


def test_private_sessions_are_independent(
    protocol: Callable[..., ProtocolClient],
) -> None:
    with Visualizer(port=0, session="private") as viz:
        first, second = (protocol(viz.viser.get_port()) for _ in range(2))
        for client in (first, second):
            client.settle(viz.viser)
        sessions = viz._server.sessions.all()  # pyright: ignore[reportPrivateUsage]
        first.edit(first.id_of("joints", LEFT), 0.5)
        first.settle(viz.viser)
        second.settle(viz.viser)
        positions = [s.robot.joints.positions[LEFT] for s in sessions if s.robot.joints]
        assert sorted(positions) == [0.0, 0.5]
        assert second.shown("joints", LEFT) == 0.0
        first.close()
        second.settle(viz.viser)
        second.edit(second.id_of("joints", LEFT), -0.5)
        second.settle(viz.viser)
        (left,) = viz._server.sessions.all()  # pyright: ignore[reportPrivateUsage]
        assert left.robot.joints is not None
        assert left.robot.joints.positions[LEFT] == -0.5


def test_a_private_page_that_opens_during_a_save_shows_the_new_robot(
    arm: Path, protocol: Callable[..., ProtocolClient]
) -> None:
    edited = arm.with_name("edited.urdf")
    edited.write_text(ARM.replace("hand", "claw"), "utf-8")
    old, new = load_robot(arm), load_robot(edited)
    with Visualizer(old, port=0, session="private") as viz:
        server = viz._server  # pyright: ignore[reportPrivateUsage]
        for robot in (new, old, new):
            browser = protocol(viz.viser.get_port())
            server.sessions.show_robot(robot)
            browser.settle(viz.viser)
            shown = {
                s.robot.model.links.keys() >= {"claw"}
                for s in server.sessions.all()
                if s.robot.model
            }
            assert shown == {robot is new}


def test_a_reload_keeps_joints_added_frames_and_the_place_in_odom(
    arm: Path,
) -> None:
    with Visualizer(arm, port=0) as viz:
        session = session_of(viz)
        viz.set_joint_positions({"shoulder": 0.5})
        viz.set_static_transform("hand", "camera", xyz=(0.1, 0, 0))
        session.frames.add(
            "odom", "base", Transform.from_xyz_rpy((2, 0, 0)), static=False
        )
        arm.write_text(ARM.replace('xyz="1 0 0"', 'xyz="3 0 0"'), "utf-8")
        session.show_robot(load_robot(arm))
        assert viz.joint_positions["shoulder"] == 0.5
        assert viz.frames.lookup("upper", "camera").translation[0] == pytest.approx(3.1)
        assert viz.frames.lookup("odom", "base").translation[0] == 2.0


def test_an_added_frame_that_an_edit_makes_impossible_is_a_warning(arm: Path) -> None:
    with Visualizer(arm, port=0) as viz:
        session = session_of(viz)
        viz.set_static_transform("hand", "tool")
        arm.write_text(
            ARM.replace(
                '<link name="base"/>', '<link name="tool"/><link name="base"/>'
            ).replace(
                "</robot>",
                '<joint name="m" type="fixed"><parent link="tool"/>'
                '<child link="base"/></joint></robot>',
            ),
            "utf-8",
        )
        session.show_robot(load_robot(arm))
        assert "static-transform" in [p.code for p in session.problems.of_model]
        assert "tool" in viz.frames


def test_a_small_step_reaches_the_browser(
    viz: Visualizer, protocol: Callable[..., ProtocolClient]
) -> None:
    client = protocol(viz.viser.get_port())
    viz.set_joint_positions({LEFT: 1.0})
    client.settle(viz.viser)
    mark = client.mark()
    viz.set_joint_positions({LEFT: 1.0 + 1e-6})
    client.wait_until(lambda: client.types(mark)["SetOrientationMessage"] == 1)


def test_the_frames_of_a_viewer_can_be_asked(viz: Visualizer) -> None:
    assert "base_link" in viz.frames
    assert "nowhere" not in viz.frames
    assert viz.frames.parent("drivewhl_l_link") == "base_link"
    assert viz.frames.can_lookup("base_link", "drivewhl_l_link")
    assert not viz.frames.can_lookup("base_link", "nowhere")
    assert "drivewhl_l_link" in viz.frames.frames
