"""What belongs to one browser alone, with two of them in one session."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from urllib.parse import urlsplit

import pytest
from inside import session_of, viser_server
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.session import Browser, Event, Session

PREFIX = "rviz_default_plugins/"
MEASURE, SELECT, MOVE = f"{PREFIX}Measure", f"{PREFIX}Select", f"{PREFIX}MoveCamera"
Protocol = Callable[..., ProtocolClient]


@dataclass
class Person:
    """A browser without a picture, and what the session knows of it."""

    viz: Visualizer
    client: ProtocolClient
    browser: Browser

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
def viz() -> Iterator[Visualizer]:
    with Visualizer(port=0) as viz:
        yield viz


@pytest.fixture
def session(viz: Visualizer) -> Session:
    return session_of(viz)


@pytest.fixture
def join(viz: Visualizer, session: Session, protocol: Protocol) -> Callable[[], Person]:
    """Open the page in one more browser."""

    def open_page() -> Person:
        before = set(session.browsers)
        client = protocol(urlsplit(viz.url).port or 0)
        client.settle(viser_server(viz))
        (new,) = session.browsers.keys() - before
        return Person(viz, client, session.browsers[new])

    return open_page


@pytest.fixture
def two(join: Callable[[], Person]) -> tuple[Person, Person]:
    return join(), join()


def leave(session: Session, person: Person, other: Person) -> None:
    """Close a page, and wait until the session has taken note."""
    person.client.close()
    end = time.monotonic() + 30.0
    while person.browser.client_id in session.browsers:
        assert time.monotonic() < end, "the session takes no note"
        other.settle()


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
    assert a.browser.tools.status.startswith("[Length: 1m] ")
    assert b.browser.tools.status == ""
    assert (a.selected, b.selected) == ([], ["base_link"])
    assert a.drawn() == {"/~measure.start", "/~measure", "/~measure.length"}
    assert b.drawn() == {"/~selected1"}


def test_a_tool_is_chosen_for_one_browser(two: tuple[Person, Person]) -> None:
    a, b = two
    heard: list[Event] = []
    b.browser.listeners.append(heard.append)
    a.browser.tools.choose(SELECT)
    assert a.browser.tools.current.kind == SELECT
    assert b.browser.tools.current.kind != SELECT
    assert heard == []
    b.browser.tools.press(MEASURE)
    assert heard == ["tools"]
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
    with session.edits.acting(a.browser.client_id):
        session.set_tool_property(MEASURE, "Line color", (1, 2, 3))
    b.settle()
    assert colors(b) != before
    assert session.edits.undo(a.browser.client_id) == "Measure: Line color"
    b.settle()
    assert colors(b) == before


# Coming and going


def test_listeners_hear_who_comes_and_goes(
    session: Session, join: Callable[[], Person]
) -> None:
    heard: list[tuple[int, bool]] = []
    session.browser_listeners.append(lambda b, here: heard.append((b.client_id, here)))
    a = join()
    b = join()
    assert list(session.browsers) == [a.browser.client_id, b.browser.client_id]
    leave(session, a, b)
    assert list(session.browsers) == [b.browser.client_id]
    assert heard == [
        (a.browser.client_id, True),
        (b.browser.client_id, True),
        (a.browser.client_id, False),
    ]


def test_what_a_browser_has_left_behind_stays_and_its_history_goes(
    session: Session, two: tuple[Person, Person]
) -> None:
    a, b = two
    with session.edits.acting(a.browser.client_id):
        session.set_global("Frame Rate", 12)
    a.browser.tools.choose(SELECT)
    a.click_down(0.0, 0.0)
    leave(session, a, b)
    assert session.edits.undo(a.browser.client_id) is None
    assert session.config.global_options.get("Frame Rate") == 12
    session.set_joint_positions({"drivewhl_l_joint": 0.4})
    assert session.problems.of_saves == {}


def test_a_private_session_has_one_browser(protocol: Protocol) -> None:
    with Visualizer(port=0, session="private") as viz:
        for count in (1, 2):
            client = protocol(urlsplit(viz.url).port or 0)
            client.settle(viser_server(viz))
            sessions = viz.server.sessions()
            assert [len(s.browsers) for s in sessions] == [1] * count
