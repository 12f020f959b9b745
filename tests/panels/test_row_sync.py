"""What is sent to the page: all rows once, then what changes."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from typing import Any, cast

import pytest
from page_rows import decode

from sambot_viz.panels import row_sync
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row_sync import RowSync
from sambot_viz.panels.rows.row import Row
from sambot_viz.session.signals import Change, Signal
from sambot_viz.session.worker import Worker


@dataclass
class Audience:
    def flush(self) -> None:
        pass

    def atomic(self) -> Any:
        return nullcontext()


class Page:
    """What one page has been sent, when it asks."""

    def __init__(self, sync: RowSync) -> None:
        self._store = sync.store
        self.version = 0

    def ask(self) -> Any:
        self.version, message = self._store.since(self.version)
        return None if message is None else decode(message)


class Numbers(Panel):
    name = "numbers"

    def __init__(self, worker: Worker, count: int) -> None:
        self.moved = Signal(Change(worker, cast(Any, Audience())), None)
        self.numbers = [0] * count

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        return (self.moved,)

    def rows(self) -> Sequence[Row]:
        return [Row(f"n{i}", "", "float", value=n) for i, n in enumerate(self.numbers)]

    def values(self) -> dict[str, Any]:
        return {f"n{i}": n for i, n in enumerate(self.numbers)}


@pytest.fixture
def worker(monkeypatch: pytest.MonkeyPatch) -> Iterator[Worker]:
    """A worker, and rows that follow at once."""
    monkeypatch.setattr(row_sync, "PERIOD", 0.0)
    loop = asyncio.new_event_loop()
    worker = Worker(loop)
    yield worker
    worker.close()
    loop.close()


def move(panel: Numbers, *changed: int) -> None:
    """Change some numbers, and tell of that."""
    for number in changed:
        panel.numbers[number] += 1
    panel.moved.touch()


def test_one_step_is_one_change_of_a_few_bytes(worker: Worker) -> None:
    panel = Numbers(worker, 300)
    made = RowSync(worker, [panel], "session")
    page = Page(made)
    told: list[bool] = []
    made.store.listeners.append(lambda: told.append(True))
    first = page.ask()
    assert first["all"] and len(first["panels"]["numbers"]) == 300
    move(panel, 7)
    assert len(told) == 1
    version, message = made.store.since(page.version)
    assert message == '{"of":"session","rows":{"n7":{"value":1}}}'
    assert made.store.since(version) == (version, None)
    move(panel)
    assert len(told) == 1
    made.close()


def test_a_page_that_is_slow_gets_the_newest_and_no_queue(worker: Worker) -> None:
    panel = Numbers(worker, 300)
    made = RowSync(worker, [panel], "session")
    fast, slow = Page(made), Page(made)
    fast.ask()
    slow.ask()
    for _ in range(50):
        move(panel, 7)
        fast.ask()
    move(panel, 8)
    assert fast.ask() == {"of": "session", "rows": {"n8": {"value": 1}}}
    newest = {"n7": {"value": 50}, "n8": {"value": 1}}
    assert slow.ask() == {"of": "session", "rows": newest}
    late = Page(made).ask()
    assert [row["value"] for row in late["panels"]["numbers"][7:9]] == [50, 1]
    assert "rows" not in late
    made.close()


def test_rows_that_are_as_before_are_not_made_ready_again(
    worker: Worker, monkeypatch: pytest.MonkeyPatch
) -> None:
    panel = Numbers(worker, 3)
    made = RowSync(worker, [panel], "session")
    page, ready, json = Page(made), list[str](), Row.json
    page.ask()

    def counted(row: Row) -> dict[str, Any]:
        ready.append(row.id)
        return json(row)

    monkeypatch.setattr(Row, "json", counted)
    panel.numbers[1] = 4
    made.remake(panel)
    assert page.ask()["rows"] == {"n1": {"value": 4}} and ready == ["n1"]
    # A motion has changed what the page has; the row is as it was made before.
    move(panel, 1)
    assert page.ask()["rows"] == {"n1": {"value": 5}}
    panel.numbers[1] = 4
    made.remake(panel)
    assert page.ask()["rows"] == {"n1": {"value": 4}}
    made.remake(panel)
    assert page.ask() is None and ready == ["n1", "n1"]
    made.close()


def test_a_row_that_can_only_be_read_now_is_shown_so(worker: Worker) -> None:
    panel = Numbers(worker, 0)
    made = RowSync(worker, [panel], "session")
    rows = [Row("a", "", "text", value="x", set=lambda _: None)]
    panel.rows = lambda: rows
    made.remake(panel)
    page = Page(made)
    page.ask()
    rows[0] = Row("a", "", "text", value="x")
    made.remake(panel)
    assert page.ask()["rows"] == {"a": {"fixed": True}}
    made.close()


def test_rows_that_were_replaced_are_sent_whole_and_keys_that_are_gone_as_null(
    worker: Worker,
) -> None:
    panel = Numbers(worker, 2)
    made = RowSync(worker, [panel], "session")
    page, store = Page(made), made.store
    page.ask()
    store.update("n0", {"level": "warn", "value": 3})
    assert page.ask()["rows"] == {"n0": {"level": "warn", "value": 3}}
    store.update("n0", {"level": None})
    assert page.ask()["rows"] == {"n0": {"level": None}}
    panel.numbers.append(5)
    made.remake(panel)
    assert list(page.ask()["panels"]) == ["numbers"]
    store.update("n2", {"value": 6})
    assert page.ask()["rows"] == {"n2": {"value": 6}}
    made.close()


@pytest.mark.parametrize("only_changed", [False, True])
def test_rows_in_the_same_order_below_another_one_are_sent_whole(
    worker: Worker, only_changed: bool
) -> None:
    panel = Numbers(worker, 0)
    rows = [Row("a", "", "group"), Row("b", "", "group")]
    panel.rows = lambda: rows
    panel.changed_by = (panel.moved,)
    made = RowSync(worker, [panel], "session")
    page = Page(made)
    page.ask()
    rows[1] = Row("b", "a", "group")
    if only_changed:
        panel.changed_rows = lambda: [rows[1]]
        panel.moved.touch()
    else:
        made.remake(panel)
    (sent,) = page.ask()["panels"].values()
    assert [(row["id"], row["in"]) for row in sent] == [("a", ""), ("b", "a")]
    made.close()


def test_what_pages_have_to_be_sent_is_packed_once_for_those_that_are_as_far(
    worker: Worker,
) -> None:
    panel = Numbers(worker, 300)
    made = RowSync(worker, [panel], "session")
    _, first = made.store.since(0)
    _, second = made.store.since(0)
    assert first is second and isinstance(first, bytes)
    assert len(first) < 5000
    made.close()


class Slow(Numbers):
    name = "slow"
    period = 120.0

    def rows(self) -> Sequence[Row]:
        return [Row("slow", "", "float", value=0)]

    def values(self) -> dict[str, Any]:
        return {"slow": self.numbers[0]}


def test_a_step_need_not_wait_where_nothing_has_changed_before(
    worker: Worker, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(row_sync, "PERIOD", 60.0)
    panel, slow = Numbers(worker, 1), Slow(worker, 1)
    made = RowSync(worker, [panel, slow], "session")
    page = Page(made)
    page.ask()
    slow.moved.touch()
    move(panel, 0)
    assert page.ask()["rows"] == {"n0": {"value": 1}}
    made.close()


def test_what_a_slow_panel_shows_is_sent(worker: Worker) -> None:
    panel = Slow(worker, 1)
    made = RowSync(worker, [panel], "session")
    page = Page(made)
    page.ask()
    panel.numbers[0] = 5
    panel.moved.touch()
    assert page.ask()["rows"] == {"slow": {"value": 5}}
    made.close()
