"""A robot in several packages: its description, and those that start it."""

from __future__ import annotations

import ast
import json
import os
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest

from sambot_viz.checks import check
from sambot_viz.checks.around import workspace
from sambot_viz.checks.around.files import parameters
from sambot_viz.cli import main

Copied = Callable[[str], Path]

MANIFEST = """\
<package format="3">
  <name>{}</name>
  <version>0.0.0</version>
  <description>Part of a cart</description>
  <maintainer email="me@example.org">me</maintainer>
  <license>MIT</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
CMAKE = """\
cmake_minimum_required(VERSION 3.8)
project({})
find_package(ament_cmake REQUIRED)
install(DIRECTORY launch DESTINATION share/${{PROJECT_NAME}})
ament_package()
"""
ROBOT = '<robot name="{0}"><link name="{0}"/></robot>'
OPENS = """\
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    share = get_package_share_directory("{}")
    model = open(share + "/urdf/{}.urdf").read()
    return LaunchDescription(
        [
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{{"robot_description": model}}],
            )
        ]
    )
"""
INCLUDES = """\
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription


def generate_launch_description():
    share = get_package_share_directory("{0}")
    return LaunchDescription(
        [IncludeLaunchDescription(share + "/launch/{0}.launch.py")]
    )
"""
XML = """\
<launch>
  <node pkg="robot_state_publisher" exec="robot_state_publisher">
    <param name="robot_description"
           value="$(command 'xacro $(find-pkg-share {})/urdf/{}.urdf')"/>
  </node>
</launch>
"""
AMCL = "amcl:\n  ros__parameters:\n    base_frame_id: {}\n"
MODEL = "cart_description/urdf/cart.urdf.xacro"
LAUNCH = "cart_bringup/launch/display.launch.py"

ROUTES = [
    ("cart_bringup", ()),
    ("cart_description", (".",)),
    (MODEL, (".",)),
    (".", ()),
]
"""What is checked, and with which workspace; all find the same."""


@pytest.fixture
def src(copied: Copied, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A workspace with the correct cart, whose parameters are in another package."""
    description = copied("gz")
    bringup = tmp_path / "cart_bringup"
    _write(bringup, "package.xml", MANIFEST.format("cart_bringup"))
    cmake = CMAKE.format("cart_bringup").replace("launch ", "launch config ")
    _write(bringup, "CMakeLists.txt", cmake)
    for folder in ("launch", "config"):
        (description / folder).rename(bringup / folder)
    _edit(description / "CMakeLists.txt", "urdf launch rviz config world", "urdf rviz")
    _edit(description / "CMakeLists.txt", "urdf rviz", "urdf rviz world")
    launch = tmp_path / LAUNCH
    _edit(launch, 'share, "config/ekf.yaml"', 'bringup, "config/ekf.yaml"')
    _edit(launch, 'share, "config", "bridge', 'bringup, "config", "bridge')
    own = 'bringup = get_package_share_directory("cart_bringup")'
    _edit(launch, "    gz_share =", f"    {own}\n    gz_share =")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def _write(package: Path, name: str, text: str) -> None:
    (package / name).parent.mkdir(parents=True, exist_ok=True)
    (package / name).write_text(text)


def _edit(file: Path, old: str, new: str) -> None:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new, 1))


def _package(folder: Path, **files: str) -> Path:
    """Write a package with files whose paths have __ for / and _ for the last dot."""
    _write(folder, "package.xml", MANIFEST.format(folder.name))
    for name, text in files.items():
        stem, _, ending = name.replace("__", "/").rpartition("_")
        _write(folder, f"{stem}.{ending}", text)
    return folder


@pytest.mark.parametrize(("path", "given"), ROUTES)
def test_a_right_robot_in_two_packages(
    src: Path, path: str, given: tuple[str, ...]
) -> None:
    assert check(path, workspace=given) == []
    assert check(src / path, workspace=[src / folder for folder in given]) == []


@pytest.mark.parametrize(("path", "given"), ROUTES)
def test_mistakes_in_the_package_that_starts_the_robot(
    src: Path, path: str, given: tuple[str, ...]
) -> None:
    config = src / "cart_bringup" / "config"
    _edit(config / "ekf.yaml", "base_link_frame: base_link", "base_link_frame: lnk")
    _edit(config / "nav2_params.yaml", "ros__parameters", "ros_parameters")
    _edit(src / LAUNCH, "            bridge,", "            bridge")
    _edit(src / LAUNCH, "            rviz,", "            rviz")

    found = [(p.code, p.file) for p in check(path, workspace=given)]

    assert found == [
        ("parameters-key", "cart_bringup/config/nav2_params.yaml"),
        ("python-syntax", LAUNCH),
        ("frame-unknown", "cart_bringup/config/ekf.yaml"),
    ]


def test_findings_are_named_as_the_user_would_write_them(
    src: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ekf = src / "cart_bringup" / "config" / "ekf.yaml"
    _edit(ekf, "base_link_frame: base_link", "base_link_frame: lnk")
    (whole,) = check(src / "cart_bringup")
    monkeypatch.chdir(src / "cart_bringup")
    (relative,) = check(".")
    (beside,) = check(f"../{MODEL}", workspace=[".."])

    assert whole.file == str(ekf)
    assert relative.file == beside.file == "config/ekf.yaml"


def test_the_model_that_is_found_is_named(
    src: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check", "cart_bringup"]) == 0
    said = capsys.readouterr().out.splitlines()
    assert said == [
        f"model: {MODEL}, which {LAUNCH} opens",
        f"{MODEL}: no problems found",
    ]
    assert main(["check", "cart_bringup", "--format", "json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said == {
        "model": MODEL,
        "models": [{"model": MODEL, "opened_by": LAUNCH}],
        "problems": [],
    }
    assert main(["check", MODEL, "--workspace", ".", "--format", "json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["models"] == [{"model": MODEL, "opened_by": None}]


def test_each_file_is_read_and_parsed_once(
    src: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    counts: dict[str, Counter[str]] = {
        "read": Counter(),
        "python": Counter(),
        "yaml": Counter(),
    }
    read, parse = workspace.read_limited, ast.parse
    loader: Any = parameters._LOADER  # pyright: ignore[reportPrivateUsage]

    def read_once(file: Path, *rest: Any) -> bytes:
        counts["read"][str(file)] += 1
        return read(file, *rest)

    def parse_once(text: Any, *rest: Any, **named: Any) -> Any:
        counts["python"][str(text)] += 1
        return parse(text, *rest, **named)

    def load_once(text: str) -> Any:
        counts["yaml"][text] += 1
        return loader(text)

    monkeypatch.setattr(workspace, "read_limited", read_once)
    monkeypatch.setattr(ast, "parse", parse_once)
    monkeypatch.setattr(parameters, "_LOADER", load_once)
    # A misspelt name makes the rules run again on the corrected robot.
    _edit(src / MODEL, "<axis xyz", "<axs xyz")

    found = {problem.code for problem in check(".")}

    assert "element-misspelt" in found
    files = {kind: set(count.values()) for kind, count in counts.items()}
    assert files == {"read": {1}, "python": {1}, "yaml": {1}}
    assert [len(counts[kind]) for kind in ("python", "yaml")] == [1, 4]


def test_a_model_that_a_launch_file_of_another_package_opens(tmp_path: Path) -> None:
    _package(tmp_path / "a_description", urdf__a_urdf=ROBOT.format("a"))
    opens = OPENS.format("a_description", "a")
    _package(tmp_path / "a_gazebo", launch__a_gazebo_launch_py=opens)
    (tmp_path / "a_gazebo/launch/a_gazebo_launch.py").rename(
        tmp_path / "a_gazebo/launch/a_gazebo.launch.py"
    )
    start = _package(
        tmp_path / "a_start",
        launch__start_launch_py=INCLUDES.format("a_gazebo"),
        config__amcl_yaml=AMCL.format("b"),
    )
    (problem,) = check(start)
    assert problem.code == "frame-unknown"
    assert problem.file == str(start / "config" / "amcl.yaml")


def test_a_model_that_an_xml_launch_file_opens(tmp_path: Path) -> None:
    _package(tmp_path / "a_description", urdf__a_urdf=ROBOT.format("a"))
    start = _package(tmp_path / "a_start", config__amcl_yaml=AMCL.format("b"))
    _write(start, "launch/a.launch.xml", XML.format("a_description", "a"))
    assert [problem.code for problem in check(start)] == ["frame-unknown"]


def test_of_a_package_that_is_installed_only_the_model_counts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    prefix = tmp_path / "opt"
    installed = _package(
        prefix / "share" / "a_description",
        urdf__a_urdf=ROBOT.format("a"),
        config__amcl_yaml=AMCL.format("c"),
    )
    start = _package(
        tmp_path / "src" / "a_start",
        launch__a_launch_py=OPENS.format("a_description", "a"),
        config__amcl_yaml=AMCL.format("b"),
    )
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))
    files = [problem.file for problem in check(start)]
    assert files == [str(start / "config" / "amcl.yaml")]
    assert str(installed) not in str(files)


def test_with_several_models_a_shared_file_is_wrong_when_it_is_for_each(
    tmp_path: Path,
) -> None:
    for name in ("a", "b"):
        _package(tmp_path / f"{name}_description", urdf__r_urdf=ROBOT.format(name))
    start = _package(
        tmp_path / "start",
        launch__a_launch_py=OPENS.format("a_description", "r"),
        launch__b_launch_py=OPENS.format("b_description", "r"),
        config__amcl_yaml=AMCL.format("b"),
    )
    assert check(start) == check(tmp_path) == []
    # It is for another robot as well.
    assert check(tmp_path / "a_description", workspace=[tmp_path]) == []
    _write(start, "config/amcl.yaml", AMCL.format("c"))
    assert [problem.code for problem in check(start)] == ["frame-unknown"] * 2


def test_a_package_without_a_model_is_checked_without_a_robot(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    package = _package(tmp_path / "nodes", config__amcl_params_yaml=AMCL.format("x"))
    assert main(["check", str(package)]) == 0
    assert "info[package-without-model]: the package nodes" in capsys.readouterr().out
    wrong = AMCL.format("x").replace("ros__p", "ros_p")
    _write(package, "config/amcl_params.yaml", wrong)
    assert main(["check", str(package)]) == 1
    assert "error[parameters-key]" in capsys.readouterr().out
    assert main(["check", str(package), "--format", "json"]) == 1
    said = json.loads(capsys.readouterr().out)
    assert (said["model"], said["models"]) == (None, [])


def test_a_package_whose_model_is_not_certain_is_checked_when_it_can_mean_no_other(
    tmp_path: Path,
) -> None:
    home = _package(tmp_path / "a_description", urdf__a_urdf=ROBOT.format("a"))
    launch = OPENS.format("a_description", "a").replace('"/urdf/a.urdf"', "input()")
    start = _package(
        tmp_path / "start",
        launch__a_launch_py=launch,
        config__amcl_yaml=AMCL.format("b"),
    )
    assert [p.code for p in check(home, workspace=[tmp_path])] == ["frame-unknown"]
    _package(home, urdf__c_urdf=ROBOT.format("c"))
    assert check(home / "urdf" / "a.urdf", workspace=[tmp_path]) == []
    # Who gives the package itself means it.
    found = check(home / "urdf" / "a.urdf", workspace=[start])
    assert [problem.code for problem in found] == ["frame-unknown"]


def test_packages_without_a_model_are_noted_once(tmp_path: Path) -> None:
    for name in ("a_msgs", "b_msgs"):
        _package(tmp_path / name)
    (note,) = check(tmp_path)
    assert note.message.startswith("none of the 2 packages in")
    _package(tmp_path / "a_description", urdf__a_urdf=ROBOT.format("a"))
    assert check(tmp_path) == []


def test_a_folder_that_has_nothing_to_check_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check", str(tmp_path)]) == 2
    assert "no model in the folder" in capsys.readouterr().err
    (problem,) = check(tmp_path)
    assert problem.code == "model-is-folder"


@pytest.mark.parametrize("names", ["abcdefghijklm", ("a.xacro", "b")])
def test_of_models_that_are_many_or_parts_none_is_checked(
    names: Sequence[str], tmp_path: Path
) -> None:
    package = _package(tmp_path / "many")
    for name in (*names, "c"):
        file = name if "." in name else f"{name}.urdf"
        _write(package, f"urdf/{file}", ROBOT.format("a"))
    (note,) = check(package)
    assert note.code == "package-without-model"
    assert note.message.startswith("several models are in the package (urdf/a")


def test_a_few_models_of_a_package_are_each_checked(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    package = _package(tmp_path / "two", urdf__a_urdf=ROBOT.format("a"))
    _write(package, "urdf/b.urdf", ROBOT.format("b").replace("</", "<lnik/></"))
    _write(package, "config/amcl.yaml", AMCL.format("a"))
    assert main(["check", str(package)]) == 0
    assert f"model: {package / 'urdf' / 'a.urdf'}\n" in capsys.readouterr().out
    assert main(["check", str(package), "--format", "json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert [Path(each["model"]).name for each in said["models"]] == ["a.urdf", "b.urdf"]
    assert {Path(p["file"]).name for p in said["problems"]} == {"b.urdf"}
    assert check(package)[0].file == str(package / "urdf" / "b.urdf")


def test_a_file_and_its_package_find_the_same(src: Path) -> None:
    package = src / "cart_description"
    _edit(package / "rviz" / "cart.rviz", "Frame: base_link", "Frame: base")
    _write(package, "setup.py", "from setuptools import setup\nsetup(name='cart')\n")

    of_file = check(src / MODEL)

    codes = {"setup-fixed-frame", "setup-py-name"}
    assert codes <= {problem.code for problem in of_file}
    assert of_file == check(package)


def test_an_untrusted_model_leads_to_no_other_package(src: Path) -> None:
    ekf = src / "cart_bringup" / "config" / "ekf.yaml"
    _edit(ekf, "base_link_frame: base_link", "base_link_frame: lnk")
    assert check(MODEL, workspace=["."], trusted=False) == []
    assert os.path.isfile(LAUNCH)
    (note,) = check("cart_bringup", trusted=False)
    assert note.code == "package-without-model"


XACRO = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" {}</robot>'
NOT_A_ROBOT = {
    "MoveIt's description": (
        "config/a.srdf.xacro",
        XACRO.format('name="a"><group name="arm"><link name="a"/></group>'),
    ),
    "constants": ("urdf/a.xacro", XACRO.format('><xacro:include filename="b.xacro"/>')),
    "scenery": (
        "models/maze/model.sdf",
        "<sdf version='1.9'><model name='maze'><pose>1 0 0 0 0 0</pose><link name='a'/>"
        "<link name='b'/><static>true</static></model></sdf>",
    ),
}


@pytest.mark.parametrize("kind", NOT_A_ROBOT)
def test_what_only_looks_like_a_robot_is_not_the_model_of_a_package(
    kind: str, tmp_path: Path
) -> None:
    file, text = NOT_A_ROBOT[kind]
    package = _package(tmp_path / "a_description")
    _write(package, file, text)
    colours = (
        '><xacro:property name="x" value="1"/><xacro:macro name="m"><link name="l"/>'
    )
    _write(package, "urdf/b.xacro", XACRO.format(f"{colours}</xacro:macro>"))
    (note,) = check(package)
    assert note.code == "package-without-model"
    _write(package, "urdf/c.urdf", ROBOT.format("c"))
    assert check(package) == []


COMMAND = """\
from launch.actions import DeclareLaunchArgument
from launch.substitutions import Command, LaunchConfiguration


def generate_launch_description():
    size = DeclareLaunchArgument("size", choices=["large", "small"])
    Command(["xacro a.urdf.xacro name:=", "a", " size:=", LaunchConfiguration("size")])
    return [size]
"""
MAPPINGS = """\
from xacro import process_file


def generate_launch_description():
    return [process_file("a.urdf.xacro", mappings={"name": "a", "size": "large"})]
"""


BRANCHES = """\
from xacro import parse, process_doc


def generate_launch_description():
    if input() == "1":
        size = "large"
    else:
        size = "small"
    doc = parse(open("a.urdf.xacro"))
    process_doc(doc, mappings={"name": "a", "size": size})
    return [doc]
"""


@pytest.mark.parametrize("launch", [COMMAND, MAPPINGS, BRANCHES])
def test_a_model_gets_the_arguments_that_launch_files_give(
    launch: str, tmp_path: Path
) -> None:
    package = _package(tmp_path / "a_description", launch__a_launch_py="")
    model = XACRO.format(
        'name="$(arg name)"><xacro:arg name="name" default="b"/>'
        '<xacro:arg name="size" default=""/>'
        '<xacro:property name="sizes" value="${dict(large=1)}"/>'
        "<link name=\"${sizes['$(arg size)']}\"/>"
    )
    _write(package, "urdf/a.urdf.xacro", model)
    assert "error" in {p.severity for p in check(package)}
    _write(package, "launch/a.launch.py", launch)
    assert [p for p in check(package) if p.code.startswith("xacro")] == []


@pytest.mark.parametrize(
    ("name", "found"), [("launch/sim.py", 0), ("launch/a/sim.py", 0), ("sim.py", 1)]
)
def test_a_launch_file_may_have_any_name_in_its_folder(
    tmp_path: Path, name: str, found: int
) -> None:
    package = _package(tmp_path / "a_description", launch__a_launch_py="")
    model = XACRO.format('name="a"><link name="$(arg name)"/>')
    _write(package, "urdf/a.urdf.xacro", model)
    _write(package, name, MAPPINGS)
    codes = [p.code for p in check(package)]
    assert codes.count("xacro-argument-missing") == found


def test_a_model_that_is_whole_only_with_given_arguments_is_right(
    tmp_path: Path,
) -> None:
    package = _package(tmp_path / "a_description", launch__a_launch_py="")
    part = '<link name="b"/>\n<joint name="j" type="fixed"><parent link="a"/>'
    part += '<child link="b"/></joint>'
    model = XACRO.format(
        'name="a"><xacro:arg name="size" default=""/><link name="a"/>'
        + part.replace("<joint", "<xacro:if value=\"${'$(arg size)' != ''}\"><joint")
        + "</xacro:if>"
    )
    _write(package, "urdf/a.urdf.xacro", model)
    assert "root-not-unique" in {p.code for p in check(package)}
    _write(package, "launch/a.launch.py", BRANCHES)
    assert "root-not-unique" not in {p.code for p in check(package)}


def test_an_argument_whose_value_only_the_launch_file_knows_is_none_that_is_missing(
    tmp_path: Path,
) -> None:
    command = COMMAND.replace('"a", " size', 'find_name(), " size')
    package = _package(tmp_path / "a_description", launch__a_launch_py="")
    model = XACRO.format('name="a"><link name="l$(arg name)"/>')
    _write(package, "urdf/a.urdf.xacro", model)
    assert "xacro-argument-missing" in {p.code for p in check(package)}
    _write(package, "launch/a.launch.py", command)
    assert [p for p in check(package) if p.code.startswith("xacro")] == []


@pytest.mark.parametrize(
    ("value", "is_found"),
    [
        ("LaunchConfiguration('base', default='chassis')", False),
        ("LaunchConfiguration('base')", True),
        ("'base_link'", True),
    ],
)
def test_the_model_that_runs_has_the_arguments_of_its_launch_file(
    value: str, is_found: bool, tmp_path: Path
) -> None:
    launch = f"""\
from launch import LaunchDescription
from launch.substitutions import Command, FindPackageShare, LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    model = [FindPackageShare('a_description'), '/urdf/a.urdf.xacro']
    command = Command(['xacro ', *model, ' base:=', {value}])
    return LaunchDescription([
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             parameters=[{{'robot_description': command}}]),
    ])
"""
    package = _package(tmp_path / "a_description", launch__a_launch_py=launch)
    model = '<xacro:arg name="base" default="base_link"/><link name="$(arg base)"/>'
    _write(package, "urdf/a.urdf.xacro", XACRO.format(f'name="a">{model}'))
    config = "Visualization Manager: {Global Options: {Fixed Frame: chassis}}\n"
    _write(package, "rviz/a.rviz", config)
    codes = {p.code for p in check(package)}
    assert ("setup-fixed-frame" in codes) is is_found


STARTING = """\
from launch import LaunchDescription
from launch.substitutions import Command, FindPackageShare
from launch_ros.actions import Node


def generate_launch_description():
    model = [FindPackageShare('a_description'), '/urdf/a.urdf.xacro']
    command = Command(['xacro ', *model, {}])
    return LaunchDescription([
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             parameters=[{{'robot_description': command}}]),
    ])
"""
VARIED = """\
name="a">
<xacro:arg name="sim" default="false"/>
<link name="base_link"/>
<xacro:if value="$(arg sim)">
<link name="lidar"/>
<joint name="j" type="fixed"><parent link="base_link"/><child link="{}"/></joint>
</xacro:if>"""


@pytest.mark.parametrize(
    ("child", "given", "found"),
    [
        ("lidar", "' sim:=', 'true'", []),
        ("lider", "' sim:=', 'false'", []),
        ("lider", "' sim:=', unknown", []),
        ("lider", "' sim:=', 'true'", ["joint-child-unknown"]),
    ],
)
def test_each_variant_of_a_model_that_launch_files_start_is_checked(
    child: str, given: str, found: list[str], tmp_path: Path
) -> None:
    package = _package(
        tmp_path / "a_description", launch__a_launch_py=STARTING.format("")
    )
    _write(package, "launch/b.launch.py", STARTING.format(given))
    _write(package, "urdf/a.urdf.xacro", XACRO.format(VARIED.format(child)))

    problems = [p for p in check(package) if p.code.startswith("joint-")]

    assert [problem.code for problem in problems] == found
    for problem in problems:
        assert problem.message.startswith("with sim:=true, as a launch file has it: ")
        assert problem.edits
    asked = check(package, xacro_args={"sim": "false"})
    assert not any(p.code.startswith("joint-") for p in asked)


@pytest.mark.parametrize(("given", "found"), [("' kind:=', 'a'", False), ("''", True)])
def test_the_root_tag_has_only_the_arguments_of_the_launch_file(
    given: str, found: bool, tmp_path: Path
) -> None:
    """Xacro evaluates it before the default values in it."""
    launch = STARTING.format(given)
    package = _package(tmp_path / "a_description", launch__a_launch_py=launch)
    model = '<xacro:arg name="kind" default="a"/><link name="base_link"/>'
    _write(package, "urdf/a.urdf.xacro", XACRO.format(f'name="$(arg kind)">{model}'))

    codes = {problem.code for problem in check(package)}

    assert ("xacro-arg-after-use" in codes) is found
