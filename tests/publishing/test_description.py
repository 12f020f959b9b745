"""A saved model becomes the description of a live robot, where that is allowed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from inside import session_of
from live_peers import eventually
from navigator_peer import NavigatorPeer

from sambot_viz import Visualizer

SERVICE = "/robot_state_publisher/set_parameters"
MODEL = '<robot name="a"><link name="{}"/></robot>'
DONE = b"\0\1\0\0" + b"\1\0\0\0" + b"\1\0\0\0" + b"\1\0\0\0" + b"\0"
REFUSED = b"\0\1\0\0" + b"\1\0\0\0" + b"\0\0\0\0" + b"\3\0\0\0" + b"no\0"
"""A SetParameters_Response as CDR: one result, whether it was set, and why not."""


@pytest.fixture
def peer() -> Iterator[NavigatorPeer]:
    made = NavigatorPeer()
    made.serve(SERVICE, reply=DONE)
    yield made
    made.stop()


@pytest.fixture
def opened(peer: NavigatorPeer, tmp_path: Path) -> Iterator[Callable[..., Visualizer]]:
    made: list[Visualizer] = []
    path = tmp_path / "a.urdf"

    def open_one(publish: str | None = "description") -> Visualizer:
        path.write_text(MODEL.format("before"))
        viz = Visualizer(path, source=peer.uri, port=0, publish=publish, watch=True)
        made.append(viz)
        data = session_of(viz).data
        assert data is not None
        eventually(lambda: data.source.status.is_connected)
        eventually(lambda: "map" in session_of(viz).scene.context.tree.frames)
        return viz

    yield open_one
    for viz in made:
        viz.stop()


def codes(viz: Visualizer) -> list[str]:
    return [
        one.code for one in session_of(viz).problems.of_saves.get("description", ())
    ]


def root_of(viz: Visualizer) -> str:
    model = session_of(viz).robot.model
    return "" if model is None else model.root


def save(path: Path, name: str) -> None:
    """Save another model, as an editor does."""
    beside = path.with_suffix(".new")
    beside.write_text(MODEL.format(name))
    beside.replace(path)


def test_a_saved_model_is_set_and_the_answer_said(
    peer: NavigatorPeer, opened: Callable[..., Visualizer], tmp_path: Path
) -> None:
    viz = opened()
    assert peer.requests == [], "only a model that is saved is sent"
    save(tmp_path / "a.urdf", "after")
    eventually(lambda: codes(viz) == ["description-taken"])
    (request,) = peer.requests
    assert b"robot_description" in request and b'name="after"' in request
    peer.serve(SERVICE, reply=REFUSED)
    save(tmp_path / "a.urdf", "again")
    eventually(lambda: codes(viz) == ["description-not-taken"])
    (said,) = session_of(viz).problems.of_saves["description"]
    assert "robot_state_publisher did not take the saved model: no" in said.message


def test_a_model_with_a_mistake_is_not_sent(
    peer: NavigatorPeer, opened: Callable[..., Visualizer], tmp_path: Path
) -> None:
    viz = opened()
    save(tmp_path / "a.urdf", '"')
    eventually(lambda: session_of(viz).problems.of_saves.get("model"))
    save(tmp_path / "a.urdf", "after")
    eventually(lambda: codes(viz) == ["description-taken"])
    assert len(peer.requests) == 1


def test_without_leave_nothing_is_sent(
    peer: NavigatorPeer, opened: Callable[..., Visualizer], tmp_path: Path
) -> None:
    viz = opened("goal")
    save(tmp_path / "a.urdf", "after")
    eventually(lambda: root_of(viz) == "after")
    assert peer.requests == [] and codes(viz) == []
