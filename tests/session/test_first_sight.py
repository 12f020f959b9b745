"""What a recording shows at first, where no config says it."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from any_recording import Given, write_any
from dds_peer import DdsPeer
from inside import session_of
from live_peers import eventually
from made_recording import write_recording
from robot_peer import BusyPeer, square_peer
from zenoh_peer import ZenohPeer

from sambot_viz import Visualizer
from sambot_viz.rviz import RvizConfig
from sambot_viz.session.first_sight import dot_size
from sambot_viz.session.session import Session
from sambot_viz.sources.bag import open_recording
from sambot_viz.topics.first_topics import shown_at_first
from sambot_viz.views.camera import Camera

Show = Callable[..., Session]


@pytest.fixture
def shown(request: pytest.FixtureRequest) -> Show:
    """Show a source: its session."""

    def show(source: Path, **options: object) -> Session:
        viz = Visualizer(source=str(source), port=0, **options)  # pyright: ignore
        request.addfinalizer(viz.stop)
        return session_of(viz)

    return show


@pytest.fixture
def recordings(shared: Path) -> Path:
    return shared / "data" / "reported" / "recordings"


@pytest.fixture
def golden(shared: Path) -> Path:
    return shared / "data" / "golden-data"


@pytest.fixture
def bags(shared: Path) -> Path:
    return shared / "data" / "reported" / "bags"


@contextmanager
def stopped(peer: BusyPeer) -> Generator[BusyPeer]:
    """Stop a peer at the end."""
    try:
        yield peer
    finally:
        peer.stop()


def kinds(config: RvizConfig) -> list[str]:
    return [one.kind.rpartition("/")[2] for one in config.displays if one.enabled]


def test_axes_of_frames_without_a_robot_follow_how_far_these_are_apart(
    bags: Path, shown: Show
) -> None:
    """This recording has nothing but frames, with one to three metres between them."""
    session = shown(bags / "c14")
    (tf,) = (one for one in session.document.config.displays if one.name == "TF")
    eventually(lambda: tf.get("Marker Scale") == 2.0)


def test_all_that_a_recording_has_is_shown_in_the_order_of_need(
    recordings: Path, shown: Show
) -> None:
    config = shown(recordings / "nav2_12.mcap").document.config
    assert kinds(config)[:3] == ["Grid", "RobotModel", "TF"]
    assert kinds(config)[3:] == [
        *("Map", "Map", "Map", "LaserScan", "Path", "Odometry", "Polygon"),
        *("ParticleCloud", "Pose"),
    ]
    assert config.global_options.get("Fixed Frame") == "map"
    costs = [d for d in config.displays if "costmap" in d.name and "Map" in d.name]
    assert {d.get("Color Scheme") for d in costs} == {"costmap"}


def test_costmaps_lie_over_the_map(recordings: Path, shown: Show) -> None:
    config = shown(recordings / "nav2_12.mcap").document.config
    maps = [one for one in config.displays if one.kind.endswith("/Map")]
    behind = [bool(one.get("Draw Behind")) for one in maps]
    assert behind == [True, False, False]
    assert "costmap" not in maps[0].name


def test_a_fixed_frame_of_the_command_line_stays_and_all_is_seen(
    recordings: Path, shown: Show
) -> None:
    source = recordings / "nav2_12.mcap"
    without = shown(source).document.config
    config = shown(source, fixed_frame="odom").document.config
    assert config.global_options.get("Fixed Frame") == "odom"
    assert kinds(config) == kinds(without)


def test_a_live_robot_without_a_description_is_seen_in_the_frame_at_its_top(
    tmp_path: Path,
) -> None:
    told = [("/tf", 0.0, {"base": "map"})]
    path = write_recording(tmp_path / "scan.mcap", {}, told, None, [(0.0, 0.0)])
    with (
        open_recording(path) as recording,
        stopped(BusyPeer(recording)) as peer,
        Visualizer(source=peer.uri, port=0) as viz,
    ):
        session = session_of(viz)
        options = session.document.config.global_options
        eventually(lambda: options.get("Fixed Frame") == "map")
        eventually(lambda: session.scene.global_status().level == "Ok")
        with session.lock:
            assert "RobotModel" not in kinds(session.document.config)


def test_a_config_is_shown_as_it_is(recordings: Path, shown: Show) -> None:
    file = recordings / "nav2.rviz"
    config = shown(recordings / "nav2_12.mcap", config=file).document.config
    assert kinds(config) == kinds(read(file))
    assert config.unasked == ()


def read(file: Path) -> RvizConfig:
    from sambot_viz import load_config

    return load_config(file)


def test_the_frame_of_the_data_is_the_fixed_frame_without_transforms(
    golden: Path, shown: Show, tmp_path: Path
) -> None:
    path = write_recording(tmp_path / "scan.mcap", {}, (), None, [(0.0, 0.0)])
    session = shown(path)
    assert session.document.config.global_options.get("Fixed Frame") == "base"
    assert session.scene.global_status().level != "Error"
    assert [d.status.level for d in session.scene.displays if d.is_data] == ["Ok"]


def test_pictures_alone_need_no_frame(
    golden: Path, shown: Show, tmp_path: Path
) -> None:
    with open_recording(golden / "image_rgb8" / "messages.mcap") as bag:
        image = next(m for m in bag.messages() if m.channel.topic == "/image")
    schema = image.channel.schema
    given = Given("/image", [bytes(image.payload)], schema.name, schema.text)
    path = write_any(tmp_path, "mcap", [given], 10**9)
    session = shown(path)
    assert session.scene.global_status().level == "Ok"
    # Of a frame that a user names it is said.
    session.document.set_option("Fixed Frame", "nowhere")
    assert session.scene.global_status().level == "Warn"
    assert shown(path, fixed_frame="base_link").scene.global_status().level == "Warn"


def test_a_robot_that_nobody_asked_for_is_no_error(golden: Path, shown: Show) -> None:
    session = shown(golden / "cloud_intensity_points" / "messages.mcap")
    assert "RobotModel" not in kinds(session.document.config)
    levels = {display.status.level for display in session.scene.displays}
    assert "Error" not in levels
    said = {p.code: p.severity for p in session.problems.shown.value.listed}
    assert said.get("no-description") == "info"


def test_the_camera_frames_the_data(golden: Path, shown: Show) -> None:
    session = shown(golden / "map_orbit" / "messages.mcap")
    assert session.data is not None and session.data.player is not None
    session.data.player.jump(session.data.player.end_ns)
    camera = session.document_view.camera_on_robot(800, 600)
    assert 2.0 < math.dist(camera.position, camera.look_at) < 50.0


def test_what_was_added_goes_at_once_and_comes_back(
    recordings: Path, shown: Show
) -> None:
    session = shown(recordings / "nav2_12.mcap")
    before = kinds(session.document.config)
    with session.history.acting(0):
        session.display_edits.remove_unasked()
    assert kinds(session.document.config) == ["Grid", "RobotModel", "TF"]
    assert not session.display_edits.has_unasked
    session.history.undo(0)
    assert kinds(session.document.config) == before


@pytest.mark.parametrize("count", [0, 1, 500, 20_000, 10**7])
def test_few_points_are_drawn_larger(count: int) -> None:
    assert dot_size(count) >= dot_size(count + 10**6)
    assert dot_size(None) >= 1


def test_no_more_pictures_are_opened_than_can_be_seen() -> None:
    types = {f"/camera{n}/image": "sensor_msgs/msg/Image" for n in range(50)}
    types |= {f"/scan{n}": "sensor_msgs/msg/LaserScan" for n in range(50)}
    found = shown_at_first(types)
    assert len(found) <= 24
    assert found[0][0].startswith("/scan")
    assert len(shown_at_first({n: t for n, t in types.items() if "camera" in n})) == 4


def test_a_live_robot_shows_its_topics_as_they_come(repository: Path) -> None:
    with (
        square_peer(repository, BusyPeer) as peer,
        Visualizer(source=peer.uri, port=0) as viz,
    ):
        session = session_of(viz)
        eventually(lambda: "/scan" in peer.subscribed())
        with session.lock:
            assert {"LaserScan", "Odometry"} <= set(kinds(session.document.config))
            with session.history.acting(0):
                session.display_edits.remove_unasked()
        # What was taken out does not come back with the next topic.
        eventually(lambda: "/scan" not in peer.subscribed())
        peer.advertise("/late")
        data = session.data
        assert data is not None
        eventually(lambda: "/late" in data.moved_by.source.topics())
        with session.lock:
            assert "LaserScan" not in kinds(session.document.config)


def test_what_nodes_only_wait_for_is_not_shown() -> None:
    robot = ZenohPeer()
    robot.listen_as("/goal", "/planner", type_name="geometry_msgs/msg/PoseStamped")
    with Visualizer(source=robot.uri, port=0) as viz:
        session = session_of(viz)
        data = session.data
        assert data is not None
        eventually(lambda: "/goal" in data.moved_by.source.topics())
        robot.advertise("/plan", type_name="nav_msgs/msg/Path")

        def shown() -> list[str]:
            with session.lock:
                return kinds(session.document.config)

        eventually(lambda: "Path" in shown())
        assert "Pose" not in shown()
    robot.stop()


def test_a_display_asks_for_what_is_offered() -> None:
    robot = DdsPeer()
    scan = "sensor_msgs/msg/LaserScan"
    robot.advertise("/scan", type_name=scan, is_loose=True)
    with Visualizer(source=robot.uri, port=0) as viz:
        session = session_of(viz)

        def policy() -> object:
            with session.lock:
                [one] = [
                    d for d in session.document.config.displays if "LaserS" in d.kind
                ]
                return one.get("Topic/Reliability Policy")

        eventually(lambda: policy() == "Best Effort")
    robot.stop()


RECORDINGS = (
    *("reported/recordings/" + name for name in ("nav2_12", "two_robots_ns")),
    *("reported/recordings/" + name for name in ("tf_clock_back", "tf_gap")),
    *("reported/bags/c14/c14", "reported/bags/c13_tworoots/c13_tworoots"),
    *("bags/made/" + name for name in ("square", "mixed", "clock_back")),
    *("bags/made/" + name for name in ("two_parents", "old_names", "static_three")),
)
SIZE = (640, 480)


@pytest.mark.parametrize("name", RECORDINGS)
def test_the_robot_or_else_all_frames_are_seen_at_each_time(
    shared: Path, shown: Show, name: str
) -> None:
    """The camera of the first sight shows a robot in at least 24 of 480 pixels."""
    session = shown(shared / "data" / f"{name}.mcap")
    assert session.data is not None and session.data.player is not None
    player, view = session.data.player, session.document_view
    player.pause()
    # It has played for as long as this machine took to come here.
    player.jump(player.start_ns)
    first, begin = view.camera_on_robot(*SIZE), view.target.position
    asked = 0
    for part in (0.0, 0.5, 1.0):
        player.jump(player.start_ns + round(part * (player.end_ns - player.start_ns)))
        with session.change():
            robot, context = session.picker.link_box(), session.scene.context
            by = view.target.position - begin
            poses = [context.pose(frame) for frame in context.tree.frames]
        camera = Camera(first.position + by, first.look_at + by, first.up)
        if robot is not None:
            middle, size = (robot[0] + robot[1]) / 2, np.max(robot[1] - robot[0])
            away = np.linalg.norm(middle - camera.position)
            assert size / (2 * away * math.tan(camera.fov / 2)) >= 24 / 480
            seen = [middle]
        else:
            seen = [T[:3, 3] for T in poses if T is not None]
        asked += len(seen)
        assert all(camera.shows(at, *SIZE) for at in seen)
    assert asked


def test_frames_alone_give_no_error_and_sizes_of_the_whole_run(
    recordings: Path, shown: Show
) -> None:
    session = shown(recordings / "tf_clock_back.mcap")
    (tf,) = (one for one in session.document.config.displays if one.name == "TF")
    # The frame moves 39 m away in four seconds.
    eventually(lambda: 5.0 <= tf.get("Marker Scale") <= 50.0)
    with session.lock:
        levels = {display.status.level for display in session.scene.displays}
    assert levels == {"Ok"}
    assert "RobotModel" not in kinds(session.document.config)
    said = {p.code: p.severity for p in session.problems.shown.value.listed}
    assert said.get("no-description") == "info"
