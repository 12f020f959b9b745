"""A live robot driven in a real page: by stick, buttons and keys, and what stops it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

import pytest
from base_peer import CMD_VEL, BasePeer
from inside import session_of
from live_peers import eventually, knows_takers
from viewer_page import ViewerPage

from sambot_viz import Visualizer, bundled
from sambot_viz.publishing import dead_mans_switch

pytestmark = pytest.mark.browser
Open = Callable[..., ViewerPage]


@pytest.fixture
def peer() -> Iterator[BasePeer]:
    made = BasePeer()
    yield made
    made.stop()


@pytest.fixture(autouse=True)
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """A page of a busy machine is too slow for the robot; that has tests of its own."""
    monkeypatch.setattr(dead_mans_switch, "SILENCE", 600.0)


@pytest.fixture
def viz(peer: BasePeer) -> Iterator[Visualizer]:
    with Visualizer(source=peer.uri, port=0, publish="") as viz:
        data = session_of(viz).data
        assert data is not None
        eventually(lambda: CMD_VEL in data.source.topics())
        knows_takers(data.source, peer)
        yield viz


def moves(peer: BasePeer, linear: float, angular: float) -> Callable[[], bool]:
    wanted = pytest.approx((linear, angular), abs=1e-3)
    return lambda: bool(peer.speeds()) and peer.speeds()[-1] == wanted


def test_stick_button_and_key_drive_while_they_are_held(
    peer: BasePeer, viz: Visualizer, open_viewer: Open
) -> None:
    viewer = open_viewer(viz.url)
    user, mouse, keyboard = viewer.user, viewer.page.mouse, viewer.page.keyboard
    user.click("tab", "Drive robot")
    button = user.find("button", "Forwards")
    mouse.move(*user.go_to(button))
    mouse.press()
    eventually(moves(peer, 0.2, 0.0))
    user.reads("drives the robot")
    mouse.release()
    eventually(peer.rests)
    # The stick is as wide as it says.
    left, top, width, height = viewer.page.evaluate(
        "(({x, y, width, height}) => [x, y, width, height])"
        "(document.querySelector('.stick').getBoundingClientRect())"
    )
    x, y = left + width / 2, top + height / 2
    mouse.move(x, y)
    mouse.press()
    mouse.move(x - width / 4, y - height / 4)
    eventually(moves(peer, 0.1, 0.25))
    mouse.release()
    eventually(peer.rests)
    keyboard.hold("8")
    eventually(moves(peer, 0.2, 0.0))
    keyboard.hold("4")
    eventually(moves(peer, 0.2, 0.5))
    keyboard.release("4")
    eventually(moves(peer, 0.2, 0.0))
    keyboard.release("8")
    eventually(peer.rests)


@pytest.mark.parametrize(
    "by", ["space", "button of another page", "button in a dialog", "escape", "hidden"]
)
def test_what_stops_a_robot_that_is_driven(
    peer: BasePeer, viz: Visualizer, open_viewer: Open, by: str
) -> None:
    viewer, other = open_viewer(viz.url), open_viewer(viz.url)
    viewer.user.click("tab", "Drive robot")
    viewer.page.keyboard.hold("8")
    eventually(moves(peer, 0.2, 0.0))
    if by == "space":
        viewer.page.keyboard.press(" ")
    elif by == "escape":
        other.user.keys("Escape", "Escape")
    elif by == "hidden":
        viewer.minimize()
    else:
        if by == "button in a dialog":
            other.user.click("menuitem", "Menu")
            other.user.click("menuitem", "Keys")
            other.user.find("dialog", re.compile("Keys"))
        other.user.click("button", "STOP")
    eventually(peer.rests)
    if by == "button in a dialog":
        other.user.keys("Escape")
    if by != "hidden":
        other.user.reads("pressed STOP")
    # The key that is still held drives no longer.
    came = len(peer.came())
    viewer.page.keyboard.release("8")
    viewer.user.until(lambda: session_of(viz).publisher.driver is not None)
    assert len(peer.came()) == came


def test_that_follow_is_off_is_said_and_leads_to_follow(
    peer: BasePeer, open_viewer: Open
) -> None:
    peer.offer("/tf", "tf2_msgs/msg/TFMessage")
    with Visualizer(bundled.model_path(), source=peer.uri, port=0) as viz:
        robot = session_of(viz).robot
        eventually(lambda: robot.followed.value)
        user = open_viewer(viz.url).user
        user.tab("Joints")
        row = "row", re.compile("^Follow ")
        user.find(*row)
        assert not user.there("button", "Not following the robot")
        user.click("checkbox", re.compile("^Follow "))
        user.find("button", "Not following the robot")
        user.tab("Topics")
        user.click("button", "Not following the robot")
        user.until(lambda: user.find(*row).state("focused"))
        user.keys(" ")
        user.gone("button", "Not following the robot")
        eventually(lambda: robot.followed.value)


# Of each STOP that is shown: its colours and its height.
_LOOK = """[...document.querySelectorAll(".stop-robot")].map((stop) => {
  const { backgroundColor, color, height } = getComputedStyle(stop);
  return [backgroundColor, color, height];
})"""
AT_REST = ["rgb(179, 20, 29)", "rgb(255, 255, 255)", "56px"]
POINTED_AT = ["rgb(142, 13, 21)", *AT_REST[1:]]


def test_stop_is_large_and_red_whatever_the_buttons_around_it_are(
    viz: Visualizer, open_viewer: Open
) -> None:
    viewer = open_viewer(viz.url)
    user = viewer.user

    def looks(*wanted: list[str]) -> None:
        user.until(lambda: viewer.page.evaluate(_LOOK) == [*wanted])

    looks(AT_REST)
    viewer.page.mouse.move(*user.go_to(user.find("button", "STOP")))
    looks(POINTED_AT)
    viewer.page.mouse.move(1.0, 1.0)
    looks(AT_REST)
    user.click("menuitem", "Menu")
    user.click("menuitem", "Keys")
    user.find("dialog", re.compile("Keys"))
    looks(AT_REST, AT_REST)


def test_a_goal_is_cancelled_with_a_button(
    peer: BasePeer, viz: Visualizer, open_viewer: Open
) -> None:
    peer.statuses = (1, 2)
    peer.listen_as("/goal_pose", "/bt_navigator")
    cancel = "/navigate_to_pose/_action/cancel_goal"
    peer.serve(cancel, reply=b"\0\1\0\0" + bytes(8))
    viewer = open_viewer(viz.url)
    eventually(lambda: "map" in session_of(viz).scene.context.tree.frames)
    data = session_of(viz).data
    assert data is not None
    knows_takers(data.source, peer)
    viz.publish_goal(1.0, 0.0, 0.0)
    viewer.user.reads("Goal: on the way")
    viewer.user.click("button", "Cancel")
    eventually(lambda: cancel in peer.calls())
    peer.tell(5)
    viewer.user.gone("button", "Cancel")
