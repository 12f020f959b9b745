"""Frames are drawn at the times of a display's messages, as RViz's Time panel says."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from inside import session_of
from live_peers import eventually
from made_recording import write_recording
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.frames.display_time import DisplayTime, SyncMode
from sambot_viz.frames.history import FrameHistory

SECOND = 1_000_000_000
FRAMES = [("/tf", number / 10, {"base": "odom"}) for number in range(41)]
"""The robot drives 1 m a second."""
SCANS = [(stamp, stamp + 0.5) for stamp in (0.5, 1.5, 2.5)]
PANELS = "Panels:\n  - Class: rviz_common/Displays\n    Name: Displays\n"
TIME = """\
  - Class: rviz_common/Time
    Experimental: {experimental}
    Name: Time
    SyncMode: {mode}
    SyncSource: Laser
"""
SHOWN = """\
Visualization Manager:
  Class: ""
  Displays:
    - Class: rviz_default_plugins/LaserScan
      Enabled: true
      Name: Laser
      Topic:
        Value: /scan
  Global Options:
    Fixed Frame: odom
"""
Open = Callable[[str], Visualizer]


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Open]:
    """Opens the recording with some panels in the config."""
    made: list[Visualizer] = []
    path = write_recording(tmp_path / "late.mcap", {}, FRAMES, scans=SCANS)

    def open_one(panels: str = "") -> Visualizer:
        config = tmp_path / "late.rviz"
        config.write_text(panels + SHOWN)
        viz = Visualizer(source=f"bag:{path}", config=config, port=0)
        made.append(viz)
        viz.player.pause()
        return viz

    yield open_one
    for viz in made:
        viz.stop()


def drawn(viz: Visualizer) -> float:
    """Where the robot is drawn [m]; where look-ups of now have it too."""
    session = session_of(viz)
    with session.lock:
        node = session.scene.context.tree.hop("base").transform.translation[0]
        found = session.scene.context.tree.lookup("odom", "base").translation[0]
    assert found == pytest.approx(node)
    return round(float(node), 3)


def play_to(viz: Visualizer, seconds: float) -> None:
    """Play on in steps, as the player does."""
    data = session_of(viz).data
    assert data is not None and data.player is not None
    player = data.player
    player._ticking = True  # pyright: ignore[reportPrivateUsage]
    player.play()
    with session_of(viz).lock:
        while viz.player.time < seconds - 1e-6:
            player.advance(0.05)
        player.pause()


def test_exact_draws_the_robot_where_it_was_at_the_last_scan(opened: Open) -> None:
    viz = opened("")
    viz.player.jump(1.2)
    assert drawn(viz) == 1.2
    document = session_of(viz).document
    document.synchronize(SyncMode.EXACT, "Laser")
    assert drawn(viz) == 0.5, "the scan that has come is of that time"
    play_to(viz, 1.9)
    assert drawn(viz) == 0.5, "nothing moves between two scans"
    play_to(viz, 2.3)
    assert drawn(viz) == 1.5
    viz.player.jump(3.9)
    assert drawn(viz) == 2.5
    document.synchronize(SyncMode.OFF, "Laser")
    assert drawn(viz) == 3.9


def test_approximate_draws_as_long_ago_as_scans_are_old(opened: Open) -> None:
    viz = opened("")
    session_of(viz).document.synchronize(SyncMode.APPROXIMATE, "Laser")
    viz.player.jump(1.1)
    play_to(viz, 3.9)
    assert drawn(viz) == pytest.approx(3.4, abs=0.01)


def test_a_source_without_messages_and_one_that_is_not_there_change_nothing(
    opened: Open,
) -> None:
    viz = opened("")
    for name in ("Laser", "Nobody", ""):
        session_of(viz).document.synchronize(SyncMode.EXACT, name)
        viz.player.jump(0.8)
        assert drawn(viz) == 0.8


@pytest.mark.parametrize(
    ("experimental", "mode", "at"),
    [("true", 1, 1.5), ("true", 0, 2.2), ("false", 1, 2.2), ("true", 7, 1.7)],
)
def test_a_file_says_it_as_rviz_does(
    opened: Open, experimental: str, mode: int, at: float
) -> None:
    panel = TIME.format(experimental=experimental, mode=mode)
    viz = opened(PANELS + panel)
    viz.player.jump(1.9)
    play_to(viz, 2.2)
    # What is above 2 is 2, as for all whole numbers; it has not settled yet.
    assert drawn(viz) == pytest.approx(at, abs=0.3 if mode == 7 else 0.01)


@pytest.mark.parametrize("panels", ["", PANELS, PANELS + TIME])
def test_it_is_saved_as_rviz_saves_it_and_undone(
    opened: Open, panels: str, tmp_path: Path
) -> None:
    viz = opened(panels.format(experimental="false", mode=0))
    session = session_of(viz)
    before = session.document.config.to_yaml()
    with session.history.acting(1):
        session.document.synchronize(SyncMode.EXACT, "Laser")
    session.document.save(tmp_path / "saved.rviz")
    time = session.document.config.copy().time
    assert time.properties == {
        "Experimental": True,
        "SyncMode": 1,
        "SyncSource": "Laser",
    }
    session.history.undo(1)
    assert session.document.config.to_yaml() == before
    session.history.redo(1)
    assert session.document.synchronization == (1, "Laser")


def test_the_page_sets_it_and_says_how_old_the_picture_is(
    opened: Open, protocol: Callable[..., ProtocolClient]
) -> None:
    viz = opened("")
    client = protocol(viz.viser.get_port())
    client.settle(viz.viser)
    viz.player.pause()
    viz.player.jump(1.2)
    assert client.row("time/mode")["options"] == ["Off", "Exact", "Approximate"]
    client.edit("time/mode", "Exact")
    eventually(lambda: drawn(viz) == 0.5)
    eventually(lambda: client.row("time/source")["value"] == "Laser")
    eventually(lambda: client.row("time/behind")["value"] == pytest.approx(0.7))


def test_the_delay_is_smoothed_as_rviz_does_it() -> None:
    history, now = FrameHistory(), [10 * SECOND]
    time = DisplayTime(history, lambda: now[0])
    time.synchronize(SyncMode.APPROXIMATE, "a")
    time.told("a", 9 * SECOND)
    behind: list[float] = []
    for _ in range(3):
        time.step()
        behind.append(time.behind_s)
    assert behind == pytest.approx([0.3, 0.51, 0.657])
    # A message of the future is of another clock: RViz begins again.
    time.told("a", 11 * SECOND)
    time.step()
    assert history.shown_at is None


def test_a_time_before_all_that_is_known_is_the_first_that_is() -> None:
    history = FrameHistory()
    pose = [[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]]
    for second in (5, 6):
        history.add(second * SECOND, (("odom", "base"),), np.array(pose) * 1.0)
    history.shown_at = SECOND
    shown = history.shown("base")
    assert shown is not None and shown.stamp == 5 * SECOND
    assert history.shown("odom") is None
