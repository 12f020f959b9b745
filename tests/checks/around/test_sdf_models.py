"""The same is found around a model in SDF, whose plugins are in other places."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.errors import Problem

SDF = Path(__file__).parents[2] / "data" / "around" / "cart.sdf"
MODEL = "src/description/cart.sdf"
BRIDGE = "config/bridge_config.yaml"

Copied = Callable[[str], Path]


@pytest.fixture
def package(copied: Copied) -> Path:
    """The correct package, with the model in SDF."""
    folder = copied("gz")
    shutil.rmtree(folder / "urdf")
    (folder / MODEL).parent.mkdir(parents=True)
    shutil.copy(SDF, folder / MODEL)
    edit(folder / "launch/display.launch.py", '"urdf"', '"src", "description"')
    edit(folder / "launch/display.launch.py", "cart.urdf.xacro", "cart.sdf")
    edit(folder / "CMakeLists.txt", "urdf", "src")
    return folder


def edit(file: Path, old: str, new: str) -> None:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))


def found(package: Path) -> list[Problem]:
    """What is wrong, without what is said of every SDF model."""
    return [p for p in check(package / MODEL) if not p.code.startswith("sdf-")]


def test_a_correct_package_has_no_findings(package: Path) -> None:
    assert found(package) == []


@pytest.mark.parametrize(
    ("file", "old", "new", "code", "names", "better"),
    [
        (
            MODEL,
            "left_joint>left_wheel_joint<",
            "left_joint>left_whel_joint<",
            "gazebo-joint",
            "the model has left_wheel_joint (line 30)",
            "left_joint>left_wheel_joint<",
        ),
        (
            MODEL,
            "separation>0.4<",
            "separation>0.6<",
            "drive-wheel-separation",
            "(line 30) are 0.36 m apart",
            "separation>0.36<",
        ),
        (
            MODEL,
            "<wheel_radius>${wheel_radius}<",
            "<wheel_radius>0.2<",
            "drive-wheel-radius",
            "has the radius 0.1 m (line 21)",
            "<wheel_radius>0.1<",
        ),
        (
            MODEL,
            "      <gz_frame_id>lidar_link<",
            "      <gz_frame_id>laser_link<",
            "frame-unknown",
            "it has lidar_link (line 55)",
            "      <gz_frame_id>lidar_link<",
        ),
        (
            MODEL,
            "<topic>scan</topic>\n        <gz_frame_id>lidar_link</gz_frame_id>",
            "<topic>scan</topic>",
            "sensor-frame",
            "cart/lidar_link/lidar",
            "<topic>scan</topic>\n        <gz_frame_id>lidar_link</gz_frame_id>",
        ),
        (
            BRIDGE,
            'gz_topic_name: "/scan"',
            'gz_topic_name: "/lidar"',
            "bridge-topic",
            "sends scan (cart.sdf line 58)",
            'gz_topic_name: "/scan"',
        ),
        (
            MODEL,
            "gz-sim-diff-drive-system",
            "libgazebo_ros_diff_drive.so",
            "gazebo-generation",
            "display.launch.py line 62 starts Gazebo",
            "gz-sim-diff-drive-system",
        ),
    ],
)
def test_a_mistake_is_found_and_its_fix_leaves_nothing(
    package: Path, file: str, old: str, new: str, code: str, names: str, better: str
) -> None:
    if code == "gazebo-generation":
        # With another plugin of Gazebo the model may be for both.
        edit(package / MODEL, "gz-sim-joint-state-publisher-system", "other")
    edit(package / file, old, new)
    problems = found(package)
    assert [p.code for p in problems] == [code]
    assert names in problems[0].message
    assert problems[0].file == str(package / file)
    edit(package / file, new, better)
    if code == "gazebo-generation":
        edit(package / MODEL, '"other"', '"gz-sim-joint-state-publisher-system"')
    assert found(package) == []
