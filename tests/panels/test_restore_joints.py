"""The positions that a page brings back after the program was started again."""

from __future__ import annotations

from typing import Any

import pytest
from inside import session_of
from panel_rows import data_of, edit, panel_of

from sambot_viz import Visualizer
from sambot_viz.errors import UsageError
from sambot_viz.panels.joints.joints_panel import JointsPanel
from sambot_viz.session import Session

LEFT, RIGHT = "drivewhl_l_joint", "drivewhl_r_joint"


@pytest.fixture
def panel(session: Session) -> JointsPanel:
    return panel_of(JointsPanel, session)


def bring_back(
    panel: JointsPanel, session: Session, client: int, joints: dict[str, Any]
) -> object:
    with session.history.acting(client):
        return edit(panel, "joints/restore", [[*joints], [*joints.values()]])


def test_the_first_page_brings_the_joints_back_in_one_step(
    panel: JointsPanel, session: Session, viz: Visualizer
) -> None:
    assert panel.values()["joints/untouched"] is True
    before = dict(viz.joint_positions)
    assert bring_back(panel, session, 1, {f"j/{LEFT}": 0.5, f"j/{RIGHT}": 1.0})
    assert (viz.joint_positions[LEFT], viz.joint_positions[RIGHT]) == (0.5, 1.0)
    assert panel.values()["joints/untouched"] is False
    assert bring_back(panel, session, 2, {f"j/{LEFT}": 3.0}) is None
    assert viz.joint_positions[LEFT] == 0.5
    assert session.history.state(2).value.undo is None
    assert session.history.undo(1) == "Restore joints"
    assert viz.joint_positions == before


def test_what_a_user_or_a_program_has_moved_stays(
    panel: JointsPanel, session: Session, viz: Visualizer
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
    panel: JointsPanel, session: Session, viz: Visualizer, joints: dict[str, Any]
) -> None:
    with pytest.raises(UsageError):
        bring_back(panel, session, 1, joints)
    assert viz.joint_positions[LEFT] == 0.0


def test_where_the_joints_were_at_first_is_known() -> None:
    with Visualizer(port=0, joint_positions={RIGHT: 0.5}) as viz:
        viz.set_joint_positions({RIGHT: 0.1})
        panel = panel_of(JointsPanel, session_of(viz))
        assert data_of(panel)["joints/first"] == {f"j/{RIGHT}": 0.5}
