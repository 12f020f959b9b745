"""A class in real pages: presenter, viewers, requests for control, private copies."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

import pytest
from protocol_client import ProtocolClient
from user import User
from viewer_page import ViewerPage, viewer_url

from sambot_viz import Robot, Visualizer
from sambot_viz.session import Session

pytestmark = pytest.mark.browser

LEFT = "drivewhl_l_joint"
Open = Callable[..., ViewerPage]


@pytest.fixture(scope="module")
def viz(sam_bot: Robot) -> Iterator[Visualizer]:
    """One class for all tests: each ends with the presenter in control again."""
    with Visualizer(sam_bot, port=0, presenter="", look="rviz") as viz:
        yield viz


@pytest.fixture(scope="module")
def guest(viz: Visualizer, open_for_all: Open) -> ViewerPage:
    return ready(open_for_all(viz.url))


@pytest.fixture(scope="module")
def teacher(viz: Visualizer, open_for_all: Open) -> ViewerPage:
    assert viz.presenter_url is not None
    return ready(open_for_all(viz.presenter_url))


def ready(viewer: ViewerPage) -> ViewerPage:
    viewer.user.row("Joints", LEFT)
    viewer.user.find("button", re.compile("^People: "))
    return viewer


def people(user: User, does: str) -> None:
    """Open the panel of the status bar, and press a button there."""
    user.click("button", re.compile("^People: "))
    user.click("button", does, ("dialog", "People"))


def slider_is_off(user: User) -> bool:
    return bool(user.row("Joints", LEFT).one("slider").state("disabled"))


def test_a_viewer_turns_the_view_and_is_told_what_needs_control(
    guest: ViewerPage, teacher: ViewerPage
) -> None:
    user = guest.user
    user.until(lambda: slider_is_off(user))
    guest.page.mouse.move(*user.go_to(user.row("Joints", LEFT).one("slider")))
    user.has_tip("View only: request control")
    yaw = user.row("Views", "Yaw").text
    user.enter(user.row("Views", "Yaw").one("textbox"), "0.25")
    user.until(lambda: user.row("Views", "Yaw").text != yaw)
    user.click("button", "Center")
    user.reads("View only: request control, or open your own copy")
    user.click("button", "Add")
    user.reads("View only: request control, or open your own copy")
    assert not user.see().all("dialog")
    user.click("menuitem", "File")
    entry = user.find("menuitem", "Save Config As… Ctrl+Shift+S")
    assert entry.state("disabled")
    assert not user.find("menuitem", "Download Config").state("disabled")
    user.keys("Escape")
    yaw = user.row("Views", "Yaw").text
    user.click("button", "Zero", ("region", "Views"))
    user.until(lambda: user.row("Views", "Yaw").text != yaw)
    user.keys("Control+s")
    user.reads("View only: request control, or open your own copy")
    assert not user.see().all("dialog")
    user.click("button", "Measure", ("toolbar", "Tools"))
    user.until(
        lambda: user.find("button", "Measure", ("toolbar", "Tools")).is_on,
    )
    assert not slider_is_off(teacher.user)


def test_a_private_copy_and_back(
    viz: Visualizer, guest: ViewerPage, teacher: ViewerPage
) -> None:
    user = guest.user
    teacher.user.enter(teacher.user.row("Joints", LEFT).one("textbox"), "1")
    # Else the copy may be made before.
    user.until(lambda: user.row("Joints", LEFT).one("textbox").value == "1")
    people(user, "Make my own copy")
    user.reads("Private copy")
    # It has no view either.
    assert guest.page.evaluate("location.search") == "?view=none"
    user.until(lambda: user.row("Joints", LEFT).one("textbox").value == "1")
    user.enter(user.row("Joints", LEFT).one("textbox"), "-2")
    user.until(lambda: len(viz.server.sessions.all()) == 2)
    teacher.user.reads("You control the robot, 1 private copy")
    assert "new private copy" not in user.see().text
    guest.page.goto(viewer_url(f"{viz.url}/copy/", view=False))
    user.reads("This is a new private copy of the shared robot as it is now")
    user.click("button", "Private copy · Back to the shared robot")
    user.reads("Presenter controls the robot, 1 viewer")
    teacher.user.until(lambda: "private copy" not in teacher.user.see().text)
    user.until(lambda: user.row("Joints", LEFT).one("textbox").value == "1")
    assert viz.joint_positions[LEFT] == 1.0
    # Control that was given is kept on the way there and back.
    user.click("button", "View only · Request control")
    teacher.user.click("button", "Give control to Viewer 2")
    user.reads("You and Presenter control the robot")
    people(user, "Make my own copy")
    user.reads("Private copy")
    user.click("button", "Private copy · Back to the shared robot")
    user.reads("You and Presenter control the robot")


def session_of(viz: Visualizer) -> Session:
    session = viz.server.sessions.shared
    assert session is not None
    return session


def test_a_viewer_who_is_removed_may_join_again_with_the_name_of_its_page(
    viz: Visualizer, guest: ViewerPage, teacher: ViewerPage
) -> None:
    user, driving = guest.user, teacher.user
    user.click("button", re.compile("^People: "))
    user.click("button", re.compile("Rename Viewer|Rename Ann"))
    user.enter(user.find("textbox", re.compile("New name of")), "Bob")
    driving.click("button", re.compile("^People: "))
    driving.click("button", "Rename Bob", ("dialog", "People"))
    driving.enter(driving.find("textbox", "New name of Bob"), "Robert")
    user.reads("The presenter has renamed you: Robert")
    driving.click("button", "Remove Robert", ("dialog", "People"))
    user.reads("The presenter has removed you.")
    driving.until(lambda: len(session_of(viz).clients.all) == 1)
    user.click("button", "Join again")
    driving.find("button", "Give control to Bob")
    driving.click("button", "Give control to Bob")
    user.reads("You can now change the robot. Everyone sees it.")
    user.until(lambda: not user.see().all("button", "View only · Request control"))
    driving.click("button", "Take back control from Bob")
    user.find("button", "View only · Request control")
    driving.keys("Escape")


def test_the_presenter_invites_with_the_link_of_viewers(
    viz: Visualizer, guest: ViewerPage, teacher: ViewerPage
) -> None:
    user = teacher.user
    people(user, "Invite…")
    user.reads(f"{viz.url}/")
    user.reads("Only works on this computer.")
    dialog = user.find("dialog", "Invite")
    assert dialog.all("image", "QR code of the link")
    user.click("button", "Close")
    guest.user.click("button", re.compile("^People: "))
    assert not guest.user.see().all("button", "Invite…")
    guest.user.keys("Escape")


def test_everyone_is_brought_to_a_view_once(
    guest: ViewerPage, teacher: ViewerPage
) -> None:
    teacher.user.enter(teacher.user.row("Views", "Yaw").one("textbox"), "2.5")
    people(teacher.user, "Bring everyone to my view")
    guest.user.reads("moved your view")
    guest.user.until(lambda: "2.5" in guest.user.row("Views", "Yaw").text)
    teacher.user.keys("Escape")


def test_many_requests_leave_the_view_free(
    viz: Visualizer, teacher: ViewerPage, protocol: Callable[..., ProtocolClient]
) -> None:
    user = teacher.user
    for number in range(12):
        client = protocol(viz.viser.get_port())
        client.wait_until(lambda c=client: "role/request" in c.rows)
        client.act("role/request", f"Pupil {number}")
        client.settle(viz.viser)
    user.reads("12 people request control.")
    covered = teacher.page.evaluate(
        "[...document.querySelectorAll('.asking .ask')].map(e => e.clientHeight)"
        ".reduce((a, b) => a + b)"
    )
    assert covered < 120
    user.click("button", "Show them")
    user.click("button", "Give control to Pupil 7", ("dialog", "People"))
    user.reads("You and Pupil 7 control the robot")
    user.keys("Escape")
    user.click("button", "Not now, all 11")
    user.until(lambda: "request control" not in user.see().text)
    assert not any(p.requests for p in session_of(viz).roles.people.values())
    people(user, "Take back control from Pupil 7")
    user.keys("Escape")


def test_with_turns_a_viewer_reads_the_place_in_the_queue(
    sam_bot: Robot, open_viewer: Open, protocol: Callable[..., ProtocolClient]
) -> None:
    with Visualizer(sam_bot, presenter="", slot=240.0, look="rviz") as viz:
        first, second = (protocol(viz.viser.get_port()) for _ in range(2))
        for client in (first, second):
            client.wait_until(lambda client=client: "role/me" in client.rows)
            client.act("role/request", "")
            client.wait_until(
                lambda client=client: any(
                    client.row("role/me")["value"][key]
                    for key in ("control", "requests")
                )
            )
        user = ready(open_viewer(viz.url)).user
        user.click("button", "View only · Request control")
        user.reads("You are number 2 in the queue")
        user.click("button", re.compile(r"^View only · second, \d+ min$"))
        user.reads("You wait for control: second, ")
        user.click("button", "Cancel the request", ("dialog", "People"))
        user.reads("Control passes to the next after 4 min.")
