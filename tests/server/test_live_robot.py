"""A robot on the network is shown as it describes itself, and moves as it says."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hand_clock import HandClock
from inside import session_of
from live_peers import WAIT, FoxglovePeer, eventually
from lower_limit import lower
from panel_rows import data_of, edit, panel_of
from patience import until
from protocol_client import CAMERA, ProtocolClient, wait_for_workers
from robot_peer import RobotPeer

from sambot_viz import JointError, UsageError, Visualizer, bundled, load_robot
from sambot_viz.panels.sources.source_panel import SourcePanel
from sambot_viz.panels.views import ViewsPanel
from sambot_viz.robot.load import expand
from sambot_viz.session.clients.client import Client
from sambot_viz.session.clients.viser_camera import VISER_FIRST_POSITION
from sambot_viz.session.data import inbox
from sambot_viz.session.data.live_clock import ClockState
from sambot_viz.session.data.robot_data import RobotData
from sambot_viz.sources.bag import open_recording
from sambot_viz.sources.message import Recorded

LEFT = "drivewhl_l_joint"


@pytest.fixture
def viz(peer: RobotPeer) -> Iterator[Visualizer]:
    with Visualizer(source=peer.uri, port=0) as viz:
        eventually(lambda: session_of(viz).robot.model.name == "sam_bot")
        eventually(lambda: {"/tf", "/joint_states"} <= set(peer.subscribed()))
        yield viz


def place(viz: Visualizer) -> tuple[float, float]:
    x, y, _ = viz.frames.lookup("odom", "base_link").translation
    return round(float(x), 2), round(float(y), 2)


def looks(client: Client) -> list[float]:
    values = client.view.values
    return [values["Yaw"], values["Pitch"], values["Distance"], *values["Focal Point"]]


def sentence(viz: Visualizer) -> str:
    told = {one.id: one.value for one in SourcePanel(session_of(viz).sources).data()}
    return told["source/status"]["sentence"]


def test_the_robot_moves_as_it_says(viz: Visualizer, peer: RobotPeer) -> None:
    peer.play(9.05)
    eventually(lambda: place(viz) == (1.0, 1.0))
    session = session_of(viz)
    eventually(lambda: viz.joint_positions[LEFT] != 0)
    assert session.robot.followed.value == peer.uri
    with pytest.raises(JointError, match="Follow"):
        viz.set_joint_positions({LEFT: 0.0})


def test_the_view_follows_the_robot_in_odom(peer: RobotPeer) -> None:
    with Visualizer(source=peer.uri, port=0) as viz:
        eventually(lambda: "/tf" in peer.subscribed())
        peer.play(1.0)
        eventually(lambda: session_of(viz).scene.context.fixed_frame == "odom")
        view = session_of(viz).document.config.view
        assert view.get("Target Frame") == "base_link"


def test_a_page_that_waited_shows_the_robot_as_a_later_one_does(
    peer: RobotPeer, protocol: Callable[..., ProtocolClient]
) -> None:
    peer.stop()
    with Visualizer(source=peer.uri, port=0) as viz:
        clients = session_of(viz).clients

        def open_page() -> None:
            page = protocol(viz.viser.get_port(), camera=False)
            first = {**CAMERA, "position": VISER_FIRST_POSITION}
            page.send("ViewerCameraMessage", **first)

        open_page()
        eventually(lambda: len(clients.all) == 1)
        (early,) = clients.all.values()
        peer.start()
        eventually(lambda: "/tf" in peer.subscribed())
        peer.play(1.0)
        eventually(lambda: early.view.values["Target Frame"] == "base_link")
        open_page()
        eventually(lambda: len(clients.all) == 2)
        _, late = clients.all.values()
        # Each shows the robot whole as it stood then: turned wheels are as large as
        # their boxes, so that the two are not the same to the last digit.
        eventually(lambda: 0.5 < early.view.values["Distance"] < 2.0)
        eventually(lambda: looks(early) == pytest.approx(looks(late), abs=0.1))


def test_a_description_that_comes_again_leaves_the_camera_where_it_is(
    peer: RobotPeer, protocol: Callable[..., ProtocolClient]
) -> None:
    text = expand(bundled.assets_folder() / "sam_bot.urdf.xacro")
    mast = (
        '<link name="mast"><visual><geometry><box size="1 1 9"/></geometry></visual>'
        '</link><joint name="mast_joint" type="fixed"><parent link="base_link"/>'
        '<child link="mast"/></joint></robot>'
    )
    with Visualizer(source=peer.uri, port=0) as viz:
        session = session_of(viz)
        page = protocol(viz.viser.get_port(), camera=False)
        page.send("ViewerCameraMessage", **{**CAMERA, "position": VISER_FIRST_POSITION})
        eventually(lambda: "/tf" in peer.subscribed())
        peer.play(1.0)
        eventually(lambda: len(session.clients.all) == 1)
        (client,) = session.clients.all.values()
        eventually(lambda: 0.5 < client.view.values["Distance"] < 2.0)
        eventually(lambda: client.view.values["Target Frame"] == "base_link")
        eventually(lambda: session.scene.context.assets.progress is None)
        wait_for_workers()
        seen = looks(client)

        peer.publish("/robot_description", text.replace("</robot>", mast))
        eventually(lambda: "mast" in session.robot.model.links)
        wait_for_workers()

        assert looks(client) == seen


def test_a_page_that_only_waited_has_no_view_of_its_own_when_it_comes_back(
    peer: RobotPeer, protocol: Callable[..., ProtocolClient]
) -> None:
    peer.stop()
    with Visualizer(source=peer.uri, port=0) as viz:
        session = session_of(viz)
        # It has kept the camera that it had before the program was started again.
        page = protocol(viz.viser.get_port())
        # A report of it that came after "first" would end that.
        page.settle(viz.viser)
        (client,) = session.clients.all.values()
        panel = panel_of(ViewsPanel, session, client)
        assert not data_of(panel)["view/waits"]
        edit(panel, "views/first", [])
        assert data_of(panel)["view/waits"]
        peer.start()
        eventually(lambda: "/tf" in peer.subscribed())
        peer.play(1.0)
        eventually(lambda: client.view.values["Target Frame"] == "base_link")
        eventually(lambda: 0.5 < client.view.values["Distance"] < 2.0)
        assert not data_of(panel)["view/waits"]


def test_without_a_robot_the_joints_say_that_none_has_come(
    peer: RobotPeer, protocol: Callable[..., ProtocolClient]
) -> None:
    peer.stop()
    with Visualizer(source=peer.uri, port=0) as viz:
        page = protocol(viz.viser.get_port())
        assert "No robot has come yet" in page.row("joints/none")["value"]


def test_joints_of_the_command_line_wait_for_the_robot(peer: RobotPeer) -> None:
    peer.stop()
    start = {LEFT: 0.5, "tail": 1.0}
    with Visualizer(source=peer.uri, joint_positions=start, port=0) as viz:
        session = session_of(viz)
        assert viz.joint_positions == {}
        peer.start()
        eventually(lambda: viz.joint_positions.get(LEFT) == 0.5)

        def about_the_tail() -> list[str]:
            listed = session.problems.shown.value.listed
            return [one.message for one in listed if "tail" in one.message]

        (said,) = until(about_the_tail, WAIT)
        assert said.startswith("the robot cannot start as the command line says")


def test_the_fixed_frame_is_ok_only_when_a_robot_has_it(
    peer: RobotPeer, protocol: Callable[..., ProtocolClient]
) -> None:
    peer.stop()
    with Visualizer(source=peer.uri, port=0) as viz:
        page, said = protocol(viz.viser.get_port()), "status/Fixed Frame"
        waits = "No tf data.  Actual error: Frame [base_link] does not exist"
        assert page.row(said)["value"] == waits
        assert page.row(said)["level"] == "warn"
        statuses = [page.row(said)["value"]]

        def is_ok() -> bool:
            statuses.append(page.row(said)["value"])
            return statuses[-1] == "OK"

        peer.start()
        eventually(is_ok)
        assert set(statuses) == {waits, "OK"}


def test_a_recording_without_a_robot_says_so_in_the_joints(
    shared: Path, protocol: Callable[..., ProtocolClient]
) -> None:
    recording = shared / "data" / "bags" / "made" / "no_description.mcap"
    with Visualizer(recording, port=0) as viz:
        page = protocol(viz.viser.get_port())
        assert "This recording has no robot model" in page.row("joints/none")["value"]
        # The view goes with it all the same.
        config = session_of(viz).document.config
        assert config.global_options.get("Fixed Frame") == "odom"
        assert config.view.get("Target Frame") == "base_link"


def test_links_that_were_published_once_are_there_after_users_had_the_joints(
    viz: Visualizer, peer: RobotPeer
) -> None:
    peer.play(1.0)
    session = session_of(viz)
    tree, data = session.frames.tree, session.data
    assert data is not None

    def roots() -> set[str]:
        return {tree.root_of(link) for link in session.robot.model.links}

    eventually(lambda: roots() == {"odom"})
    for follow in (False, True):
        data.follow(follow)
        assert roots() == {"odom"}


def test_the_robot_stays_while_the_connection_is_lost(
    viz: Visualizer, peer: RobotPeer
) -> None:
    peer.play(4.05)
    eventually(lambda: place(viz) == (1.0, 0.0))
    peer.stop()
    eventually(lambda: "Connected" not in sentence(viz))
    assert place(viz) == (1.0, 0.0)
    peer.start()
    eventually(lambda: "/tf" in peer.subscribed())
    peer.play(9.05)
    eventually(lambda: place(viz) == (1.0, 1.0))


def test_all_browsers_share_one_subscription(
    peer: RobotPeer, protocol: Callable[..., ProtocolClient]
) -> None:
    with Visualizer(source=peer.uri, port=0, session="private") as viz:
        for _ in range(3):
            protocol(viz.viser.get_port()).settle(viz.viser)
        eventually(lambda: len(viz.server.sessions.all()) == 3)
        eventually(
            lambda: all(
                one.robot.model.name == "sam_bot" for one in viz.server.sessions.all()
            )
        )
        eventually(lambda: "/joint_states" in peer.subscribed())
        assert len(set(peer.subscribed())) == len(peer.subscribed())
        peer.play(9.05)
        for session in viz.server.sessions.all():
            tree = session.frames.tree
            eventually(
                lambda tree=tree: np.allclose(
                    tree.lookup("odom", "base_link").translation[:2], 1.0, atol=0.01
                )
            )


def test_a_simulation_that_is_reset_begins_again(
    viz: Visualizer, peer: RobotPeer
) -> None:
    """Its clock goes back: what moved is forgotten, as in RViz, and it is said."""
    data = session_of(viz).data
    assert isinstance(data, RobotData) and peer.server is not None
    peer.server.broadcast_time(9_050_000_000)
    eventually(lambda: data.time_s() == pytest.approx(9.05))
    peer.play(9.05)
    eventually(lambda: place(viz) == (1.0, 1.0))
    eventually(lambda: data.clock.state.value.simulated)
    eventually(lambda: "wrong use_sim_time" in sentence(viz))

    peer.server.broadcast_time(1_000_000_000)
    eventually(lambda: not viz.frames.can_lookup("odom", "base_link"))
    (problem,) = session_of(viz).sources.problems.value
    assert problem.code == "clock-back"
    assert "time went back by 8.1 s" in problem.message
    eventually(lambda: data.clock.state.value == ClockState(True, 1.0, 0.0))
    # Stamps from before what was forgotten count again.
    peer.play(4.05)
    eventually(lambda: place(viz) == (1.0, 0.0))


def test_without_a_robot_the_page_says_what_is_missing() -> None:
    peer = FoxglovePeer()
    try:
        with Visualizer(source=peer.uri, port=0) as viz:
            eventually(lambda: "robot_state_publisher" in sentence(viz))
            peer.stop()
            eventually(lambda: "robot_state_publisher" not in sentence(viz))
            assert session_of(viz).robot.model is not None
    finally:
        peer.stop()


def test_a_robot_that_describes_itself_in_sdf_is_that_of_the_file() -> None:
    path = bundled.assets_folder() / "sam_bot.sdf"
    of_file = load_robot(path)
    peer = FoxglovePeer()
    try:
        peer.advertise("/robot_description", latched=True)
        peer.publish("/robot_description", expand(path))
        with Visualizer(source=peer.uri, port=0) as viz:
            eventually(lambda: session_of(viz).robot.model.name == of_file.name)
            robot = session_of(viz).robot.model
        assert list(robot.links) == list(of_file.links)
        assert list(robot.joints) == list(of_file.joints)
        poses, expected = robot.forward_kinematics(), of_file.forward_kinematics()
        for name, pose in expected.items():
            np.testing.assert_allclose(poses[name], pose, atol=1e-9)
    finally:
        peer.stop()


def test_meshes_come_through_the_connection() -> None:
    """Each once for all, and a refusal is said with what would allow it."""
    stl = b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
    stl += b"vertex 0 1 0\nendloop\nendfacet\nendsolid a\n"
    asked: list[str] = []

    def fetch(uri: str) -> bytes | None:
        asked.append(uri)
        return stl if uri.endswith("a.stl") else None

    mesh = '<visual><geometry><mesh filename="package://lab/{}"/></geometry></visual>'
    text = '<robot name="lab"><link name="base">'
    text += (
        mesh.format("meshes/a.stl") + mesh.format("meshes/b.stl") + "</link></robot>"
    )
    peer = FoxglovePeer(
        asset_handler=fetch,
    )
    try:
        peer.advertise("/robot_description", latched=True)
        peer.publish("/robot_description", text)
        with Visualizer(source=peer.uri, port=0) as viz:
            eventually(lambda: session_of(viz).robot.model.name == "lab")
            viz.server.sessions.wait_for_meshes(WAIT)
            listed = session_of(viz).problems.shown.value.listed
        refused = [problem for problem in listed if problem.code == "mesh-not-served"]
        assert len(refused) == 1
        assert "b.stl" in refused[0].message
        assert "asset_uri_allowlist" in refused[0].hint
        assert sorted(asked) == [
            "package://lab/meshes/a.stl",
            "package://lab/meshes/b.stl",
        ]
    finally:
        peer.stop()


def test_what_it_says_is_recorded_until_the_end(
    peer: RobotPeer, tmp_path: Path
) -> None:
    path = tmp_path / "new.mcap"
    with Visualizer(source=peer.uri, record=path, port=0) as viz:
        eventually(lambda: session_of(viz).robot.model.name == "sam_bot")
        eventually(lambda: "/scan" in peer.subscribed())
        peer.play(4.05)
        eventually(lambda: place(viz) == (1.0, 0.0))
    with open_recording(path) as recording, Visualizer(path, port=0, at=99.0) as viz:
        assert {"/tf", "/tf_static", "/robot_description"} <= set(recording.topics)
        assert not recording.problems
        assert session_of(viz).robot.model.name == "sam_bot"
        eventually(lambda: place(viz) == (1.0, 0.0))


def test_a_recording_needs_a_live_robot(peer: RobotPeer, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="--record needs a live robot"):
        Visualizer(record=tmp_path / "new.mcap")
    with pytest.raises(UsageError, match="--record-dir needs a live robot"):
        Visualizer(source="bag:assets/square.mcap", record_dir=tmp_path)
    there = tmp_path / "there.mcap"
    there.touch()
    with pytest.raises(UsageError, match="is there already"):
        Visualizer(source=peer.uri, record=there)
    with pytest.raises(UsageError, match="make it with mkdir -p"):
        Visualizer(source=peer.uri, record_dir=tmp_path / "none")


def bytes_taken(data: RobotData, monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The size of each message of transforms that a session takes from now on."""
    taken: list[int] = []
    take = data.transforms.take

    def counted(message: Recorded) -> None:
        taken.append(len(message.payload))
        take(message)

    monkeypatch.setattr(data.transforms, "take", counted)
    return taken


def test_a_page_does_not_wait_for_all_that_a_robot_has_sent(
    viz: Visualizer, peer: RobotPeer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(inbox, "SLICE", 2000)
    data, worker = session_of(viz).data, session_of(viz).worker
    assert isinstance(data, RobotData)
    came: list[str] = []
    taken = bytes_taken(data, monkeypatch)
    # What this one has got, the session has got before.
    source = data.moved_by.source
    for topic in ("/tf", "/joint_states"):
        source.subscribe(topic, lambda message: came.append(message.topic))
    with worker.lock:
        peer.play(9.05)
        eventually(lambda: came.count("/tf") > 300)
        before: list[int] = []
        worker.post(lambda: before.append(sum(taken)), client=7)
    eventually(lambda: before)
    assert before[0] <= 2 * 2000 + 1000
    eventually(lambda: place(viz) == (1.0, 1.0))


def test_what_waits_for_a_session_is_limited_in_bytes(
    viz: Visualizer, peer: RobotPeer, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "WAITING_BYTES", 10_000)
    data, worker = session_of(viz).data, session_of(viz).worker
    assert isinstance(data, RobotData)
    came: list[str] = []
    data.moved_by.source.subscribe("/tf", lambda message: came.append(message.topic))
    with worker.lock:
        taken = bytes_taken(data, monkeypatch)
        # In parts, since what waits for delivery is limited in bytes as well.
        for begin in np.arange(0.0, 9.05, 0.25):
            before = len(came)
            peer.play(min(begin + 0.25, 9.05), begin, topics=["/tf"])
            eventually(lambda before=before: len(came) > before)
    # The last ones are kept, so that the robot is where it is.
    eventually(lambda: place(viz) == (1.0, 1.0))
    assert 5000 < sum(taken) <= 10_000 + max(taken) * (len(peer.subscribed()) + 2)
    assert data.inbox.lost > 0


def test_drawing_takes_at_most_half_of_the_time(
    hand_clock: HandClock, viz: Visualizer, peer: RobotPeer, monkeypatch: Any
) -> None:
    session = session_of(viz)
    drawn: list[float] = []
    draw = session.robot.draw_moved

    def slow() -> None:
        drawn.append(hand_clock.now())
        draw()
        hand_clock.advance(1.0)

    peer.play(1.0)
    hand_clock.advance(10.0)
    wait_for_workers()
    monkeypatch.setattr(session.robot, "draw_moved", slow)

    def has_drawn_often() -> bool:
        for _ in range(10):
            peer.play(9.05)
            wait_for_workers()
            hand_clock.advance(0.25)
        return len(drawn) > 3

    eventually(has_drawn_often)
    # What comes while it is drawn, and for as long again, is drawn together.
    assert all(b - a >= 2.0 for a, b in itertools.pairwise(drawn))
