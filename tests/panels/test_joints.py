"""The Joints panel: rows, exact values, wheels that turn, notes, texts to copy."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from inside import session_of
from panel_rows import data_of, edit, panel_of, row_named, rows_of

from sambot_viz import Visualizer
from sambot_viz.errors import UsageError
from sambot_viz.panels.joints.joint_rows import FOLLOWERS, SKIPPED
from sambot_viz.panels.joints.joints_panel import JointsPanel
from sambot_viz.panels.rows.row import Answer
from sambot_viz.session import Session
from sambot_viz.session.signals import connect

LEFT, RIGHT = "drivewhl_l_joint", "drivewhl_r_joint"
PI = math.pi
Open = Callable[..., JointsPanel]


def joint(name: str, kind: str, inside: str = "") -> str:
    """A link below the root, and its joint."""
    return (
        f'<link name="{name}_link"/><joint name="{name}" type="{kind}">'
        f'<parent link="base"/><child link="{name}_link"/><axis xyz="0 0 1"/>'
        f"{inside}</joint>"
    )


def limit(lower: float, upper: float) -> str:
    return f'<limit lower="{lower}" upper="{upper}" effort="1" velocity="1"/>'


@pytest.fixture
def open_robot(tmp_path: Path) -> Iterator[Open]:
    """Make the panel of a robot with these joints."""
    opened = ExitStack()

    def make(*joints: str) -> JointsPanel:
        path = tmp_path / "robot.urdf"
        path.write_text(f'<robot name="r"><link name="base"/>{"".join(joints)}</robot>')
        viz = opened.enter_context(Visualizer(path, port=0, watch=False))
        return panel_of(JointsPanel, session_of(viz))

    with opened:
        yield make


@pytest.fixture
def panel(session: Session) -> JointsPanel:
    return panel_of(JointsPanel, session)


def answer(panel: JointsPanel, row_id: str, value: Any) -> Any:
    return edit(panel, row_id, value)


def names_below(panel: JointsPanel, parent: str) -> list[str]:
    return [row.name for row in panel.rows() if row.parent == parent]


def test_a_joint_has_its_value_unit_limits_and_what_it_joins(
    panel: JointsPanel,
) -> None:
    row = row_named(panel, LEFT)
    assert (row.kind, row.value, row.unit) == ("slider", 0.0, "rad")
    assert (row.least, row.most) == pytest.approx((-PI, PI))
    assert row.help == "continuous joint, base_link → drivewhl_l_link"
    assert row.extra == {"wheel": True}


def test_a_value_is_taken_exactly(panel: JointsPanel, viz: Visualizer) -> None:
    edit(panel, f"j/{LEFT}", 0.123456789)
    assert viz.joint_positions[LEFT] == 0.123456789
    assert panel.values()[f"j/{LEFT}"] == 0.123456789


def test_a_value_outside_the_limits_is_refused(
    panel: JointsPanel, viz: Visualizer
) -> None:
    with pytest.raises(UsageError, match="cannot be 9: its limits are"):
        edit(panel, f"j/{LEFT}", 9)
    assert viz.joint_positions[LEFT] == 0


def test_steps_are_round_and_smaller_for_a_short_range(open_robot: Open) -> None:
    panel = open_robot(
        joint("turn", "revolute", limit(-1, 1)),
        joint("slide", "prismatic", limit(0, 0.5)),
        joint("short", "revolute", limit(0, 0.05)),
        joint("tiny", "prismatic", limit(0, 0.005)),
    )
    steps = {row.name: row.step for row in panel.rows() if row.kind == "slider"}
    expected = {"turn": 0.01, "slide": 0.001, "short": 0.001, "tiny": 0.0001}
    assert steps == pytest.approx(expected)
    assert row_named(panel, "slide").unit == "m"


def test_center_and_randomize_move_all_joints_and_can_be_undone(
    panel: JointsPanel, session: Session, viz: Visualizer
) -> None:
    viz.set_joint_positions({LEFT: 0.5})
    for action in ("joints/center", "joints/randomize"):
        before = dict(viz.joint_positions)
        with session.history.acting(1):
            edit(panel, action, [])
        assert viz.joint_positions != before
        session.history.undo(1)
        assert viz.joint_positions == before


def test_a_drag_is_one_step_to_undo(
    panel: JointsPanel, session: Session, viz: Visualizer
) -> None:
    for value in (0.1, 0.2, 0.3):
        with session.history.acting(1, gesture=7):
            edit(panel, f"j/{LEFT}", value)
    session.history.undo(1)
    assert viz.joint_positions[LEFT] == 0
    assert session.history.state(1).value.undo is None


# Wheels that turn


def turning(panel: JointsPanel) -> Any:
    return panel.values()["joints/turning"]


def test_a_click_starts_a_wheel_and_another_one_stops_it(
    panel: JointsPanel, session: Session
) -> None:
    heard: list[int] = []
    connect([session.motion.turning], lambda: heard.append(1))
    edit(panel, "joints/turn", [f"j/{LEFT}"])
    assert turning(panel) == [f"j/{LEFT}"]
    edit(panel, "joints/turn", [f"j/{LEFT}"])
    assert turning(panel) == []
    assert len(heard) == 2


def test_the_rate_holds_for_the_wheels_that_turn_already(
    panel: JointsPanel, session: Session, viz: Visualizer
) -> None:
    session.motion._ticking = True  # pyright: ignore[reportPrivateUsage]
    edit(panel, "joints/turn", [f"j/{LEFT}"])
    session.motion.advance(0.5)
    assert viz.joint_positions[LEFT] == pytest.approx(0.5)
    edit(panel, "joints/rate", -2)
    session.motion.advance(0.5)
    assert viz.joint_positions[LEFT] == pytest.approx(-0.5)
    assert rows_of(panel)["joints/rate"].value == -2


def test_undo_stops_a_wheel_and_puts_it_where_it_stood_before_it_turned(
    panel: JointsPanel, session: Session, viz: Visualizer
) -> None:
    session.motion._ticking = True  # pyright: ignore[reportPrivateUsage]
    viz.set_joint_positions({LEFT: 0.25})
    for stops in (True, False):
        with session.history.acting(1):
            edit(panel, "joints/turn", [f"j/{LEFT}"])
        session.motion.advance(0.5)
        if stops:
            with session.history.acting(1):
                edit(panel, "joints/turn", [f"j/{LEFT}"])
        assert session.history.undo(1) == f"Turn {LEFT}"
        assert turning(panel) == []
        assert viz.joint_positions[LEFT] == 0.25
        session.history.redo(1)
        assert viz.joint_positions[LEFT] == pytest.approx(0.75)
        assert turning(panel) == []
        session.history.undo(1)


@pytest.mark.parametrize(
    ("row", "value", "reached"),
    [
        (f"j/{LEFT}", 0.25, 0.25),
        ("joints/center", [], 0.0),
        ("joints/randomize", [], 0),
    ],
)
def test_a_wheel_that_is_put_somewhere_stays_there(
    panel: JointsPanel,
    session: Session,
    viz: Visualizer,
    row: str,
    value: Any,
    reached: float,
) -> None:
    session.motion._ticking = True  # pyright: ignore[reportPrivateUsage]
    for wheel in (LEFT, RIGHT):
        edit(panel, "joints/turn", [f"j/{wheel}"])
    session.motion.advance(0.5)
    edit(panel, row, value)
    put = viz.joint_positions[LEFT]
    assert row == "joints/randomize" or put == reached
    session.motion.advance(0.5)
    assert viz.joint_positions[LEFT] == put
    # A value is for its wheel alone.
    assert turning(panel) == ([f"j/{RIGHT}"] if row == f"j/{LEFT}" else [])


def test_a_wheel_goes_to_its_pose_and_stays_there(
    session: Session, viz: Visualizer
) -> None:
    session.motion._ticking = True  # pyright: ignore[reportPrivateUsage]
    session.motion.turn(LEFT, 1.0)
    session.motion.glide({LEFT: 0.25}, 1.0)
    for _ in range(4):
        session.motion.advance(0.5)
    assert viz.joint_positions[LEFT] == 0.25
    assert not session.motion.moving


def test_the_turn_rate_can_be_undone(panel: JointsPanel, session: Session) -> None:
    for rate in (2.0, 3.0):
        with session.history.acting(1, gesture=7):
            edit(panel, "joints/rate", rate)
    assert session.history.undo(1) == "Turn rate"
    assert rows_of(panel)["joints/rate"].value == 1.0
    assert not session.history.modified.value


def test_nothing_turns_at_a_rate_of_zero(panel: JointsPanel) -> None:
    edit(panel, "joints/turn", [f"j/{LEFT}"])
    edit(panel, "joints/rate", 0)
    assert turning(panel) == []
    with pytest.raises(UsageError, match="nothing turns at a turn rate of 0"):
        edit(panel, "joints/turn", [f"j/{LEFT}"])


def test_a_robot_without_wheels_has_no_turn_rate(open_robot: Open) -> None:
    panel = open_robot(joint("j", "revolute", limit(-1, 1)))
    assert "joints/rate" not in rows_of(panel)


# Joints that cannot be set


def test_a_joint_that_follows_is_read_only_and_says_how(open_robot: Open) -> None:
    mimic = '<mimic joint="a" multiplier="-2" offset="0.5"/>'
    panel = open_robot(
        joint("a", "revolute", limit(-1, 1)),
        joint("b", "revolute", limit(-3, 3) + mimic),
    )
    row = row_named(panel, "b")
    assert row.set is None and row.parent == FOLLOWERS
    assert row.extra == {"follows": "j/a", "times": -2.0, "plus": 0.5}
    edit(panel, "j/a", 0.25)
    assert panel.values()["j/b"] == 0.0


def test_a_joint_without_a_position_says_why(open_robot: Open) -> None:
    panel = open_robot(
        joint("a", "revolute", limit(-1, 1)),
        joint("loose", "floating"),
        joint("tight", "fixed"),
    )
    assert names_below(panel, SKIPPED) == ["loose"]
    assert row_named(panel, "loose").value == "floating: has no position in ROS"


def test_a_joint_over_its_limit_is_named(open_robot: Open) -> None:
    over = '<mimic joint="a" multiplier="2"/>'
    panel = open_robot(
        joint("a", "revolute", limit(-1, 1)),
        joint("b", "revolute", limit(-1, 1) + over),
    )
    edit(panel, "j/a", 0.75)
    assert data_of(panel)["joints/over"] == ["b"]
    edit(panel, "j/a", 0.25)
    assert panel.values()["joints/over"] == []


def test_a_robot_with_nothing_to_move_says_so(open_robot: Open) -> None:
    panel = open_robot(joint("tight", "fixed"))
    (row,) = panel.rows()
    assert row.kind == "note" and "no joint to move" in row.value


# Many joints


def test_all_joints_of_a_large_robot_are_there_in_groups(open_robot: Open) -> None:
    panel = open_robot(*(joint(f"joint_{i}", "continuous") for i in range(300)))
    rows = panel.rows()
    groups = {row.id: row for row in rows if row.kind == "group"}
    sliders = [row for row in rows if row.kind == "slider"]
    assert len(sliders) == 300
    assert {row.parent for row in sliders} == set(groups)
    assert all(group.expanded for group in groups.values())


# Copying


def test_the_values_are_copied_as_a_joint_state(panel: JointsPanel) -> None:
    edit(panel, f"j/{LEFT}", 1.5)
    copied = answer(panel, "joints/copy", ["yaml"])
    assert isinstance(copied, Answer)
    assert copied.say == "2 joint values as yaml of a sensor_msgs/JointState"
    assert yaml.safe_load(copied.copy) == {
        "name": [LEFT, RIGHT],
        "position": [1.5, 0.0],
    }


@pytest.mark.parametrize(
    ("form", "part"),
    [
        ("command", "ros2 topic pub --once /joint_states"),
        ("launch", f"'zeros.{LEFT}': 0.0,"),
        ("arguments", f"--joint {LEFT}=0.0 --joint {RIGHT}=0.0"),
    ],
)
def test_the_values_are_copied_in_other_forms(
    panel: JointsPanel, form: str, part: str
) -> None:
    assert part in answer(panel, "joints/copy", [form]).copy


def test_an_unknown_form_is_refused(panel: JointsPanel) -> None:
    with pytest.raises(UsageError, match="there is no form 'xml'"):
        answer(panel, "joints/copy", ["xml"])


# The arrow in the scene


def test_moving_a_joint_twice_shows_its_axis_in_the_scene(
    panel: JointsPanel, session: Session
) -> None:
    before = set(session.audience.scene._handle_from_node_name)  # pyright: ignore
    edit(panel, f"j/{LEFT}", 0.1)
    edit(panel, f"j/{LEFT}", 0.2)
    nodes: Any = session.audience.scene._handle_from_node_name  # pyright: ignore
    new = {name.rpartition("/")[2]: node for name, node in nodes.items()}
    new = {name: new[name] for name in ("~positive", "~turn")}
    assert len(set(nodes) - before) == 2
    # The wheel turns about y: a round arc, and on it two heads that point along it.
    arc = np.asarray(new["~turn"].points)
    assert np.allclose(np.hypot(arc[..., 0], arc[..., 2]), 0.15, atol=1e-6)
    _, *heads = np.asarray(new["~positive"].points)
    for start, end in heads:
        middle, way = (start + end) / 2, end - start
        assert np.cross(middle, way)[1] > 0.0
        assert np.hypot(middle[0], middle[2]) == pytest.approx(0.15, abs=0.01)
        assert np.linalg.norm(way) == pytest.approx(0.0404, abs=1e-4)
