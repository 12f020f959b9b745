"""What is sent to the page: all rows once, then what changes."""

from __future__ import annotations

import asyncio
import json
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import pytest

from sambot_viz.panels import publisher
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.publisher import Publisher
from sambot_viz.panels.row import Row
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


class Numbers(Panel):
    name = "numbers"
    moved_by = frozenset({"joints"})

    def __init__(self, count: int) -> None:
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


def move(made: Publisher, panel: Numbers, *changed: int) -> None:
    """Change some numbers, and publish that."""
    for number in changed:
        panel.numbers[number] += 1
    made.hear("joints")


def test_one_step_is_one_change_of_a_few_bytes(worker: Worker) -> None:
    owner, panel = Owner(), Numbers(300)
    made = Publisher(owner, worker, [panel], "session")
    whole, changes = owner.elements
    assert len(whole.data()["panels"]["numbers"]) == 300
    move(made, panel, 7)
    assert changes.data()["rows"] == {"n7": {"value": 1}}
    assert len(changes.content) < 200
    move(made, panel)
    assert len(whole.contents) == 1
    made.close()


def test_after_many_changes_all_rows_are_sent_once_and_a_step_is_small_again(
    worker: Worker, monkeypatch: pytest.MonkeyPatch
) -> None:
    owner, panel = Owner(), Numbers(300)
    made = Publisher(owner, worker, [panel], "session")
    whole, changes = owner.elements
    move(made, panel, *range(300))
    assert len(changes.data()["rows"]) == 300 and len(whole.contents) == 1
    monkeypatch.setattr(publisher, "TIDY_PERIOD", 0.0)
    move(made, panel, 7)
    assert len(whole.contents) == 2
    assert whole.data()["panels"]["numbers"][7]["value"] == 2
    assert changes.data()["base"] == whole.data()["base"]
    move(made, panel, 8)
    assert changes.data()["rows"] == {"n8": {"value": 2}}
    assert len(whole.contents) == 2
    made.close()


class Slow(Numbers):
    name = "slow"
    moved_by = frozenset({"motion"})
    period = 120.0

    def rows(self) -> Sequence[Row]:
        return [Row("slow", "", "float", value=0)]

    def values(self) -> dict[str, Any]:
        return {"slow": self.numbers[0]}


def test_a_step_need_not_wait_where_nothing_has_changed_before(
    worker: Worker, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(publisher, "PERIOD", 60.0)
    owner, panel = Owner(), Numbers(1)
    made = Publisher(owner, worker, [panel, Slow(1)], "session")
    made.hear("motion")
    move(made, panel, 0)
    assert owner.elements[1].data()["rows"] == {"n0": {"value": 1}}
    made.close()


def test_what_a_slow_panel_shows_is_sent(worker: Worker) -> None:
    owner, panel = Owner(), Slow(1)
    made = Publisher(owner, worker, [panel], "session")
    panel.numbers[0] = 5
    made.hear("motion")
    assert owner.elements[1].data()["rows"] == {"slow": {"value": 5}}
    made.close()
