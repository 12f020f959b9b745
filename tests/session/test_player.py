"""A recording is played in a session: it moves the robot, and jumps."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from inside import session_of
from made_recording import described, write_recording
from patience import until
from protocol_client import ProtocolClient

from sambot_viz import JointError, UsageError, Visualizer
from sambot_viz.displays.display import AHEAD
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.frames.robot_frames import explain
from sambot_viz.session.data.player import Player

LEFT, WHEEL = "drivewhl_l_joint", "drivewhl_l_link"


@pytest.fixture
def viz(repository: Path) -> Iterator[Visualizer]:
    path = repository / "assets" / "square.mcap"
    with Visualizer(path, port=0) as viz:
        yield viz


@pytest.fixture
def player(viz: Visualizer) -> Player:
    """The player, with steps that only the test takes."""
    data = session_of(viz).data
    assert data is not None
    data.player._ticking = True  # pyright: ignore[reportPrivateUsage]
    return data.player


def place(viz: Visualizer) -> tuple[float, float]:
    x, y, _ = viz.frames.lookup("odom", "base_link").translation
    return round(float(x), 3), round(float(y), 3)


def test_the_robot_is_where_it_was_at_each_time(
    viz: Visualizer, player: Player
) -> None:
    viz.player.jump(4.0)
    assert place(viz) == (1.0, 0.0)
    viz.player.jump(14.0)
    assert place(viz) == (0.0, 1.0)
    viz.player.jump(9.0)
    assert place(viz) == (1.0, 1.0)
    assert viz.player.time == pytest.approx(9.0)
    assert not viz.player.playing


def test_playing_gives_what_a_jump_gives(viz: Visualizer, player: Player) -> None:
    player.play()
    for _ in range(70):
        player.advance(0.1)
    there = viz.frames.lookup("odom", WHEEL).matrix
    positions = dict(viz.joint_positions)
    viz.player.jump(0.5)
    assert not np.allclose(viz.frames.lookup("odom", WHEEL).matrix, there)
    viz.player.jump(7.0)
    assert viz.frames.lookup("odom", WHEEL).matrix == pytest.approx(there)
    assert dict(viz.joint_positions) == pytest.approx(positions)


def test_it_stops_at_the_end_or_begins_again(viz: Visualizer, player: Player) -> None:
    player.play()
    player.advance(100.0)
    assert not viz.player.playing
    assert viz.player.time == pytest.approx(viz.player.duration)
    player.play()
    assert viz.player.time == 0.0
    player.set_loop(True)
    player.advance(100.0)
    assert viz.player.playing
    assert viz.player.time == 0.0


def test_frames_without_a_place_at_a_time_are_known_and_nothing_fails(
    viz: Visualizer, player: Player, protocol: Callable[..., ProtocolClient]
) -> None:
    """As in tf2; the Frames panel of a page explains why there is no answer."""
    protocol(viz.viser.get_port()).settle(viz.viser)
    player.pause()
    viz.player.jump(19.5)
    viz.player.jump(0.0)
    assert WHEEL in viz.frames
    assert not viz.frames.can_lookup("odom", WHEEL)
    session = session_of(viz)
    found = explain(session.frames.tree, "odom", WHEEL, session.robot.model)
    assert "no transform joins the two" in found.reason
    assert session.problems.shown.value.listed == ()
    viz.player.jump(4.0)
    assert viz.frames.can_lookup("odom", WHEEL)


def test_the_start_of_a_recording_is_drawn_with_what_comes_first(
    viz: Visualizer, player: Player
) -> None:
    """Look-ups are those of tf2; the picture is whole, and the statuses say why."""
    player.pause()
    viz.player.jump(4.0)
    viz.player.jump(0.0)
    scene, frames = session_of(viz).scene, session_of(viz).frames
    model = next(d for d in scene.displays if d.kind.endswith("RobotModel"))
    assert not viz.frames.can_lookup("odom", WHEEL)
    assert scene.context.nodes.connected(WHEEL)
    assert model.status.level == "Ok"
    assert model.status.rows[WHEEL].text == AHEAD
    first = frames.tree.drawn("base_link", WHEEL).matrix
    player.advance(0.3)
    now = viz.frames.lookup("base_link", WHEEL).matrix
    assert now[:3, 3] == pytest.approx(first[:3, 3])
    assert model.status.rows[WHEEL].text == "Transform OK"


def test_a_jump_to_before_the_first_transform_says_so(tmp_path: Path) -> None:
    path = write_recording(
        tmp_path / "late.mcap",
        {"/robot_description": described("base", "arm")},
        [("/tf", 3.0 + n / 10, {"base": "odom"}) for n in range(10)],
        scans=[(0.0, 0.0), (1.0, 1.0), (3.5, 3.5)],
    )
    with Visualizer(path, port=0, at=3.6) as viz:
        topics = session_of(viz).data.topics
        assert topics is not None
        session_of(viz).document.set_option("Fixed Frame", "odom")
        topics.follow(None, ["/scan"])
        until(lambda: topics.is_complete)
        codes = list[str]()
        for seconds in (3.6, 1.0, 3.6):
            viz.player.jump(seconds)
            reason = topics.account("/scan").reason
            codes.append("" if reason is None else reason.code)
        assert codes == ["", "no-transform", ""]


def test_steps_go_from_message_to_message_of_a_topic(
    viz: Visualizer, player: Player
) -> None:
    viz.player.jump(1.0)
    times: list[float] = []
    for back in (False, False, True):
        player.step("/scan", back=back)
        times.append(viz.player.time)
    assert times[1] - times[0] == pytest.approx(0.2, abs=1e-6)
    assert times[2] == pytest.approx(times[0])
    before = viz.player.time
    player.step(None)
    assert 0 < viz.player.time - before < 0.05


def test_a_paused_recording_reads_and_sends_nothing(
    viz: Visualizer, player: Player, monkeypatch: pytest.MonkeyPatch
) -> None:
    viz.player.jump(3.0)
    calls: list[float] = []
    monkeypatch.setattr(player, "advance", calls.append)
    player._step()  # pyright: ignore[reportPrivateUsage]
    assert calls == []


def test_the_joints_follow_until_a_user_takes_them(
    viz: Visualizer, player: Player
) -> None:
    viz.player.jump(2.0)
    followed = viz.joint_positions[LEFT]
    assert followed != 0
    with pytest.raises(JointError, match="Follow"):
        viz.set_joint_positions({LEFT: 0.0})
    assert viz.joint_positions[LEFT] == followed
    data = session_of(viz).data
    assert data is not None
    data.follow(False)
    viz.set_joint_positions({LEFT: 0.5})
    session_of(viz).robot.draw_moved()
    turned = viz.frames.lookup("base_link", WHEEL).matrix
    player.play()
    player.advance(1.0)
    # The wheel stays, the robot drives on.
    assert viz.frames.lookup("base_link", WHEEL).matrix == pytest.approx(turned)
    assert place(viz)[0] == pytest.approx(0.75, abs=0.02)
    assert viz.joint_positions[LEFT] == 0.5
    data.follow(True)
    assert viz.joint_positions[LEFT] != 0.5
    assert not np.allclose(viz.frames.lookup("base_link", WHEEL).matrix, turned)


def test_what_turns_or_drives_stops_when_the_joints_follow_again(
    viz: Visualizer, player: Player
) -> None:
    session = session_of(viz)
    viz.player.jump(2.0)
    followed, data = dict(viz.joint_positions), session.data
    assert data is not None
    data.follow(False)
    session.motion.turn(LEFT, 1.0)
    session.motion.advance(0.25)
    assert dict(viz.joint_positions) != followed
    data.follow(True)
    assert not session.motion.moving and session.motion.turning.value == ()
    session.motion.advance(0.25)
    assert dict(viz.joint_positions) == followed
    with pytest.raises(JointError, match="Follow"):
        session.motion.turn(LEFT, 1.0)
    session.drive.reset()
    assert dict(viz.joint_positions) == followed


def test_an_edit_of_joints_is_undone_when_they_do_not_follow(
    viz: Visualizer, player: Player
) -> None:
    session = session_of(viz)
    viz.player.jump(2.0)
    followed, data = dict(viz.joint_positions), session.data
    assert data is not None
    data.follow(False)
    with session.history.acting(0):
        session.robot.set_positions({LEFT: 0.5})
    data.follow(True)
    with pytest.raises(UsageError, match=r"cannot be undone: .* Follow off"):
        session.history.undo(0)
    assert dict(viz.joint_positions) == followed
    data.follow(False)
    assert session.history.undo(0) == f"Move {LEFT}"
    assert dict(viz.joint_positions) == followed
    data.follow(True)
    with pytest.raises(UsageError, match=r"cannot be done again: .* Follow off"):
        session.history.redo(0)
    data.follow(False)
    assert session.history.redo(0) == f"Move {LEFT}"
    assert viz.joint_positions[LEFT] == 0.5


def test_wheels_that_have_turned_often_stay_on_their_sliders(
    viz: Visualizer, player: Player
) -> None:
    viz.player.jump(19.0)
    assert all(abs(q) <= 3.1416 for q in viz.joint_positions.values())


def test_only_what_has_moved_is_sent(viz: Visualizer, player: Player) -> None:
    viz.player.jump(3.0)
    session = session_of(viz)
    placed: list[set[str]] = []
    session.scene.place = lambda frames: placed.append({*frames})  # type: ignore[method-assign]
    version = session.frames.tree.version
    player.play()
    player.advance(0.05)
    moved = set[str]().union(*placed)
    assert moved == {"base_link", "drivewhl_l_link", "drivewhl_r_link"}
    assert session.frames.tree.version == version


def test_a_robot_that_a_recording_moves_is_not_driven(viz: Visualizer) -> None:
    with pytest.raises(JointError, match="messages move it"):
        session_of(viz).drive.set_velocity(0.1, 0.0)


def test_without_a_config_the_view_follows_the_robot_in_odom(viz: Visualizer) -> None:
    session = session_of(viz)
    assert session.scene.context.fixed_frame == "odom"
    assert session.document.config.view.get("Target Frame") == "base_link"


def test_a_robot_without_a_recording_has_no_player(
    make_viz: Callable[..., Visualizer],
) -> None:
    viz = make_viz()
    with pytest.raises(UsageError, match="no recording"):
        viz.player.jump(1.0)


def test_distances_of_what_is_selected_follow_a_recording(
    viz: Visualizer, player: Player, protocol: Callable[..., ProtocolClient]
) -> None:
    client = protocol(viz.viser.get_port())
    client.settle(viz.viser)
    player.pause()
    viz.player.jump(4.0)
    (browser,) = session_of(viz).clients.all.values()
    chosen = {Selectable("frame", "odom"), Selectable("link", "base_link")}
    browser.tools.select(chosen, None)
    client.settle(viz.viser)
    assert str(client.shown("selection", "Distance")).startswith("1.0")
    player.advance(5.0)
    client.wait_until(
        lambda: str(client.shown("selection", "Distance")).startswith("1.4")
    )
