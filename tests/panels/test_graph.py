"""The Graph panel: what launch files would start, and what runs."""

from __future__ import annotations

import threading
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

import sambot_viz.graph.expected as expected
from sambot_viz import Visualizer
from sambot_viz.graph.node_graph import NodeGraph
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options
from sambot_viz.panels.graph.graph_panel import GraphPanel
from sambot_viz.session import Session

BROKEN = '<robot name="r"><link name="base"/>'


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


def parts(panel: GraphPanel, session: Session) -> dict[str, dict[str, Any]]:
    """What is drawn by now, by name."""
    with session.lock:
        picture = data_of(panel)["graph/picture"]
    return {part["name"]: part for part in picture["parts"]} if picture else {}


def until_drawn(panel: GraphPanel, session: Session, *names: str) -> None:
    until(lambda: [*parts(panel, session)] == [*names], WAIT)


def test_a_model_without_launch_files_has_no_graph(
    make_viz: Callable[..., Visualizer],
) -> None:
    assert rows_of(panel_of(GraphPanel, session_of(make_viz()))) == {}


def test_the_graph_is_made_once_somebody_looks(session: Session) -> None:
    panel = panel_of(GraphPanel, session)
    assert [*rows_of(panel)] == ["graph/details", "graph/wait"]
    assert parts(panel, session) == {}
    edit(panel, "graph/show", [True])
    until_drawn(panel, session, "/listener", "/talker")
    edit(panel, "graph/show", [False])
    assert parts(panel, session) == {}


def test_a_node_has_its_place_which_only_those_at_the_disk_see_whole(
    session: Session, tmp_path: Path
) -> None:
    for folders, begin in ((True, f"{tmp_path}/robot/launch/"), (False, "")):
        panel = panel_of(GraphPanel, session, folders=folders)
        edit(panel, "graph/show", [True])
        until_drawn(panel, session, "/listener", "/talker")
        talker = parts(panel, session)["/talker"]
        assert talker["place"] == f"{begin}whole.launch.py:8"
        assert (str(tmp_path) in talker["said"]) == folders
        edit(panel, "graph/show", [False])


def test_a_package_whose_model_has_an_error_has_its_graph(tmp_path: Path) -> None:
    package = launch_package(tmp_path)
    (package / "robot.urdf").write_text(BROKEN, "utf-8")
    for model in (package, package / "robot.urdf"):
        inputs = Inputs(Options(model, watch=True), may_be_broken=True)
        with Visualizer.of_inputs(inputs) as viz:
            session = session_of(viz)
            panel = panel_of(GraphPanel, session)
            with session.lock:
                edit(panel, "graph/show", [True])
            until_drawn(panel, session, "/listener", "/talker")


def test_another_launch_file_is_chosen(session: Session) -> None:
    panel = panel_of(GraphPanel, session)
    edit(panel, "graph/show", [True])
    until_drawn(panel, session, "/listener", "/talker")
    row = rows_of(panel)["graph/launch"]
    assert (row.value, row.options) == (
        "whole.launch.py",
        ["whole.launch.py", "small.launch.py"],
    )
    edit(panel, "graph/launch", "small.launch.py")
    until_drawn(panel, session, "/listener")


def test_what_a_robot_runs_is_compared_with_the_launch_files(
    peer: RosbridgePeer, tmp_path: Path
) -> None:
    package = launch_package(tmp_path)
    with Visualizer(package, port=0, source=peer.uri) as viz:
        session = session_of(viz)
        panel = panel_of(GraphPanel, session)

        def looks() -> dict[str, str]:
            drawn = parts(panel, session)
            return {name: part["look"] for name, part in drawn.items()}

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


def test_a_robot_that_is_not_connected_is_not_compared(
    session: Session, tmp_path: Path
) -> None:
    robot = RosbridgePeer()
    robot.stop()
    with Visualizer(tmp_path / "robot", port=0, source=robot.uri) as viz:
        session = session_of(viz)
        panel = panel_of(GraphPanel, session)
        with session.lock:
            edit(panel, "graph/show", [True])
            assert "is not connected" in str(rows_of(panel)["graph/robot"].value)
        until_drawn(panel, session, "/listener", "/talker")
        assert {p["look"] for p in parts(panel, session).values()} == {"node"}


def test_the_session_does_not_wait_for_a_graph_and_keeps_the_last_one(
    session: Session, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    panel = panel_of(GraphPanel, session)
    edit(panel, "graph/show", [True])
    until_drawn(panel, session, "/listener", "/talker")
    drawn, going_on, makers = expected.expected_graph, threading.Event(), list[object]()

    def slow(*arguments: Any) -> NodeGraph:
        makers.append(threading.current_thread())
        assert going_on.wait(WAIT)
        return drawn(*arguments)

    monkeypatch.setattr(expected, "expected_graph", slow)
    for name in ("small", "whole", "small"):
        edit(panel, "graph/launch", f"{name}.launch.py")
    assert [*parts(panel, session)] == ["/listener", "/talker"]
    going_on.set()
    until_drawn(panel, session, "/listener")
    # What was asked for meanwhile is made once, in the same thread.
    assert len(makers) <= 2 and len(set(makers)) == 1
