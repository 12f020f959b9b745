"""The button that records a live robot: who has it, and what it writes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from inside import session_of
from live_peers import FoxglovePeer, eventually
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.sources.bag import open_recording

Protocol = Callable[..., ProtocolClient]


@pytest.fixture
def peer() -> Iterator[FoxglovePeer]:
    made = FoxglovePeer()
    made.advertise("/a")
    yield made
    made.stop()


def recording(client: ProtocolClient) -> Any:
    return client.row("source/status")["value"]["recording"]


def has(client: ProtocolClient, row_id: str) -> bool:
    return row_id in client.rows


def test_who_has_control_records_to_a_new_file_of_the_folder(
    make_viz: Callable[..., Visualizer],
    protocol: Protocol,
    peer: FoxglovePeer,
    tmp_path: Path,
) -> None:
    viz = make_viz(source=peer.uri, record_dir=tmp_path, presenter="teach-the-class")
    port = viz.viser.get_port()
    viewer, teacher = protocol(port), protocol(port, path="/?token=teach-the-class")
    eventually(lambda: "/" in teacher.row("source/status")["value"]["name"])
    eventually(lambda: has(teacher, "source/record"))
    # A viewer can do nothing.
    viewer.act("source/record")
    eventually(
        lambda: viewer.row("notice")["value"]["text"].startswith("View only"),
    )
    assert recording(teacher) is None
    assert list(tmp_path.iterdir()) == []

    teacher.act("source/record")
    eventually(lambda: recording(teacher)["running"])
    eventually(lambda: has(teacher, "source/stop"))
    assert not has(teacher, "source/record")
    eventually(lambda: "/a" in peer.subscribed())
    eventually(lambda: viewer.row("source/status")["value"]["recording"]["running"])
    peer.publish("/a", "words")
    eventually(lambda: recording(teacher)["size"] > 100)
    # The file has a head, and may have no message yet.
    data = session_of(viz).data
    assert data is not None
    recorder = data.moved_by.recorder
    assert recorder is not None
    eventually(lambda: recorder.status is not None and recorder.status.messages == 1)
    viewer.act("source/stop")
    viewer.settle(viz.viser)
    assert recording(teacher)["running"]
    teacher.act("source/stop")
    eventually(lambda: not recording(teacher)["running"])
    eventually(lambda: has(teacher, "source/record"))
    (path,) = tmp_path.iterdir()
    assert recording(teacher)["name"] == path.name
    with open_recording(path) as made:
        assert [bytes(one.payload[8:-1]) for one in made.messages()] == [b"words"]


@pytest.mark.parametrize(
    "options", [{"session": "private"}, {"record_dir": None}], ids=["private", "none"]
)
def test_nobody_else_has_the_button(
    make_viz: Callable[..., Visualizer],
    protocol: Protocol,
    peer: FoxglovePeer,
    tmp_path: Path,
    options: dict[str, Any],
) -> None:
    folder = tmp_path / "recordings"
    folder.mkdir()
    allowed = {"record_dir": folder, **options}
    viz = make_viz(source=peer.uri, record=tmp_path / "one.mcap", **allowed)
    client = protocol(viz.viser.get_port())
    eventually(lambda: recording(client)["running"])
    assert recording(client)["name"] == "one.mcap"
    client.act("source/record")
    client.act("source/stop")
    client.settle(viz.viser)
    assert not has(client, "source/record") and not has(client, "source/stop")
    assert recording(client)["running"]
    assert list(folder.iterdir()) == []
