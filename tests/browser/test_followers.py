"""The page of a follower: what it shows of its origin, and what it says without one."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from viewer_page import ViewerPage
from zenoh_peer import ZenohPeer

from sambot_viz import Visualizer
from sambot_viz.options import Options
from sambot_viz.server.followers.follower import follow
from sambot_viz.server.listener import listen

pytestmark = [pytest.mark.browser, pytest.mark.view]

LEFT = "drivewhl_l_joint"
SAID = "document.querySelector('.connection').textContent.trim()"


@pytest.fixture
def place() -> Iterator[str]:
    peer = ZenohPeer(has_nodes=False)
    yield f"{peer.uri}/arm"
    peer.stop()


@pytest.fixture
def url(place: str) -> Iterator[str]:
    """The page of a follower."""
    options = Options(follow=place, port=0)
    with listen(options) as listener:
        stop = follow(options, listener)
        yield listener.url()
        stop()


def shown(viewer: ViewerPage) -> str:
    """The position of a joint in the panel."""
    return str(viewer.user.row("Joints", LEFT).one("textbox").value)


def test_a_page_keeps_the_last_picture_of_an_origin_that_ends_and_shows_the_next(
    place: str, url: str, open_viewer: Callable[..., ViewerPage]
) -> None:
    with Visualizer(port=0, broadcast=place) as origin:
        viewer = open_viewer(url)
        user = viewer.user
        user.find("link", "View only · Request control")
        href = viewer.page.evaluate("document.querySelector('a.chip').href")
        assert href == f"{origin.url}/"
        user.tab("Joints")
        user.row("Joints", LEFT)
        origin.set_joint_positions({LEFT: 1.0})
        user.until(lambda: shown(viewer) == "1")
        nodes = viewer.nodes
    user.reads("The origin has ended; this is what it showed last. Trying again…")
    assert viewer.nodes == nodes
    with Visualizer(port=0, broadcast=place) as again:
        user.until(lambda: viewer.page.evaluate(SAID) == "")
        again.set_joint_positions({LEFT: 2.0})
        user.until(lambda: shown(viewer) == "2")
        user.until(lambda: sorted(viewer.nodes) == sorted(nodes))
