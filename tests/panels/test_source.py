"""The player below the view: rows for its time, rate and loop, and steps."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from inside import session_of

from sambot_viz import Visualizer
from sambot_viz.panels.sources.source_panel import SourcePanel
from sambot_viz.session.data.player import Player
from sambot_viz.session.data.session_sources import SessionSources


@pytest.fixture
def sources(repository: Path) -> Iterator[SessionSources]:
    path = repository / "assets" / "square.mcap"
    with Visualizer(path, port=0) as viz:
        sources = session_of(viz).sources
        assert sources.data is not None
        sources.data.player._ticking = True  # pyright: ignore[reportPrivateUsage]
        yield sources


@pytest.fixture
def player(sources: SessionSources) -> Player:
    assert sources.data is not None and sources.data.player is not None
    return sources.data.player


@pytest.fixture
def panel(sources: SessionSources) -> SourcePanel:
    return SourcePanel(sources)


def value(panel: SourcePanel, row_id: str) -> Any:
    return next(row.value for row in panel.rows() if row.id == row_id)


def put(panel: SourcePanel, row_id: str, value: Any) -> None:
    row = next(row for row in panel.rows() if row.id == row_id)
    assert row.set is not None
    row.set(value)


def run(panel: SourcePanel, command_id: str, *arguments: Any) -> None:
    next(c for c in panel.commands() if c.id == command_id).run(*arguments)


def test_the_time_is_from_the_first_message(panel: SourcePanel, player: Player) -> None:
    assert value(panel, "player/time") == 0.0
    put(panel, "player/time", 5.5)
    assert value(panel, "player/time") == 5.5
    assert player.time_ns - player.start_ns == 5_500_000_000
    assert panel.values() == {"player/time": 5.5}


def test_the_controls_play_and_stop(panel: SourcePanel, player: Player) -> None:
    put(panel, "player/rate", 2.0)
    put(panel, "player/loop", True)
    put(panel, "player/playing", True)
    playback = player.playback.value
    assert (playback.playing, playback.rate, playback.loop) == (True, 2.0, True)
    put(panel, "player/playing", False)
    assert not player.playback.value.playing


def test_steps_go_to_messages_of_the_chosen_topic(panel: SourcePanel) -> None:
    put(panel, "player/topic", "/scan")
    assert value(panel, "player/topic") == "/scan"
    run(panel, "player/step", False)
    first = value(panel, "player/time")
    run(panel, "player/step", False)
    assert value(panel, "player/time") - first == pytest.approx(0.2, abs=1e-4)
    run(panel, "player/step", True)
    assert value(panel, "player/time") == first


def test_only_who_has_control_plays(panel: SourcePanel) -> None:
    assert not any(row.client_local for row in panel.rows())
    assert not any(one.client_local for one in panel.commands())
