"""What goes wrong for one browser is not noticed by the others, and nothing is lost."""

from __future__ import annotations

import errno
import logging
import os
import random
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from lower_limit import lower
from protocol_client import ProtocolClient
from troublemakers import garbage, garbage_edit

from sambot_viz import Visualizer, bundled, viser_private
from sambot_viz.server.connections import connection

Connect = Callable[..., ProtocolClient]
LEFT = "drivewhl_l_joint"
SLIDER = "joints", LEFT


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    shutil.copy(bundled.config_path(), tmp_path / "mine.rviz")
    return tmp_path


@pytest.fixture
def viz(folder: Path, make_viz: Callable[..., Visualizer]) -> Visualizer:
    poses = folder / "mine.poses.yaml"
    return make_viz(config=folder / "mine.rviz", poses=poses)


@pytest.fixture
def user(viz: Visualizer, protocol: Connect) -> ProtocolClient:
    client = protocol(viz.viser.get_port())
    client.settle(viz.viser)
    return client


def notice(client: ProtocolClient, after: str = "") -> str:
    """What a browser is told, once that is something else."""

    def text() -> str:
        said = client.row("notice").get("value")
        return str(said["text"]) if said else ""

    client.wait_until(lambda: text() not in ("", after))
    return text()


def moves(viz: Visualizer, user: ProtocolClient, witness: ProtocolClient) -> bool:
    """Whether a joint that a user moves is moved for another one too."""
    user.edit(user.id_of(*SLIDER), 0.25)
    for client in (user, witness):
        client.settle(viz.viser)
    return witness.shown(*SLIDER) == viz.joint_positions[LEFT] == 0.25


def test_a_full_disk_keeps_the_old_files_and_what_was_not_saved(
    viz: Visualizer,
    user: ProtocolClient,
    protocol: Connect,
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    witness = protocol(viz.viser.get_port())
    user.act("poses/save", "half")
    said = notice(user)
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    assert set(before) == {"mine.rviz", "mine.poses.yaml"}

    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    user.edit(user.id_of("displays", "Grid", "Plane Cell Count"), 7)
    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full)
        user.act("poses/save", "more")
        said = notice(user, said)
        assert os.strerror(errno.ENOSPC) in said
        user.act("file/save", [])
        assert os.strerror(errno.ENOSPC) in notice(user, said)
        assert moves(viz, user, witness)
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before
    assert user.row("file/state")["value"]["modified"]
    user.act("file/save", [])
    user.wait_until(lambda: not user.row("file/state")["value"]["modified"])
    assert b"Plane Cell Count: 7" in (folder / "mine.rviz").read_bytes()


def test_no_garbage_raises_or_is_noticed_by_the_others(
    viz: Visualizer,
    user: ProtocolClient,
    protocol: Connect,
    caplog: pytest.LogCaptureFixture,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    lower(monkeypatch, "PAGE_MESSAGES", 1_000_000)
    monkeypatch.setattr(connection, "BURST", 1e6)
    chance = random.Random(1)
    bad = protocol(viz.viser.get_port())
    bad.settle(viz.viser)
    caplog.clear()
    with caplog.at_level(logging.WARNING):
        for _ in range(1000):
            bad.send_raw(garbage(chance))
            bad.send_edit(garbage_edit(chance))
        for client in (bad, user):
            client.settle(viz.viser)
        assert moves(viz, user, protocol(viz.viser.get_port()))
    assert len(caplog.records) <= 1
    assert all("dropped" in record.getMessage() for record in caplog.records)
    assert capfd.readouterr() == ("", "")
    assert not bad.closed


def test_browsers_that_come_and_go_leave_nothing_behind(
    viz: Visualizer, user: ProtocolClient, protocol: Connect
) -> None:
    def here() -> tuple[int, int]:
        buffer = viser_private.broadcast_buffer(viz.viser)
        return len(viz.viser.get_clients()), len(buffer.generator_cursors)

    user.wait_until(lambda: here() == (1, 1))
    for number in range(50):
        protocol(viz.viser.get_port(), camera=number % 2 == 0).close()
    user.wait_until(lambda: here() == (1, 1))
    assert moves(viz, user, protocol(viz.viser.get_port()))
