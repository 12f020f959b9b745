"""Real robots: each ends as the collection's index expects, none crashes or hangs."""

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
import yaml

from sambot_viz.errors import RobotError
from sambot_viz.robot.model import load_robot

ARGUMENTS = {
    "vehicle_model": "sample_vehicle",
    "sensor_model": "sample_sensor_kit",
    "DEBUG": "false",
    "namespace": "",
    "enable_mavlink_interface": "false",
    "enable_ground_truth": "false",
    "enable_logging": "false",
    "enable_cameras": "false",
    "enable_depth": "false",
}


# The index has what xacro says; the nodes of ROS read this finished URDF without it.
DRAWN_BY_ROS = ("ros2__urdf/urdf/test/pr2_desc.urdf",)


def ending(folder: Path, entry: Mapping[str, Any]) -> str:
    """How a robot of the collection ended, or "" when that is as expected."""
    expected: str = entry["expected"]
    wanted = expected.partition(" with args ")[2].split("|")
    arguments = {name: ARGUMENTS[name] for name in wanted if name in ARGUMENTS}
    try:
        robot = load_robot(folder / entry["path"], xacro_args=arguments)
    except RobotError as error:
        if not expected.startswith("render"):
            reported = all(p.file and p.hint for p in error.problems)
            return "" if reported else f"an error without a place or a fix: {error}"
        return f"refused: {error}"
    errors = [str(p) for p in robot.problems if p.severity == "error"]
    if expected.startswith("clear"):
        return "" if entry["path"] in DRAWN_BY_ROS else "drawn"
    if expected == "render" and errors:
        return f"drawn with errors: {errors}"
    return ""


def test_every_real_robot_ends_as_expected(shared: Path):
    folder = shared / "data" / "robots"
    index = yaml.safe_load((folder / "index.yaml").read_text("utf-8"))
    entries: list[dict[str, Any]] = index["robots"]
    with ThreadPoolExecutor(4) as pool:
        endings = list(pool.map(lambda entry: ending(folder, entry), entries))
    assert len(endings) > 100
    odd = {e["path"]: end for e, end in zip(entries, endings, strict=True) if end}
    assert odd == {}


@pytest.mark.parametrize(
    ("path", "package"),
    [
        ("jackal__jackal/jackal_description/urdf/jackal.urdf.xacro", "sick_tim"),
        (
            "pal-robotics__tiago_robot/tiago_description/robots/tiago.urdf.xacro",
            "pmb2_description",
        ),
    ],
)
def test_a_missing_dependency_is_named(path: str, package: str, shared: Path):
    model = shared / "data" / "robots" / path
    if not model.is_file():
        pytest.skip(f"{path} is not in this collection")
    with pytest.raises(RobotError, match=package):
        load_robot(model)
