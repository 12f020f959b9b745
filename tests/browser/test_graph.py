"""The Graph panel: nodes and topics, and what a click and the keys lead to."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from launch_package import launch_package
from rosbridge_peer import RosbridgePeer
from user import User
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = pytest.mark.browser


@pytest.fixture
def user(open_viewer: Callable[..., ViewerPage], tmp_path: Path) -> Iterator[User]:
    with Visualizer(launch_package(tmp_path), port=0, look="rviz") as viz:
        page = open_viewer(viz.url)
        page.page.allow("clipboardReadWrite", "clipboardSanitizedWrite")
        made = page.user
        made.click_on(made.find("tab", "Graph"))
        yield made


def test_a_node_says_where_it_is_started_and_that_is_copied(user: User) -> None:
    user.click("button", "node /talker")
    user.reads("package demo_nodes_cpp")
    user.click("button", "Copy file and line")
    user.until(lambda: user.clipboard.endswith("whole.launch.py:8"))


def test_arrow_keys_go_from_node_to_node(user: User) -> None:
    user.click("button", "node /listener")
    user.keys("ArrowRight")
    user.until(lambda: user.find("button", "node /talker").state("focused"))
    user.keys("ArrowLeft")
    user.until(lambda: user.find("button", "node /listener").state("focused"))


_PUBLISHER = """<node pkg="robot_state_publisher" exec="robot_state_publisher"
  namespace="robot{}"/>"""
_LETTERS = """(() => {
  const texts = [...document.querySelectorAll(".ros-graph text")];
  return Math.min(...texts.map(one => one.getBoundingClientRect().height));
})()"""


def test_the_names_of_a_large_graph_can_be_read_without_enlarging_it(
    open_viewer: Callable[..., ViewerPage], tmp_path: Path
) -> None:
    package = launch_package(tmp_path)
    nodes = "".join(_PUBLISHER.format(i) for i in range(16))
    launch = f"<launch>{nodes}</launch>"
    (package / "launch" / "large.launch.xml").write_text(launch, "utf-8")
    with Visualizer(package, port=0, look="rviz") as viz:
        user = open_viewer(viz.url, width=1400, height=900).user
        user.click_on(user.find("tab", "Graph"))
        user.find("button", "node /robot0/robot_state_publisher")
        readable = user.page.evaluate(_LETTERS)
        assert readable > 9
        # Of topics that one node has only those are drawn that nobody publishes.
        assert not user.there("button", "topic /robot0/robot_description")
        user.click("checkbox", "Details")
        user.find("button", "topic /robot0/robot_description")
        user.click("button", "Fit")
        user.until(lambda: user.page.evaluate(_LETTERS) < readable)


def test_the_graph_is_shown_large_and_closed(user: User) -> None:
    user.click("button", "Enlarge")
    user.until(lambda: user.there("dialog", "Nodes and topics"))
    user.click("button", "Larger", ("dialog", "Nodes and topics"))
    user.keys("Escape")
    user.gone("dialog", "Nodes and topics")


def test_a_topic_of_a_robot_leads_to_its_row_from_the_large_graph_too(
    open_viewer: Callable[..., ViewerPage], tmp_path: Path
) -> None:
    peer = RosbridgePeer()
    peer.advertise("/chatter")
    package = launch_package(tmp_path)
    try:
        with Visualizer(package, port=0, look="rviz", source=peer.uri) as viz:
            user = open_viewer(viz.url).user
            user.click_on(user.find("tab", "Graph"))
            user.find("button", "topic /chatter")
            user.click("button", "Enlarge")
            large = ("dialog", "Nodes and topics")
            user.click("button", "topic /chatter", large)
            user.gone(*large)
            user.until(lambda: user.row("Topics", "/chatter").state("focused"))
    finally:
        peer.stop()
