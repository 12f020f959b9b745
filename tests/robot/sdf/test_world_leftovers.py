"""A robot that is left in a world, or beside what belongs there, gets one advice."""

from __future__ import annotations

import pytest

from sambot_viz import Problem, RobotError, load_robot

ROBOT = """<model name="bot">
<link name="base_link"/>
<joint name="mast_joint" type="fixed">
<parent>base_link</parent><child>mast</child>
</joint>
<link name="mast"/>
</model>
"""
SUN = '<light name="sun" type="directional"><direction>0 0 -1</direction></light>\n'
GROUND = '<model name="ground"><static>true</static><link name="link"/></model>\n'
PHYSICS = (
    '<physics name="p" type="ode"><max_step_size>0.001</max_step_size></physics>\n'
)


def in_sdf(text: str) -> str:
    return f'<sdf version="1.8">\n{text}</sdf>\n'


def found(text: str) -> tuple[Problem, ...]:
    try:
        return load_robot(text).problems
    except RobotError as error:
        return error.problems


@pytest.mark.parametrize("more", ["", SUN, GROUND, PHYSICS + SUN + GROUND])
def test_a_robot_inside_a_world_is_to_be_taken_out_of_it(more: str) -> None:
    world = f'<world name="w">\n{more}{ROBOT}</world>\n'

    (problem,) = found(in_sdf(world))

    assert problem.hint == (
        'delete <world name="w"> and </world>, and all between them but the <model> '
        f"bot (line {3 + more.count(chr(10))}); or open the file of the robot"
    )
    assert found(in_sdf(ROBOT)) == ()


@pytest.mark.parametrize(
    ("before", "after", "hint"),
    [
        ("", SUN, "delete <light> sun (line 9)"),
        ("", GROUND, "delete <model> ground (line 9)"),
        (GROUND, "", "delete <model> ground (line 2)"),
        (SUN, GROUND, "delete <light> sun (line 2) and <model> ground (line 10)"),
    ],
)
def test_what_is_beside_a_robot_is_to_be_deleted(
    before: str, after: str, hint: str
) -> None:
    (problem,) = found(in_sdf(before + ROBOT + after))

    assert (problem.code, problem.hint) == ("sdf-not-one-model", hint)


@pytest.mark.parametrize(
    "left",
    [
        GROUND,
        "<include><uri>model://sun</uri></include>\n",
        "<include><uri>https://example.org/models/Ground Plane</uri></include>\n",
    ],
)
def test_what_is_of_the_world_among_the_links_is_to_be_deleted(left: str) -> None:
    wrong = ROBOT.replace("</model>", f"{left}</model>")

    problems = [p for p in found(in_sdf(wrong)) if p.severity != "info"]

    assert [p.hint.partition(":")[0] for p in problems] == ["delete it"]
    assert found(in_sdf(ROBOT)) == ()


def test_a_world_of_two_robots_is_not_taken_apart() -> None:
    other = ROBOT.replace('"bot"', '"other"')

    (problem,) = found(in_sdf(f'<world name="w">\n{ROBOT}{other}</world>\n'))

    assert problem.hint == "open the file of the robot"
