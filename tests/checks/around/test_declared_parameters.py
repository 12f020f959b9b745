"""What a package's own nodes declare is what their parameters may be called."""

from __future__ import annotations

from pathlib import Path

import pytest
from edited import edited_files
from manifests import manifest, written

from sambot_viz.checks import check

CONFIG, LAUNCH = "config/params.yaml", "launch/all.launch.py"
PYTHON = """\
from rclpy.node import Node


class Follower(Node):
    def __init__(self):
        super().__init__('follower')
        self.declare_parameter('max_speed', 0.5)
        self.declare_parameters(
            namespace='', parameters=[('topics.scan', 'scan'), ('gains', [0.1, 0.2])]
        )
"""
CPP = """\
Guard::Guard() : Node("guard")
{
  declare_parameter("stop_distance", 0.3);
  this->declare_parameter<std::vector<std::string>>("zones", {});
  declare_parameter<int>("rate");
}
"""
FILES = {
    "package.xml": manifest(),
    "robot/follower.py": PYTHON,
    "robot/__init__.py": "",
    "src/guard.cpp": CPP,
    CONFIG: """\
follower:
  ros__parameters:
    max_speed: 0.8
    topics:
      scan: /scan
    gains: [0.3, 0.4]
guard:
  ros__parameters:
    stop_distance: 0.4
    zones: [front]
    rate: 10
    parameter_of_a_base_class: 3
""",
    LAUNCH: """\
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription(
        [
            Node(
                package='robot',
                executable='follower.py',
                parameters=[{'max_speed': 0.2}],
            )
        ]
    )
""",
}


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A package with a node in Python and one in C++."""
    return written(tmp_path / "robot", FILES)


@pytest.mark.parametrize(
    ("file", "right", "wrong", "severity"),
    [
        (CONFIG, "max_speed", "max_sped", "warning"),
        (CONFIG, "scan:", "scn:", "warning"),
        (CONFIG, "stop_distance", "stop_distnace", "warning"),
        (CONFIG, "max_speed: 0.8", "max_speed: 'fast'", "error"),
        (CONFIG, "rate: 10", "rate: 10.0", "error"),
        (CONFIG, "[0.3, 0.4]", "[0.3, 4]", "error"),
        (CONFIG, "[front]", "front", "error"),
        (LAUNCH, "'max_speed'", "'max_spedd'", "warning"),
    ],
)
def test_a_parameter_that_no_node_declares(
    package: Path, file: str, right: str, wrong: str, severity: str
) -> None:
    found = [p for p in check(package) if p.code != "package-without-model"]
    assert found == []
    path = package / file
    path.write_text(FILES[file].replace(right, wrong))
    (problem,) = [p for p in check(package) if p.code != "package-without-model"]
    assert problem.severity == severity
    if severity == "warning":
        assert edited_files(problem.edits)[str(path)].decode() == FILES[file]


@pytest.mark.parametrize(
    "other",
    [
        "self.declare_parameter(prefix + 'speed', 0.5)",
        "# automatically_declare_parameters_from_overrides=True",
    ],
)
def test_a_node_that_declares_names_which_are_not_known(
    package: Path, other: str
) -> None:
    (package / "robot/follower.py").write_text(f"{PYTHON}        {other}\n")
    (package / CONFIG).write_text(FILES[CONFIG].replace("max_speed: ", "max_sped: "))
    assert [p.code for p in check(package)] == ["package-without-model"]
