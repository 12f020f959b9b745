"""`viz.snapshot` says what it needs before it starts a browser."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from sambot_viz import UsageError, Visualizer
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
