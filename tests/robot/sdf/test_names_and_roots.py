"""One wrong name, or one wrong element around the model, is one problem."""

from __future__ import annotations

import re

import pytest

from sambot_viz import Problem, RobotError, load_robot

GOOD = """<sdf version="1.8">
<model name="bot">
<link name="base_link"/>
<link name="imu"><pose relative_to="imu_joint"/></link>
<joint name="imu_joint" type="fixed">
<parent>base_link</parent><child>imu</child>
<pose relative_to="base_link">0 0 1 0 0 0</pose>
</joint>
</model>
</sdf>
"""
JOINT = GOOD[GOOD.index("<joint") : GOOD.index("</model>")]
JOINT_FIRST = GOOD.replace(JOINT, "").replace(
    '<link name="imu">', JOINT + '<link name="imu">'
)


def found(text: str) -> tuple[Problem, ...]:
    try:
        return load_robot(text).problems
    except RobotError as error:
        return error.problems


@pytest.mark.parametrize("good", [GOOD, JOINT_FIRST], ids=["link first", "joint first"])
def test_a_joint_with_the_name_of_a_link_is_one_problem(good: str) -> None:
    assert found(good) == ()
    wrong = good.replace('"imu_joint"', '"imu"')

    (problem,) = found(wrong)

    line = wrong[: wrong.index("<joint")].count("\n") + 1
    pose = wrong[: wrong.index('relative_to="imu"')].count("\n") + 1
    assert (problem.code, problem.line) == ("sdf-name-taken", line)
    assert problem.hint == (
        f"write imu_joint, here and in relative_to of link imu (line {pose})"
    )
    fixed = wrong.replace('<joint name="imu"', '<joint name="imu_joint"')
    assert fixed.replace('relative_to="imu"', 'relative_to="imu_joint"') == good


@pytest.mark.parametrize("good", [GOOD, JOINT_FIRST], ids=["link first", "joint first"])
def test_a_frame_with_the_name_of_a_link_is_one_problem(good: str) -> None:
    frame = '<frame name="imu" attached_to="base_link"/>'
    wrong = good.replace("</model>", f"{frame}</model>")

    (problem,) = found(wrong)

    assert problem.hint == "write imu_frame, here and where it is used"
    assert found(wrong.replace(frame, frame.replace("imu", "imu_frame"))) == ()


def test_robot_around_a_model_of_sdf_is_to_be_sdf() -> None:
    wrong = GOOD.replace('<sdf version="1.8">', '<robot name="bot">')
    wrong = wrong.replace("</sdf>", "</robot>")

    (problem,) = found(wrong)

    said = re.fullmatch(r"write (.*) for (.*) and (.*) for (.*)", problem.hint)
    assert said
    assert wrong.replace(said[2], said[1]).replace(said[4], said[3]) == GOOD


def test_robot_around_an_sdf_is_to_be_deleted() -> None:
    wrong = f'<robot name="bot">\n{GOOD}</robot>'

    (problem,) = found(wrong)

    assert problem.hint == "delete <robot> and </robot>: then it is an SDF file"


def test_a_group_of_urdf_that_is_called_model_is_still_taken_away() -> None:
    urdf = (
        '<robot name="r"><model name="m"><link name="a"/><link name="b"/><joint '
        'name="j" type="fixed"><parent link="a"/><child link="b"/></joint></model>'
        "</robot>"
    )

    (problem,) = found(urdf)

    assert problem.hint == "delete <model> and </model>"
