"""A robot that is driven stays in the picture of the browser that drives it."""

from __future__ import annotations

from collections.abc import Callable
from urllib.parse import urlsplit

import pytest
from inside import viser_server
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.session import Client, Session
from sambot_viz.session.clients.follow_view import FollowView
from sambot_viz.views.camera import vector

START, AWAY, FARTHER = vector(0, 0, 0.1), vector(5, 2, 0.1), vector(6, 2, 0.1)


@pytest.fixture
def join(
    viz: Visualizer, session: Session, protocol: Callable[..., ProtocolClient]
) -> Callable[[], Client]:
    """Open the page in one more browser, near the robot."""

    def open_page() -> Client:
        before = set(session.clients.all)
        protocol(urlsplit(viz.url).port or 0).settle(viser_server(viz))
        (new,) = session.clients.all.keys() - before
        session.clients.all[new].view.set("Distance", 2.0)
        return session.clients.all[new]

    return open_page


@pytest.fixture
def driver(join: Callable[[], Client]) -> Client:
    return join()


@pytest.fixture
def seen(session: Session, driver: Client) -> FollowView:
    """What the driver sees; the driver's first command was just now."""
    seen = session.follow_view
    with session.history.acting(driver.client_id):
        seen.begin()
    return seen


def looks_at(browser: Client) -> tuple[float, ...]:
    return tuple(round(float(part), 6) for part in browser.view.camera.look_at[:2])


def test_a_robot_that_drives_out_of_the_picture_is_in_its_middle_again(
    seen: FollowView, driver: Client
) -> None:
    before = driver.view.camera
    seen.follow(START)
    seen.follow(vector(0.1, 0, 0.1))
    assert looks_at(driver) == (0, 0)
    seen.follow(AWAY)
    now = driver.view.camera
    assert looks_at(driver) == (5, 2)
    # The camera is moved, not turned, and not up or down.
    assert now.forward == pytest.approx(before.forward)
    assert now.distance == pytest.approx(before.distance)
    assert now.look_at[2] == before.look_at[2]


def test_who_looks_elsewhere_is_left_alone(seen: FollowView, driver: Client) -> None:
    seen.follow(START)
    driver.view.pan(vector(-20, 0, 0))
    before = looks_at(driver)
    seen.follow(AWAY)
    seen.follow(FARTHER)
    assert looks_at(driver) == before


def test_a_robot_that_is_out_of_sight_when_a_drive_begins_is_brought_back(
    session: Session, driver: Client
) -> None:
    driver.view.pan(vector(-20, 0, 0))
    seen = session.follow_view
    with session.history.acting(driver.client_id):
        seen.begin()
    seen.follow(AWAY)
    assert looks_at(driver) == (5, 2)


def test_one_missed_moment_does_not_lose_the_robot(
    seen: FollowView, driver: Client
) -> None:
    seen.follow(START)
    # It has no place for a moment, and is far away when it has one again.
    seen.follow(None)
    seen.follow(AWAY)
    seen.follow(FARTHER)
    assert looks_at(driver) == (6, 2)


def test_a_late_report_of_the_page_does_not_lose_the_robot(
    seen: FollowView, driver: Client
) -> None:
    seen.follow(START)
    before, number = driver.view.shown.camera, driver.view.shown.number
    seen.follow(AWAY)
    driver.view.take_report(number, before.placed(AWAY, START, before.up))
    seen.follow(FARTHER)
    assert looks_at(driver)[0] >= 5


def test_who_turns_the_camera_a_little_goes_on_with_the_robot(
    seen: FollowView, driver: Client
) -> None:
    seen.follow(START)
    shown = driver.view.shown
    aside = shown.camera.placed(
        shown.camera.position + vector(0, 0, 0.1), shown.camera.look_at, vector(0, 0, 1)
    )
    driver.view.take_report(shown.number, aside)
    seen.follow(AWAY)
    assert looks_at(driver) == (5, 2)


def test_the_cameras_of_others_stay(
    seen: FollowView, driver: Client, join: Callable[[], Client]
) -> None:
    other = join()
    seen.follow(START)
    seen.follow(AWAY)
    assert looks_at(other) == (0, 0)
    assert other.view.values["Distance"] == 2.0


def test_the_view_goes_back_by_the_way_that_it_was_panned(
    seen: FollowView, driver: Client
) -> None:
    seen.follow(START)
    seen.follow(AWAY)
    driver.view.pan(vector(-1, 0, 0))
    seen.follow(vector(9, 2, 0.1))
    assert looks_at(driver) == (9, 2)
    seen.back_to_start()
    assert looks_at(driver) == (-1, 0)
    seen.follow(AWAY)
    assert looks_at(driver) == (-1, 0)


def test_a_robot_that_is_in_the_picture_needs_no_finding(
    session: Session, driver: Client
) -> None:
    before = driver.view.shown.number
    session.follow_view.find(driver.client_id)
    assert driver.view.shown.number == before
    driver.view.pan(vector(-20, 0, 0))
    session.follow_view.find(driver.client_id)
    assert looks_at(driver) == (0, 0)


def test_a_program_that_drives_moves_no_camera(
    session: Session, driver: Client
) -> None:
    seen = session.follow_view
    seen.begin()
    seen.follow(START)
    seen.follow(AWAY)
    seen.follow(None)
    assert looks_at(driver) == (0, 0)


def test_no_part_of_a_robot_that_fits_is_cut_off(
    seen: FollowView, driver: Client
) -> None:
    seen.follow(START)
    window = driver.client.camera
    size = max(1, window.image_width), max(1, window.image_height)
    for step in range(1, 100):
        place = vector(0.1 * step, 0.02 * step, 0.1)
        seen.follow(place)
        camera = driver.view.camera
        for away in ((0.2, 0.15), (0.2, -0.15), (-0.2, 0.15), (-0.2, -0.15)):
            assert camera.shows(place + vector(*away, 0.0), *size)
    assert looks_at(driver)[0] > 5


def test_a_robot_that_is_larger_than_the_picture_stays_with_its_root(
    seen: FollowView, driver: Client
) -> None:
    driver.view.set("Distance", 0.2)
    seen.begin()
    seen.follow(START)
    seen.follow(vector(0.001, 0, 0.1))
    assert looks_at(driver) == (0, 0)
