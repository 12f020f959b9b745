"""The button that records a live robot, in the line below the view."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from inside import session_of
from live_peers import FoxglovePeer
from viewer_page import ViewerPage

from sambot_viz import Visualizer
from sambot_viz.sources.bag import open_recording

pytestmark = pytest.mark.browser


def test_a_click_records_and_another_ends_it(
    make_viz: Callable[..., Visualizer],
    open_viewer: Callable[..., ViewerPage],
    tmp_path: Path,
) -> None:
    peer = FoxglovePeer()
    try:
        peer.advertise("/a")
        viz = make_viz(source=peer.uri, record_dir=tmp_path)
        user = open_viewer(viz.url).user
        user.click("button", "Record")
        user.until(lambda: "/a" in peer.subscribed())
        peer.publish("/a", "words")
        data = session_of(viz).data
        recorder = data and data.moved_by.recorder
        assert recorder is not None
        user.until(lambda: recorder.status and recorder.status.messages == 1)
        user.find("button", "Stop")
        (path,) = tmp_path.iterdir()
        user.reads(f"Recording {path.name}")
        user.click("button", "Stop")
        user.reads(f"Recorded {path.name}")
        user.find("button", "Record")
    finally:
        peer.stop()
    with open_recording(path) as recording:
        assert [bytes(one.payload[8:-1]) for one in recording.messages()] == [b"words"]
