"""The Graph panel: what launch files would start, and what runs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from inside import session_of
from launch_package import launch_package
from live_peers import WAIT
from panel_rows import data_of, edit, panel_of, rows_of
from patience import until
from rosbridge_peer import RosbridgePeer

from sambot_viz import Visualizer
from sambot_viz.panels.graph.graph_panel import GraphPanel
from sambot_viz.session import Session


@pytest.fixture
def session(tmp_path: Path) -> Iterator[Session]:
    with Visualizer(launch_package(tmp_path), port=0) as viz:
        yield session_of(viz)


@pytest.fixture
def peer() -> Iterator[RosbridgePeer]:
    made = RosbridgePeer()
    made.advertise("/chatter")
    yield made
    made.stop()


def parts(panel: GraphPanel) -> dict[str, dict[str, Any]]:
    """What is drawn by now, by name."""
    picture = data_of(panel)["graph/picture"]
    return {part["name"]: part for part in picture["parts"]} if picture else {}


def test_a_model_without_launch_files_has_no_graph(
    make_viz: Callable[..., Visualizer],
) -> None:
    assert rows_of(panel_of(GraphPanel, session_of(make_viz()))) == {}


def test_the_graph_is_made_once_somebody_looks(session: Session) -> None:
    panel = panel_of(GraphPanel, session)
    assert [*rows_of(panel)] == ["graph/wait"]
    assert parts(panel) == {}
    edit(panel, "graph/show", [True])
    assert [*parts(panel)] == ["/listener", "/talker"]
    edit(panel, "graph/show", [False])
    assert parts(panel) == {}


def test_a_node_has_its_place_which_only_those_at_the_disk_see_whole(
    session: Session, tmp_path: Path
) -> None:
    for folders, begin in ((True, f"{tmp_path}/robot/launch/"), (False, "")):
        panel = panel_of(GraphPanel, session, folders=folders)
        edit(panel, "graph/show", [True])
        talker = parts(panel)["/talker"]
        assert talker["place"] == f"{begin}whole.launch.py:8"
        assert (str(tmp_path) in talker["said"]) == folders
        edit(panel, "graph/show", [False])


def test_another_launch_file_is_chosen(session: Session) -> None:
    panel = panel_of(GraphPanel, session)
    edit(panel, "graph/show", [True])
    row = rows_of(panel)["graph/launch"]
    assert (row.value, row.options) == (
        "whole.launch.py",
        ["whole.launch.py", "small.launch.py"],
    )
    edit(panel, "graph/launch", "small.launch.py")
    assert [*parts(panel)] == ["/listener"]


def test_what_a_robot_runs_is_compared_with_the_launch_files(
    peer: RosbridgePeer, tmp_path: Path
) -> None:
    package = launch_package(tmp_path)
    with Visualizer(package, port=0, source=peer.uri) as viz:
        session = session_of(viz)
        panel = panel_of(GraphPanel, session)

        def looks() -> dict[str, str]:
            with session.lock:
                return {name: part["look"] for name, part in parts(panel).items()}

        with session.lock:
            edit(panel, "graph/show", [True])
        expected = {
            "/listener": "node expected",
            "/talker": "node both",
            "/chatter": "topic running",
        }
        until(lambda: looks() == expected, WAIT)
        # It is looked at again as long as somebody sees it.
        peer.listen_as("/chatter", "/listener")
        until(lambda: looks()["/listener"] == "node both", WAIT)
