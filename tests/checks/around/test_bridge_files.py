"""Mistakes in the form of a bridge's file are found, and mended."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check

MODEL = "urdf/cart.urdf.xacro"
BRIDGE, EKF = "config/bridge_config.yaml", "config/ekf.yaml"
GZ_TYPE = '  gz_type_name: "gz.msgs.IMU"\n'
CLOCK = (
    "{ros_topic_name: /clock, gz_topic_name: /clock, ros_type_name: "
    "rosgraph_msgs/msg/Clock, gz_type_name: gz.msgs.Clock, direction: GZ_TO_ROS}"
)

Copied = Callable[[str], Path]


@pytest.mark.parametrize(
    ("severity", "right", "wrong", "line", "cause", "hint", "better"),
    [
        (
            "warning",
            '  gz_topic_name: "/scan"',
            '  gz_topic: "/scan"',
            33,
            "does not know the key gz_topic",
            "write gz_topic_name",
            '  gz_topic_name: "/scan"',
        ),
        (
            "error",
            GZ_TYPE,
            GZ_TYPE.replace("type_name", "typename"),
            11,
            "does not know the key gz_typename: it leaves this topic out",
            "write gz_type_name",
            GZ_TYPE,
        ),
        (
            "error",
            GZ_TYPE,
            "",
            8,
            "has no gz_type_name",
            "add gz_type_name: gz.msgs.IMU",
            GZ_TYPE.replace('"', ""),
        ),
        (
            "error",
            "direction: GZ_TO_ROS",
            "direction: gz_to_ros",
            6,
            "does not know the direction gz_to_ros",
            "write direction: GZ_TO_ROS",
            "direction: GZ_TO_ROS",
        ),
    ],
)
def test_an_entry_that_the_bridge_does_not_take(
    copied: Copied,
    severity: str,
    right: str,
    wrong: str,
    line: int,
    cause: str,
    hint: str,
    better: str,
) -> None:
    package = copied("gz")
    bridge = package / BRIDGE
    text = bridge.read_text()
    assert right in text
    bridge.write_text(text.replace(right, wrong, 1))

    (problem,) = [p for p in check(package / MODEL) if p.file == str(bridge)]

    assert (problem.code, problem.severity) == ("bridge-entry", severity)
    assert problem.line == line
    assert cause in problem.message
    assert problem.hint == hint
    bridge.write_text(text.replace(right, better, 1))
    assert check(package / MODEL) == []


def test_topics_below_a_key_are_not_read(copied: Copied) -> None:
    package = copied("gz")
    bridge = package / BRIDGE
    entries = bridge.read_text().removeprefix("---\n")
    bridge.write_text(f"bridge:\n{entries}")
    (problem,) = (p for p in check(package / MODEL) if p.file == str(bridge))
    assert (problem.code, problem.line) == ("bridge-entry", 1)
    assert problem.hint == "delete the line bridge:"
    bridge.write_text(entries)
    assert check(package / MODEL) == []


def test_an_entry_below_a_key_and_one_without_its_dash(copied: Copied) -> None:
    package = copied("gz")
    bridge = package / BRIDGE
    first, _ = bridge.read_text().removeprefix("---\n- ").split("\n\n", 1)
    other = package / "config" / "second_bridge.yaml"
    other.write_text(f"bridge:\n  {first}\n")
    (problem,) = check(package / MODEL)
    assert (
        problem.hint == "delete the line bridge:, and write - ros_topic_name below it"
    )
    other.write_text(first.replace("\n  ", "\n"))
    (problem,) = check(package / MODEL)
    assert problem.hint == (
        "write - ros_topic_name, and two blanks more before the others"
    )
    other.write_text(f"- {first}\n")
    assert check(package / MODEL) == []


def test_the_clock_is_added_at_the_end_and_not_above_a_document(
    copied: Copied,
) -> None:
    package = copied("gz")
    bridge = package / BRIDGE
    text = bridge.read_text()
    without = "---\n" + text.split("\n\n", 1)[1]
    bridge.write_text(without)
    (problem,) = check(package / MODEL)
    assert problem.code == "clock-not-bridged"
    assert problem.hint == f"add - {CLOCK} at the end of the file"
    assert problem.line == len(without.splitlines())
    assert "(display.launch.py line 32)" in problem.message
    bridge.write_text(f"{without}- {CLOCK}\n")
    assert check(package / MODEL) == []

    bridge.write_text(f"- {CLOCK}\n{without}")
    (problem,) = check(package / MODEL)
    assert (problem.code, problem.line) == ("parameters-yaml", 2)
    assert problem.hint == "delete this line"
    bridge.write_text(f"- {CLOCK}\n{without}".replace("---\n", ""))
    assert check(package / MODEL) == []


def test_an_empty_file_that_a_node_is_given(copied: Copied) -> None:
    package = copied("gz")
    text = (package / EKF).read_text()
    (package / EKF).write_text("# later\n")
    (problem,) = check(package / MODEL)
    assert (problem.code, problem.line) == ("parameters-empty", 1)
    assert "display.launch.py line 40 gives it to ekf_filter_node" in problem.message
    (package / EKF).write_text(text)
    assert check(package / MODEL) == []


@pytest.mark.parametrize(
    ("right", "other"),
    [
        ('ros_topic_name: "/scan"\n  gz_topic_name: "/scan"', 'topic_name: "/scan"'),
        ("  direction: GZ_TO_ROS\n\n- ros_topic_name: /d", "\n- ros_topic_name: /d"),
        ('  gz_topic_name: "/scan"\n', '  gz_topic_name: "/scan"\n  lazy: true\n'),
        ("gz_t", "ign_t"),
        ("---\n", "---\n- service_name: /world/room/control\n"),
    ],
)
def test_what_a_bridge_reads_is_not_reported(
    copied: Copied, right: str, other: str
) -> None:
    package = copied("gz")
    bridge = package / BRIDGE
    bridge.write_text(bridge.read_text().replace(right, other))
    assert check(package / MODEL) == []


def test_of_parameters_ros_reads_all_documents(copied: Copied) -> None:
    package = copied("gz")
    ekf, bridge = package / EKF, package / BRIDGE
    ekf.write_text(f"{ekf.read_text()}---\nother:\n  ros__parameters:\n    a: 1\n")
    assert check(package / MODEL) == []
    bridge.write_text(f"{bridge.read_text()}---\n- service_name: /world/room/control\n")
    (problem,) = check(package / MODEL)
    assert (problem.code, problem.hint) == ("parameters-yaml", "delete this line")
