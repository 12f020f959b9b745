"""The config of a robot that has none: opaque, with frames, of the robot's size."""

from __future__ import annotations

import shutil
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from inside import session_of
from live_peers import FoxglovePeer, eventually
from patience import patience
from protocol_client import ProtocolClient

from sambot_viz import Visualizer, bundled, load_robot
from sambot_viz.displays.data.poses.odometry_display import OdometryDisplay
from sambot_viz.displays.scene_size import round_size
from sambot_viz.displays.tf.tf import AXES_LENGTH
from sambot_viz.inputs import load_config
from sambot_viz.rviz import DisplayConfig, RvizConfig
from sambot_viz.session import Session

BOX = """
<robot name="{name}">
  <link name="hull">
    <visual><geometry>{geometry}</geometry></visual>
  </link>
</robot>
"""


def write(folder: Path, side: float = 0.1, name: str = "r") -> Path:
    """Write a model of one box, with a side that differs from the others."""
    path = folder / "r.urdf"
    path.write_text(BOX.format(name=name, geometry=f"<box size='0.01 {side} 0.02'/>"))
    return path


def displays(config: RvizConfig) -> dict[str, DisplayConfig]:
    return {display.name: display for display in config.displays}


def look(config: RvizConfig) -> dict[str, Any]:
    """What the config says of the look of a robot."""
    shown = displays(config)
    return {
        "alpha": shown["RobotModel"].get("Alpha"),
        "frames": shown["TF"].enabled,
        "cell": shown["Grid"].get("Cell Size"),
        "scale": shown["TF"].get("Marker Scale"),
    }


def shown(session: Session) -> dict[str, Any]:
    return look(session.document.config)


TUTORIAL = {"alpha": 0.6, "frames": True, "cell": 1.0, "scale": 0.3}


@pytest.mark.parametrize(
    ("side", "cell"), [(0.1, 0.05), (0.45, 0.2), (2.1, 1.0), (30.0, 20.0)]
)
def test_a_robot_without_a_config_is_opaque_with_frames_on_a_grid_of_its_size(
    side: float, cell: float, tmp_path: Path
) -> None:
    with Visualizer(write(tmp_path, side), port=0) as viz:
        session = session_of(viz)
        expected = {"alpha": 1.0, "frames": True, "cell": cell, "scale": cell}
        assert shown(session) == expected
        assert displays(session.document.config)["TF"].get("Show Names") is True
        assert session.scene.context.fixed_frame == "hull"
        assert not session.history.modified.value

        saved = tmp_path / "saved.rviz"
        session.document.save(saved)
    # RViz has numbers of 32 bits.
    assert look(load_config(saved)) == pytest.approx(expected)
    assert load_config(saved).problems == ()
    with Visualizer(write(tmp_path, 10.0), saved, port=0) as viz:
        assert shown(session_of(viz)) == pytest.approx(expected)


def chain(folder: Path, links: int, step: float) -> Path:
    """Write a model whose links follow each other along x."""
    ways = range(1, links)
    visual = "<visual><geometry><box size='0.05 0.05 0.05'/></geometry></visual>"
    parts = [f"<link name='l{n}'>{visual}</link>" for n in range(links)]
    parts += [
        f"<joint name='j{n}' type='fixed'><parent link='l{n - 1}'/>"
        f"<child link='l{n}'/><origin xyz='{step} 0 0'/></joint>"
        for n in ways
    ]
    path = folder / "chain.urdf"
    path.write_text(f"<robot name='chain'>{''.join(parts)}</robot>")
    return path


@pytest.mark.parametrize(("links", "named"), [(30, True), (31, False)])
def test_the_frames_of_every_robot_are_shown_and_names_where_they_have_room(
    links: int, named: bool, tmp_path: Path
) -> None:
    with Visualizer(chain(tmp_path, links, 0.1), port=0) as viz:
        tf = displays(session_of(viz).document.config)["TF"]
        assert tf.enabled
        assert tf.get("Show Axes") is True
        assert tf.get("Show Names") is named
        assert tf.get("Show Arrows") is named


def test_the_axes_of_many_frames_do_not_cover_each_other(tmp_path: Path) -> None:
    with Visualizer(chain(tmp_path, 200, 0.1), port=0) as viz:
        scale = shown(session_of(viz))["scale"]
        assert AXES_LENGTH * scale == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("side", "length"), [(0.1, 0.05), (0.45, 0.2), (2.1, 1.0), (30.0, 20.0)]
)
def test_an_added_display_has_the_size_of_the_robot(
    side: float, length: float, tmp_path: Path
) -> None:
    with Visualizer(write(tmp_path, side), port=0) as viz:
        viz.displays.add("Axes")
        axes = displays(session_of(viz).document.config)["Axes"]
        assert axes.get("Length") == length
        assert axes.get("Radius") == pytest.approx(length / 10)


def test_in_a_users_config_an_added_display_has_the_sizes_of_rviz(
    tmp_path: Path,
) -> None:
    config = shutil.copy(bundled.config_path(), tmp_path / "own.rviz")
    with Visualizer(write(tmp_path), config, port=0) as viz:
        viz.displays.add("Axes")
        axes = displays(session_of(viz).document.config)["Axes"]
        assert (axes.get("Length"), axes.get("Radius")) == (1.0, 0.1)


@pytest.mark.parametrize("name", ["sam_bot.urdf.xacro", "sam_bot_collision.urdf.xacro"])
def test_the_tutorials_robot_keeps_its_config(name: str) -> None:
    with Visualizer(bundled.model_path(name), port=0) as viz:
        assert shown(session_of(viz)) == TUTORIAL


def test_a_copy_of_the_tutorials_robot_that_is_changed_keeps_it_too(
    tmp_path: Path,
) -> None:
    with Visualizer(write(tmp_path, name="sam_bot"), port=0) as viz:
        assert shown(session_of(viz)) == TUTORIAL


def test_a_config_that_is_given_is_shown_as_it_is(tmp_path: Path) -> None:
    with Visualizer(write(tmp_path), bundled.config_path(), port=0) as viz:
        assert shown(session_of(viz)) == TUTORIAL


def test_the_config_of_a_package_is_shown_as_it_is(tmp_path: Path) -> None:
    write(tmp_path)
    (tmp_path / "package.xml").write_text("<package><name>r</name></package>")
    (tmp_path / "rviz").mkdir()
    shutil.copy(bundled.config_path(), tmp_path / "rviz" / "view.rviz")
    with Visualizer(tmp_path, port=0) as viz:
        assert shown(session_of(viz)) == TUTORIAL


def test_a_robot_of_frames_alone_keeps_them(tmp_path: Path) -> None:
    path = tmp_path / "r.urdf"
    path.write_text('<robot name="r"><link name="only"/></robot>')
    with Visualizer(path, port=0) as viz:
        assert shown(session_of(viz)) == TUTORIAL


def test_the_size_is_that_of_the_meshes(tmp_path: Path) -> None:
    corners = ((0, 0, 0), (0.3, 0, 0), (0, 4.2, 0))
    triangle = struct.pack("<12fH", 0, 0, 1, *(n for c in corners for n in c), 0)
    (tmp_path / "t.stl").write_bytes(bytes(80) + struct.pack("<I", 1) + triangle)
    model = tmp_path / "r.urdf"
    model.write_text(BOX.format(name="r", geometry="<mesh filename='t.stl'/>"))
    with Visualizer(model, port=0) as viz:
        viz.server.sessions.wait_for_meshes(patience(20))
        assert shown(session_of(viz))["cell"] == 2.0


def test_another_size_of_the_robot_is_followed_until_a_user_chooses(
    tmp_path: Path,
) -> None:
    with Visualizer(write(tmp_path, 0.1), port=0) as viz:
        session = session_of(viz)
        session.show_robot(load_robot(write(tmp_path, 0.4)))
        assert shown(session)["cell"] == 0.2
        session.display_edits.set_property(session.scene.displays[0], "Cell Size", 0.25)
        session.show_robot(load_robot(write(tmp_path, 4.0)))
        assert shown(session) == {
            "alpha": 1.0,
            "frames": True,
            "cell": 0.25,
            "scale": 2.0,
        }


def test_each_private_session_has_it(
    tmp_path: Path, protocol: Callable[..., ProtocolClient]
) -> None:
    with Visualizer(write(tmp_path, 0.1), port=0, session="private") as viz:
        for _ in range(2):
            protocol(viz.viser.get_port()).settle(viz.viser)
        sessions = viz.server.sessions.all()
        expected = {"alpha": 1.0, "frames": True, "cell": 0.05, "scale": 0.05}
        assert list(map(shown, sessions)) == [expected, expected]


def test_a_live_robot_has_it_as_soon_as_it_comes() -> None:
    peer = FoxglovePeer()
    try:
        peer.advertise("/robot_description", latched=True)
        with Visualizer(source=peer.uri, port=0) as viz:
            session = session_of(viz)
            assert shown(session) == TUTORIAL
            box = BOX.format(name="lab", geometry="<box size='0.1 0.1 0.1'/>")
            peer.publish("/robot_description", box)
            eventually(lambda: getattr(session.robot.model, "name", "") == "lab")
            expected = {"alpha": 1.0, "frames": True, "cell": 0.05, "scale": 0.05}
            eventually(lambda: shown(session) == expected)
            assert session.scene.displays[2].shown
    finally:
        peer.stop()


def arrow(viz: Visualizer) -> list[float]:
    (odometry,) = (
        display
        for display in session_of(viz).document.config.displays
        if display.kind == OdometryDisplay.kind
    )
    parts = ("Shaft Length", "Shaft Radius", "Head Length", "Head Radius")
    return [float(odometry.get(f"Shape/{part}")) for part in parts]


def test_arrows_of_data_are_as_long_as_the_robot_where_no_config_says_it(
    repository: Path, tmp_path: Path
) -> None:
    """Also where the robot is the tutorial's, whose frames keep their size."""
    square = repository / "assets" / "square.mcap"
    with Visualizer(source=str(square), port=0) as viz:
        viz.server.sessions.wait_for_meshes(20)
        assert arrow(viz) == pytest.approx([0.5, 0.025, 0.15, 0.05])
        assert shown(session_of(viz)) == TUTORIAL
        assert not session_of(viz).history.modified.value
    config = tmp_path / "own.rviz"
    config.write_text(
        "Visualization Manager:\n  Displays:\n    - Class: "
        f"{OdometryDisplay.kind}\n      Name: Odometry\n      Topic: {{Value: /odom}}\n"
    )
    with Visualizer(source=str(square), config=config, port=0) as viz:
        viz.server.sessions.wait_for_meshes(20)
        assert arrow(viz) == [1.0, 0.05, 0.3, 0.1]


@pytest.mark.parametrize(
    ("size", "rounded"),
    [(0.0, 1e-4), (0.13, 0.1), (0.15, 0.2), (0.33, 0.5), (0.8, 1.0), (70, 50)],
)
def test_sizes_are_round(size: float, rounded: float) -> None:
    assert round_size(size) == pytest.approx(rounded)
