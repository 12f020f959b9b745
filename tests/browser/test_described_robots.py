"""Which robot a RobotModel shows: its topic, its QoS, and the button of its status."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from inside import session_of
from live_peers import FoxglovePeer
from made_recording import described, write_recording
from user import User
from viewer_page import ViewerPage

from sambot_viz import Visualizer, bundled

MAIN, OTHER = "/robot_description", "/other/robot_description"
FRAMES = {"a_base": "odom", "a_arm": "a_base", "b_base": "odom", "b_arm": "b_base"}

pytestmark = pytest.mark.browser


@pytest.fixture
def viz(tmp_path: Path) -> Iterator[Visualizer]:
    texts = {MAIN: described("a_base", "a_arm"), OTHER: described("b_base", "b_arm")}
    path = write_recording(tmp_path / "two.mcap", texts, [("/tf", 0.0, FRAMES)])
    # Without a config both robots would be shown.
    config = bundled.config_path()
    with Visualizer(path, config=config, look="rviz", port=0) as viz:
        yield viz


@pytest.fixture
def user(viz: Visualizer, open_viewer: Callable[..., ViewerPage]) -> User:
    return open_viewer(viz.url).user


def test_the_robot_of_another_topic_is_shown_by_name_and_by_the_button(
    viz: Visualizer, user: User
) -> None:
    (display,) = [
        one for one in session_of(viz).scene.displays if one.robot_display is not None
    ]

    def links() -> list[str]:
        return sorted(display.entries()[0].names)

    user.unfold("Displays", "RobotModel")
    user.unfold("Displays", "RobotModel", "Description Topic")
    user.until(lambda: "Durability Policy" in user.rows("Displays"))
    assert links() == ["a_arm", "a_base"]
    user.enter(user.find("combobox", "Description Topic"), "/othr/robot_description")
    user.find("button", f"Use {OTHER}")
    assert links() == ["a_arm", "a_base"]
    user.click("button", f"Use {OTHER}")
    user.until(lambda: links() == ["b_arm", "b_base"])
    user.gone("button", f"Use {OTHER}")


def test_the_time_of_a_simulation_is_below_the_view(
    open_viewer: Callable[..., ViewerPage],
) -> None:
    peer = FoxglovePeer()
    try:
        peer.advertise(MAIN, latched=True)
        peer.publish(MAIN, described("a_base"))
        with Visualizer(source=peer.uri, look="rviz", port=0) as viz:
            user = open_viewer(viz.url).user
            user.until(lambda: session_of(viz).robot.model.name == "a_base")
            assert peer.server is not None
            peer.server.broadcast_time(12_500_000_000)
            user.click("button", re.compile("Simulated 12.5 s"))
            user.reads("ROS Elapsed")
            # It is paused.
            user.find("button", re.compile("Simulated 12.5 s"))
    finally:
        peer.stop()
