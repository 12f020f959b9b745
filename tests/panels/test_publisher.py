"""What is sent to the page: all rows once, then what changes."""

from __future__ import annotations

import asyncio
import json
import re
from collections.abc import Iterator, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field
from typing import Any, cast

import pytest

from sambot_viz.panels import publisher
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.publisher import Publisher
from sambot_viz.panels.row import Row
from sambot_viz.session.signals import Change, Signal
from sambot_viz.session.worker import Worker


class Html:
    """Stands for an HTML element of viser."""

    def __init__(self, content: str) -> None:
        self.contents = [content]

    @property
    def content(self) -> str:
        return self.contents[-1]

    @content.setter
    def content(self, content: str) -> None:
        self.contents.append(content)

    def data(self) -> Any:
        found = re.fullmatch(r"<script [^>]*>(.*)</script>", self.content)
        assert found is not None
        return json.loads(found[1])


@dataclass
class Owner:
    elements: list[Html] = field(default_factory=list[Html])

    @property
    def gui(self) -> Any:
        return self

    def add_html(self, content: str) -> Html:
        self.elements.append(Html(content))
        return self.elements[-1]

    def flush(self) -> None:
        pass

    def atomic(self) -> Any:
        return nullcontext()


class Numbers(Panel):
    name = "numbers"

    def __init__(self, worker: Worker, count: int) -> None:
        self.moved = Signal(Change(worker, cast(Any, Owner())), None)
        self.moved_by = (self.moved,)
        self.numbers = [0] * count

    def rows(self) -> Sequence[Row]:
        return [Row(f"n{i}", "", "float", value=n) for i, n in enumerate(self.numbers)]

    def values(self) -> dict[str, Any]:
        return {f"n{i}": n for i, n in enumerate(self.numbers)}


@pytest.fixture
def worker(monkeypatch: pytest.MonkeyPatch) -> Iterator[Worker]:
    """A worker, and publishers that send at once."""
    monkeypatch.setattr(publisher, "PERIOD", 0.0)
    loop = asyncio.new_event_loop()
    worker = Worker(loop)
    yield worker
    worker.close()
    loop.close()


def move(panel: Numbers, *changed: int) -> None:
    """Change some numbers, and publish that."""
    for number in changed:
        panel.numbers[number] += 1
    panel.moved.touch()


def test_one_step_is_one_change_of_a_few_bytes(worker: Worker) -> None:
    owner, panel = Owner(), Numbers(worker, 300)
    made = Publisher(owner, worker, [panel], "session")
    whole, changes = owner.elements
    assert len(whole.data()["panels"]["numbers"]) == 300
    move(panel, 7)
    assert changes.data()["rows"] == {"n7": {"value": 1}}
    assert len(changes.content) < 200
    move(panel)
    assert len(whole.contents) == 1
    made.close()


def test_after_many_changes_all_rows_are_sent_once_and_a_step_is_small_again(
    worker: Worker, monkeypatch: pytest.MonkeyPatch
) -> None:
    owner, panel = Owner(), Numbers(worker, 300)
    made = Publisher(owner, worker, [panel], "session")
    whole, changes = owner.elements
    move(panel, *range(300))
    assert len(changes.data()["rows"]) == 300 and len(whole.contents) == 1
    monkeypatch.setattr(publisher, "TIDY_PERIOD", 0.0)
    move(panel, 7)
    assert len(whole.contents) == 2
    assert whole.data()["panels"]["numbers"][7]["value"] == 2
    assert changes.data()["base"] == whole.data()["base"]
    move(panel, 8)
    assert changes.data()["rows"] == {"n8": {"value": 2}}
    assert len(whole.contents) == 2
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
    monkeypatch.setattr(publisher, "PERIOD", 60.0)
    owner, panel, slow = Owner(), Numbers(worker, 1), Slow(worker, 1)
    made = Publisher(owner, worker, [panel, slow], "session")
    slow.moved.touch()
    move(panel, 0)
    assert owner.elements[1].data()["rows"] == {"n0": {"value": 1}}
    made.close()


def test_what_a_slow_panel_shows_is_sent(worker: Worker) -> None:
    owner, panel = Owner(), Slow(worker, 1)
    made = Publisher(owner, worker, [panel], "session")
    panel.numbers[0] = 5
    panel.moved.touch()
    assert owner.elements[1].data()["rows"] == {"slow": {"value": 5}}
    made.close()
