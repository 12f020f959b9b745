"""A robot drives only as long as a page is there whose user drives it."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from inside import session_of
from patience import until
from viewer_page import ViewerPage

from sambot_viz import Visualizer
from sambot_viz.session import Session
from sambot_viz.session.robot import motion
from sambot_viz.session.robot.robot_drive import KEEP, Drive

pytestmark = pytest.mark.browser

STOPPED = "The robot has stopped: the page that drove it was closed or hidden"
Open = Callable[..., ViewerPage]


@pytest.fixture(autouse=True)
def slow_motion(monkeypatch: pytest.MonkeyPatch) -> None:
    """The robot's time goes by half as fast as that of its pages.

    On a busy machine one that drives may say nothing for longer than it has.
    """
    monkeypatch.setattr(motion, "LONGEST_STEP", 0.5 / 30)


@pytest.fixture
def viz() -> Iterator[Visualizer]:
    with Visualizer(port=0, look="rviz") as viz:
        yield viz


@pytest.fixture
def drive(viz: Visualizer) -> Drive:
    return session_of(viz).drive


def drive_by_keys(viewer: ViewerPage, drive: Drive, times: int) -> None:
    """Press the key for more speed."""
    user, before = viewer.user, drive.v
    user.click("tab", "Drive")
    user.keys(*["8"] * times)
    user.until(lambda: drive.v == pytest.approx(before + 0.1 * times))


def drives_on(drive: Drive) -> None:
    """Wait until the robot has driven longer than it does alone."""
    there = drive.pose.x
    until(lambda: drive.pose.x - there > 1.1 * KEEP * drive.v, 20.0)


def hide(viewer: ViewerPage) -> None:
    viewer.minimize()


def close(viewer: ViewerPage) -> None:
    viewer.page.goto("about:blank")


def load_again(viewer: ViewerPage) -> None:
    viewer.page.goto(viewer.url)


@pytest.mark.parametrize(
    "leave", [hide, close, pytest.param(load_again, marks=pytest.mark.slow)]
)
def test_a_robot_stops_when_the_page_that_drives_it_goes(
    viz: Visualizer,
    drive: Drive,
    open_viewer: Open,
    leave: Callable[[ViewerPage], None],
) -> None:
    viewer, other = open_viewer(viz.url), open_viewer(viz.url)
    drive_by_keys(viewer, drive, times=3)
    drives_on(drive)
    leave(viewer)
    until(lambda: not drive.moving)
    other.user.reads(STOPPED)


@pytest.mark.parametrize("leave", [pytest.param(hide, marks=pytest.mark.slow), close])
def test_another_page_that_drives_keeps_the_robot_going(
    viz: Visualizer,
    drive: Drive,
    open_viewer: Open,
    leave: Callable[[ViewerPage], None],
) -> None:
    viewer, other = open_viewer(viz.url), open_viewer(viz.url)
    drive_by_keys(viewer, drive, times=2)
    drive_by_keys(other, drive, times=1)
    leave(viewer)
    drives_on(drive)
    other.user.keys("5")
    until(lambda: not drive.moving)


@pytest.mark.view
def test_who_comes_back_sees_the_robot(
    viz: Visualizer, drive: Drive, open_viewer: Open
) -> None:
    session = session_of(viz)
    viewer = open_viewer(viz.url)
    drive_by_keys(viewer, drive, times=10)
    drives_on(drive)
    close(viewer)
    # It drives on for a while, out of the picture of a page that is back sooner.
    until(lambda: not drive.moving)
    viewer.page.goto(viewer.url)
    viewer.user.reads(STOPPED)
    until(lambda: sees_robot(session))


def sees_robot(session: Session) -> bool:
    """Whether the page, of which there is one, has the robot in its picture."""
    (client,) = session.clients.all.values()
    tree, fixed = session.scene.context.tree, session.scene.context.fixed_frame
    place = tree.lookup(fixed, session.drive.root).matrix[:3, 3]
    window = client.client.camera
    size = window.image_width, window.image_height
    return client.view.confirmed and client.view.camera.shows(place, *size)
