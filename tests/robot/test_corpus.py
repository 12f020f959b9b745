"""Real robots: each ends as the collection's index expects, none crashes or hangs."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from real_robots import RealRobot, real_robots

from sambot_viz.errors import RobotError
from sambot_viz.robot.model import load_robot

# The index has what xacro says; the nodes of ROS read this finished URDF without it.
DRAWN_BY_ROS = ("ros2__urdf/urdf/test/pr2_desc.urdf",)


def ending(folder: Path, real: RealRobot) -> str:
    """How a robot of the collection ended, or "" when that is as expected."""
    expected = real.expected
    try:
        robot = load_robot(folder / real.path, xacro_args=real.arguments)
    except RobotError as error:
        if not expected.startswith("render"):
            reported = all(p.file and p.hint for p in error.problems)
            return "" if reported else f"an error without a place or a fix: {error}"
        return f"refused: {error}"
    errors = [str(p) for p in robot.problems if p.severity == "error"]
    if expected.startswith("clear"):
        return "" if real.path in DRAWN_BY_ROS else "drawn"
    if expected == "render" and errors:
        return f"drawn with errors: {errors}"
    return ""


def test_every_real_robot_ends_as_expected(shared: Path):
    folder = shared / "data" / "robots"
    robots = real_robots(folder)
    with ThreadPoolExecutor(4) as pool:
        endings = list(pool.map(lambda robot: ending(folder, robot), robots))
    assert len(endings) > 100
    odd = {each.path: end for each, end in zip(robots, endings, strict=True) if end}
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
