"""What belongs to one browser alone, with two of them in one session."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from urllib.parse import urlsplit

import numpy as np
import pytest
from inside import viser_server
from patience import until
from protocol_client import ProtocolClient

from sambot_viz import UsageError, Visualizer
from sambot_viz.session import Client, Session
from sambot_viz.session.signals import connect

PREFIX = "rviz_default_plugins/"
MEASURE, SELECT, MOVE = f"{PREFIX}Measure", f"{PREFIX}Select", f"{PREFIX}MoveCamera"
Protocol = Callable[..., ProtocolClient]


@dataclass
class Person:
    """A browser without a picture, and what the session knows of it."""

    viz: Visualizer
    client: ProtocolClient
    browser: Client

    def settle(self) -> None:
        self.client.settle(viser_server(self.viz))

    def click_down(self, x: float, y: float, modifier: str | None = None) -> None:
        """Click from 5 m above."""
        self.client.send(
            "ScenePointerMessage",
            event_type="click",
            ray_origin=(x, y, 5.0),
            ray_direction=(0.0, 0.0, -1.0),
            screen_pos=((0.5, 0.5),),
            modifier=modifier,
        )
        self.settle()

    @property
    def selected(self) -> list[str]:
        return [item.name for item in self.browser.tools.selection]

    def drawn(self) -> set[str]:
        """The nodes of tools that the page was sent."""
        names = {str(m.fields.get("name")) for m in self.client.messages}
        return {n for n in names if n.startswith(("/~measure", "/~selected"))}


@pytest.fixture
def join(viz: Visualizer, session: Session, protocol: Protocol) -> Callable[[], Person]:
    """Open the page in one more browser."""

    def open_page() -> Person:
        before = set(session.clients.all)
        client = protocol(urlsplit(viz.url).port or 0)
        client.settle(viser_server(viz))
        (new,) = session.clients.all.keys() - before
        return Person(viz, client, session.clients.all[new])

    return open_page


@pytest.fixture
def two(join: Callable[[], Person]) -> tuple[Person, Person]:
    return join(), join()


def leave(session: Session, person: Person, other: Person) -> None:
    """Close a page, and wait until the session has taken note."""
    person.client.close()

    def has_left() -> bool:
        other.settle()
        with session.lock:
            return person.browser.client_id not in session.clients.all

    until(has_left, 30.0, "the session takes no note")


# Tools


def test_one_measures_while_the_other_selects(two: tuple[Person, Person]) -> None:
    a, b = two
    a.browser.tools.choose(MEASURE)
    b.browser.tools.choose(SELECT)
    a.click_down(1.0, 1.0)
    b.click_down(0.0, 0.0)
    a.click_down(2.0, 1.0)
    a.settle()
    b.settle()
    assert a.browser.tools.status.startswith("1 m. ")
    assert b.browser.tools.status == ""
    assert (a.selected, b.selected) == ([], ["base_link"])
    assert a.drawn() == {f"/~measure{of}" for of in (".start", ".rim", "", ".length")}
    assert b.drawn() == {"/~selected1"}


def test_a_tool_is_chosen_for_one_browser(two: tuple[Person, Person]) -> None:
    a, b = two
    heard: list[int] = []
    connect([b.browser.tools.changed], lambda: heard.append(1))
    a.browser.tools.choose(SELECT)
    assert a.browser.tools.current.kind == SELECT
    assert b.browser.tools.current.kind != SELECT
    assert heard == []
    b.browser.tools.press(MEASURE)
    assert heard == [1]
    assert b.browser.tools.current.kind == MEASURE
    b.browser.tools.press(MEASURE)
    assert b.browser.tools.current.kind != MEASURE


def test_a_selection_follows_the_robot_for_its_browser(
    viz: Visualizer, two: tuple[Person, Person]
) -> None:
    a, b = two
    a.browser.tools.choose(SELECT)
    a.click_down(-0.12, 0.18)
    marks = [person.client.mark() for person in two]
    viz.set_joint_positions({"drivewhl_l_joint": 0.4})
    for person in two:
        person.settle()
    moved = [
        {m.fields.get("name") for m in person.client.since(mark)}
        for person, mark in zip(two, marks, strict=True)
    ]
    assert "/~selected1" in moved[0]
    assert "/~selected1" not in moved[1]
    assert (a.selected, b.selected) == (["drivewhl_l_link"], [])


def test_a_colour_of_a_tool_is_the_documents_and_can_be_undone(
    session: Session, two: tuple[Person, Person]
) -> None:
    a, b = two
    for person in two:
        person.browser.tools.choose(MEASURE)
        person.click_down(1.0, 1.0)
        person.click_down(2.0, 1.0)

    def colors(person: Person) -> object:
        return person.client.node("/~measure").fields["props"]["colors"]

    before = colors(b)
    with session.history.acting(a.browser.client_id):
        session.document.set_tool_property(MEASURE, "Line color", (1, 2, 3))
    b.settle()
    assert colors(b) != before
    assert session.history.undo(a.browser.client_id) == "Measure: Line color"
    b.settle()
    assert colors(b) == before


# Views


def test_one_turns_the_camera_and_the_other_sees_nothing_of_it(
    session: Session, two: tuple[Person, Person]
) -> None:
    a, b = (person.browser for person in two)
    before, camera = dict(b.view.values), b.view.shown.camera
    heard: list[int] = []
    connect([b.tools.changed, b.view.changed], lambda: heard.append(1))
    a.view.set("Distance", 3.0)
    a.view.set_kind(f"{PREFIX}TopDownOrtho")
    a.view.look_at(np.array((1.0, 2.0, 0.0)))
    a.tools.focus()
    assert a.view.view.kind == f"{PREFIX}TopDownOrtho"
    assert b.view.view.kind == f"{PREFIX}Orbit"
    assert (b.view.values, b.view.shown.camera) == (before, camera)
    assert heard == []
    assert session.document.config.view.kind == f"{PREFIX}Orbit"


def test_fit_shows_the_robot_or_a_box_from_the_same_direction(
    two: tuple[Person, Person],
) -> None:
    view = two[0].browser.view
    before = view.camera
    view.fit()
    assert view.camera.forward == pytest.approx(before.forward, abs=1e-6)
    assert view.camera.distance < 2.0
    assert np.abs(view.camera.look_at).max() < 0.3
    view.fit((np.array((9.0, 9.0, 0.0)), np.array((11.0, 11.0, 2.0))))
    assert view.camera.look_at == pytest.approx((10.0, 10.0, 1.0))
    assert view.camera.distance > 2.0


def test_the_document_takes_the_view_of_the_browser_that_saves(
    session: Session, two: tuple[Person, Person]
) -> None:
    a, b = (person.browser for person in two)
    a.view.set("Distance", 3.0)
    b.view.set("Distance", 5.0)
    a.view.store()
    assert session.document.config.view.get("Distance") == 3.0
    assert (a.view.values["Distance"], b.view.values["Distance"]) == (3.0, 5.0)


def test_a_program_moves_all_cameras_and_a_late_browser_starts_like_them(
    session: Session, two: tuple[Person, Person], join: Callable[[], Person]
) -> None:
    session.document.config.view.set("Distance", 6.5)
    session.clients.show_view()
    late = join()
    late.browser.view.show()
    for person in (*two, late):
        assert person.browser.view.values["Distance"] == 6.5
        assert person.browser.view.camera.distance == pytest.approx(6.5)


def test_edits_of_a_view_are_undone_by_their_browser_and_mark_no_file(
    session: Session, two: tuple[Person, Person]
) -> None:
    a, b = (person.browser for person in two)
    acting, undo = session.history.acting, session.history.undo
    start = dict(a.view.values)
    for value in (3.0, 4.0, 5.0):
        with acting(a.client_id, "drag"):
            a.view.set("Distance", value)
    with acting(a.client_id):
        a.view.zero()
    with acting(a.client_id):
        a.view.set_kind(f"{PREFIX}FPS")
    with acting(b.client_id):
        b.view.set("Distance", 7.0)
    assert not session.history.modified.value
    assert undo(a.client_id) == "View: FPS"
    assert a.view.view.kind == f"{PREFIX}Orbit"
    assert undo(a.client_id) == "Zero the view"
    assert a.view.values["Distance"] == 5.0
    assert undo(a.client_id) == "View: Distance"
    assert a.view.values == start
    assert a.view.camera.distance == pytest.approx(start["Distance"])
    for _ in range(3):
        session.history.redo(a.client_id)
    assert a.view.view.kind == f"{PREFIX}FPS"
    assert b.view.values["Distance"] == 7.0


def test_an_edit_of_a_view_that_is_not_shown_any_more_is_dropped(
    session: Session, two: tuple[Person, Person]
) -> None:
    browser = two[0].browser
    with session.history.acting(browser.client_id):
        browser.view.set("Distance", 4.0)
    session.clients.show_view()
    with pytest.raises(UsageError, match="another view was shown since"):
        session.history.undo(browser.client_id)


def test_saved_views_belong_to_the_document_and_are_undone(
    session: Session, two: tuple[Person, Person]
) -> None:
    a, b = (person.browser for person in two)
    text = session.document.config.to_yaml()
    with session.history.acting(a.client_id):
        saved = a.view.save()
    assert session.history.modified.value
    with session.history.acting(a.client_id):
        a.view.saved.rename(saved, "near")
    a.view.set("Distance", 9.0)
    with session.history.acting(b.client_id):
        b.view.use(saved)
    assert a.view.values["Distance"] == 9.0, "only the camera of b is moved"
    with session.history.acting(b.client_id):
        b.view.saved.remove(saved)
    with pytest.raises(UsageError, match="the view 'near' was removed"):
        session.history.undo(a.client_id)
    assert session.history.undo(b.client_id) == "Remove view near"
    assert session.document.config.saved_views == (saved,)
    assert session.history.undo(a.client_id) == "Save view Orbit"
    assert session.document.config.to_yaml() == text


# Coming and going


def test_listeners_hear_who_comes_and_goes(
    session: Session, join: Callable[[], Person]
) -> None:
    heard: list[tuple[int, bool]] = []
    session.clients.listeners.append(lambda b, here: heard.append((b.client_id, here)))
    a = join()
    b = join()
    assert list(session.clients.all) == [a.browser.client_id, b.browser.client_id]
    leave(session, a, b)
    assert list(session.clients.all) == [b.browser.client_id]
    assert heard == [
        (a.browser.client_id, True),
        (b.browser.client_id, True),
        (a.browser.client_id, False),
    ]


def test_what_a_browser_has_left_behind_stays_and_its_history_goes(
    session: Session, two: tuple[Person, Person]
) -> None:
    a, b = two
    with session.history.acting(a.browser.client_id):
        session.document.set_option("Frame Rate", 12)
    a.browser.tools.choose(SELECT)
    a.click_down(0.0, 0.0)
    leave(session, a, b)
    assert session.history.undo(a.browser.client_id) is None
    assert session.document.config.global_options.get("Frame Rate") == 12
    session.robot.set_positions({"drivewhl_l_joint": 0.4})
    assert session.problems.of_saves == {}


def test_a_private_session_has_one_browser(protocol: Protocol) -> None:
    with Visualizer(port=0, session="private") as viz:
        for count in (1, 2):
            client = protocol(urlsplit(viz.url).port or 0)
            client.settle(viser_server(viz))
            sessions = viz.server.sessions.all()
            assert [len(s.clients.all) for s in sessions] == [1] * count


def test_who_leaves_after_the_session_was_closed_is_gone_already(
    make_viz: Callable[..., Visualizer],
    protocol: Callable[..., ProtocolClient],
) -> None:
    viz = make_viz()
    session = viz.server.sessions.all()[0]
    protocol(urlsplit(viz.url).port or 0).settle(viser_server(viz))
    (client_id,) = session.clients.all
    session.close()
    assert not session.clients.all
    session.leave(client_id)
