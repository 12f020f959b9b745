"""What one step of a slider makes the panels do: counted as work, not as messages."""

from __future__ import annotations

import functools
from collections import Counter
from collections.abc import Callable, Sequence

import pytest
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row import Row
from sambot_viz.session.config_file import ConfigFile

JOINT = "drivewhl_l_joint"
STEPS = 5


def all_panels(kind: type[Panel] = Panel) -> list[type[Panel]]:
    """The classes of all panels."""
    return [
        kind,
        *(found for one in kind.__subclasses__() for found in all_panels(one)),
    ]


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """How often each panel has made its rows."""
    counts: Counter[str] = Counter()

    def counting(make: Callable[[Panel], Sequence[Row]]):
        @functools.wraps(make)
        def rows(panel: Panel) -> Sequence[Row]:
            counts[panel.name] += 1
            return make(panel)

        return rows

    for kind in all_panels():
        if "rows" in vars(kind):
            monkeypatch.setattr(kind, "rows", counting(vars(kind)["rows"]))
    return counts


def drag(client: ProtocolClient, viz: Visualizer) -> None:
    """A few steps, one gesture each, every one shown before the next."""
    row = client.id_of("joints", JOINT)
    for step in range(1, STEPS + 1):
        client.edit(row, step / 100, gesture=step)
        client.wait_until(lambda at=step: client.shown("joints", JOINT) == at / 100)
    client.settle(viz.viser)


def test_a_step_makes_rows_again_only_of_undo(
    made: Counter[str], protocol: Callable[..., ProtocolClient]
):
    with Visualizer(port=0) as viz:
        clients = [protocol(viz.viser.get_port()) for _ in range(3)]
        for client in clients:
            client.settle(viz.viser)
        drag(clients[0], viz)
        made.clear()
        drag(clients[0], viz)
    assert set(made) <= {"edit"}
    # The undo list of the client that dragged, and of the others.
    assert made["edit"] <= len(clients) * (STEPS + 1)


def test_a_step_does_not_ask_the_disk(
    protocol: Callable[..., ProtocolClient], monkeypatch: pytest.MonkeyPatch
):
    asked: list[str] = []
    look_up = ConfigFile.folder.fget
    assert look_up is not None

    def folder(file: ConfigFile):
        asked.append(file.name)
        return look_up(file)

    monkeypatch.setattr(ConfigFile, "folder", property(folder))
    with Visualizer(port=0) as viz:
        client = protocol(viz.viser.get_port())
        client.settle(viz.viser)
        drag(client, viz)
        assert asked, "the File menu has not said where the config is"
        asked.clear()
        drag(client, viz)
    assert asked == []
