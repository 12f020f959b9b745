"""A path of another machine leads to the file beside what was opened."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.displays.robot_model.description_file import find_description


@pytest.fixture
def package(tmp_path: Path) -> Path:
    for name in ("urdf/a.urdf", "launch/b.launch.py"):
        path = tmp_path / "ws" / "pkg" / name
        path.parent.mkdir(parents=True)
        path.touch()
    return tmp_path / "ws" / "pkg"


@pytest.mark.parametrize(
    "name",
    [
        "/home/ann/ros/src/pkg/urdf/a.urdf",
        "/elsewhere/other_name/urdf/a.urdf",
        "C:\\Users\\ann\\pkg\\urdf\\a.urdf",
        "package://pkg/urdf/a.urdf",
        "urdf/a.urdf",
        "~/nowhere/urdf/a.urdf",
    ],
)
def test_the_file_is_found_by_the_end_of_its_path(name: str, package: Path) -> None:
    assert find_description(name, [package / "launch"]) == package / "urdf/a.urdf"


def test_a_path_that_exists_is_taken_as_it_is(package: Path) -> None:
    own = package / "urdf/a.urdf"
    assert find_description(str(own), []) == own
    assert find_description(f"file://{own}", []) == own


def test_what_is_nowhere_is_not_found(package: Path) -> None:
    assert find_description("/home/ann/c.urdf", [package]) is None
