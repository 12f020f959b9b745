"""The positions that a page brings back after the program was started again."""

from __future__ import annotations

from typing import Any

import pytest
from inside import session_of

from sambot_viz import Visualizer
from sambot_viz.errors import UsageError
from sambot_viz.panels import gate
from sambot_viz.panels.joints.joints import JointsPanel
from sambot_viz.panels.joints.joints_again import JointsAgainPanel
from sambot_viz.session import Session

LEFT, RIGHT = "drivewhl_l_joint", "drivewhl_r_joint"


@pytest.fixture
def panel(session: Session) -> JointsAgainPanel:
    joints = JointsPanel(session, lambda panel: None)
    return JointsAgainPanel(
        session, lambda row_id: {row.id: row for row in joints.rows()}.get(row_id)
    )


def bring_back(
    panel: JointsAgainPanel, session: Session, browser: int, joints: dict[str, Any]
) -> object:
    row = {row.id: row for row in panel.rows()}["joints/again"]
    assert row.set is not None
    with session.edits.acting(browser):
        return row.set(gate.checked(row, [[*joints], [*joints.values()]]))


def test_the_first_page_brings_the_joints_back_in_one_step(
    panel: JointsAgainPanel, session: Session, viz: Visualizer
) -> None:
    assert panel.values() == {"joints/again": True}
    before = dict(viz.joint_positions)
    assert bring_back(panel, session, 1, {f"j/{LEFT}": 0.5, f"j/{RIGHT}": 1.0})
    assert (viz.joint_positions[LEFT], viz.joint_positions[RIGHT]) == (0.5, 1.0)
    assert panel.values() == {"joints/again": False}
    assert bring_back(panel, session, 2, {f"j/{LEFT}": 3.0}) is None
    assert viz.joint_positions[LEFT] == 0.5
    assert session.edits.undo_label(2) is None
    assert session.edits.undo(1) == "Joints as before the restart"
    assert viz.joint_positions == before


def test_what_a_user_or_a_program_has_moved_stays(
    panel: JointsAgainPanel, session: Session, viz: Visualizer
) -> None:
    viz.set_joint_positions({RIGHT: 0.1})
    assert bring_back(panel, session, 1, {f"j/{LEFT}": 0.5}) is None
    assert viz.joint_positions[LEFT] == 0.0


@pytest.mark.parametrize(
    "joints",
    [
        {f"j/{LEFT}": 0.5, "j/other": 0.5},
        {f"j/{LEFT}": 9.0},
        {f"j/{LEFT}": "1"},
        {f"j/{LEFT}": None},
        {"joints/rate": 1.0},
    ],
)
def test_a_position_that_the_row_would_refuse_moves_nothing(
    panel: JointsAgainPanel, session: Session, viz: Visualizer, joints: dict[str, Any]
) -> None:
    with pytest.raises(UsageError):
        bring_back(panel, session, 1, joints)
    assert viz.joint_positions[LEFT] == 0.0


def test_where_the_joints_were_at_first_is_known() -> None:
    with Visualizer(port=0, joint_positions={RIGHT: 0.5}) as viz:
        viz.set_joint_positions({RIGHT: 0.1})
        panel = JointsAgainPanel(session_of(viz), lambda row_id: None)
        first = {row.id: row for row in panel.rows()}["joints/first"]
        assert first.value == {f"j/{RIGHT}": 0.5}
