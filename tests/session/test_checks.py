"""What the checks find is listed in the page, after the robot is shown."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path

import pytest
from patience import patience
from protocol_client import ProtocolClient, wait_for_workers

from sambot_viz import Problem, Visualizer, checks, load_robot
from sambot_viz.session import Session

MODEL = """\
<robot name="r">
  <link name="base_link"/>
  <link name="arm"/>
  <joint name="j" type="revolute">
    <parent link="base_link"/>
    <child link="arm"/>
    <limit lower="-90" upper="90" effort="1" velocity="1"/>
  </joint>
</robot>
"""
CONFIG = """\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/RobotModel
      Enabled: true
      Name: RobotModel
      Description Topic:
        Value: /robot_description
  Global Options:
    Fixed Frame: base_lnk
"""


@pytest.fixture
def model(tmp_path: Path) -> Path:
    path = tmp_path / "r.urdf"
    path.write_text(MODEL)
    return path


@pytest.fixture
def config(tmp_path: Path) -> Path:
    path = tmp_path / "r.rviz"
    path.write_text(CONFIG)
    return path


def session_of(viz: Visualizer) -> Session:
    return viz._server.sessions.all()[0]  # pyright: ignore[reportPrivateUsage]


def codes(viz: Visualizer) -> list[str]:
    return [problem.code for problem in session_of(viz).problems.of_model]


def test_problems_of_the_robot_that_is_shown_are_listed(model: Path) -> None:
    with Visualizer(model, port=0) as viz:
        assert codes(viz) == ["limit-in-degrees"]
        model.write_text(MODEL.replace("90", "1"))
        viz.server.sessions.show_robot(load_robot(model))
        assert codes(viz) == []


def test_a_fixed_frame_that_does_not_exist_is_reported_until_another_is_chosen(
    model: Path, config: Path
) -> None:
    with Visualizer(model, config, port=0) as viz:
        assert codes(viz) == ["limit-in-degrees", "setup-fixed-frame"]
        assert session_of(viz).problems.of_model[1].line == 9
        session_of(viz).document.set_option("Fixed Frame", "base_link")
        assert codes(viz) == ["limit-in-degrees"]


def test_a_fixed_frame_that_a_static_transform_brings_is_not_a_problem(
    model: Path, config: Path
) -> None:
    with Visualizer(model, config, port=0) as viz:
        viz.set_static_transform("base_lnk", "base_link")
        assert codes(viz) == ["limit-in-degrees"]


def test_a_fixed_frame_that_a_node_of_the_package_publishes_is_not_a_problem(
    model: Path, config: Path, tmp_path: Path
) -> None:
    (tmp_path / "package.xml").write_text("<package><name>r</name></package>")
    config.write_text(CONFIG.replace("base_lnk", "odom"))
    with Visualizer(model, config, port=0) as viz:
        assert codes(viz) == ["limit-in-degrees", "setup-fixed-frame"]
    driver = "driver:\n  ros__parameters:\n    odom_frame: odom\n"
    (tmp_path / "driver.yaml").write_text(driver)
    with Visualizer(model, config, port=0) as viz:
        assert codes(viz) == ["limit-in-degrees"]


def test_a_display_that_is_switched_on_or_removed_is_checked_again(
    model: Path, config: Path
) -> None:
    config.write_text(CONFIG.replace("true", "false").replace("lnk", "link"))
    with Visualizer(model, config, port=0) as viz:
        session = session_of(viz)
        (display,) = session.scene.displays
        assert codes(viz) == ["limit-in-degrees", "setup-no-robot-model"]
        session.display_edits.set_enabled(display, True)
        assert codes(viz) == ["limit-in-degrees"]
        session.display_edits.remove_display(display.config)
        assert codes(viz) == ["limit-in-degrees", "setup-no-robot-model"]


def test_a_private_session_lists_the_same(
    model: Path, protocol: Callable[..., ProtocolClient]
) -> None:
    with Visualizer(model, port=0, session="private") as viz:
        client = protocol(viz.viser.get_port())
        client.settle(viz.viser)
        assert codes(viz) == ["limit-in-degrees"]


def test_a_mesh_in_millimetres_is_reported_when_the_picture_has_read_it(
    tmp_path: Path,
) -> None:
    (tmp_path / "p.obj").write_text("v 0 0 0\nv 250 0 0\nv 0 120 40\nf 1 2 3\n")
    model = tmp_path / "r.urdf"
    model.write_text(
        '<robot name="r"><link name="base_link"><visual><geometry>'
        '<mesh filename="p.obj"/></geometry></visual></link></robot>'
    )
    with Visualizer(model, port=0) as viz:
        assert session_of(viz).scene.context.assets.wait(patience(20.0))
        wait_for_workers()
        assert codes(viz) == ["mesh-size"]


def test_what_the_files_around_the_model_contradict_is_listed(
    model: Path, tmp_path: Path
) -> None:
    (tmp_path / "package.xml").write_text("<package><name>r</name></package>")
    (tmp_path / "nav2_params.yaml").write_text(
        "amcl:\n  ros__parameters:\n    base_frame_id: base_footprint\n"
    )
    with Visualizer(model, port=0) as viz:
        wait_for_workers()
        assert codes(viz) == ["limit-in-degrees", "frame-unknown"]


def test_a_package_that_starts_the_model_is_checked_with_it(tmp_path: Path) -> None:
    for name, files in {
        "r_description": {"r.urdf": MODEL.replace("90", "1")},
        "r_bringup": {
            "launch/r.launch.xml": "<launch><arg name='model' default='"
            "$(find-pkg-share r_description)/r.urdf'/></launch>",
            "nav2_params.yaml": "amcl:\n  ros__parameters:\n    base_frame_id: base\n",
        },
    }.items():
        for file, text in {
            "package.xml": f"<package><name>{name}</name></package>",
            **files,
        }.items():
            path = tmp_path / name / file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
    model = tmp_path / "r_description" / "r.urdf"
    for shown, workspace in ((tmp_path / "r_bringup", ()), (model, (tmp_path,))):
        with Visualizer(shown, port=0, workspace=workspace) as viz:
            wait_for_workers()
            assert list(viz.joint_positions) == ["j"]
            assert codes(viz) == ["frame-unknown"]
    with Visualizer(model, port=0) as viz:
        wait_for_workers()
        assert codes(viz) == []


def test_what_was_checked_late_does_not_replace_what_is_newer(
    model: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun, newer = threading.Event(), threading.Event()
    old, new = (Problem("warning", code, code) for code in ("old", "new"))

    def check_robot(*_: object, **__: object) -> list[Problem]:
        if begun.is_set():
            return [new]
        begun.set()
        assert newer.wait(patience(10.0))
        return [old]

    with Visualizer(model, port=0) as viz:
        wait_for_workers()
        session = session_of(viz)
        monkeypatch.setattr(checks, "check_robot", check_robot)
        session.show_robot(load_robot(model))
        thread = threading.Thread(target=session.checks.run)
        thread.start()
        assert begun.wait(patience(10.0))
        # A mesh has been read meanwhile.
        session.scene.context.assets.read_count += 1
        session.checks.run()
        newer.set()
        thread.join(10)
        assert codes(viz) == ["new"]


@pytest.mark.parametrize(
    ("leader", "code"),
    [
        ("jj", "mimic-joint-unknown"),
        ("k", "mimic-ring"),
        ("f", "mimic-joint-immovable"),
    ],
)
def test_a_wrong_mimic_is_listed_once(tmp_path: Path, leader: str, code: str) -> None:
    path = tmp_path / "r.urdf"
    joints = "".join(
        f'''<link name="{name}"/>
  <joint name="{name}" type="{kind}">
    <parent link="base_link"/><child link="{name}"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>{mimic}
  </joint>'''
        for name, kind, mimic in (
            ("f", "fixed", ""),
            ("k", "revolute", f'<mimic joint="{leader}"/>'),
            ("m", "revolute", '<mimic joint="k"/>'),
        )
    )
    path.write_text(f'<robot name="r"><link name="base_link"/>{joints}</robot>')
    viz = Visualizer(load_robot(path), port=0)
    try:
        assert codes(viz).count(code) == 1
        session_of(viz).checks.run()
        assert codes(viz).count(code) == 1
    finally:
        viz.stop()
