"""A pose that counts from a name that is gone is answered with what ends well."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from edited import edited_files

from sambot_viz import Problem, RobotError, load_robot

GOOD = """<sdf version="1.8">
<model name="bot">
<link name="base_link"/>
<joint name="left_wheel_joint" type="fixed">
<parent>base_link</parent><child>left_wheel</child>
<pose relative_to="base_link">0 1 0 0 0 0</pose>
</joint>
<link name="left_wheel"><pose relative_to="left_wheel_joint"/></link>
<joint name="lidar_joint" type="fixed">
<parent>base_link</parent><child>lidar_link</child>
<pose relative_to="base_link">0 0 1 0 0 0</pose>
</joint>
<link name="lidar_link"><pose relative_to="lidar_joint"/></link>
</model>
</sdf>
"""
LIDAR = GOOD[GOOD.index('<joint name="lidar') : GOOD.index('<link name="lidar')]


def found(text: str) -> tuple[Problem, ...]:
    try:
        return load_robot(text).problems
    except RobotError as error:
        return error.problems


def test_the_model_of_these_tests_is_good() -> None:
    assert found(GOOD) == ()


@pytest.mark.parametrize(
    "right",
    [
        "<parent>base_link</parent><child>lidar_link",
        "<child>lidar_link",
        'relative_to="base_link">0 0 1',
        'attached_to="lidar_link"',
    ],
)
def test_the_own_model_is_no_prefix_of_a_name(tmp_path: Path, right: str) -> None:
    frame = '<frame name="beam" attached_to="lidar_link"/>\n</model>'
    good = GOOD.replace("</model>", frame)
    path = tmp_path / "bot.sdf"
    wrong = re.sub("(base|lidar)_link", r"bot::\1_link", right, count=1)
    path.write_text(good.replace(right, wrong))
    (problem,) = (p for p in found(str(path)) if p.severity == "error")
    assert "bot is the model itself" in problem.message
    path.write_bytes(edited_files(problem.edits)[str(path)])
    assert path.read_text() == good


@pytest.mark.parametrize("name", ["lidar_jnt", "mount", "right_lidar_joint", "left"])
def test_a_link_of_a_renamed_joint_is_given_the_new_name(name: str) -> None:
    wrong = GOOD.replace('name="lidar_joint"', f'name="{name}"')

    (problem,) = found(wrong)

    assert problem.hint == f"write {name}"
    assert found(wrong.replace('to="lidar_joint"', f'to="{name}"')) == ()


@pytest.mark.parametrize("pose", ["", "0 0 0 0 0 0", "0.0 0 0 0 0 0"])
@pytest.mark.parametrize("link", ["lidar_joints_link", "lidar_joi", "a_lidar_joint_b"])
def test_the_name_of_another_link_does_not_hide_the_renamed_joint(
    link: str, pose: str
) -> None:
    right = GOOD.replace("left_wheel<", f"{link}<").replace(
        '<link name="left_wheel">', f'<link name="{link}">'
    )
    right = right.replace(
        '<pose relative_to="lidar_joint"/>',
        f'<pose relative_to="lidar_joint">{pose}</pose>',
    )
    wrong = right.replace('name="lidar_joint"', 'name="mast_mount"')

    (problem,) = found(wrong)

    assert found(right) == ()
    assert problem.hint == "write mast_mount"
    assert found(wrong.replace('to="lidar_joint"', 'to="mast_mount"')) == ()


def test_a_joint_that_was_deleted_is_to_be_added() -> None:
    wrong = GOOD.replace(LIDAR, "")

    (problem,) = found(wrong)

    said = re.fullmatch(
        r"add (<joint .*</joint>) with its real place, or delete the link lidar_link",
        problem.hint,
    )
    assert said
    assert found(wrong.replace("</model>", f"{said[1]}\n</model>")) == ()


@pytest.mark.parametrize(
    ("link", "name"), [("lidar_link", "lidar_lnk"), ("left_wheel", "left_wheels")]
)
def test_a_link_is_never_sent_to_itself(link: str, name: str) -> None:
    joint = "lidar_joint" if link == "lidar_link" else "left_wheel_joint"
    wrong = GOOD.replace(f'relative_to="{joint}"', f'relative_to="{name}"')

    (problem,) = found(wrong)

    assert problem.hint == f"write {joint}"


def test_a_joint_is_not_sent_to_what_counts_from_it() -> None:
    wrong = GOOD.replace(
        'relative_to="base_link">0 0 1', 'relative_to="lidar_lnk">0 0 1'
    )

    (problem,) = found(wrong)

    assert "'lidar_link'" not in problem.message
    assert "'lidar_joint'" not in problem.message
    assert "'base_link'" in problem.message


def test_a_link_that_counts_from_itself_is_sent_to_its_joint() -> None:
    wrong = GOOD.replace('to="lidar_joint"', 'to="lidar_link"')

    (problem,) = found(wrong)

    assert problem.code == "sdf-pose-cycle"
    assert problem.hint == 'write relative_to="lidar_joint"'


def test_with_a_joint_to_the_world_goes_what_counts_from_it() -> None:
    joint = (
        '<joint name="fix" type="fixed"><parent>world</parent><child>base_link</child>'
        '<pose relative_to="__model__"/></joint>'
    )
    wrong = GOOD.replace(
        '<link name="base_link"/>',
        f'{joint}<link name="base_link"><pose relative_to="fix"/></link>',
    )

    (problem,) = found(wrong)

    assert problem.hint.startswith(
        'delete the joint fix and relative_to="fix" of the <pose> in link base_link '
        "(line 3), or"
    )
    assert found(wrong.replace(joint, "").replace(' relative_to="fix"', "")) == ()


ARM = GOOD.replace(
    "</model>",
    """<joint name="tip_joint" type="fixed">
<parent>base_link</parent><child>tip</child>
<pose relative_to="base_link">1 0 0 0 0 0</pose>
</joint>
<link name="tip"><pose relative_to="tip_joint"/></link>
</model>""",
)


@pytest.mark.parametrize("wrong", ["", '<pose relative_to="lidar_joint"/>'])
def test_a_link_that_is_not_at_its_joint_is_told_where_the_others_are(
    wrong: str,
) -> None:
    right = '<pose relative_to="tip_joint"/>'

    (problem,) = found(ARM.replace(right, wrong))

    assert problem.code == "sdf-link-away-from-joint"
    assert problem.hint == f"write {right} into it"
    assert found(ARM) == ()


def test_links_that_count_from_the_robot_are_right_where_most_do() -> None:
    assert found(re.sub(r'<pose relative_to="\w+_joint"/>', "", ARM)) == ()
