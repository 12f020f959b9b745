"""The Drive panel: speeds, buttons that are held, keys, Stop and Reset."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from inside import session_of
from panel_rows import edit, panel_of
from patience import until

from sambot_viz import Visualizer
from sambot_viz.errors import FrameError, UsageError
from sambot_viz.frames import Transform
from sambot_viz.panels.drive_panel import DrivePanel
from sambot_viz.panels.rows.row import Answer
from sambot_viz.session import Session
from sambot_viz.session.clients.client import Client
from sambot_viz.session.robot.robot_drive import KEEP, Drive
from sambot_viz.views.camera import vector

LEFT, RIGHT = "drivewhl_l_joint", "drivewhl_r_joint"
IN_ODOM = Answer("Fixed Frame is now odom. Undo puts it back.")


@pytest.fixture
def panel(session: Session) -> Iterator[DrivePanel]:
    """The panel, with steps that only the test takes."""
    session.motion._ticking = True  # pyright: ignore[reportPrivateUsage]
    yield panel_of(DrivePanel, session)


@pytest.fixture
def drive(session: Session) -> Drive:
    return session.drive


def send(panel: DrivePanel, row_id: str, value: Any) -> Any:
    return edit(panel, row_id, value)


def speeds(drive: Drive) -> tuple[float, float]:
    return drive.v, drive.w


def test_speeds_are_set_one_by_one_within_their_limits(
    panel: DrivePanel, drive: Drive
) -> None:
    edit(panel, "drive/linear", 0.3)
    edit(panel, "drive/angular", -1)
    assert speeds(drive) == (0.3, -1)
    assert (panel.values()["drive/linear"], panel.values()["drive/angular"]) == (
        0.3,
        -1,
    )
    with pytest.raises(UsageError, match="'Linear speed' cannot be"):
        edit(panel, "drive/linear", 1.5)


SET = pytest.mark.parametrize(
    ("row_id", "value"),
    [("drive/hold", [0.5, 0]), ("drive/press", ["8"]), ("drive/linear", 0.5)],
)
"""All that a hand at a page drives with."""


@SET
def test_a_robot_stops_when_no_page_says_that_it_drives_it(
    panel: DrivePanel, session: Session, drive: Drive, row_id: str, value: Any
) -> None:
    edit(panel, row_id, value)
    session.motion.advance(10 * KEEP)
    assert not drive.moving
    assert drive.pose.x == pytest.approx(KEEP * (0.1 if "press" in row_id else 0.5))
    assert panel.values()["drive/alone"]


@SET
def test_a_robot_drives_as_long_as_one_page_says_that_it_drives_it(
    panel: DrivePanel, session: Session, drive: Drive, row_id: str, value: Any
) -> None:
    edit(panel, row_id, value)
    for _ in range(5):
        session.motion.advance(0.9 * KEEP)
        edit(panel, "drive/keep")
    assert drive.moving
    assert not panel.values()["drive/alone"]


def test_a_page_that_comes_late_does_not_start_the_robot_again(
    panel: DrivePanel, session: Session, drive: Drive
) -> None:
    edit(panel, "drive/linear", 0.5)
    session.motion.advance(2 * KEEP)
    edit(panel, "drive/keep")
    assert not drive.moving


@pytest.mark.parametrize("end", ["drive/stop", "drive/reset"])
def test_the_next_command_of_a_hand_ends_what_is_said_of_the_stop(
    panel: DrivePanel, session: Session, end: str
) -> None:
    edit(panel, "drive/linear", 0.5)
    session.motion.advance(2 * KEEP)
    assert panel.values()["drive/alone"]
    edit(panel, end)
    assert not panel.values()["drive/alone"]


def test_a_program_drives_without_a_page(session: Session, drive: Drive) -> None:
    drive.set_velocity(0.5, 0.0)
    session.motion._ticking = True  # pyright: ignore[reportPrivateUsage]
    session.motion.advance(10 * KEEP)
    assert drive.moving


def test_a_held_button_drives_no_faster_than_the_limits(
    panel: DrivePanel, drive: Drive
) -> None:
    edit(panel, "drive/hold", [50, -50])
    assert speeds(drive) == (1, -2)


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        ("88", (0.2, 0)),
        ("2", (-0.1, 0)),
        ("44", (0, 0.5)),
        ("86", (0.1, -0.25)),
        ("885", (0, 0)),
    ],
)
def test_the_keys_of_a_number_pad_change_the_speeds(
    panel: DrivePanel, drive: Drive, keys: str, expected: tuple[float, float]
) -> None:
    for key in keys:
        edit(panel, "drive/press", [key])
    assert speeds(drive) == pytest.approx(expected)


def test_the_yaw_is_shown_within_half_a_turn(
    panel: DrivePanel, session: Session
) -> None:
    edit(panel, "drive/angular", 2)
    session.motion.advance(1.0)
    edit(panel, "drive/keep")
    session.motion.advance(1.0)
    assert panel.values()["drive/yaw"] == pytest.approx(4 - 2 * math.pi, abs=1e-4)


def test_another_key_is_refused(panel: DrivePanel) -> None:
    with pytest.raises(UsageError, match="no key '7' drives the robot"):
        edit(panel, "drive/press", ["7"])


def test_stop_and_reset_put_robot_wheels_and_path_back(
    panel: DrivePanel, session: Session, drive: Drive, viz: Visualizer
) -> None:
    edit(panel, "drive/linear", 0.5)
    session.motion.advance(1.0)
    assert viz.joint_positions[LEFT] != 0 and len(drive.trail) > 1
    edit(panel, "drive/stop", None)
    assert speeds(drive) == (0, 0)
    assert panel.values()["drive/x"] == 0.5
    edit(panel, "drive/reset", None)
    assert (panel.values()["drive/x"], panel.values()["drive/yaw"]) == (0, 0)
    assert viz.joint_positions[LEFT] == viz.joint_positions[RIGHT] == 0
    assert len(drive.trail) == 1


# What the motion is seen in


def test_driving_fixes_a_frame_that_the_robot_moves_in(
    panel: DrivePanel, session: Session, client: Client
) -> None:
    assert session.scene.context.fixed_frame == "base_link"
    client.view.set("Distance", 2.0)
    with session.history.acting(client.client_id):
        assert send(panel, "drive/hold", [0.5, 0]) == IN_ODOM
    assert session.scene.context.fixed_frame == "odom"
    assert client.view.values["Distance"] == 2
    with session.history.acting(client.client_id):
        assert send(panel, "drive/hold", [0.5, 0]) is None
    session.history.undo(client.client_id)
    assert session.scene.context.fixed_frame == "base_link"


def test_back_at_its_start_the_frame_that_was_fixed_before_is_told(
    panel: DrivePanel, session: Session, client: Client
) -> None:
    with session.history.acting(client.client_id):
        assert send(panel, "drive/hold", [0.5, 0]) == IN_ODOM
        again = Answer("Fixed Frame is base_link again")
        assert send(panel, "drive/reset", None) == again
        assert send(panel, "drive/reset", None) is None
    assert session.scene.context.fixed_frame == "base_link"


def test_starting_to_drive_keeps_the_camera_and_reset_brings_it_back(
    panel: DrivePanel, session: Session, client: Client
) -> None:
    client.view.set("Distance", 1.0)
    before = dict(client.view.values)
    with session.history.acting(client.client_id):
        edit(panel, "drive/linear", 1.0)
        assert dict(client.view.values) == before
        for _ in range(20):
            session.motion.advance(0.2)
            edit(panel, "drive/keep")
            session.follow_view.follow(vector(session.drive.pose.x, 0.0, 0.1))
        assert session.drive.pose.x == pytest.approx(4)
        assert client.view.camera.look_at[0] > 2
        assert client.view.values["Distance"] == pytest.approx(1.0)
        edit(panel, "drive/reset", None)
    assert session.scene.context.fixed_frame == "base_link"
    assert client.view.camera.look_at == pytest.approx((0, 0, 0), abs=1e-6)
    assert client.view.values["Distance"] == pytest.approx(1.0)


def test_back_at_its_start_the_robot_is_seen_by_who_looked_at_it(
    panel: DrivePanel, session: Session, join: Callable[[], Client]
) -> None:
    driver, loaded, elsewhere, still = join(), join(), join(), join()
    with session.history.acting(driver.client_id):
        edit(panel, "drive/linear", 1.0)
        for _ in range(20):
            session.motion.advance(0.2)
            edit(panel, "drive/keep")
            session.follow_view.follow(vector(session.drive.pose.x, 0.0, 0.1))
        # A page that comes back has its own camera.
        loaded.view.pan(vector(4.0, 0.0, 0.0))
        elsewhere.view.pan(vector(-50.0, 0.0, 0.0))
        edit(panel, "drive/reset", None)
    assert driver.view.camera.look_at == pytest.approx((0, 0, 0), abs=1e-6)
    assert loaded.view.camera.look_at[0] == pytest.approx(0.0, abs=0.3)
    assert elsewhere.view.camera.look_at[0] == pytest.approx(-50.0)
    assert still.view.camera.look_at[0] == pytest.approx(0.0)


def test_a_driven_robot_stays_in_the_picture_when_the_fixed_frame_changes(
    panel: DrivePanel, session: Session, client: Client
) -> None:
    tree = session.scene.context.tree

    def in_picture() -> tuple[float, ...]:
        fixed = session.scene.context.fixed_frame
        place = tree.lookup(fixed, "base_link").translation
        aside = place - client.view.camera.look_at
        return tuple(round(float(part), 6) for part in aside[:2])

    with session.history.acting(client.client_id):
        edit(panel, "drive/linear", 1.0)
        session.motion.advance(1.0)
        edit(panel, "drive/stop", None)
    until(lambda: tree.lookup("odom", "base_link").translation[0] == 1.0)
    session.follow_view.find(client.client_id)
    before = in_picture()
    with session.history.acting(client.client_id):
        session.document.set_option("Fixed Frame", "base_link")
    assert in_picture() == before
    # The same robot goes on from there.
    with session.history.acting(client.client_id):
        edit(panel, "drive/linear", 1.0)
        edit(panel, "drive/stop", None)
    assert session.scene.context.fixed_frame == "odom"
    assert in_picture() == before
    for act in (*[session.history.undo] * 3, *[session.history.redo] * 3):
        act(client.client_id)
        assert in_picture() == before


def test_who_looks_elsewhere_keeps_its_view_when_the_fixed_frame_changes(
    panel: DrivePanel, session: Session, join: Callable[[], Client]
) -> None:
    driver, other = join(), join()
    with session.history.acting(driver.client_id):
        edit(panel, "drive/linear", 1.0)
        session.motion.advance(1.0)
    other.view.pan(vector(-50.0, 0.0, 0.0))
    session.history.undo(driver.client_id)
    assert session.scene.context.fixed_frame == "base_link"
    assert other.view.camera.look_at[0] == pytest.approx(-50.0)


def test_reset_leaves_a_fixed_frame_that_was_chosen_alone(
    panel: DrivePanel, session: Session, client: Client
) -> None:
    with session.history.acting(client.client_id):
        edit(panel, "drive/linear", 1.0)
        session.document.set_option("Fixed Frame", "drivewhl_l_link")
        edit(panel, "drive/reset", None)
        assert session.scene.context.fixed_frame == "drivewhl_l_link"


def test_reset_takes_odom_away_and_undo_brings_it_back(
    panel: DrivePanel, session: Session, client: Client
) -> None:
    tree = session.scene.context.tree
    before = set(tree.frames)
    with session.history.acting(client.client_id):
        edit(panel, "drive/linear", 1.0)
        session.motion.advance(1.0)
        assert set(tree.frames) == before | {"odom"}
        edit(panel, "drive/reset", None)
        assert set(tree.frames) == before
        assert session.scene.context.fixed_frame in before
    session.history.undo(client.client_id)
    assert tree.lookup("odom", "base_link").translation[0] == 0
    with session.history.acting(client.client_id):
        edit(panel, "drive/linear", 1.0)
        session.motion.advance(1.0)
    # Motions are drawn at the Frame Rate.
    until(lambda: tree.lookup("odom", "base_link").translation[0] == 1.0)
    while session.history.undo(client.client_id) is not None:
        assert session.scene.context.fixed_frame in tree.frames


def test_reset_leaves_an_odom_that_somebody_uses(
    panel: DrivePanel, session: Session, client: Client
) -> None:
    with session.history.acting(client.client_id):
        edit(panel, "drive/linear", 1.0)
        session.motion.advance(1.0)
        still = Transform.from_xyz_rpy((0, 0, 0), (0, 0, 0))
        session.frames.add("map", "odom", still)
        edit(panel, "drive/reset", None)
    assert session.scene.context.tree.parent("base_link") == "odom"


def test_a_fixed_frame_in_the_world_stays(panel: DrivePanel, session: Session) -> None:
    session.drive.enter_odom()
    session.frames.add(
        "map", "odom", Transform.from_xyz_rpy((1.0, 0.0, 0.0), (0, 0, 0))
    )
    session.document.set_option("Fixed Frame", "map")
    assert send(panel, "drive/linear", 0.1) is None
    assert session.scene.context.fixed_frame == "map"


def test_a_robot_that_is_attached_to_another_frame_is_not_driven(
    panel: DrivePanel, session: Session
) -> None:
    session.frames.add("map", "base_link", Transform.from_xyz_rpy((0, 0, 0), (0, 0, 0)))
    with pytest.raises(FrameError, match="attached to 'map' already"):
        edit(panel, "drive/linear", 0.1)


def test_a_robot_without_two_wheels_has_no_drive_panel(tmp_path: Path) -> None:
    model = tmp_path / "box.urdf"
    model.write_text('<robot name="box"><link name="a"/></robot>')
    with Visualizer(model, port=0, watch=False) as viz:
        assert [*panel_of(DrivePanel, session_of(viz)).rows()] == []
