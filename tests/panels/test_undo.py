"""Undo and Redo of one browser: what they touch is what its page goes to."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from panel_rows import data_of, edit, panel_of

from sambot_viz.panels.displays.displays_panel import DisplaysPanel
from sambot_viz.panels.rows.row import Answer
from sambot_viz.panels.undo_panel import UndoPanel
from sambot_viz.session import Session
from sambot_viz.session.clients.client import Client

GRID = "rviz_default_plugins/Grid"


@pytest.fixture
def displays(session: Session) -> DisplaysPanel:
    return panel_of(DisplaysPanel, session)


@pytest.fixture
def panel(session: Session, client: Client, displays: DisplaysPanel) -> UndoPanel:
    return panel_of(UndoPanel, session, client, displays=displays)


def touched(panel: UndoPanel) -> Any:
    value = data_of(panel)["edit/touched"]
    return value and value["row"]


def test_the_display_that_undo_or_redo_touches_is_named(
    panel: UndoPanel, session: Session, client: Client, displays: DisplaysPanel
) -> None:
    first = session.document.config.displays[0]
    changes: tuple[Callable[[], object], ...] = (
        lambda: session.display_edits.rename_display(first, "Other"),
        lambda: session.display_edits.move_display(first, 1, None),
        lambda: session.display_edits.remove_display(first),
    )
    for change in changes:
        with session.history.acting(client.client_id):
            change()
        edit(panel, "edit/undo", None)
        assert touched(panel) == displays.id_of(first)
        edit(panel, "edit/redo", None)
        edit(panel, "edit/undo", None)


def test_a_display_that_is_not_there_after_it_is_not_named(
    panel: UndoPanel, session: Session, client: Client, displays: DisplaysPanel
) -> None:
    makers: tuple[Callable[[], Any], ...] = (
        lambda: session.display_edits.add_display(GRID),
        lambda: session.display_edits.duplicate_display(
            session.document.config.displays[0]
        ),
    )
    for make in makers:
        with session.history.acting(client.client_id):
            made = make()
        edit(panel, "edit/undo", None)
        assert touched(panel) is None
        edit(panel, "edit/redo", None)
        assert touched(panel) == displays.id_of(made)


def test_each_undo_is_told_from_the_one_before(
    panel: UndoPanel, session: Session, client: Client
) -> None:
    for name in ("One", "Two"):
        with session.history.acting(client.client_id):
            session.display_edits.rename_display(
                session.document.config.displays[0], name
            )
    edit(panel, "edit/undo", None)
    before = data_of(panel)["edit/touched"]
    edit(panel, "edit/undo", None)
    after = data_of(panel)["edit/touched"]
    assert before["row"] == after["row"] and before != after


def test_undo_and_redo_say_what_they_did(
    panel: UndoPanel, session: Session, client: Client
) -> None:
    with session.history.acting(client.client_id):
        session.document.set_option("Frame Rate", 10)
    for row_id, said in (
        ("edit/undo", "Undone: Global Options: Frame Rate"),
        ("edit/redo", "Redone: Global Options: Frame Rate"),
    ):
        assert edit(panel, row_id) == Answer(said)


def test_other_edits_and_other_browsers_name_nothing(
    panel: UndoPanel,
    session: Session,
    client: Client,
    displays: DisplaysPanel,
    join: Callable[[], Client],
) -> None:
    with session.history.acting(client.client_id):
        session.document.set_option("Frame Rate", 10)
        session.display_edits.rename_display(session.document.config.displays[0], "One")
    other = panel_of(UndoPanel, session, join(), displays=displays)
    edit(panel, "edit/undo", None)
    assert touched(other) is None
    with session.history.acting(client.client_id):
        session.document.set_option("Frame Rate", 10)
    edit(panel, "edit/undo", None)
    assert touched(panel) is None


def edits_of(session: Session, client: Client) -> None:
    """Two steps: one of the view alone, one of it and the document."""
    with session.history.acting(client.client_id):
        client.view.set("Distance", 6.0)
    with session.history.acting(client.client_id):
        client.view.set("Distance", 4.0)
        session.document.set_option("Frame Rate", 12)


def test_a_page_that_is_loaded_again_undoes_its_view_too(
    session: Session, join: Callable[[], Client], displays: DisplaysPanel
) -> None:
    before, after = join(), join()
    at_first = before.view.values["Distance"]
    edits_of(session, before)
    # As the page shows its view again.
    with session.history.unrecorded():
        after.view.set("Distance", 4.0)
    first, second = (
        panel_of(UndoPanel, session, client, displays=displays)
        for client in (before, after)
    )
    key = data_of(first)["edit/key"]
    assert key != data_of(second)["edit/key"]
    session.leave(before.client_id)
    edit(second, "edit/resume", [key])
    assert after.view.values["Distance"] == 4.0
    edit(second, "edit/undo", None)
    assert session.document.config.global_options.get("Frame Rate") != 12
    assert after.view.values["Distance"] == 6.0
    edit(second, "edit/undo", None)
    assert after.view.values["Distance"] == pytest.approx(at_first)
    assert data_of(second)["edit/labels"]["undo"] == ""
    for _ in range(2):
        edit(second, "edit/redo", None)
    assert after.view.values["Distance"] == 4.0
    # And once more, with the edits of both pages.
    third = join()
    last = panel_of(UndoPanel, session, third, displays=displays)
    key = data_of(second)["edit/key"]
    session.leave(after.client_id)
    edit(last, "edit/resume", [key])
    edit(last, "edit/undo", None)
    assert third.view.values["Distance"] == 6.0


def test_a_page_that_shows_another_type_of_view_undoes_all_but_that(
    session: Session, join: Callable[[], Client], displays: DisplaysPanel
) -> None:
    before, after = join(), join()
    edits_of(session, before)
    with session.history.unrecorded():
        after.view.set_kind("rviz_default_plugins/FPS")
    first, second = (
        panel_of(UndoPanel, session, client, displays=displays)
        for client in (before, after)
    )
    key = data_of(first)["edit/key"]
    session.leave(before.client_id)
    edit(second, "edit/resume", [key])
    assert data_of(second)["edit/labels"]["undo"] == "Global Options: Frame Rate"
    edit(second, "edit/undo", None)
    assert session.document.config.global_options.get("Frame Rate") != 12
    assert data_of(second)["edit/labels"]["undo"] == ""
