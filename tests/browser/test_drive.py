"""sam_bot drives a square in the browser and comes back."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from inside import node_of
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = pytest.mark.browser


@pytest.mark.view
def test_the_sam_bot_drives_a_square_and_returns(
    viz: Visualizer, open_viewer: Callable[..., ViewerPage]
) -> None:
    session = viz._server.sessions.all()[0]  # pyright: ignore[reportPrivateUsage]
    drive = session.drive
    viewer = open_viewer(viz.url)
    viewer.wait_for_nodes(node_of(viz, "base_link"))
    drive.enter_odom()
    session.document.set_option("Fixed Frame", "odom")
    base = node_of(viz, "base_link")
    viewer.wait_for_nodes(base)
    start = viz.frames.lookup("odom", "base_link").matrix
    viewer.wait_for_pose(base, start)

    # The test takes the steps, so that each side of the square is exact.
    session.motion._ticking = True  # pyright: ignore[reportPrivateUsage]
    places: list[tuple[float, float]] = []
    for _ in range(4):
        drive.set_velocity(0.5, 0.0)
        session.motion.advance(2.0)
        drive.set_velocity(0.0, math.pi / 4)
        session.motion.advance(2.0)
        pose = drive.pose
        T = np.eye(4)
        c, s = math.cos(pose.yaw), math.sin(pose.yaw)
        T[:2, :2] = ((c, -s), (s, c))
        T[:3, 3] = (pose.x, pose.y, start[2, 3])
        viewer.wait_for_pose(base, T)
        places.append((pose.x, pose.y))
    drive.stop()
    assert max(x for x, _ in places) > 0.8
    assert max(y for _, y in places) > 0.8
    viewer.wait_for_pose(base, start)
