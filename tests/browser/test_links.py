"""A link to what one browser sees, opened in another one."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from inside import node_of, session_of
from viewer_page import ViewerPage

from sambot_viz import Visualizer
from sambot_viz.displays.picking.selectable import Selectable

pytestmark = pytest.mark.browser
LEFT, RIGHT = "drivewhl_l_joint", "drivewhl_r_joint"
LEFT_LINK = "drivewhl_l_link"
CAMERA = "__viserMutable.camera.position.toArray()"
Open = Callable[..., ViewerPage]


def copied(viewer: ViewerPage) -> str:
    viewer.page.allow("clipboardReadWrite", "clipboardSanitizedWrite")
    viewer.user.menu("Edit", "Copy permalink")
    viewer.user.reads("Link copied")
    return viewer.user.clipboard


def is_ready(viewer: ViewerPage) -> None:
    viewer.user.row("Joints", LEFT)


@pytest.mark.view
def test_a_link_shows_the_same_in_another_browser_and_in_another_program(
    open_viewer: Open,
) -> None:
    with (
        Visualizer(port=0, look="rviz") as viz,
        Visualizer(port=0, look="rviz", token="a-long-secret-word") as other,
    ):
        viewer = open_viewer(viz.url)
        is_ready(viewer)
        viewer.wait_for_nodes(node_of(viz, LEFT_LINK))
        viewer.settle(viz)
        viewer.page.mouse.drag((600.0, 300.0), (680.0, 340.0))
        user = viewer.user
        user.enter(user.row("Joints", LEFT).one("textbox"), "0.75")
        user.click_on(user.row("Displays", "Grid").one("checkbox"))
        (browser,) = session_of(viz).clients.all.values()
        browser.tools.select({Selectable("link", LEFT_LINK)}, None)
        user.reads(f"Selected: {LEFT_LINK}")
        viewer.settle(viz)
        link = copied(viewer)
        camera = viewer.page.evaluate(CAMERA)
        assert link.startswith(f"{viz.url}/#view=Orbit&")
        assert len(link) < 500
        # The token is taken out of the address by a redirect, which keeps the link.
        assert "?token=" in other.url
        mark = link.partition("#")[2]
        # The programs end before the pages.
        viewer.expects_errors = True
        pages: list[ViewerPage] = []
        for address, server in ((link, viz), (f"{other.url}#{mark}", other)):
            page = open_viewer(address)
            pages.append(page)
            page.expects_errors = True
            # A notice goes after some seconds: the next page is opened later.
            page.user.reads("Opened the link")
            page.user.until(lambda s=server: s.joint_positions[LEFT] == 0.75)
            page.user.until(
                lambda p=page: np.allclose(p.page.evaluate(CAMERA), camera, atol=1e-3)
            )
            page.user.reads(f"Selected: {LEFT_LINK}")
            page.user.until(
                lambda p=page: not p.user.row("Displays", "Grid").one("checkbox").is_on
            )
            # Loading the page again does not put the joints back.
            address = str(page.page.evaluate("location.href"))
            assert "#" not in address and "token" not in address
        # In a page that is open already, the address may be replaced.
        other.set_joint_positions({LEFT: 0.0, RIGHT: 1.0})
        elsewhere = pages[-1]
        elsewhere.page.evaluate(f"void (location.hash = {mark!r})")
        elsewhere.user.until(
            lambda: dict(other.joint_positions) == {LEFT: 0.75, RIGHT: 0.0}
        )
