"""The Python API: a robot in a server of one's own, and what reaches the browsers."""

from __future__ import annotations

import math
import socket
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import live_peers
import numpy as np
import pytest
from patience import patience
from protocol_client import ProtocolClient, Received

from sambot_viz import (
    JointError,
    Robot,
    RobotError,
    ServerError,
    Transform,
    UsageError,
    Visualizer,
    load_robot,
)
from sambot_viz.errors import FrameError

LEFT, RIGHT = "drivewhl_l_joint", "drivewhl_r_joint"
Connect = Callable[..., ProtocolClient]


def port_of(viz: Visualizer) -> int:
    return int(viz.url.rsplit(":", 1)[1])


@pytest.fixture
def client(viz: Visualizer, protocol: Connect) -> ProtocolClient:
    client = protocol(port_of(viz))
    client.settle(viz.viser)
    return client


def test_the_bundled_sam_bot_is_shown_without_a_model(protocol: Connect) -> None:
    with Visualizer(port=0) as viz:
        assert viz.url.startswith("http://127.0.0.1:")
        assert dict(viz.joint_positions) == {LEFT: 0.0, RIGHT: 0.0}
        client = protocol(port_of(viz))
        client.settle(viz.viser)
    assert {m.fields["props"]["text"] for m in labels(client)} == {
        "base_link",
        "base_footprint",
        "drivewhl_l_link",
        "drivewhl_r_link",
        "front_caster",
    }


def test_there_is_a_slider_for_each_wheel_with_its_range_and_start(
    client: ProtocolClient,
) -> None:
    for joint in (LEFT, RIGHT):
        row = client.row_named("joints", joint)
        assert row["kind"] == "slider"
        assert (row["min"], row["max"]) == (-math.pi, math.pi)
        assert row["value"] == 0.0


@pytest.mark.parametrize(
    "value", [99.0, -99.0, math.nan, math.inf, "fast", [1.0], {"a": 1}, None, True]
)
def test_a_bad_value_from_a_browser_moves_nothing_and_is_answered(
    viz: Visualizer, client: ProtocolClient, value: object
) -> None:
    viz.set_joint_positions({LEFT: 0.5})
    row = client.id_of("joints", LEFT)
    client.edit(row, value)
    client.settle(viz.viser)
    assert viz.joint_positions[LEFT] == 0.5
    notice = client.row("notice")["value"]
    assert (notice["row"], notice["level"]) == (row, "error")
    assert LEFT in notice["text"]


def test_center_and_randomize_move_all_joints(
    viz: Visualizer, client: ProtocolClient
) -> None:
    client.act("joints/randomize")
    client.settle(viz.viser)
    assert 0.0 not in viz.joint_positions.values()
    client.act("joints/center")
    client.settle(viz.viser)
    assert set(viz.joint_positions.values()) == {0.0}


def test_browsers_cannot_write_the_inner_state_of_a_widget(
    viz: Visualizer, client: ProtocolClient
) -> None:
    number = viz.viser.gui.add_number("of a script", 1.0)
    client.settle(viz.viser)
    uuid = client.uuid_of("of a script")
    client.send("GuiUpdateMessage", uuid=uuid, updates={"update_cb": []})
    client.send("GuiUpdateMessage", uuid=uuid, updates={"removed": True})
    client.settle(viz.viser)
    client.set_value(uuid, 0.7)
    client.settle(viz.viser)
    assert number.value == 0.7


def test_no_gui_leaves_the_joints_panel_out(protocol: Connect) -> None:
    with Visualizer(port=0, gui=False) as viz:
        client = protocol(port_of(viz))
        client.settle(viz.viser)
        assert "joints" not in {row["panel"] for row in client.rows.values()}
        assert client.row_named("displays", "Global Options", "Fixed Frame")


def test_the_fixed_frame_changes_live(viz: Visualizer, client: ProtocolClient) -> None:
    mark = client.mark()
    client.edit(
        client.id_of("displays", "Global Options", "Fixed Frame"), "base_footprint"
    )
    client.settle(viz.viser)
    moved = [m for m in client.since(mark) if m.type == "SetPositionMessage"]
    assert [m.fields["position"] for m in moved] == [pytest.approx((0, 0, 0.15))]


def test_a_display_is_switched_off_and_on(
    viz: Visualizer, client: ProtocolClient
) -> None:
    box = client.id_of("displays", "TF")
    mark = client.mark()
    client.edit(box, False)
    client.settle(viz.viser)
    gone = {m.fields["name"] for m in client.since(mark) if "Remove" in m.type}
    assert {m.fields["name"] for m in labels(client)} <= gone
    mark = client.mark()
    client.edit(box, True)
    client.settle(viz.viser)
    assert client.types(since=mark)["LabelMessage"] == 5


def labels(client: ProtocolClient) -> list[Received]:
    return [m for m in client.messages if m.type == "LabelMessage"]


def test_a_static_transform_is_found_and_can_be_looked_up(viz: Visualizer) -> None:
    viz.set_static_transform("base_link", "base_laser", xyz=(0.1, 0.0, 0.2))
    T = viz.frames.lookup("base_link", "base_laser").matrix
    assert T[:3, 3] == pytest.approx((0.1, 0.0, 0.2))
    wheel = viz.frames.lookup("base_link", "drivewhl_l_link").matrix
    assert wheel[:3, 3] == pytest.approx((-0.12, 0.18, -0.05))


def test_a_ring_of_frames_is_refused(viz: Visualizer) -> None:
    with pytest.raises(FrameError):
        viz.set_static_transform("front_caster", "base_link")


def test_frames_follow_the_joints(viz: Visualizer) -> None:
    viz.set_joint_positions({LEFT: math.pi / 2})
    T = viz.frames.lookup("base_link", "drivewhl_l_link").matrix
    assert np.allclose(T[:3, :3] @ [1, 0, 0], [0, 0, -1])


def test_a_wrong_joint_name_offers_the_right_one(viz: Visualizer) -> None:
    with pytest.raises(JointError, match=f"did you mean '{LEFT}'"):
        viz.set_joint_positions({"drivewhl_l_jiont": 1.0})
    with pytest.raises(JointError):
        viz.set_joint_positions({LEFT: math.nan})


def test_the_port_is_free_again_after_the_end(free_port: int) -> None:
    with Visualizer(port=free_port):
        pass
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        probe.bind(("127.0.0.1", free_port))


def test_a_taken_port_is_an_error_that_says_what_to_do() -> None:
    with Visualizer(port=0) as viz, pytest.raises(ServerError, match="--port 0"):
        Visualizer(port=port_of(viz))


def test_an_address_of_another_machine_is_an_error() -> None:
    with pytest.raises(ServerError, match="no such address"):
        Visualizer(host="203.0.113.7", port=0)


@pytest.fixture
def free_port() -> int:
    """A port that nobody else gets meanwhile."""
    return live_peers.free_port()


def answers(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


def test_an_ill_formed_model_leaves_no_server_behind(
    tmp_path: Path, free_port: int
) -> None:
    model = tmp_path / "wrong.urdf"
    model.write_text('<robot name="r">\n  <link name="a">\n</robot>\n')
    with pytest.raises(RobotError):
        Visualizer(model=model, port=free_port)
    assert not answers(free_port)


def test_a_model_that_urdf_refuses_leaves_no_server_behind(
    tmp_path: Path, free_port: int
) -> None:
    model = tmp_path / "wrong.urdf"
    model.write_text('<robot name="r"><link name="a"/><link name="b"/></robot>')
    with pytest.raises(RobotError):
        Visualizer(model=model, port=free_port)
    assert not answers(free_port)


def test_a_ring_of_static_transforms_leaves_no_server_behind(free_port: int) -> None:
    ring = ["0 0 0 0 0 0 a b", "0 0 0 0 0 0 b a"]
    with pytest.raises(FrameError):
        Visualizer(port=free_port, static_transforms=ring)
    assert not answers(free_port)


def test_a_start_position_that_is_refused_leaves_no_server_behind(
    free_port: int,
) -> None:
    with pytest.raises(JointError):
        Visualizer(port=free_port, joint_positions={"no_such_joint": 1.0})
    assert not answers(free_port)


def test_stopping_twice_is_fine_and_ends_the_wait() -> None:
    viz = Visualizer(port=0)
    waiting = threading.Thread(target=viz.wait)
    waiting.start()
    viz.stop()
    waiting.join(timeout=patience(30.0))
    assert not waiting.is_alive()
    viz.stop()


def test_an_exception_in_the_with_block_stops_the_server(free_port: int) -> None:
    with pytest.raises(KeyError), Visualizer(port=free_port):
        assert answers(free_port)
        raise KeyError("a mistake of the script")
    assert not answers(free_port)


def test_no_thread_is_left_after_the_end() -> None:
    before = set(threading.enumerate())
    with Visualizer(port=0, watch=True):
        pass
    left = [t for t in threading.enumerate() if t not in before]
    for thread in left:
        thread.join(timeout=patience(30.0))
    assert [t.name for t in left if t.is_alive()] == []


def test_a_misspelled_option_is_refused_by_name() -> None:
    with pytest.raises(TypeError, match="prot"):
        Visualizer(prot=0)  # type: ignore[call-arg]


def test_a_missing_file_is_an_error_with_the_nearest_name(tmp_path: Path) -> None:
    (tmp_path / "robot.urdf").write_text("<robot/>")
    with pytest.raises(UsageError, match=r"did you mean 'robot\.urdf'"):
        Visualizer(model=tmp_path / "robto.urdf")


def test_a_robot_object_and_korean_folders_work(
    tmp_path: Path, protocol: Connect
) -> None:
    folder = tmp_path / "내 로봇 폴더"
    folder.mkdir()
    model = folder / "로봇.urdf"
    model.write_text(
        "<!-- 우리 로봇 -->\n"
        '<robot name="로봇"><link name="몸"><visual><geometry><box size="1 1 1"/>'
        "</geometry></visual></link></robot>",
        encoding="utf-8",
    )
    with Visualizer(model=load_robot(model), port=0) as viz:
        viz.displays["TF"].enabled = True
        client = protocol(port_of(viz))
        assert [m.fields["props"]["text"] for m in labels(client)] == ["몸"]
        client.settle(viz.viser)
        assert client.shown("displays", "Global Options", "Fixed Frame") == "몸"


def test_private_sessions_have_a_robot_each(protocol: Connect) -> None:
    with Visualizer(port=0, session="private") as viz:
        first, second = protocol(port_of(viz)), protocol(port_of(viz))
        first.settle(viz.viser)
        second.settle(viz.viser)
        mark = second.mark()
        assert second.shown("joints", LEFT) == 0.0
        first.edit(first.id_of("joints", LEFT), 0.5)
        first.settle(viz.viser)
        second.settle(viz.viser)
        assert second.since(mark) == []


def test_a_vector_moves_all_joints_in_the_order_of_the_robot(
    viz: Visualizer, sam_bot: Robot
) -> None:
    assert sam_bot.joint_names == (LEFT, RIGHT)
    for vector in ([0.1, 0.2], (0.1, 0.2), np.array([0.1, 0.2])):
        viz.set_joint_positions({LEFT: 0.0, RIGHT: 0.0})
        viz.set_joint_positions(vector)
        assert list(viz.joint_positions.values()) == [0.1, 0.2]
        T = sam_bot.forward_kinematics(vector)
        named = sam_bot.forward_kinematics({LEFT: 0.1, RIGHT: 0.2})
        assert all(np.array_equal(T[link], named[link]) for link in T)
    viz.set_joint_positions({LEFT: np.array(0.3), RIGHT: np.float32(0.5)})
    assert list(viz.joint_positions.values()) == [0.3, 0.5]
    for wrong in ([0.1], [0.1, 0.2, 0.3], np.zeros((2, 1)), 0.1):
        with pytest.raises(JointError, match="needs 2 numbers, in the order"):
            viz.set_joint_positions(wrong)  # type: ignore[arg-type]
    with pytest.raises(JointError, match="not a finite number"):
        viz.set_joint_positions([0.1, math.nan])


def test_a_callback_hears_of_every_move_whoever_makes_it(
    viz: Visualizer, client: ProtocolClient, caplog: pytest.LogCaptureFixture
) -> None:
    heard: list[dict[str, float]] = []

    @viz.on_joint_positions
    def moved(positions: Mapping[str, float]) -> None:
        heard.append(dict(positions))
        if positions[LEFT] == 0.75:
            raise ZeroDivisionError("in a user's program")

    viz.set_joint_positions([0.25, 0.5])
    client.settle(viz.viser)
    assert heard == [{LEFT: 0.25, RIGHT: 0.5}]
    viz.set_joint_positions([0.25, 0.5])
    viz.set_static_transform("base_link", "camera")
    client.settle(viz.viser)
    assert len(heard) == 1
    client.edit(client.row_named("joints", LEFT)["id"], 0.75)
    client.settle(viz.viser)
    assert heard[1:] == [{LEFT: 0.75, RIGHT: 0.5}]
    assert [record.message for record in caplog.records] == [
        "error in a callback of on_joint_positions"
    ]
    viz.set_joint_positions({LEFT: 0.0})
    client.settle(viz.viser)
    assert heard[-1] == {LEFT: 0.0, RIGHT: 0.5}


def test_a_callback_hears_of_private_sessions_that_come_later(
    make_viz: Callable[..., Visualizer], protocol: Connect
) -> None:
    viz = make_viz(session="private")
    heard: list[float] = []
    viz.on_joint_positions(lambda positions: heard.append(positions[LEFT]))
    for value in (0.25, 0.5):
        one = protocol(port_of(viz))
        one.wait_until(lambda one=one: f"j/{LEFT}" in one.rows)
        one.edit(f"j/{LEFT}", value)
        one.settle(viz.viser)
    assert heard == [0.25, 0.5]


def test_a_frame_is_hung_by_whatever_describes_its_pose(viz: Visualizer) -> None:
    quarter = (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))
    wanted = Transform.from_xyz_rpy((1.0, 2.0, 3.0), (0.0, 0.0, math.pi / 2))
    viz.set_static_transform("base_link", "a", (1, 2, 3), rpy=(0, 0, math.pi / 2))
    viz.set_static_transform("base_link", "b", np.array([1, 2, 3]), quarter)
    viz.set_static_transform("base_link", "c", wanted)
    viz.set_static_transform("base_link", "d", wanted.matrix)
    viz.set_static_transform("base_link", "e", wanted.matrix.tolist())
    viz.set_static_transform("base_link", "f", viz.frames.lookup("base_link", "a"))
    for child in "abcdef":
        found = viz.frames.lookup("base_link", child).matrix
        assert found == pytest.approx(wanted.matrix, abs=1e-12)
    wrong: list[Any] = [np.eye(3), np.ones((4, 4)), "base", [1, 2], [[1], [2, 3]]]
    for pose in wrong:
        with pytest.raises(FrameError):
            viz.set_static_transform("base_link", "g", pose)
    with pytest.raises(FrameError, match="has its rotation already"):
        viz.set_static_transform("base_link", "g", np.eye(4), (0, 0, 1))
    assert "g" not in viz.frames.frames


def test_an_option_that_does_not_exist_is_named_with_the_nearest() -> None:
    wrong: Any = {"prt": 1}
    with pytest.raises(TypeError, match=r"has no option 'prt'; did you mean 'port'\?"):
        Visualizer(**wrong)


def test_the_text_of_a_model_is_a_model() -> None:
    text = '\n<robot name="two"><link name="body"/></robot>'
    with Visualizer(text, port=0) as viz:
        assert viz.frames.frames == ("body",)
        assert repr(viz) == f"<Visualizer of 'two' at {viz.url}>"
    with pytest.raises(RobotError, match="body"):
        Visualizer("<robot name='two'><link name='body'></robot>", port=0)


def test_the_token_is_not_in_the_name_of_a_visualizer(
    make_viz: Callable[..., Visualizer],
) -> None:
    viz = make_viz(token="a-secret-word")
    assert "secret" in viz.url and "secret" not in repr(viz)


def test_after_the_end_nothing_is_changed_in_silence(
    make_viz: Callable[..., Visualizer], tmp_path: Path
) -> None:
    viz = make_viz()
    link, tf = viz.link("base_link"), viz.displays["TF"]
    viz.stop()
    changes: list[Callable[[], object]] = [
        lambda: viz.set_joint_positions({LEFT: 1.0}),
        lambda: viz.set_static_transform("base_link", "laser"),
        lambda: viz.camera.look_at("base_link"),
        lambda: tf.set("Show Names", False),
        link.highlight,
        lambda: viz.snapshot(tmp_path / "a.png"),
    ]
    for change in changes:
        with pytest.raises(ServerError, match="was stopped"):
            change()
    assert viz.joint_positions[LEFT] == 0.0


def test_joints_outside_their_limits_are_named() -> None:
    arm = (
        '<robot name="arm"><link name="a"/><link name="b"/><joint name="lift" '
        'type="prismatic"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>'
        '<limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>'
    )
    with Visualizer(arm, port=0) as viz:
        assert viz.joints_over_limit == ()
        viz.set_joint_positions([1.5])
        assert viz.joints_over_limit == ("lift",)
        assert viz.joint_positions["lift"] == 1.5
