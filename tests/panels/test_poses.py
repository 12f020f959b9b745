"""Named poses: saved in a file that is named, chosen again, removed."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from inside import node_of, session_of
from panel_rows import data_of, edit, panel_of

from sambot_viz import Visualizer, limits
from sambot_viz.errors import JointError, UsageError
from sambot_viz.panels.joints.poses import MOVE_TIME, GhostPanel, PosesPanel
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Answer
from sambot_viz.session import Session
from sambot_viz.session.clients.client import Client

LEFT, RIGHT = "drivewhl_l_joint", "drivewhl_r_joint"


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "some.poses.yaml"


@pytest.fixture
def viz(path: Path, make_viz: Callable[..., Visualizer]) -> Visualizer:
    return make_viz(poses=path)


@pytest.fixture
def remade() -> list[Panel]:
    return []


@pytest.fixture
def panel(session: Session, remade: list[Panel]) -> PosesPanel:
    return panel_of(PosesPanel, session, remake=remade.append)


def send(panel: PosesPanel, row_id: str, *values: Any) -> Any:
    return edit(panel, row_id, [*values])


def names(panel: PosesPanel) -> list[str]:
    return data_of(panel)["poses/names"]


def test_a_pose_is_kept_in_the_file_that_is_named_when_it_is_saved(
    panel: PosesPanel, viz: Visualizer, path: Path, remade: list[Panel]
) -> None:
    viz.set_joint_positions({LEFT: 1.25})
    assert send(panel, "poses/save", " half ") == Answer(f"Saved pose 'half' in {path}")
    assert names(panel) == ["half"] and remade == [panel]
    assert data_of(panel)["poses/place"] == f"Saved in {path}."
    with Visualizer(port=0, poses=path) as again:
        other = panel_of(PosesPanel, session_of(again), remake=remade.append)
        send(other, "poses/use", "half")
        assert again.joint_positions[LEFT] == 1.25


def test_choosing_a_pose_can_be_undone(
    panel: PosesPanel, session: Session, viz: Visualizer
) -> None:
    viz.set_joint_positions({LEFT: 1.25})
    send(panel, "poses/save", "half")
    viz.set_joint_positions({LEFT: 0.5})
    with session.history.acting(1):
        assert send(panel, "poses/use", "half") is None
    assert viz.joint_positions[LEFT] == 1.25
    session.history.undo(1)
    assert viz.joint_positions[LEFT] == 0.5


def test_a_pose_of_another_robot_says_what_is_left_out(path: Path) -> None:
    path.write_text(f"odd: {{arm: 1.0, {LEFT}: 0.25}}\n")
    with Visualizer(port=0, poses=path) as viz:
        panel = panel_of(PosesPanel, session_of(viz))
        said = send(panel, "poses/use", "odd")
        assert said == Answer("Without arm, which cannot be set")
        assert viz.joint_positions[LEFT] == 0.25


def test_a_removed_pose_comes_back_by_undo(
    panel: PosesPanel, session: Session, path: Path
) -> None:
    send(panel, "poses/save", "half")
    with session.history.acting(1):
        said = send(panel, "poses/remove", "half")
    assert said == Answer("Removed pose 'half'; Undo brings it back")
    assert names(panel) == [] and "half" not in path.read_text()
    session.history.undo(1)
    assert names(panel) == ["half"] and "half" in path.read_text()


def test_a_pose_needs_a_name_that_is_not_too_long(panel: PosesPanel) -> None:
    with pytest.raises(JointError, match="a pose needs a name"):
        edit(panel, "poses/save", ["  "])
    with pytest.raises(UsageError, match="at most 60 characters"):
        edit(panel, "poses/save", ["x" * 61])


def test_there_is_room_for_a_hundred_poses(panel: PosesPanel, path: Path) -> None:
    for number in range(limits.SESSION_POSES.value):
        send(panel, "poses/save", f"p{number}")
    with pytest.raises(UsageError, match="100 named poses; remove one first"):
        edit(panel, "poses/save", ["one more"])
    send(panel, "poses/save", "p0")
    send(panel, "poses/remove", "p0")
    send(panel, "poses/save", "one more")
    assert "one more" in path.read_text()


def test_an_unknown_pose_is_refused(panel: PosesPanel) -> None:
    with pytest.raises(JointError, match="no pose 'half'"):
        edit(panel, "poses/use", ["half"])


def test_a_visitor_keeps_poses_in_memory_only(
    session: Session, viz: Visualizer
) -> None:
    session.poses = session.poses.in_memory()
    panel = panel_of(PosesPanel, session)
    assert data_of(panel)["poses/place"] == "Saved in memory only."
    assert send(panel, "poses/save", "half") == Answer(
        "Saved pose 'half' in memory only"
    )


def test_a_pose_is_gone_to_in_steps_and_undone_at_once(
    panel: PosesPanel, session: Session, viz: Visualizer, client: Client
) -> None:
    motion = session.motion
    motion._ticking = True  # pyright: ignore[reportPrivateUsage]
    viz.set_joint_positions({LEFT: 1.0})
    send(panel, "poses/save", "one")
    viz.set_joint_positions({LEFT: 0.0})
    with session.history.acting(client.client_id):
        assert send(panel, "poses/move", "one") is None
    seen: list[float] = []
    for _ in range(3):
        motion.advance(MOVE_TIME / 3)
        seen.append(viz.joint_positions[LEFT])
    assert seen == [pytest.approx(0.25), pytest.approx(0.75), 1.0]
    assert not motion.moving
    assert session.history.undo(client.client_id) == "Pose one"
    assert viz.joint_positions[LEFT] == 0.0


def test_a_joint_that_is_moved_on_the_way_to_a_pose_stays_there(
    panel: PosesPanel, session: Session, viz: Visualizer
) -> None:
    motion = session.motion
    motion._ticking = True  # pyright: ignore[reportPrivateUsage]
    viz.set_joint_positions({LEFT: 1.0, RIGHT: 1.0})
    send(panel, "poses/save", "both")
    viz.set_joint_positions({LEFT: 0.0, RIGHT: 0.0})
    send(panel, "poses/move", "both")
    motion.advance(MOVE_TIME / 2)
    viz.set_joint_positions({LEFT: -0.5})
    motion.advance(MOVE_TIME)
    assert viz.joint_positions == {LEFT: -0.5, RIGHT: 1.0}


def test_a_ghost_has_the_poses_of_the_links_and_moves_no_joint(
    session: Session, viz: Visualizer
) -> None:
    viz.set_joint_positions({LEFT: 1.0})
    session.poses.save("one", {LEFT: 1.0})
    viz.set_joint_positions({LEFT: 0.0})
    ghost = panel_of(GhostPanel, session)
    assert data_of(ghost)["poses/ghost"] is None
    edit(ghost, "poses/show", ["one"])
    shown = data_of(ghost)["poses/ghost"]
    wheel = shown["links"][node_of(viz, "drivewhl_l_link").rpartition("/")[2]]
    assert wheel[:3] == pytest.approx([-0.12, 0.18, -0.05])
    assert abs(wheel[3]) == pytest.approx(math.cos(0.5))
    assert viz.joint_positions[LEFT] == 0.0
    with pytest.raises(JointError, match="no pose 'two'"):
        edit(ghost, "poses/show", ["two"])
    edit(ghost, "poses/show", [""])
    assert data_of(ghost)["poses/ghost"] is None
