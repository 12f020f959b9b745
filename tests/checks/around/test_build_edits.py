"""What stops colcon carries the edit that mends it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits

Copied = Callable[[str], Path]
CMAKE, MANIFEST, MODEL = "CMakeLists.txt", "package.xml", "urdf/cart.urdf.xacro"
FOLDERS = "DIRECTORY urdf launch rviz config world"
TO_SHARE = "DESTINATION share/${PROJECT_NAME}"


@pytest.mark.parametrize(
    ("file", "right", "wrong", "code"),
    [
        (CMAKE, "ament_package()", "ament_packages()", "cmake-command-missing"),
        (CMAKE, "ament_package()\n", "", "cmake-command-missing"),
        (
            CMAKE,
            "find_package(ament_cmake REQUIRED)\n",
            "find_package(xacro REQUIRED)\n",
            "cmake-command-missing",
        ),
        (CMAKE, FOLDERS, FOLDERS.removeprefix("DIRECTORY "), "install-destination"),
        (CMAKE, f"  {TO_SHARE}\n", "", "install-destination"),
        (CMAKE, FOLDERS, FOLDERS.replace(" config", ""), "folder-not-installed"),
        (
            MANIFEST,
            "  <export>\n    <build_type>ament_cmake</build_type>\n  </export>\n",
            "",
            "package-build-type",
        ),
        (MODEL, 'type="gpu_lidar"', 'type="lidar_gpu"', "gazebo-sensor"),
        (MODEL, 'type="imu"', 'type="imu_sensor"', "gazebo-sensor"),
    ],
)
def test_the_edit_leaves_nothing(
    copied: Copied, file: str, right: str, wrong: str, code: str
) -> None:
    package = copied("gz")
    text = (package / file).read_text()
    assert right in text
    changed = text.replace(right, wrong, 1)
    (package / file).write_text(changed)
    (problem,) = check(package / MODEL)

    assert (problem.code, problem.file) == (code, str(package / file))
    (package / file).write_text(apply_edits(problem.edits, changed))
    assert check(package / MODEL) == []
