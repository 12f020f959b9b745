"""Undo and redo: each browser its own edits, and whether the document is saved."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import pytest
import yaml

from sambot_viz import UsageError, Visualizer, bundled, limits, load_config
from sambot_viz.displays.display import Display
from sambot_viz.frames import Transform
from sambot_viz.rviz import DisplayConfig
from sambot_viz.session import Session
from sambot_viz.session.document.saved_views import SavedViews
from sambot_viz.session.scene.scene import walk
from sambot_viz.session.signals import connect

A, B = 1, 2
LEFT, RIGHT = "drivewhl_l_joint", "drivewhl_r_joint"
UNKNOWN = {"Class": "somewhere/Unknown", "Name": "Odd", "Enabled": "true", "X": "1"}


@pytest.fixture
def config(tmp_path: Path) -> Path:
    document = yaml.safe_load(bundled.config_path().read_text("utf-8"))
    manager = document["Visualization Manager"]
    group = {"Class": "rviz_common/Group", "Name": "Both", "Enabled": True}
    manager["Displays"] += [UNKNOWN, {**group, "Displays": []}]
    path = tmp_path / "test.rviz"
    path.write_text(yaml.safe_dump(document), "utf-8")
    return path


@pytest.fixture
def viz(config: Path, make_viz: Callable[..., Visualizer]) -> Visualizer:
    poses = config.parent / "poses.yaml"
    return make_viz(config=config, poses=poses)


def named(session: Session, name: str) -> DisplayConfig:
    return next(d for d in session.document.config.displays if d.name == name)


def display(session: Session, name: str) -> Display:
    found = session.scene.display_of(named(session, name))
    assert found is not None
    return found


def names(session: Session) -> list[str]:
    return [d.name for d in session.document.config.displays]


def act(
    session: Session, browser: int | None, *actions: Callable[[], Any], by: Any = None
) -> None:
    """One action of a browser."""
    with session.history.acting(browser, by):
        for action in actions:
            action()


def alpha(session: Session) -> float:
    return float(display(session, "RobotModel").config.get("Alpha"))


def set_alpha(session: Session, value: float) -> Callable[[], None]:
    return lambda: session.display_edits.set_property(
        display(session, "RobotModel"), "Alpha", value
    )


# One browser


def test_ten_changes_undone_give_the_first_value_and_the_file_is_not_modified(
    session: Session,
) -> None:
    before, text = alpha(session), session.document.config.to_yaml()
    for step in range(10):
        act(session, A, set_alpha(session, 0.05 * (step + 1)))
    assert session.history.modified.value
    assert session.history.state(A).value.undo == "RobotModel: Alpha"
    for _ in range(10):
        assert session.history.undo(A) == "RobotModel: Alpha"
    assert session.history.undo(A) is None
    assert (alpha(session), session.document.config.to_yaml()) == (before, text)
    assert not session.history.modified.value
    assert session.history.redo(A) == "RobotModel: Alpha"
    assert alpha(session) == 0.05
    assert session.history.modified.value


def test_a_new_edit_ends_what_could_be_done_again(session: Session) -> None:
    act(session, A, set_alpha(session, 0.5))
    session.history.undo(A)
    assert session.history.state(A).value.redo == "RobotModel: Alpha"
    act(session, A, lambda: session.document.set_option("Frame Rate", 12))
    assert session.history.state(A).value.redo is None
    assert session.history.redo(A) is None


def test_there_is_room_for_a_hundred_displays_and_views(session: Session) -> None:
    group = session.display_edits.add_display("rviz_common/Group")
    while (
        len(list(walk(session.document.config.displays)))
        < limits.SESSION_DISPLAYS.value
    ):
        session.display_edits.add_display("rviz_default_plugins/Grid", after=None)
    for add in (
        lambda: session.display_edits.add_display("rviz_default_plugins/Grid"),
        lambda: session.display_edits.duplicate_display(group),
    ):
        with pytest.raises(UsageError, match="100 displays; remove one first"):
            add()
    session.display_edits.remove_display(named(session, "Grid"))
    session.display_edits.duplicate_display(group)
    views = SavedViews(session.document, session.history, session.change)
    for _ in range(
        limits.SESSION_VIEWS.value - len(session.document.config.saved_views)
    ):
        views.add(session.document.config.view)
    with pytest.raises(UsageError, match="100 saved views"):
        views.add(session.document.config.view)


def test_a_drag_is_one_edit_and_the_next_drag_another(session: Session) -> None:
    before = alpha(session)
    for drag in ("first", "second"):
        for step in (0.2, 0.4, 0.6):
            value = step if drag == "first" else step + 0.1
            act(session, A, set_alpha(session, value), by=drag)
    session.history.undo(A)
    assert alpha(session) == pytest.approx(0.6)
    session.history.redo(A)
    assert alpha(session) == pytest.approx(0.7)
    session.history.undo(A)
    session.history.undo(A)
    assert alpha(session) == before
    assert session.history.state(A).value.undo is None


def test_a_gesture_over_two_values_is_two_edits(session: Session) -> None:
    grid = display(session, "Grid")
    for path, value in (("Alpha", 0.1), ("Cell Size", 2.0), ("Alpha", 0.2)):
        act(
            session,
            A,
            partial(session.display_edits.set_property, grid, path, value),
            by="one",
        )
    session.history.undo(A)
    assert grid.config.get("Alpha") == pytest.approx(0.1)
    session.history.undo(A)
    assert grid.config.get("Cell Size") == 1.0


def test_what_one_action_changes_is_undone_together(session: Session) -> None:
    before, rate = (
        alpha(session),
        session.document.config.global_options.get("Frame Rate"),
    )
    act(
        session,
        A,
        set_alpha(session, 0.5),
        lambda: session.document.set_option("Frame Rate", 7),
        set_alpha(session, 0.25),
    )
    session.history.undo(A)
    assert alpha(session) == before
    assert session.document.config.global_options.get("Frame Rate") == rate
    assert session.history.state(A).value.undo is None
    session.history.redo(A)
    assert alpha(session) == 0.25


def test_the_oldest_edits_are_forgotten(session: Session) -> None:
    for step in range(limits.UNDO.value + 5):
        act(session, A, set_alpha(session, 0.001 * (step + 1)))
    count = 0
    while session.history.undo(A) is not None:
        count += 1
    assert count == limits.UNDO.value
    assert alpha(session) == pytest.approx(0.005)
    assert session.history.modified.value


# Several browsers, and programs


def test_each_browser_undoes_its_own_edits_only(session: Session) -> None:
    grid = display(session, "Grid")
    act(session, A, set_alpha(session, 0.5))
    act(session, B, lambda: session.display_edits.set_property(grid, "Cell Size", 2.0))
    session.history.undo(A)
    assert (alpha(session), grid.config.get("Cell Size")) == (0.6, 2.0)
    assert session.history.undo(A) is None
    session.history.undo(B)
    assert grid.config.get("Cell Size") == 1.0
    assert not session.history.modified.value


def test_an_edit_whose_display_is_gone_is_dropped_with_a_sentence(
    session: Session,
) -> None:
    rate = session.document.config.global_options.get("Frame Rate")
    act(session, A, lambda: session.document.set_option("Frame Rate", 8))
    act(
        session,
        A,
        set_alpha(session, 0.5),
        lambda: session.document.set_option("Frame Rate", 12),
    )
    robot = named(session, "RobotModel")
    act(session, B, lambda: session.display_edits.remove_display(robot))
    with pytest.raises(
        UsageError,
        match="'RobotModel: Alpha' cannot be undone: the display 'RobotModel' was ",
    ):
        session.history.undo(A)
    assert session.document.config.global_options.get("Frame Rate") == 12, (
        "all or nothing"
    )
    assert session.history.undo(A) == "Global Options: Frame Rate"
    assert session.document.config.global_options.get("Frame Rate") == rate
    session.history.undo(B)
    assert alpha(session) == 0.5


def test_a_browser_that_leaves_loses_its_history_but_not_its_edits(
    session: Session,
) -> None:
    act(session, A, set_alpha(session, 0.5))
    session.history.leave(A)
    assert session.history.undo(A) is None
    assert alpha(session) == 0.5
    assert session.history.modified.value


def test_edits_of_a_program_count_but_cannot_be_undone(session: Session) -> None:
    act(session, None, set_alpha(session, 0.5))
    assert session.history.modified.value
    session.history.saved()
    assert not session.history.modified.value
    set_alpha(session, 0.6)()
    assert session.history.modified.value
    assert session.history.undo(A) is None


# Saved or not


def test_modified_is_about_what_was_saved_last(
    session: Session, tmp_path: Path
) -> None:
    act(session, A, set_alpha(session, 0.5))
    session.document.save(tmp_path / "saved.rviz")
    assert not session.history.modified.value
    session.history.undo(A)
    assert session.history.modified.value
    session.history.redo(A)
    assert not session.history.modified.value


def test_an_edit_that_takes_another_back_leaves_nothing_to_save(
    session: Session,
) -> None:
    def tick(on: bool) -> Callable[[], None]:
        return lambda: session.display_edits.set_enabled(named(session, "Grid"), on)

    for _ in range(2):
        act(session, A, tick(False))
        assert session.history.modified.value
        act(session, A, tick(True))
        assert not session.history.modified.value
    session.history.undo(A)
    assert session.history.modified.value
    for _ in range(3):
        session.history.undo(A)
    assert not session.history.modified.value


def test_a_drag_does_not_look_at_the_whole_document(session: Session) -> None:
    looks = []
    session.history.is_as_saved = lambda: looks.append(1) is None and False
    for value in (0.5, 0.6, 0.7):
        act(session, A, set_alpha(session, value), by="drag")
    assert looks == []
    act(session, A, set_alpha(session, 0.8))
    assert len(looks) == 1


def test_a_drag_that_goes_on_after_a_save_is_not_saved(session: Session) -> None:
    act(session, A, set_alpha(session, 0.5), by="drag")
    session.history.saved()
    act(session, A, set_alpha(session, 0.6), by="drag")
    assert session.history.modified.value


def test_joints_frames_and_values_that_stay_are_no_edits_of_the_document(
    session: Session,
) -> None:
    act(session, A, lambda: session.robot.set_positions({LEFT: 1.0}))
    act(session, A, session.robot.center, set_alpha(session, alpha(session)))
    T = Transform.from_xyz_rpy((0.1, 0, 0))
    act(session, A, lambda: session.frames.add("base_link", "laser", T))
    assert not session.history.modified.value


def test_another_document_starts_with_an_empty_history(
    session: Session, config: Path
) -> None:
    act(session, A, set_alpha(session, 0.5))
    session.document.replace(load_config(config))
    assert not session.history.modified.value
    assert session.history.undo(A) is None


# What can be undone


def test_one_box_that_switches_all_links_is_undone_with_all_of_them(
    session: Session,
) -> None:
    robot = display(session, "RobotModel")
    links = "Links"

    def box(link: str) -> bool:
        entries = next(e for e in robot.entries() if e.title == links)
        return bool(entries.item(link).get("Value"))

    act(
        session,
        A,
        lambda: session.display_edits.set_entry(
            robot, links, "base_link", "Value", False
        ),
    )
    text = session.document.config.to_yaml()
    for on in (False, True):
        act(
            session,
            A,
            partial(
                session.display_edits.set_property, robot, "Links/All Links Enabled", on
            ),
        )
    assert box("base_link")
    session.history.undo(A)
    session.history.undo(A)
    assert session.document.config.to_yaml() == text
    assert (box("base_link"), box("drivewhl_l_link")) == (False, True)
    assert session.history.undo(A) == "RobotModel: base_link/Value"
    assert box("base_link")
    session.history.redo(A)
    assert not box("base_link")


def test_the_box_of_a_frame_is_undone(session: Session) -> None:
    tf = display(session, "TF")

    def on() -> bool:
        (frames,) = tf.entries()
        return bool(frames.item("base_link").get("Value"))

    act(
        session,
        A,
        lambda: session.display_edits.set_entry(
            tf, "Frames", "base_link", "Value", False
        ),
    )
    assert not on()
    session.history.undo(A)
    assert on()
    assert "base_link" not in tf.config.dynamic("Frames")


def test_an_entry_that_does_not_exist_is_refused(session: Session) -> None:
    robot = display(session, "RobotModel")
    with pytest.raises(UsageError, match="'RobotModel' has no link 'x'"):
        session.display_edits.set_entry(robot, "Links", "x", "Alpha", 1.0)
    with pytest.raises(UsageError, match="'RobotModel' has no Frames"):
        session.display_edits.set_entry(robot, "Frames", "x", "Value", True)


def test_the_fixed_frame_and_the_background_are_undone(session: Session) -> None:
    frame, color = session.scene.context.fixed_frame, session.scene.context.background
    act(
        session,
        A,
        lambda: session.document.set_option("Fixed Frame", "drivewhl_l_link"),
    )
    act(session, A, lambda: session.document.set_option("Background Color", (1, 2, 3)))
    assert session.scene.context.background == (1, 2, 3)
    session.history.undo(A)
    session.history.undo(A)
    assert (session.scene.context.fixed_frame, session.scene.context.background) == (
        frame,
        color,
    )


def test_displays_are_added_copied_named_moved_removed_and_all_that_is_undone(
    session: Session,
) -> None:
    before, text = names(session), session.document.config.to_yaml()
    grid, group = named(session, "Grid"), named(session, "Both")
    act(
        session,
        A,
        lambda: session.display_edits.add_display("rviz_default_plugins/Axes", grid),
    )
    assert names(session).index("Axes") == before.index("Grid") + 1
    act(session, A, lambda: session.display_edits.duplicate_display(grid))
    act(
        session,
        A,
        lambda: session.display_edits.duplicate_display(named(session, "Grid (2)")),
    )
    assert {"Grid", "Grid (2)", "Grid (3)"} <= set(names(session))
    act(session, A, lambda: session.display_edits.rename_display(grid, " Floor "))
    act(session, A, lambda: session.display_edits.move_display(grid, 0, group))
    assert [d.name for d in group.displays] == ["Floor"]
    act(session, A, lambda: session.display_edits.remove_display(group))
    assert session.scene.display_of(grid) is None
    for label in (
        "Remove Both",
        "Move Floor",
        "Rename Grid to Floor",
        "Duplicate Grid (2)",
        "Duplicate Grid",
        "Add Axes",
    ):
        assert session.history.undo(A) == label
    assert names(session) == before
    assert session.document.config.to_yaml() == text
    assert named(session, "Grid") is grid, "the same display is put back"
    while session.history.redo(A) is not None:
        pass
    assert {"Axes", "Grid (2)", "Grid (3)"} <= set(names(session))
    assert not {"Floor", "Grid", "Both"} & set(names(session))


def test_an_unsupported_display_is_moved_named_switched_and_removed(
    session: Session,
) -> None:
    odd, text = named(session, "Odd"), session.document.config.to_yaml()
    act(session, A, lambda: session.display_edits.set_enabled(odd, False))
    act(session, A, lambda: session.display_edits.rename_display(odd, "Strange"))
    act(session, A, lambda: session.display_edits.move_display(odd, 0, None))
    assert names(session)[0] == "Strange"
    assert not odd.enabled
    act(session, A, lambda: session.display_edits.remove_display(odd))
    for _ in range(4):
        session.history.undo(A)
    assert odd.enabled
    assert session.document.config.to_yaml() == text


def test_what_goes_nowhere_is_no_edit(session: Session) -> None:
    grid = named(session, "Grid")
    act(session, A, lambda: session.display_edits.rename_display(grid, "  "))
    act(session, A, lambda: session.display_edits.rename_display(grid, "Grid"))
    act(
        session,
        A,
        lambda: session.display_edits.move_display(
            grid, names(session).index("Grid"), None
        ),
    )
    act(session, A, lambda: session.display_edits.set_enabled(grid, grid.enabled))
    with pytest.raises(UsageError, match="cannot be moved into itself"):
        act(
            session,
            A,
            lambda: session.display_edits.move_display(
                named(session, "Both"), 0, named(session, "Both")
            ),
        )
    assert session.history.state(A).value.undo is None
    assert not session.history.modified.value


def test_a_display_that_was_removed_takes_no_edits(session: Session) -> None:
    robot = display(session, "RobotModel")
    session.display_edits.remove_display(robot.config)
    for edit in (
        lambda: session.display_edits.set_property(robot, "Alpha", 0.5),
        lambda: session.display_edits.set_enabled(robot, False),
        lambda: session.display_edits.rename_display(robot.config, "x"),
        lambda: session.display_edits.move_display(robot.config, 0, None),
        lambda: session.display_edits.duplicate_display(robot.config),
        lambda: session.display_edits.remove_display(robot.config),
        lambda: session.display_edits.add_display(
            "rviz_default_plugins/Grid", robot.config
        ),
    ):
        with pytest.raises(UsageError, match="the display 'RobotModel' was removed"):
            edit()


def test_joints_go_back_to_where_they_were(viz: Visualizer, session: Session) -> None:
    for step in (0.1, 0.2, 0.3):
        act(session, A, partial(session.robot.set_positions, {LEFT: step}), by="drag")
    act(session, A, session.robot.randomize)
    act(session, A, session.robot.center)
    session.poses.save("turned", {LEFT: 2.0, "gone": 1.0})
    with session.history.acting(A):
        assert session.robot.take_pose("turned", session.poses.get("turned")) == (
            "gone",
        )
    viz.set_joint_positions({RIGHT: -1.0})
    assert viz.joint_positions == {LEFT: 2.0, RIGHT: -1.0}
    labels = [session.history.undo(A) for _ in range(4)]
    assert labels == [
        "Pose turned",
        "Center the joints",
        "Randomize the joints",
        f"Move {LEFT}",
    ]
    assert viz.joint_positions[LEFT] == 0.0
    session.history.redo(A)
    assert viz.joint_positions[LEFT] == 0.3


def test_frames_are_added_changed_and_removed_and_all_that_is_undone(
    viz: Visualizer, session: Session
) -> None:
    def x() -> float:
        return float(viz.frames.lookup("base_link", "laser").translation[0])

    for at in (1.0, 2.0):
        T = Transform.from_xyz_rpy((at, 0, 0))
        act(session, A, partial(session.frames.add, "base_link", "laser", T))
    act(session, A, lambda: session.frames.remove("laser"))
    assert session.history.undo(A) == "Remove frame laser"
    assert x() == 2.0
    session.history.undo(A)
    assert x() == 1.0
    session.history.undo(A)
    assert "laser" not in viz.frames
    session.history.redo(A)
    assert x() == 1.0


def test_listeners_hear_of_edits(session: Session) -> None:
    heard: list[int] = []
    connect(
        [session.history.state(A), session.history.modified], lambda: heard.append(1)
    )
    for action in (
        lambda: act(session, A, set_alpha(session, 0.5)),
        lambda: session.history.undo(A),
        lambda: session.history.redo(A),
        session.history.saved,
        set_alpha(session, 0.7),
    ):
        heard.clear()
        action()
        assert heard


# A page that is loaded again is another client


def test_a_page_that_is_loaded_again_undoes_and_redoes_what_it_has_done_before(
    viz: Visualizer, session: Session
) -> None:
    history, before = session.history, alpha(session)
    key = history.key(A)
    act(session, A, lambda: session.robot.set_positions({LEFT: 0.5}))
    act(session, A, set_alpha(session, 0.5), by=1)
    act(session, A, lambda: session.document.set_option("Frame Rate", 12))
    history.undo(A)
    history.leave(A)
    history.resume(B, key)
    assert history.state(B).value.redo == "Global Options: Frame Rate"
    # Its first drag has a number that the last one before may have had.
    act(session, B, set_alpha(session, 0.6), by=1)
    history.undo(B)
    assert alpha(session) == 0.5
    history.undo(B)
    assert alpha(session) == before
    history.undo(B)
    assert viz.joint_positions[LEFT] == 0.0
    assert not session.history.modified.value
    assert history.undo(B) is None


def test_edits_are_had_once_and_only_with_the_key_of_the_page(session: Session) -> None:
    history = session.history
    key = history.key(A)
    act(session, A, set_alpha(session, 0.5))
    history.resume(B, "another")
    history.resume(B, history.key(B))
    assert history.state(B).value.undo is None
    # The server may still believe in the connection that was lost.
    history.resume(B, key)
    assert history.state(B).value.undo == "RobotModel: Alpha"
    assert history.undo(A) is None
    history.leave(A)
    history.resume(3, key)
    assert history.undo(3) is None


def test_another_document_and_many_who_leave_end_what_could_be_taken_up(
    session: Session,
) -> None:
    history = session.history
    keys: list[str] = []
    for client in range(limits.UNDO_PAGES.value + 1):
        keys.append(history.key(client))
        act(session, client, set_alpha(session, 0.3 + 0.01 * client))
        history.leave(client)
    history.resume(1000, keys[0])
    assert history.undo(1000) is None
    history.resume(1000, keys[1])
    assert history.state(1000).value.undo == "RobotModel: Alpha"
    history.clear()
    history.resume(1001, keys[2])
    assert history.undo(1001) is None
