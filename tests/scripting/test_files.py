"""Pictures say what they need before a browser starts; pages play a motion."""

from __future__ import annotations

import base64
import gzip
import json
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from inside import node_of

from sambot_viz import JointError, UsageError, Visualizer
from sambot_viz.errors import SambotVizError
from sambot_viz.export.devtools import BrowserError


def test_without_a_browser_a_picture_says_how_to_get_one(
    viz: Visualizer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SAMBOT_VIZ_BROWSER", str(tmp_path / "no-such-browser"))
    with pytest.raises(BrowserError, match="SAMBOT_VIZ_BROWSER"):
        viz.snapshot(tmp_path / "a.png")
    assert list(tmp_path.iterdir()) == []


def test_a_size_that_makes_no_sense_is_refused(viz: Visualizer, tmp_path: Path) -> None:
    sizes: list[Any] = [(0, 600), (9000, 600), (1, 2, 3), "big", None]
    for size in sizes:
        with pytest.raises(UsageError, match="pixels"):
            viz.snapshot(tmp_path / "a.png", size=size)


def test_private_sessions_have_no_picture(
    make_viz: Callable[..., Visualizer], tmp_path: Path
) -> None:
    with pytest.raises(UsageError, match="shared session"):
        make_viz(session="private").snapshot(tmp_path / "a.png")


LEFT, RIGHT = "drivewhl_l_joint", "drivewhl_r_joint"


def poses_of(page: Path) -> tuple[float, list[tuple[str, list[int], list[Any]]]]:
    """How long the motion of a page is [s], and its turns: node, times [ms], values."""
    text = page.read_text("utf-8")
    duration = re.search(r'"duration": ?([0-9.]+)', text)
    packed = max(re.findall(r"H4sI[A-Za-z0-9+/=]+", text), key=len)
    assert duration is not None
    found: list[tuple[str, list[int], list[Any]]] = []
    for track in json.loads(gzip.decompress(base64.b64decode(packed))):
        if track["type"] == "SetOrientationMessage":
            times = np.cumsum(track["since"]).tolist()
            found.append((track["name"], times, track["values"]))
    return float(duration[1]), found


def angle(wxyz: list[float]) -> float:
    """How far a wheel is turned about its axle [rad]."""
    w, _, y, _ = wxyz
    return 2.0 * math.atan2(y, w)


def test_a_page_plays_a_motion_of_the_program(viz: Visualizer, tmp_path: Path) -> None:
    times = np.array([5.0, 6.0, 7.0])
    viz.export(tmp_path / "a.html", motion=(times, {LEFT: [0.0, 1.0, 0.5]}))
    duration, (turns,) = poses_of(tmp_path / "a.html")
    assert 2.0 <= duration <= 3.0
    name, at, values = turns
    assert name == node_of(viz, "drivewhl_l_link")
    angles = dict(zip(at, map(angle, values), strict=True))
    assert angles[500] == pytest.approx(0.5, abs=1e-3)
    assert angles[1000] == pytest.approx(1.0, abs=1e-3)
    assert angles[2000] == pytest.approx(0.5, abs=1e-3)


def test_a_motion_may_be_rows_of_all_joints(viz: Visualizer, tmp_path: Path) -> None:
    rows = np.column_stack([[0.0, 1.0], [0.0, -1.0]])
    viz.export(tmp_path / "a.html", motion=([0, 1], rows))
    _, turns = poses_of(tmp_path / "a.html")
    ends = sorted(angle(values[-1]) for _, _, values in turns)
    assert ends == pytest.approx([-1.0, 1.0], abs=1e-3)


WRONG: list[tuple[Any, type[SambotVizError], str]] = [
    (([0, 1], {"drivewhl_jiont": [0, 1]}), JointError, "did you mean"),
    (([0, 1], {LEFT: [0, 1, 2]}), JointError, "needs 2 positions"),
    (([0, 1], {LEFT: [0, math.nan]}), JointError, "not all positions are finite"),
    (([0, 1], {LEFT: ["a", "b"]}), JointError, "not all numbers"),
    (([0, 1], [[0, 1, 2], [0, 1, 2]]), JointError, r"have the shape \(2, 2\)"),
    (([1, 0], {LEFT: [0, 1]}), UsageError, "numbers .s. that grow"),
    (([], {LEFT: []}), UsageError, "numbers .s. that grow"),
    (([0, 1e9], {LEFT: [0, 1]}), UsageError, "at most"),
    (5, UsageError, "a pair"),
]


@pytest.mark.parametrize(("motion", "error", "text"), WRONG)
def test_a_motion_that_makes_no_sense_is_refused(
    viz: Visualizer,
    tmp_path: Path,
    motion: Any,
    error: type[SambotVizError],
    text: str,
) -> None:
    with pytest.raises(error, match=text):
        viz.export(tmp_path / "a.html", motion=motion)
    assert list(tmp_path.iterdir()) == []
