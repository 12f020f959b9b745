"""Groups of joints, by what their names begin with."""

from __future__ import annotations

from sambot_viz.panels.joints.joint_rows import JointGroup, joint_groups

ARMS = [f"arm_{side}_{i}_joint" for side in ("left", "right") for i in range(1, 8)]
LEGS = [f"leg_{side}_{i}_joint" for side in ("left", "right") for i in range(1, 7)]
HEAD = ["head_1_joint", "head_2_joint"]
HUMANOID = ["torso_1_joint", "torso_2_joint", *HEAD, *ARMS, "neck", *LEGS, "gripper"]


def labels(names: list[str]) -> list[str]:
    return [group.label for group in joint_groups(names)]


def test_a_few_joints_are_one_list_without_a_label() -> None:
    assert joint_groups(ARMS) == [JointGroup("", tuple(ARMS))]


def test_many_joints_are_grouped_by_what_their_names_begin_with() -> None:
    groups = joint_groups(HUMANOID)
    assert [(group.label, len(group.names)) for group in groups] == [
        ("torso", 2),
        ("head", 2),
        ("arm_left", 7),
        ("arm_right", 7),
        ("", 1),
        ("leg_left", 6),
        ("leg_right", 6),
        ("", 1),
    ]
    assert groups[2].names == tuple(ARMS[:7])


def test_every_joint_is_in_one_group() -> None:
    for names in (
        HUMANOID,
        [f"j{i}" for i in range(300)],
        [*"abcdefghijklmnopqrstuvwxyzäöüßå"],
    ):
        assert sorted(n for g in joint_groups(names) for n in g.names) == sorted(names)


def test_words_may_begin_with_a_capital_letter() -> None:
    sides = [f"{s}Hip{a}" for s in "LR" for a in ("Yaw", "Roll", "Pitch", "A", "B")]
    fingers = [f"{s}Finger{i}" for s in "LR" for i in range(11, 22)]
    assert labels([*sides, *fingers]) == ["LHip", "LFinger", "RHip", "RFinger"]


def test_joints_that_only_a_number_tells_apart_are_grouped_in_their_order() -> None:
    groups = joint_groups([f"joint_{i}" for i in range(1, 301)])
    assert [len(group.names) for group in groups] == [25] * 12
    assert groups[10].label == "joint_251 … joint_275"
    assert groups[10].names[6] == "joint_257"


def test_names_with_nothing_in_common_are_one_list_if_they_are_not_too_many() -> None:
    names = [f"{letter}{letter}" for letter in "abcdefghijklmnopqrstuvwxyzABCDEFG"]
    assert len(joint_groups([*names])) == 2
