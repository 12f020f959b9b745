"""Interact: handles of interactive markers are moved by hand, as in RViz."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hand import Hand
from inside import session_of
from interactive_messages import (
    ALONG_Z,
    BUTTON,
    MENU,
    MOVE_PLANE,
    ROTATE_AXIS,
    VIEW_FACING,
    control,
    cube,
    marker,
    moved,
)
from live_peers import eventually, knows_takers
from marker_peer import SERVICE, MarkerPeer
from protocol_client import ProtocolClient, wait_for_workers

from sambot_viz import Visualizer
from sambot_viz.displays.data.interactive_markers.interactive_display import (
    InteractiveMarkersDisplay,
)

CONFIG = """
Visualization Manager:
  Global Options: {Fixed Frame: map}
  Displays:
    - Class: rviz_default_plugins/InteractiveMarkers
      Name: Markers
      Enabled: true
      Interactive Markers Namespace: /ns
  Tools:
    - {Class: rviz_default_plugins/Interact}
    - {Class: rviz_default_plugins/MoveCamera}
"""
UPDATE, SELECT, CLICK, DOWN, UP = range(1, 6)
Peer = Callable[..., MarkerPeer]
MOVE_3D = 7
AT_ONE = 0.5 * (5.0 - 0.075) / 5.0
"""Half a metre on the ground, where an arrow is seen: it is 0.075 m above [m]."""


@pytest.fixture
def peer() -> Iterator[Peer]:
    made: list[MarkerPeer] = []

    def make(*markers: Callable[[Any], Any], **options: Any) -> MarkerPeer:
        made.append(MarkerPeer(*markers, **options))
        return made[-1]

    yield make
    for one in made:
        one.stop()


@pytest.fixture
def hand(
    tmp_path: Path, protocol: Callable[..., ProtocolClient]
) -> Iterator[Callable[..., Hand]]:
    made: list[Visualizer] = []

    def make(peer: MarkerPeer, marks: int = 1, **options: Any) -> Hand:
        config = tmp_path / "a.rviz"
        config.write_text(CONFIG)
        options = {"publish": "", **options}
        viz = Visualizer(source=peer.uri, config=config, port=0, **options)
        made.append(viz)
        data = session_of(viz).data
        assert data is not None
        found = Hand(viz, protocol(viz.viser.get_port()))
        eventually(lambda: data.source.status.is_connected)
        eventually(lambda: tick(found) and len(known(viz)) == marks)
        knows_takers(data.source, peer)
        wait_for_workers()
        return found

    yield make
    for viz in made:
        viz.stop()


def display_of(viz: Visualizer) -> InteractiveMarkersDisplay:
    (found,) = session_of(viz).scene.displays
    assert isinstance(found, InteractiveMarkersDisplay)
    return found


def known(viz: Visualizer) -> dict[str, Any]:
    return display_of(viz)._markers.known  # pyright: ignore[reportPrivateUsage]


def tick(page: Hand) -> bool:
    """Let a second pass for the display."""
    session = session_of(page.viz)
    with session.change():
        display_of(page.viz).time_passed()
    page.client.settle(page.viz.viser)
    return True


def x_of(page: Hand, name: str = "one") -> float:
    return float(known(page.viz)[name].pose(display_of(page.viz).context)[0, 3])


def test_markers_older_than_the_page_are_there(peer: Peer, hand: Any) -> None:
    robot = peer(lambda t: marker(t, x=1.0), lambda t: marker(t, "two"))
    page = hand(robot, 2)
    assert x_of(page) == pytest.approx(1.0)
    assert set(robot.calls()) == {SERVICE}


def test_an_axis_is_moved_along_and_each_step_is_told(peer: Peer, hand: Any) -> None:
    robot = peer(lambda t: marker(t))
    page = hand(robot)
    page.choose("Interact")
    begin, end = page.place(0.7, 0.0), page.place(1.2, 0.3)
    assert page.hover(begin)
    assert page.said == "one: Left: move along the axis."
    page.drag(begin, end)
    eventually(lambda: robot.events() == [UPDATE, DOWN, UPDATE, UP])
    first, *_, last = robot.feedback()
    assert first.pose.position.x == pytest.approx(0.0)
    assert last.pose.position.x == pytest.approx(AT_ONE, abs=1e-6)
    assert last.pose.position.y == pytest.approx(0.0, abs=1e-6)
    assert (last.marker_name, last.control_name) == ("one", "control")
    assert (last.header.frame_id, last.header.stamp.sec) == ("map", 0)
    assert first.mouse_point_valid and first.mouse_point.x == pytest.approx(
        0.7, abs=0.1
    )
    assert first.client_id == last.client_id and "sambot-viz" in last.client_id
    assert x_of(page) == pytest.approx(AT_ONE, abs=1e-6)


def test_beside_a_handle_the_view_has_the_press(peer: Peer, hand: Any) -> None:
    robot = peer(lambda t: marker(t))
    page = hand(robot)
    page.choose("Interact")
    assert not page.hover(page.place(0.0, 1.0))
    page.drag(page.place(0.0, 1.0), page.place(1.0, 1.0))
    assert robot.events() == [] and x_of(page) == 0.0


def test_another_tool_takes_no_handle(peer: Peer, hand: Any) -> None:
    page = hand(peer(lambda t: marker(t)))
    page.choose("Move Camera")
    listed = page.client.row("tools/list")["value"]
    assert not any(tool["hover"] for tool in listed)


def test_a_ring_is_turned(peer: Peer, hand: Any) -> None:
    ring = lambda t: control(t, ROTATE_AXIS, turn=ALONG_Z)  # noqa: E731
    robot = peer(lambda t: marker(t, controls=[ring(t)]))
    page = hand(robot)
    page.choose("Interact")
    assert page.hover(page.place(0.6, 0.0))
    page.drag(page.place(0.6, 0.0), page.place(0.0, 0.6))
    eventually(lambda: robot.events()[-1:] == [UP])
    turn = robot.feedback()[-1].pose.orientation
    assert 2 * math.atan2(turn.z, turn.w) == pytest.approx(math.pi / 2, abs=1e-6)


def test_a_plane_is_moved_in(peer: Peer, hand: Any) -> None:
    plane = lambda t: control(t, MOVE_PLANE, turn=ALONG_Z)  # noqa: E731
    robot = peer(lambda t: marker(t, controls=[plane(t)]))
    page = hand(robot)
    page.choose("Interact")
    assert page.hover(page.place(0.6, 0.0))
    page.drag(page.place(0.6, 0.0), page.place(0.2, 0.9))
    eventually(lambda: robot.events()[-1:] == [UP])
    place = robot.feedback()[-1].pose.position
    assert (place.x, place.y) == pytest.approx((-0.4, 0.9), abs=1e-6)


def test_a_box_is_moved_in_the_plane_of_the_picture(peer: Peer, hand: Any) -> None:
    box = lambda t: control(t, MOVE_3D, always=True, markers=[cube(t)])  # noqa: E731
    robot = peer(lambda t: marker(t, controls=[box(t)]))
    page = hand(robot)
    page.choose("Interact")
    middle = page.place(0.0, 0.0)
    assert page.hover(middle)
    page.drag(middle, page.place(1.0, 0.0))
    eventually(lambda: robot.events()[-1:] == [UP])
    # Its top is nearer to the camera than the ground.
    assert robot.feedback()[-1].pose.position.x == pytest.approx(0.98, abs=1e-6)


def test_with_shift_a_box_goes_away_from_the_view(peer: Peer, hand: Any) -> None:
    box = lambda t: control(t, MOVE_3D, always=True, markers=[cube(t)])  # noqa: E731
    robot = peer(lambda t: marker(t, controls=[box(t)]))
    page = hand(robot)
    page.choose("Interact")
    middle = page.place(0.0, 0.0)
    assert page.hover(middle)
    page.drag(middle, page.place(0.0, 0.5), key="shift")
    eventually(lambda: robot.events()[-1:] == [UP])
    place = robot.feedback()[-1].pose.position
    assert place.z < -0.4 and abs(place.x) < 1e-6


def test_a_button_is_pressed(peer: Peer, hand: Any) -> None:
    button = lambda t: control(t, BUTTON, always=True, markers=[cube(t)])  # noqa: E731
    robot = peer(lambda t: marker(t, controls=[button(t)]))
    page = hand(robot)
    page.choose("Interact")
    middle = page.place(0.0, 0.0)
    assert page.hover(middle)
    page.drag(middle)
    eventually(lambda: robot.events() == [UPDATE, DOWN, CLICK, UPDATE, UP])


def with_menu(t: Any, mode: int = MENU) -> Any:
    entry = t["visualization_msgs/msg/MenuEntry"]
    made = marker(t, controls=[control(t, mode, always=True, markers=[cube(t)])])
    made.menu_entries = [
        entry(1, 0, "[x] Lights", "", 0),
        entry(2, 0, "More", "", 0),
        entry(3, 2, "Deep", "", 0),
        entry(4, 9, "Lost", "", 0),
        entry(5, 0, "Shell", "rm", 1),
    ]
    return made


@pytest.mark.parametrize("mode", [MENU, BUTTON])
def test_a_menu_is_shown_and_an_entry_told(peer: Peer, hand: Any, mode: int) -> None:
    robot = peer(lambda t: with_menu(t, mode))
    page = hand(robot)
    page.choose("Interact")
    middle = page.place(0.0, 0.0)
    assert page.hover(middle)
    if mode == MENU:
        page.drag(middle)
    else:
        page.act("tools/open_menu")
    menu = page.client.row("tools/menu")["value"]
    titles = [one["title"] for one in menu["entries"]]
    assert titles == ["☑ Lights", "More", "Shell"] and menu["title"] == "one"
    assert [one["id"] for one in menu["entries"][1]["entries"]] == [3]
    assert menu["entries"][2]["runs"]
    page.act("tools/entry", 3)
    eventually(lambda: robot.events()[-1:] == [SELECT])
    assert robot.feedback()[-1].menu_entry_id == 3
    # The menu is chosen from once: what comes next is another thing.
    page.act("tools/entry", 1)
    # Nor are a menu, a command for a shell, and what is not there.
    for number in (2, 5, 4, 77, 1):
        page.act("tools/open_menu")
        page.act("tools/entry", number)
    eventually(lambda: robot.feedback()[-1].menu_entry_id == 1)
    assert robot.events().count(SELECT) == 2


def test_what_the_program_says_during_a_drag_counts_after_it(
    peer: Peer, hand: Any
) -> None:
    robot = peer(lambda t: marker(t))
    page = hand(robot)
    page.choose("Interact")
    begin = page.place(0.7, 0.0)
    assert page.hover(begin)
    page.drag(begin, page.place(1.2, 0.0), ends=False)
    robot.update(poses=[lambda t: moved(t, "one", 3.0)], number=8)
    eventually(lambda: tick(page) and known(page.viz)["one"].later)
    assert x_of(page) == pytest.approx(AT_ONE, abs=1e-6)
    page.act("tools/drop", *begin, *page.place(1.2, 0.0), None)
    assert x_of(page) == pytest.approx(3.0)


def test_two_hands_do_not_hold_one_marker(
    peer: Peer, hand: Any, protocol: Callable[..., ProtocolClient]
) -> None:
    robot = peer(lambda t: marker(t))
    one = hand(robot)
    other = Hand(one.viz, protocol(one.viz.viser.get_port()))
    begin = one.place(0.7, 0.0)
    for page in (one, other):
        page.choose("Interact")
        assert page.hover(begin)
    one.drag(begin, ends=False)
    other.drag(begin, ends=False)
    assert "another hand" in other.said
    # A page that goes leaves what it holds.
    one.client.close()
    eventually(lambda: not known(other.viz)["one"].is_held)
    eventually(lambda: robot.events()[-1:] == [UP])


def test_esc_leaves_what_is_held(peer: Peer, hand: Any) -> None:
    robot = peer(lambda t: marker(t))
    page = hand(robot)
    page.choose("Interact")
    begin = page.place(0.7, 0.0)
    assert page.hover(begin)
    page.drag(begin, ends=False)
    page.act("tools/escape")
    eventually(lambda: robot.events()[-1:] == [UP])
    assert not known(page.viz)["one"].is_held


def test_a_marker_that_is_gone_is_not_moved(peer: Peer, hand: Any) -> None:
    robot = peer(lambda t: marker(t), lambda t: marker(t, "two", x=9.0))
    page = hand(robot, 2)
    page.choose("Interact")
    begin = page.place(0.7, 0.0)
    assert page.hover(begin)
    page.drag(begin, ends=False)
    eventually(lambda: DOWN in robot.events())
    robot.update(erases=["one"], number=8)
    eventually(lambda: "one" not in known(page.viz))
    page.drag(begin, page.place(1.2, 0.0))
    assert UP not in robot.events()


@pytest.mark.parametrize("publish", [None, "goal"])
def test_without_leave_the_view_has_the_press(
    peer: Peer, hand: Any, publish: str | None
) -> None:
    robot = peer(lambda t: marker(t))
    page = hand(robot, publish=publish)
    page.choose("Interact")
    listed = page.client.row("tools/list")["value"]
    assert not any(tool["hover"] for tool in listed)
    page.drag(page.place(0.7, 0.0), page.place(1.2, 0.0))
    assert robot.events() == [] and x_of(page) == 0.0


def test_who_hears_nothing_is_said(peer: Peer, hand: Any) -> None:
    robot = peer(lambda t: marker(t), is_heard=False)
    robot.listen_as("/other", "/node")
    page = hand(robot)
    page.choose("Interact")
    begin = page.place(0.7, 0.0)
    assert page.hover(begin)
    # Before that it is not known who takes it.
    eventually(robot.advertised)
    page.drag(begin, page.place(1.2, 0.0))
    assert "Nobody has subscribed to /ns/feedback" in page.said
    assert x_of(page) == 0.0


def test_a_locked_marker_is_told_in_its_frame(peer: Peer, hand: Any) -> None:
    robot = peer(lambda t: marker(t, frame="base_link"))
    page = hand(robot)
    page.choose("Interact")
    begin = page.place(0.7, 0.0)
    assert page.hover(begin)
    page.drag(begin, page.place(1.2, 0.0))
    eventually(lambda: robot.events()[-1:] == [UP])
    last = robot.feedback()[-1]
    assert last.header.frame_id == "base_link"
    assert last.pose.position.x == pytest.approx(AT_ONE, abs=1e-6)


def test_what_faces_the_view_is_moved_in_its_plane(peer: Peer, hand: Any) -> None:
    disc = lambda t: control(t, MOVE_PLANE, turning=VIEW_FACING)  # noqa: E731
    robot = peer(lambda t: marker(t, controls=[disc(t)]))
    page = hand(robot)
    page.choose("Interact")
    assert page.hover(page.place(0.6, 0.0))
    page.drag(page.place(0.6, 0.0), page.place(0.6, 0.5))
    eventually(lambda: robot.events()[-1:] == [UP])
    place = robot.feedback()[-1].pose.position
    assert (place.x, place.y) == pytest.approx((0.0, 0.5), abs=1e-6)


def test_missed_updates_ask_for_all_again(peer: Peer, hand: Any) -> None:
    robot = peer(lambda t: marker(t))
    page = hand(robot)
    robot.answer(lambda t: marker(t), lambda t: marker(t, "late"), number=12)
    robot.update(poses=[lambda t: moved(t, "one", 2.0)], number=12)
    for _ in range(8):
        tick(page)
    eventually(lambda: tick(page) and "late" in known(page.viz))


def test_a_bridge_that_dies_in_the_middle_of_a_drag_leaves_nothing_held(
    peer: Peer, hand: Any
) -> None:
    robot = peer(lambda t: marker(t))
    page = hand(robot)
    page.choose("Interact")
    begin, end = page.place(0.7, 0.0), page.place(1.2, 0.0)
    assert page.hover(begin)
    page.drag(begin, end, ends=False)
    robot.stop()
    data = session_of(page.viz).data
    assert data is not None
    eventually(lambda: not data.source.status.is_connected)
    page.act("tools/drop", *begin, *end, None)
    assert not any(one.is_held for one in known(page.viz).values())
    assert "othing can be sent" in page.said


def test_who_only_watches_moves_nothing(
    peer: Peer, hand: Any, protocol: Callable[..., ProtocolClient]
) -> None:
    robot = peer(lambda t: marker(t))
    page = hand(robot, presenter="a-long-word")
    page.choose("Interact")
    listed = page.client.row("tools/list")["value"]
    assert not any(tool["hover"] for tool in listed)
    begin = page.place(0.7, 0.0)
    page.act("tools/hover", *begin)
    page.drag(begin, page.place(1.2, 0.0))
    page.act("tools/open_menu")
    page.act("tools/entry", 1)
    assert robot.events() == [] and robot.advertised() == []


def test_nonsense_of_a_page_moves_nothing(peer: Peer, hand: Any) -> None:
    robot = peer(lambda t: marker(t))
    page = hand(robot)
    page.choose("Interact")
    begin = page.place(0.7, 0.0)
    assert page.hover(begin)
    for place in ((7.0, 1e300), (-1.0, 0.5)):
        page.act("tools/drag", *begin, *place, "shift")
    page.act("tools/drop", *begin, 9.0, 9.0, "meta")
    assert x_of(page) == 0.0
    assert not any(one.is_held for one in known(page.viz).values())


def test_who_loses_control_in_the_middle_of_a_drag_leaves_the_marker(
    peer: Peer, hand: Any
) -> None:
    robot = peer(lambda t: marker(t))
    page = hand(robot, presenter="a-long-word")
    (person,) = session_of(page.viz).roles.people.values()
    person.has_control = True
    page.choose("Interact")
    begin, end = page.place(0.7, 0.0), page.place(1.2, 0.0)
    assert page.hover(begin)
    page.drag(begin, end, ends=False)
    eventually(lambda: DOWN in robot.events())
    at = x_of(page)
    person.has_control = False
    page.drag(begin, page.place(1.5, 0.0))
    assert not known(page.viz)["one"].is_held and x_of(page) == at
    assert "view only" in page.said.lower() and UP not in robot.events()


def test_another_tool_knows_nothing_of_the_handle_under_the_mouse(
    peer: Peer, hand: Any
) -> None:
    page = hand(peer(lambda t: with_menu(t)))
    page.choose("Interact")
    assert page.hover(page.place(0.0, 0.0))
    page.choose("Measure")
    assert not page.client.row("tools/over")["value"]["holds"]
