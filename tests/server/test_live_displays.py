"""Displays of data and a robot on the network: asked for, drawn, and left alone."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from inside import session_of
from live_peers import eventually
from robot_peer import RobotPeer

from sambot_viz import Visualizer

CONFIG = """
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/LaserScan
      Name: Scan
      Enabled: true
      Topic: {Value: /scan}
  Global Options: {Fixed Frame: odom}
"""


@pytest.fixture
def viz(peer: RobotPeer, tmp_path: Path) -> Iterator[Visualizer]:
    """Opens the robot with a display of its scans."""
    config = tmp_path / "scan.rviz"
    config.write_text(CONFIG)
    with Visualizer(source=peer.uri, config=config, port=0) as viz:
        # Nobody else looks, and scans are asked for only then.
        session_of(viz)
        eventually(lambda: {"/scan", "/tf"} <= set(peer.subscribed()))
        yield viz


def scan(viz: Visualizer) -> Any:
    displays = session_of(viz).scene.displays
    return next(one for one in displays if one.kind.endswith("/LaserScan"))


def said(viz: Visualizer, key: str) -> str:
    status = scan(viz).status.rows.get(key)
    return "" if status is None else status.text


def test_scans_are_drawn_where_they_were_measured(
    peer: RobotPeer, viz: Visualizer
) -> None:
    peer.play(3.0, topics=("/tf", "/scan"))
    eventually(lambda: "from [1] messages" in said(viz, "Points"))
    # Scans that come before their transforms may have been too many to wait.
    eventually(lambda: said(viz, "Transform") == "Transform OK")


def test_a_scan_waits_for_its_transform(peer: RobotPeer, viz: Visualizer) -> None:
    peer.play(1.0, topics=("/scan",))
    eventually(lambda: "Warn" in {row.level for row in scan(viz).status.rows.values()})
    assert "from [1]" not in said(viz, "Points")
    peer.play(3.0, topics=("/tf",))
    eventually(lambda: "from [1] messages" in said(viz, "Points"))


def test_a_display_that_is_off_costs_the_network_nothing(
    peer: RobotPeer, viz: Visualizer
) -> None:
    edits = session_of(viz).display_edits
    edits.set_enabled(scan(viz).config, False)
    eventually(lambda: "/scan" not in peer.subscribed())
    edits.set_enabled(scan(viz).config, True)
    eventually(lambda: "/scan" in peer.subscribed())


def test_a_topic_of_another_type_and_one_that_is_missing_say_so(
    peer: RobotPeer, viz: Visualizer
) -> None:
    edits = session_of(viz).display_edits
    edits.set_property(scan(viz), "Topic", "/tf")
    assert "this is tf2_msgs/msg/TFMessage" in said(viz, "Topic")
    assert list(scan(viz).status.rows) == ["Topic"]
    edits.set_property(scan(viz), "Topic", "/scn")
    assert "there is no topic /scn" in said(viz, "Topic").lower()
    assert scan(viz).repairs()["Topic"].value == "/scan"
