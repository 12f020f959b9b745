"""Mimic by parameter (spec/ros-nodes.md §1.2)."""

from __future__ import annotations

import pytest

from sambot_viz.errors import UsageError
from sambot_viz.joints import JointState
from sambot_viz.joints.dependent import read_dependent_joints
from sambot_viz.robot.model import Mimic, Robot


def test_flat_and_nested_parameters_mean_the_same() -> None:
    flat = {"k.parent": "j", "k.factor": -1, "k.offset": "0.5", "l.parent": "k"}
    nested = {"k": {"parent": "j", "factor": -1, "offset": 0.5}, "l": {"parent": "k"}}
    expected = {"k": Mimic("j", -1.0, 0.5), "l": Mimic("k")}
    assert read_dependent_joints(flat) == expected
    assert read_dependent_joints(nested) == expected


def test_a_joint_may_have_dots_in_its_name() -> None:
    assert read_dependent_joints({"a.b.parent": "j"}) == {"a.b": Mimic("j")}


def test_the_joint_follows(arm: Robot) -> None:
    # The real node of 2.4.0 publishes 0.25 here; later ones forget the parameters.
    given = read_dependent_joints({"wheel.parent": "j", "wheel.factor": 0.5})
    state = JointState(arm, dependent_joints=given)
    state.set("j", 0.5)
    assert state.all_positions()["wheel"] == 0.25
    assert "wheel" not in state.sliders


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        (
            {"k": 1.0},
            "Invalid dependent_joint name 'k'; write JOINT.parent, JOINT.factor or "
            "JOINT.offset",
        ),
        (
            {"k.parent": "j", "k.gain": 2},
            "Invalid dependent_joint name 'gain' (allowed values are 'parent', "
            "'factor', 'offset'); it stands at joint 'k'",
        ),
        (
            {"k.factor": 2},
            "All dependent_joints must at least have a parent; 'k' has none: add "
            "k.parent",
        ),
        (
            {"k.parent": "j", "k.factor": "two"},
            "k.factor: 'two' is no finite number",
        ),
    ],
)
def test_parameters_that_make_no_sense_have_the_real_nodes_text(
    parameters: dict[str, str | float], message: str
) -> None:
    with pytest.raises(UsageError) as caught:
        read_dependent_joints(parameters)
    assert str(caught.value) == message
