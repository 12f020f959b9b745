import os
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import pytest

from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.model import Robot, load_robot
from sambot_viz.robot.parts import MeshFile


def errors(model: Path | str) -> list[Problem]:
    with pytest.raises(RobotError) as caught:
        load_robot(model)
    return [p for p in caught.value.problems if p.severity == "error"]


def test_the_tutorials_xacro_and_its_urdf_are_the_same_robot(shared: Path):
    seed = shared / "data" / "seed"
    xacro = load_robot(seed / "sam_bot.urdf.xacro")
    urdf = load_robot(seed / "sam_bot.urdf")

    assert xacro == urdf
    assert (xacro.name, xacro.root, len(xacro.links)) == ("sam_bot", "base_link", 5)
    assert xacro.problems == ()


def test_the_early_closing_tag_is_named_with_its_fix(shared: Path):
    found = errors(shared / "data" / "seed" / "robot_closed_too_early.urdf.xacro")
    assert len(found) == 1
    assert found[0].line == 4
    assert "line 4" in found[0].message
    assert "move </robot> from line 4" in found[0].hint


def test_every_urdf_error_of_the_collection_is_reported_on_its_line(shared: Path):
    import yaml

    folder = shared / "data" / "bad-models"
    index = yaml.safe_load((folder / "index.yaml").read_text("utf-8"))
    # These three are rules of sambot_viz.checks: ROS has nothing against them.
    rules = {"limit-in-degrees", "rpy-in-degrees", "root-link-with-inertia"}
    missed: list[str] = []
    for entry in index["models"]:
        name = entry["file"]
        if entry["stage"] != "urdf" or name.partition(".")[0] in rules:
            continue
        if name.endswith(".sdf"):
            # An error for tools that know URDF only; here it is a robot.
            continue
        try:
            problems = load_robot(folder / name).problems
        except RobotError as error:
            problems = error.problems
        near = [p for p in problems if abs((p.line or -9) - entry["line"]) <= 1]
        # joint_state_publisher leaves the joint out; it does not refuse the model.
        mild = name == "limit-without-lower-upper.urdf"
        severity = "warning" if mild else entry["severity"]
        if not any(p.severity == severity and p.hint for p in near):
            missed.append(name)
    assert missed == []


def test_the_right_models_of_the_collection_have_no_errors(shared: Path):
    folder = shared / "data" / "bad-models"
    for name in ("_good.urdf", "_good.urdf.xacro"):
        assert load_robot(folder / name).problems == ()


def test_a_model_may_be_text():
    robot = load_robot('\ufeff<robot name="r"><link name="a"/></robot>')
    assert (robot.root, robot.files) == ("a", ())


def test_a_folder_with_korean_letters_and_blanks_works(tmp_path: Path):
    folder = tmp_path / "내 로봇 1"
    folder.mkdir()
    model = folder / "모델.urdf"
    model.write_text(
        '<?xml version="1.0"?>\n<!-- 바퀴 두 개 -->\n<robot name="로봇">\n'
        '<link name="몸통"><visual><geometry><mesh filename="몸통.stl"/></geometry>'
        "</visual></link></robot>",
        "utf-8",
    )
    (folder / "몸통.stl").write_text("solid")
    robot = load_robot(model)
    mesh = robot.links["몸통"].visuals[0].geometry

    assert isinstance(mesh, MeshFile)
    assert mesh.path == folder / "몸통.stl"
    assert robot.files == (model,)
    assert robot.problems == ()


def test_the_same_missing_mesh_is_reported_once():
    mesh = '<geometry><mesh filename="package://none/a.stl"/></geometry>'
    shapes = f"<visual>{mesh}</visual><collision>{mesh}</collision>"
    robot = load_robot(f'<robot name="r"><link name="a">{shapes}</link></robot>')
    assert [p.code for p in robot.problems] == ["mesh-not-found"]
    assert "the package none is not known" in robot.problems[0].message
    assert "--package-path" in robot.problems[0].hint


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"  \n",
        b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n",
        b"PK\x03\x04rest",
        b"\x89PNG\r\n\x1a\n\x00\x00",
        b"solid cube\nfacet normal 0 0 1\n",
        b"\xff\xfe<\x00r\x00",
        b"<robot name='r'><link name='a'/></robot",
        "<robot name='r'><link name='ä'/></robot>".encode("latin-1"),
    ],
)
def test_a_file_that_is_not_a_model_is_one_clear_error(content: bytes, tmp_path: Path):
    model = tmp_path / "m.urdf"
    model.write_bytes(content)
    found = errors(model)
    assert len(found) == 1
    assert found[0].file == str(model)
    assert found[0].hint


def test_a_missing_file_is_reported_with_similar_names(tmp_path: Path):
    (tmp_path / "sam_bot.urdf").write_text("<robot/>")
    problem = errors(tmp_path / "sambot.urdf")[0]
    assert problem.code == "model-not-found"
    assert "did you mean 'sam_bot.urdf'?" in problem.hint


def test_a_folder_is_reported_with_the_models_in_it(tmp_path: Path):
    (tmp_path / "urdf").mkdir()
    (tmp_path / "urdf" / "a.urdf").write_text("<robot/>")
    problem = errors(tmp_path)[0]
    assert problem.code == "model-is-folder"
    assert "a.urdf" in problem.hint


def test_a_robot_of_any_encoding_is_converted_to_yourdfpy(tmp_path: Path):
    text = '<?xml version="1.0" encoding="euc-kr"?><robot name="로봇"><link name="a"/>'
    model = tmp_path / "m.urdf"
    model.write_bytes(f"{text}</robot>".encode("euc-kr"))
    assert load_robot(model).to_yourdfpy().robot.name == "로봇"


PIECE = """\
<robot>
  <xacro:camera_mount prefix="front"/>
  <joint name="j" type="fixed"><parent link="mount"/><child link="camera"/></joint>
  <joint name="k" type="fixed"><parent link="camera"/><child link="lens"/></joint>
  <joint name="l" type="fixed"><parent link="beam"/><child link="laser"/></joint>
</robot>
"""


def test_a_urdf_that_does_not_declare_xacro_is_read_as_ros_reads_it(tmp_path: Path):
    model = tmp_path / "piece.urdf"
    model.write_text(PIECE)
    robot = load_robot(model)
    assert (robot.root, list(robot.links)) == ("mount", ["mount", "camera", "lens"])
    reported = {(p.severity, p.code, p.line) for p in robot.problems}
    assert ("warning", "xacro-prefix-undeclared", 2) in reported
    assert ("warning", "robot-without-name", 1) in reported
    assert ("warning", "joint-child-elsewhere", 4) in reported
    assert ("warning", "root-not-unique", 1) in reported
    assert {severity for severity, _, _ in reported} == {"warning"}


def test_a_xacro_file_that_does_not_declare_xacro_is_an_error(tmp_path: Path):
    model = tmp_path / "piece.urdf.xacro"
    model.write_text(PIECE)
    assert [p.code for p in errors(model)] == ["xml-prefix-undeclared"]


def test_a_named_robot_with_undefined_links_is_still_refused(tmp_path: Path):
    model = tmp_path / "robot.urdf"
    model.write_text(PIECE.replace("<robot>", '<robot name="r">'))
    assert {p.code for p in errors(model)} == {"robot-without-links"}


def test_a_pipe_is_read_once_and_works(tmp_path: Path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    text = '<robot name="r" xmlns:xacro="x"><xacro:arg name="a" default="1"/>'
    writer = Thread(target=pipe.write_text, args=(text + '<link name="l"/></robot>',))
    writer.start()
    assert load_robot(pipe).root == "l"
    writer.join()


def test_a_device_is_refused_without_reading_it():
    assert errors(Path("/dev/zero"))[0].code == "model-unreadable"


def test_a_home_folder_that_does_not_exist_is_a_missing_file():
    assert errors("~no-such-user/robot.urdf")[0].code == "model-not-found"


@pytest.mark.parametrize("name", ["undefined", "punycode", "rot13", "idna", "base64"])
def test_an_encoding_that_no_xml_file_has_is_a_clear_error(name: str, tmp_path: Path):
    model = tmp_path / "r.urdf"
    head = f'<?xml version="1.0" encoding="{name}"?>'.encode()
    model.write_bytes(head + b'<robot name="\xff\xfe"><link name="a"/></robot>')
    (problem,) = errors(model)
    assert (problem.code, problem.line) == ("xml-encoding", 1)


def test_arguments_only_in_file_names_are_missing_files_as_for_ros(tmp_path: Path):
    model = tmp_path / "tool.urdf"
    model.write_text(
        '<robot name="tool">\n<link name="a"><visual><geometry>\n'
        '<mesh filename="$(arg folder)/body.stl"/></geometry></visual>\n'
        '<visual><geometry><box size="1 1 1"/></geometry></visual></link></robot>'
    )
    robot = load_robot(model)
    assert len(robot.links["a"].visuals) == 2
    reported = {p.code: (p.severity, p.line) for p in robot.problems}
    assert reported["xacro-argument-missing"] == ("warning", 3)
    assert "mesh-not-found" in reported
    (tmp_path / "body.stl").write_text("solid")
    given = load_robot(model, xacro_args={"folder": str(tmp_path)})
    assert [p.code for p in given.problems] == ["xacro-in-urdf"]


@pytest.mark.parametrize("name", ["sam_bot.urdf.xacro", "mbot.urdf.xacro"])
def test_a_robot_is_read_from_yourdfpy(name: str, repository: Path):
    robot = load_robot(repository / "assets" / name)
    back = Robot.from_yourdfpy(robot.to_yourdfpy())
    assert (back.name, back.root, list(back.links)) == (
        robot.name,
        robot.root,
        list(robot.links),
    )
    assert set(back.joints) == set(robot.joints)
    poses, others = robot.forward_kinematics(), back.forward_kinematics()
    assert all(np.allclose(poses[link], others[link]) for link in poses)
    for link, other in zip(robot.links.values(), back.links.values(), strict=True):
        assert [s.geometry for s in link.visuals] == [s.geometry for s in other.visuals]


def test_meshes_of_yourdfpy_are_found_where_yourdfpy_finds_them(tmp_path: Path):
    import yourdfpy  # pyright: ignore[reportMissingTypeStubs]

    (tmp_path / "a.stl").write_text("solid")
    model = tmp_path / "m.urdf"
    model.write_text(
        '<robot name="r"><link name="a"><visual><geometry>'
        '<mesh filename="a.stl"/></geometry></visual></link></robot>'
    )
    untyped: Any = yourdfpy
    urdf = untyped.URDF.load(str(model), load_meshes=False, build_scene_graph=False)
    mesh = Robot.from_yourdfpy(urdf).links["a"].visuals[0].geometry
    assert isinstance(mesh, MeshFile)
    assert mesh.path == tmp_path / "a.stl"


STRAY = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<link name="a"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
<xacro:camera name="front" size="${camera_size}"/>
</robot>
"""


def test_a_finished_urdf_with_a_call_that_was_left_in_it_is_drawn(tmp_path: Path):
    model = tmp_path / "r.urdf"
    model.write_text(STRAY)

    robot = load_robot(model)

    (problem,) = robot.problems
    assert list(robot.links) == ["a"]
    assert (problem.severity, problem.code, problem.line) == (
        "warning",
        "xacro-left-over",
        3,
    )
    assert load_robot(STRAY).links.keys() == robot.links.keys()
    model.write_text("\n".join(STRAY.splitlines()[:2]) + "</robot>")
    assert load_robot(model).problems == ()


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("r.urdf.xacro", "", ""),
        ("r.urdf", "xacro:camera name", "xacro:inculde filename"),
        ("r.urdf", 'size="1 1 1"', 'size="${x} 1 1"'),
        ("r.urdf", "<link", '<xacro:arg name="a" default="b"/><link'),
    ],
)
def test_a_call_of_an_unknown_macro_is_an_error_where_xacro_is_needed(
    tmp_path: Path, name: str, old: str, new: str
):
    model = tmp_path / name
    model.write_text(STRAY.replace(old, new, 1))

    with pytest.raises(RobotError):
        load_robot(model)
