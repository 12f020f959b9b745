"""Sensors with elements and words that Gazebo does not know."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits

SENSOR = """<sensor name="cam" type="camera">
<update_rate>10</update_rate>
<topic>image</topic>
<gz_frame_id>a</gz_frame_id>
<camera><horizontal_fov>1</horizontal_fov><image><width>4</width><height>4</height>
<format>R8G8B8</format></image></camera>
</sensor>"""
URDF = '<robot name="r">\n<link name="a"/>\n<gazebo reference="a">{}</gazebo>\n</robot>'
SDF = '<sdf version="1.8"><model name="r">\n<link name="a">{}</link>\n</model></sdf>'


@pytest.mark.parametrize("model", [URDF, SDF], ids=["URDF", "SDF"])
@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("update_rate", "updateRate"),
        ("topic", "topicName"),
        ("gz_frame_id", "gzFrameId"),
        ("R8G8B8", "RGB8"),
        ("R8G8B8", "r8g8b8"),
    ],
)
def test_what_gazebo_does_not_know_in_a_sensor_has_the_right_word(
    right: str, wrong: str, model: str, tmp_path: Path
) -> None:
    text = model.format(SENSOR)
    file = tmp_path / ("r.sdf" if model is SDF else "r.urdf")
    file.write_text(text.replace(right, wrong), "utf-8")
    (problem,) = [one for one in check(file) if one.severity != "info"]
    assert apply_edits(problem.edits, text.replace(right, wrong)) == text
    file.write_text(text, "utf-8")
    assert all(one.severity == "info" for one in check(file))


@pytest.mark.parametrize("model", [URDF, SDF], ids=["URDF", "SDF"])
@pytest.mark.parametrize("element", ["topic", "update_rate", "gz_frame_id"])
def test_an_element_of_a_sensor_moves_out_of_another_one_there(
    element: str, model: str, tmp_path: Path
) -> None:
    lines = model.format(SENSOR).splitlines(keepends=True)
    at = next(n for n, line in enumerate(lines) if line.startswith(f"<{element}>"))
    camera = next(n for n, line in enumerate(lines) if line.startswith("<camera>"))
    line = lines.pop(at)
    text = "".join([*lines[:camera], "\n", *lines[camera:]])
    file = tmp_path / ("r.sdf" if model is SDF else "r.urdf")
    wrong = text.replace("<camera>", f"<camera>\n{line}")
    file.write_text(wrong, "utf-8")
    (problem,) = [one for one in check(file) if one.severity != "info"]
    assert problem.code == "element-misplaced"
    file.write_text(apply_edits(problem.edits, wrong), "utf-8")
    assert all(one.severity == "info" for one in check(file))


def test_a_sensor_in_a_joint_belongs_into_the_link_of_the_joint(tmp_path: Path) -> None:
    imu, torque = (
        f'<sensor name="s" type="{kind}"/>' for kind in ("imu", "force_torque")
    )
    text = (
        '<sdf version="1.8"><model name="r"><link name="a"/><link name="b"/>'
        '<joint name="j" type="fixed"><parent>a</parent><child>b</child>{}</joint>'
        "</model></sdf>"
    )
    file = tmp_path / "r.sdf"
    file.write_text(text.format(torque), "utf-8")
    assert all(one.severity == "info" for one in check(file))
    file.write_text(text.format(imu), "utf-8")
    (problem,) = [one for one in check(file) if one.severity != "info"]
    assert problem.code == "gazebo-sensor"
    assert '<link name="b">' in problem.hint


@pytest.mark.parametrize("model", [URDF, SDF], ids=["URDF", "SDF"])
@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ('name="cam" type="camera"', 'type="cam" name="camera"'),
        ("<stddev>0.1</stddev>", "<stddev>-0.1</stddev>"),
    ],
)
def test_a_sensor_is_as_it_was_meant(
    right: str, wrong: str, model: str, tmp_path: Path
) -> None:
    noise = "<noise><type>gaussian</type><stddev>0.1</stddev></noise></camera>"
    text = model.format(SENSOR.replace("</camera>", noise))
    file = tmp_path / ("r.sdf" if model is SDF else "r.urdf")
    written = text.replace(right, wrong)
    file.write_text(written, "utf-8")
    (problem,) = [one for one in check(file) if one.severity != "info"]
    better = 'type="camera" name="cam"' if "type" in wrong else right
    assert apply_edits(problem.edits, written) == text.replace(right, better)


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("muu2", "mu2"),
        ("Material", "material"),
        ("selfCollid", "selfCollide"),
        ("my_own", None),
        ("initial_joint_position", None),
    ],
)
def test_an_element_of_gazebo_has_the_right_letters(
    wrong: str, right: str | None, tmp_path: Path
) -> None:
    file, text = tmp_path / "r.urdf", URDF.format(f"<{wrong}>1</{wrong}>")
    file.write_text(text, "utf-8")
    found = [one for one in check(file) if one.severity != "info"]
    better = [apply_edits(problem.edits, text) for problem in found]
    assert better == ([text.replace(wrong, right)] if right else [])


def test_a_joint_has_its_type_and_name_exchanged_again(tmp_path: Path) -> None:
    file = tmp_path / "r.urdf"
    text = (
        '<robot name="r">\n<link name="a"/>\n<link name="b"/>\n'
        '<joint type="j" name="fixed"><parent link="a"/><child link="b"/></joint>\n'
        "</robot>"
    )
    file.write_text(text, "utf-8")
    (problem,) = check(file)
    right = 'type="fixed" name="j"'
    better = text.replace('type="j" name="fixed"', right)
    assert apply_edits(problem.edits, text) == better


def test_a_link_and_the_joint_get_the_name_that_more_elements_use(
    tmp_path: Path,
) -> None:
    text = (
        '<robot name="r">\n<link name="base"/>\n<link name="imu"/>\n'
        '<joint name="j" type="fixed">\n<parent link="base"/>\n'
        '<child link="imu_link"/>\n</joint>\n{}\n</robot>'
    )
    file = tmp_path / "r.urdf"
    for more, wrong, right in (
        ("", 'link="imu_link"', 'link="imu"'),
        ('<gazebo reference="imu_link"/>', 'name="imu"', 'name="imu_link"'),
    ):
        written = text.format(more)
        file.write_text(written, "utf-8")
        (problem,) = check(file)
        assert "'imu', on line 3" in problem.message
        assert apply_edits(problem.edits, written) == written.replace(wrong, right)


def test_a_name_without_its_dollar_is_named_where_it_is(tmp_path: Path) -> None:
    text = (
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        '<xacro:macro name="part" params="name">\n<link name="{name}_link"/>\n'
        '<joint name="${name}_joint" type="fixed"><parent link="base"/>'
        '<child link="${name}_link"/></joint>\n</xacro:macro>\n'
        '<link name="base"/>\n<xacro:part name="arm"/>\n</robot>'
    )
    file = tmp_path / "r.urdf.xacro"
    file.write_text(text, "utf-8")
    (problem,) = check(file)
    assert problem.line == 3
    right = text.replace('"{name}', '"${name}')
    assert apply_edits(problem.edits, text) == right


@pytest.mark.parametrize("wrong", ["libgazebo_ros_diff_drive", "libgazebo_ros_camera"])
def test_a_plugin_of_gazebo_among_those_of_classic_is_not_made_one_of_gazebo(
    wrong: str, tmp_path: Path
) -> None:
    inside = "".join(
        f'<plugin name="{name}" filename="{name}.so"><wheel_diameter>1'
        "</wheel_diameter></plugin>\n"
        for name in ("libgazebo_ros_diff_drive", "libgazebo_ros_camera")
    )
    text = f'<robot name="r"><link name="a"/><gazebo>\n{inside}</gazebo></robot>'
    file = tmp_path / "r.urdf"
    file.write_text(text.replace(f"{wrong}.so", "gz-sim-diff-drive-system"), "utf-8")
    found = [one for one in check(file) if one.severity != "info"]
    assert {problem.code for problem in found} == {"gazebo-generation"}
    assert not any(problem.edits for problem in found)


def test_exchanged_limits_of_a_camera_are_one_finding(tmp_path: Path) -> None:
    clip = "<clip><near>{}</near><far>{}</far></clip></camera>"
    wrong = clip.format("0.2", "0.05")
    text = URDF.format(SENSOR.replace("</camera>", wrong))
    file = tmp_path / "r.urdf"
    file.write_text(text, "utf-8")
    (problem,) = [p for p in check(file) if p.severity != "info"]
    assert problem.code == "gazebo-sensor"
    right = text.replace(wrong, clip.format("0.05", "0.2"))
    assert apply_edits(problem.edits, text) == right


def test_the_joint_of_a_mimic_that_does_not_exist_is_written_by_its_edit(
    tmp_path: Path,
) -> None:
    joint = (
        '<joint name="{0}_joint" type="revolute"><parent>base</parent>'
        "<child>{0}</child><axis><xyz>1 0 0</xyz>{1}</axis></joint>"
    )
    mimic = '<mimic joint="{}"><multiplier>1</multiplier></mimic>'
    links = "".join(f'<link name="{n}"/>' for n in ("base", "finger_l", "finger_r"))
    text = (
        f'<sdf version="1.11"><model name="r">{links}'
        f"{joint.format('finger_l', '')}"
        f"{joint.format('finger_r', mimic.format('finger_left_joint'))}</model></sdf>"
    )
    file = tmp_path / "r.sdf"
    file.write_text(text, "utf-8")
    (problem,) = (p for p in check(file) if p.code == "mimic-joint-unknown")
    right = text.replace("finger_left_joint", "finger_l_joint")
    assert apply_edits(problem.edits, text) == right


OPTICAL = (
    '<robot name="r"><link name="camera_link"/><link name="{0}"/>\n'
    '<joint name="j" type="fixed"><parent link="camera_link"/><child link="{0}"/>\n'
    '<origin rpy="{1}"/></joint>\n'
    '<gazebo reference="camera_link"><sensor name="s" type="depth_camera">\n'
    "<gz_frame_id>{0}</gz_frame_id></sensor></gazebo></robot>"
)


@pytest.mark.parametrize("frame", ["camera_optical", "camera_depth_frame"])
@pytest.mark.parametrize("rpy", ["-1.5708 -1.5708 0", "0 -1.57 -1.57", "1.57 0 -1.57"])
def test_an_optical_frame_looks_forward(frame: str, rpy: str, tmp_path: Path) -> None:
    right = OPTICAL.format(frame, "-1.5708 0 -1.5708")
    file = tmp_path / "r.urdf"
    file.write_text(OPTICAL.format(frame, rpy), "utf-8")
    (problem,) = [one for one in check(file) if one.severity != "info"]
    assert (problem.code, problem.line) == ("optical-frame", 3)
    assert apply_edits(problem.edits, file.read_text("utf-8")) == right
    for fine in ("-1.5708 0 -1.5708", "0 0 0", "0 3.1416 1.5708", "0 0 1.5708"):
        file.write_text(OPTICAL.format(frame, fine), "utf-8")
        assert all(one.severity == "info" for one in check(file))
