"""A program of foxglove-sdk that runs is shown as a recording of it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import foxglove
import foxglove.messages as fox
import pytest
from inside import session_of
from live_peers import FoxglovePeer, eventually

from sambot_viz import Visualizer

CONFIG = """
Visualization Manager:
  Displays:
    - {Class: rviz_default_plugins/LaserScan, Enabled: true, Topic: {Value: /scan}}
  Global Options: {Fixed Frame: map}
"""


@pytest.fixture
def peer() -> Iterator[FoxglovePeer]:
    peer = FoxglovePeer()
    yield peer
    peer.stop()


def channel(peer: FoxglovePeer, topic: str, kind: Any) -> foxglove.Channel:
    schema = kind.get_schema()
    return foxglove.Channel(
        topic, schema=schema, message_encoding="protobuf", context=peer.context
    )


def test_what_a_program_sends_in_protobuf_is_drawn(
    peer: FoxglovePeer, tmp_path: Path
) -> None:
    config = tmp_path / "config.rviz"
    config.write_text(CONFIG)
    frames = channel(peer, "/tf", fox.FrameTransform)
    scans = channel(peer, "/scan", fox.LaserScan)
    stamp = fox.Timestamp(sec=1_700_000_000)
    frame = fox.FrameTransform(
        timestamp=stamp, parent_frame_id="map", child_frame_id="lidar"
    )
    scan = fox.LaserScan(
        timestamp=stamp, frame_id="lidar", end_angle=1, ranges=[1.0, 2.0]
    )
    with Visualizer(config=config, source=peer.uri, port=0) as viz:

        def is_drawn() -> bool:
            # The program sees clients come and go; it sends to all.
            frames.log(frame.encode())
            scans.log(scan.encode())
            display: Any = session_of(viz).scene.displays[0]
            said = display.status.rows.get("Transform")
            return said is not None and said.text == "Transform OK"

        eventually(is_drawn)
