"""A file that nothing can read is found with its line, its cause and its fix."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
import yaml

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits
from sambot_viz.errors import Problem

MODEL = "urdf/cart.urdf.xacro"
LAUNCH = "launch/display.launch.py"
EKF = "config/ekf.yaml"
NAV2 = "config/nav2_params.yaml"
BRIDGE = "config/bridge_config.yaml"

Copied = Callable[[str], Path]


def found(package: Path) -> list[Problem]:
    return check(package / MODEL)


def edit(file: Path, old: str, new: str) -> None:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new, 1))


@pytest.mark.parametrize(
    ("file", "right", "wrong", "line", "cause", "hint"),
    [
        (
            EKF,
            "frequency: 30.0",
            "frequency 30.0",
            3,
            "no colon after frequency",
            "write frequency: 30.0",
        ),
        (
            EKF,
            "two_d_mode: false",
            "two_d_mode:false",
            4,
            "no blank after the colon of two_d_mode",
            "write two_d_mode: false",
        ),
        (EKF, "    publish_tf", "\tpublish_tf", 5, "a tab", "write blanks"),
        (EKF, "    two_d_mode", "     two_d_mode", 4, "indentation", "write 4 blanks"),
        (EKF, "    two_d_mode", "   two_d_mode", 4, "indentation", "write 4 blanks"),
        (EKF, "    imu0: ", "imu0: ", 18, "indentation", "write 4 blanks"),
        (
            NAV2,
            "scan_topic: scan",
            'scan_topic: scan\n    critics:\n      [\n       "A"\n       "B"\n      ]',
            10,
            "a comma is missing",
            "write a comma",
        ),
        (
            EKF,
            "false, false, false]",
            "false, false, false",
            17,
            "the bracket ] is missing",
            "add ]",
        ),
        (
            BRIDGE,
            'gz_topic_name: "/clock"',
            'gz_topic_name: "/clock',
            3,
            "not closed",
            'write "/clock"',
        ),
        (
            BRIDGE,
            'gz_type_name: "gz.msgs.LaserScan"',
            'gz_type_name: "gz.msgs.LaserScan',
            35,
            "not closed",
            'write "gz.msgs.LaserScan"',
        ),
        (
            NAV2,
            "scan_topic: scan",
            "scan_topic scan",
            7,
            "no colon",
            "scan_topic: scan",
        ),
    ],
)
def test_a_parameter_file_that_is_no_yaml(
    copied: Copied,
    file: str,
    right: str,
    wrong: str,
    line: int,
    cause: str,
    hint: str,
) -> None:
    package = copied("gz")
    edit(package / file, right, wrong)
    (problem,) = found(package)
    assert (problem.code, problem.severity) == ("parameters-yaml", "error")
    assert (problem.file, problem.line) == (str(package / file), line)
    assert cause in problem.message
    assert hint in problem.hint
    if file != NAV2:
        assert "display.launch.py line" in problem.message


@pytest.mark.parametrize(
    ("right", "wrong", "hint"),
    [
        ("    frequency: 30.0", "    frequency:30.0", "write frequency: 30.0"),
        ("    two_d_mode", "   two_d_mode", "write 4 blanks before it"),
        ("    world_frame", "     world_frame", "write 4 blanks before it"),
    ],
)
def test_comments_between_the_lines_hide_nothing(
    copied: Copied, right: str, wrong: str, hint: str
) -> None:
    package = copied("gz")
    # The guide's own file has its comments at the margin.
    around = "\n\n# What the next line is for.\n# It has a default.\n# 1.\n# 2.\n"
    text = (package / EKF).read_text().replace("\n    ", f"{around}    ")
    (package / EKF).write_text(text)
    edit(package / EKF, right, wrong)
    (problem,) = found(package)
    assert problem.line == text[: text.index(right)].count("\n") + 1
    assert problem.hint == hint


def test_a_file_that_nothing_names_is_left_alone(copied: Copied) -> None:
    package = copied("gz")
    (package / "config" / "notes.yaml").write_text("a: b: c\n")
    assert found(package) == []
    (package / "config" / "ekf_template.yaml").write_text("{% if a %}\n\tb: c: d\n")
    assert found(package) == []


@pytest.mark.parametrize("wrong", ["ros_parameters", "ros__parameter", "ros__params"])
def test_a_misspelt_ros_parameters(copied: Copied, wrong: str) -> None:
    package = copied("gz")
    edit(package / EKF, "ros__parameters:", f"{wrong}:")
    (problem,) = found(package)
    assert (problem.code, problem.severity) == ("parameters-key", "error")
    assert (problem.file, problem.line) == (str(package / EKF), 2)
    assert wrong in problem.message
    assert "display.launch.py line 40" in problem.message
    assert problem.hint == "write ros__parameters"


@pytest.mark.parametrize("indent", ["  ", "    "])
def test_values_that_are_not_below_ros_parameters(copied: Copied, indent: str) -> None:
    package = copied("gz")
    right = (package / EKF).read_text()
    text = right.replace("  ros__parameters:\n", "").replace("\n    ", f"\n{indent}")
    (package / EKF).write_text(text)
    (problem,) = found(package)
    assert (problem.code, problem.severity) == ("parameters-key", "error")
    assert (problem.file, problem.line) == (str(package / EKF), 1)
    assert "display.launch.py line 40" in problem.message
    mended = apply_edits(problem.edits, text)
    assert yaml.safe_load(mended) == yaml.safe_load(right)
    (package / EKF).write_text(mended)
    assert found(package) == []


def test_values_in_one_line_are_not_moved(copied: Copied) -> None:
    package = copied("gz")
    (package / EKF).write_text("ekf_filter_node: {frequency: 30.0}\n")
    problem = next(p for p in found(package) if p.code == "parameters-key")
    assert problem.line == 1 and problem.edits == ()


def test_a_key_below_ros_parameters_is_a_parameter(copied: Copied) -> None:
    package = copied("gz")
    edit(package / EKF, "    publish_tf", "    ros_parameters: {a: 1}\n    publish_tf")
    assert found(package) == []


@pytest.mark.parametrize(
    ("right", "wrong", "line", "cause"),
    [
        (
            'executable="robot_state_publisher",',
            'executable="robot_state_publisher"',
            29,
            "a comma is missing",
        ),
        ("            bridge,", "            bridge", 64, "a comma is missing"),
        (
            "GzServer(world_sdf_file=world),",
            "GzServer(world_sdf_file=world)",
            63,
            "a comma is missing",
        ),
        ('"world": "room",', '"world": "room"', 54, "a comma is missing"),
        ("        ]\n    )", "        ]\n", 59, "never closed"),
        ('"cart.urdf.xacro")', '"cart.urdf.xacro)', 21, "a quotation mark is missing"),
        ("description():", "description()", 18, "the : at the end is missing"),
        ("publisher = Node(", "publisher = Node", 27, "the ( after Node is missing"),
        ("    model = os", "      model = os", 21, "other blanks before it"),
    ],
)
def test_a_launch_file_that_is_no_python(
    copied: Copied, right: str, wrong: str, line: int, cause: str
) -> None:
    package = copied("gz")
    edit(package / LAUNCH, right, wrong)
    problem = next(p for p in found(package) if p.code == "python-syntax")
    assert [p.code for p in found(package)] == ["python-syntax"]
    assert problem.severity == "error"
    assert (problem.file, problem.line) == (str(package / LAUNCH), line)
    assert cause in problem.message
    assert problem.hint


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("description():", "description(:"),
        ("def generate", "function generate"),
        ("    return Launch", "    retrun Launch"),
        ("import os\n", "imort os\n"),
        (
            "from launch import LaunchDescription",
            "import LaunchDescription from launch",
        ),
        ('executable="robot_state_publisher",', 'executable="robot_state_publisher,'),
        ('executable="robot_state_publisher",', "executable=\"robot_state_publisher',"),
        ('executable="robot_state_publisher",', 'executable: "robot_state_publisher",'),
        ('executable="robot_state_publisher",', 'executable=robot_state_publisher",'),
        ('executable="robot_state_publisher",', "executable=“robot_state_publisher”,"),
        ('"world": "room",', '"world" "room",'),
        ('"world": "room",', '"world" = "room",'),
        ("LaunchDescription(\n        [", "LaunchDescription(\n        {"),
        ("    model = os", "\tmodel = os"),
    ],
)
def test_a_line_that_is_no_python_is_written_as_it_was_meant(
    copied: Copied, right: str, wrong: str
) -> None:
    package = copied("gz")
    text = (package / LAUNCH).read_text()
    assert right in text
    changed = text.replace(right, wrong, 1)
    (package / LAUNCH).write_text(changed)
    (problem,) = (p for p in found(package) if p.code == "python-syntax")

    assert apply_edits(problem.edits, changed) == text


def test_a_file_that_no_line_repairs_is_told_too(copied: Copied) -> None:
    package = copied("gz")
    edit(package / LAUNCH, "import os\n", "import\n")
    (problem,) = (p for p in found(package) if p.code == "python-syntax")

    assert (problem.line, problem.edits) == (1, ())


@pytest.mark.parametrize(
    "newer",
    [
        "type Name = str",
        "def first[T](items: list[T]) -> T: ...",
        'name = t"{share}"',
        'name = f"{names["a"]}"',
        "try: ...\nexcept KeyError, ValueError: ...",
    ],
)
def test_what_another_version_of_python_reads_is_not_judged(
    copied: Copied, newer: str
) -> None:
    package = copied("gz")
    edit(package / LAUNCH, "import os\n", f"import os\n{newer}\n")
    assert "python-syntax" not in [p.code for p in found(package)]
