"""A page of a recording plays it, and copies of a session show its time."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from inside import node_of, session_of
from lower_limit import lower

from sambot_viz import Visualizer
from sambot_viz.export.page_file import ViewState, cut_short, page_file


@pytest.fixture
def viz(repository: Path) -> Iterator[Visualizer]:
    path = repository / "assets" / "square.mcap"
    with Visualizer(path, port=0) as viz:
        viz.player.pause()
        yield viz


def about(page: bytes) -> Any:
    found = re.search(rb'id="sambot-about"[^>]*>(.*?)</script>', page, re.DOTALL)
    assert found is not None
    return json.loads(found[1])


def exported(viz: Visualizer, motion: Any) -> Any:
    session = session_of(viz)
    view = ViewState.at_first(session.document_view, True)
    return about(page_file(session.copy(), view, motion))


def test_a_page_has_the_recording_from_the_present_time_on(viz: Visualizer) -> None:
    viz.player.jump(15.0)
    shown = exported(viz, "recording")
    assert shown["duration"] == pytest.approx(viz.player.duration - 15.0, abs=1e-6)


def test_it_is_said_from_where_a_long_recording_is_left_out(
    viz: Visualizer, monkeypatch: pytest.MonkeyPatch
) -> None:
    viz.player.jump(5.0)
    assert cut_short(session_of(viz).copy()) == []
    lower(monkeypatch, "EXPORTED_RECORDING", 10)
    (said,) = cut_short(session_of(viz).copy())
    rest = round(viz.player.duration - 5.0)
    assert f"10 of {rest} seconds" in said.message
    assert "--at 15.0" in said.hint


def test_the_last_minute_ends_at_the_present_time(viz: Visualizer) -> None:
    viz.player.jump(2.5)
    assert exported(viz, "past")["duration"] == pytest.approx(2.5, abs=1e-6)


def test_a_copy_shows_the_same_time_and_who_moves_the_joints(viz: Visualizer) -> None:
    viz.player.jump(3.0)
    copy = session_of(viz).copy()
    assert copy.time_ns - 1_750_000_000_001_000_000 == 3_000_000_000
    assert copy.follows
    data = session_of(viz).data
    assert data is not None
    data.follow(False)
    assert not session_of(viz).copy().follows


def test_a_sweep_moves_the_joints_of_a_recorded_robot(viz: Visualizer) -> None:
    assert exported(viz, "sweep")["duration"] > 1.0
    # What is shown is as it was.
    assert session_of(viz).robot.followed.value == "square.mcap"


def test_the_camera_of_a_page_follows_the_frame_of_the_view_from_where_it_is_seen(
    viz: Visualizer,
) -> None:
    def cameras() -> list[Any]:
        found: list[Any] = []
        for seconds in (1.0, 9.0):
            viz.player.jump(seconds)
            found.append(exported(viz, "recording")["camera"])
        return found

    viz.camera.view("Orbit", {"Distance": 3.0, "Target Frame": "base_link"})
    one, two = cameras()
    assert one["follows"]["node"] == node_of(viz, "base_link")
    x, y, _ = viz.frames.lookup("odom", "base_link").translation
    assert two["follows"]["at"][:2] == pytest.approx([x, y], abs=1e-6)
    assert one["follows"]["at"] != two["follows"]["at"]
    # Relative to the frame it is the same.
    for end in ("position", "look_at"):
        assert one["camera"][end] == pytest.approx(two["camera"][end], abs=1e-6)


def test_a_page_from_the_begin_waits_for_nothing_and_has_all_links(
    viz: Visualizer,
) -> None:
    viz.player.jump(0.0)
    shown = exported(viz, "recording")
    assert shown["duration"] == pytest.approx(viz.player.duration, abs=1e-6)
    # Its first picture has the links where the first transforms will have them.
    copy = session_of(viz).copy()
    pose = session_of(viz).scene.context.pose
    for link in copy.robot.links if copy.robot else ():
        assert pose(link) is not None
