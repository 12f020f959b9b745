"""What one edit makes the panels do while all of them are open: counted as work."""

from __future__ import annotations

import functools
import os
import sys
import threading
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import pytest
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Row
from sambot_viz.panels.window import Window
from sambot_viz.session import Session
from sambot_viz.session.worker import Worker

JOINT, OTHER = "drivewhl_l_joint", "drivewhl_r_joint"
STEPS = 4


def all_panels(kind: type[Panel] = Panel) -> Iterator[type[Panel]]:
    """The classes of all panels."""
    for one in kind.__subclasses__():
        yield one
        yield from all_panels(one)


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """How often each panel has made its rows, or its data where it has no rows."""
    counts: Counter[str] = Counter()

    def counting(make: Callable[[Panel], Sequence[Any]]) -> Callable[[Panel], Any]:
        @functools.wraps(make)
        def counted(panel: Panel) -> Sequence[Any]:
            counts[panel.name] += 1
            return make(panel)

        return counted

    for kind in all_panels():
        what = "rows" if "rows" in vars(kind) else "data"
        if what in vars(kind):
            monkeypatch.setattr(kind, what, counting(vars(kind)[what]))
    return counts


class Disk:
    """Counts what the threads of sessions ask of the file system."""

    def __init__(self) -> None:
        self.asked: list[str] = []
        self.counts = False

    def note(self, what: str) -> None:
        if self.counts and isinstance(threading.current_thread(), Worker):
            self.asked.append(what)


@pytest.fixture
def disk(monkeypatch: pytest.MonkeyPatch) -> Iterator[Disk]:
    disk = Disk()

    def hook(event: str, arguments: tuple[Any, ...]) -> None:
        if event == "open" or event.startswith("os."):
            disk.note(event)

    # It cannot be taken away again, and counts nothing after this test.
    sys.addaudithook(hook)

    def noting(name: str, call: Callable[..., Any]) -> Callable[..., Any]:
        def noted(*arguments: Any, **more: Any) -> Any:
            disk.note(name)
            return call(*arguments, **more)

        return noted

    # Nothing is audited of these.
    for name in ("stat", "lstat", "access", "readlink"):
        monkeypatch.setattr(os, name, noting(name, getattr(os, name)))
    yield disk
    disk.counts = False


def open_all(client: ProtocolClient, viz: Visualizer) -> None:
    """Open every panel, unfold all rows, and select a link."""
    client.settle(viz.viser)
    client.act("frames/show", True)
    client.act("permalink/open", ["select", "v"], ["link:base_link", "1"])
    done: set[str] = set()
    while lazy := {i for i, row in client.rows.items() if row.get("lazy")} - done:
        for row_id in lazy:
            client.act(f"{client.rows[row_id]['panel']}/unfold", row_id)
        done |= lazy
        client.settle(viz.viser)


@pytest.fixture
def viz() -> Iterator[Visualizer]:
    with Visualizer(port=0, watch=False) as viz:
        yield viz


@pytest.fixture
def clients(
    viz: Visualizer, protocol: Callable[..., ProtocolClient]
) -> list[ProtocolClient]:
    clients = [protocol(viz.viser.get_port()) for _ in range(3)]
    for client in clients:
        open_all(client, viz)
    assert any(row["id"].startswith("selected/") for row in clients[0].rows.values())
    return clients


def drag(client: ProtocolClient, viz: Visualizer, *row: str) -> None:
    """A few steps of one gesture, each shown before the next."""
    first: float = client.shown(*row)
    for step in range(1, STEPS + 1):
        wanted = first + step / 64
        client.edit(client.id_of(*row), wanted, gesture=1)
        client.wait_until(lambda wanted=wanted: client.shown(*row) == wanted)
    client.settle(viz.viser)


def test_a_step_makes_no_rows_again_and_asks_no_disk(
    viz: Visualizer, clients: list[ProtocolClient], made: Counter[str], disk: Disk
) -> None:
    drag(clients[0], viz, "joints", JOINT)
    made.clear()
    disk.counts = True
    drag(clients[0], viz, "joints", JOINT)
    assert set(made) <= {"edit"} and made["edit"] <= len(clients)
    assert disk.asked == []


@pytest.fixture
def converted(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """How often each row was made ready for the pages, by its name."""
    counts: Counter[str] = Counter()
    json = Row.json

    def counted(row: Row) -> dict[str, Any]:
        counts[row.name] += 1
        return json(row)

    monkeypatch.setattr(Row, "json", counted)
    return counts


def test_a_number_of_a_display_makes_only_its_row_again(
    viz: Visualizer,
    clients: list[ProtocolClient],
    made: Counter[str],
    converted: Counter[str],
    disk: Disk,
) -> None:
    drag(clients[0], viz, "displays", "Grid", "Cell Size")
    made.clear()
    converted.clear()
    disk.counts = True
    drag(clients[0], viz, "displays", "Grid", "Cell Size")
    assert set(made) <= {"edit"} and made["edit"] <= len(clients)
    # Once for all clients, however many there are.
    assert set(converted) == {"Cell Size"}
    assert converted["Cell Size"] <= STEPS + 1
    clients[0].act("edit/undo")
    clients[0].settle(viz.viser)
    assert set(converted) == {"Cell Size"} and "displays" not in made
    assert disk.asked == []


def rows_of_displays(client: ProtocolClient) -> dict[str, Any]:
    rows = client.rows.items()
    return {i: dict(row) for i, row in rows if row["panel"] == "displays"}


@pytest.mark.parametrize(
    "path, value",
    [
        (("Grid", "Cell Size"), 0.25),
        (("Grid", "Color"), [1, 2, 3]),
        # Too many lines: the status gets a row, and loses it again.
        (("Grid", "Plane Cell Count"), 1_000_000),
        (("RobotModel", "Alpha"), 0.5),
        (("TF", "Marker Scale"), 2.0),
        (("RobotModel", "Links", "=base_link", "Alpha"), 0.5),
    ],
)
def test_rows_that_are_made_alone_are_as_when_all_are_made(
    viz: Visualizer, clients: list[ProtocolClient], path: tuple[str, ...], value: Any
) -> None:
    client, session = clients[0], viz.server.sessions.all()[0]
    first = rows_of_displays(client)

    def made_alone() -> dict[str, Any]:
        client.settle(viz.viser)
        alone = rows_of_displays(client)
        with session.lock:
            session.document.displays.touch()
        client.settle(viz.viser)
        assert rows_of_displays(client) == alone
        return alone

    display, *below = path
    client.edit("/".join([client.id_of("displays", display), *below]), value)
    assert made_alone() != first
    client.act("edit/undo")
    assert made_alone() == first
    client.act("edit/redo")
    assert made_alone() != first


@pytest.mark.parametrize("path", [("Grid",), ("RobotModel", "Visual Enabled")])
def test_a_box_of_a_display_asks_no_disk(
    viz: Visualizer, clients: list[ProtocolClient], disk: Disk, path: tuple[str, ...]
) -> None:
    row = clients[0].id_of("displays", *path)
    disk.counts = True
    for wanted in (False, True):
        clients[0].edit(row, wanted)
        clients[0].wait_until(lambda on=wanted: clients[0].rows[row]["value"] == on)
    clients[0].act("edit/undo")
    clients[0].settle(viz.viser)
    assert disk.asked == []


def test_numbers_that_come_faster_than_they_are_handled_are_one_edit(
    viz: Visualizer,
    session: Session,
    protocol: Callable[..., ProtocolClient],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    client = protocol(viz.viser.get_port())
    client.settle(viz.viser)
    counts = Counter[str]()

    def counting(name: str) -> Callable[..., None]:
        method = vars(Window)[name]

        def counted(window: Window, *given: Any) -> None:
            counts[name] += 1
            method(window, *given)

        return counted

    for name in ("receive", "_take"):
        monkeypatch.setattr(Window, name, counting(name))
    rows = [client.id_of("joints", name) for name in (JOINT, OTHER)]
    with session.lock:
        for step in range(1, 11):
            for row in rows:
                client.edit(row, step / 10)
        client.wait_until(lambda: counts["receive"] == 20)
    client.settle(viz.viser)
    # The first one has been taken out already, and waited for the lock.
    assert counts["_take"] <= 3
    assert dict(viz.joint_positions) == {JOINT: 1.0, OTHER: 1.0}
