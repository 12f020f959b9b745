"""The Topics panel of one browser: what each topic has, and why it shows nothing."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

from sambot_viz import limits
from sambot_viz.errors import Severity
from sambot_viz.panels.command import FLAG, TEXT, command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Data, Json, Level, Row
from sambot_viz.session.data.session_sources import SessionSources
from sambot_viz.session.data.source_topics import SourceTopics
from sambot_viz.session.signals import Signal
from sambot_viz.text import capitalized
from sambot_viz.topics import reasons
from sambot_viz.topics.account import Account

AGES = 50
"""Number of topics whose age is looked up at a time."""
_LEVELS: dict[Severity, Level] = {"error": "error", "warning": "warn", "info": "info"}


class TopicsPanel(Panel):
    """The topics that match a search, and their accounts.

    Nothing is read before the panel is opened, and no age is computed while it is not
    on the screen.

    Args:
        sources: the sources of the topics.
        statuses: emitted when the statuses of displays change.
        remake: called when other topics are shown.
    """

    name = "topics"
    period = 1.0

    def __init__(
        self,
        sources: SessionSources,
        statuses: Signal[Any],
        remake: Callable[[Panel], None],
    ) -> None:
        self._sources = sources
        self._statuses = statuses
        self._remake = remake
        self._shown = False
        self._words = ""
        self._chosen = ""
        self._names: list[str] = []
        self._next = 0
        # What stands beside the names, and their numbers, until it is their turn again.
        self._beside: dict[str, str] = {}
        self._counts: dict[str, str] = {}
        self._rows: Sequence[Row] = (
            Row("topics/wait", "", "note", value="Looking at the messages …"),
        )
        self._topics = self._of_now()
        self.refresh()

    def _of_now(self) -> SourceTopics:
        data = self._sources.data
        assert data is not None, "a session without sources has no topics"
        return data.topics

    def refresh(self) -> None:
        """Show the topics of the sources that there are by now."""
        topics = self._of_now()
        self.remade_by = (self._sources.replaced, *topics.remade_by, self._statuses)
        if topics is self._topics:
            return
        self._topics, self._names = topics, []
        self._beside.clear()
        self._counts.clear()
        if self._shown:
            topics.follow(self, [], self._chosen)

    @property
    def moved_by(self) -> Sequence[Signal[Any]]:
        """The time, while the panel is on the screen."""
        return self._topics.moved_by if self._shown else ()

    def rows(self) -> Sequence[Row]:
        """Return a row for each topic, with its account below it."""
        if self._shown and self._topics.is_complete:
            self._rows = list(self._made())
        return self._rows

    def data(self) -> Sequence[Data]:
        """Return whether the panel is known to be on the screen."""
        return [Data("topics/shown", self._shown)]

    def values(self) -> dict[str, Json]:
        """Return what some topics show beside their names; the others have their turn.

        The ages come from an index, or from when messages came: nothing is decoded.
        """
        if not self._shown or not self._names:
            return {}
        first, self._next = self._next, (self._next + AGES) % len(self._names)
        names = (self._names * 2)[first : first + min(AGES, len(self._names))]
        self._measure(names)
        counts: dict[str, Json] = {_count_id(n): self._counts[n] for n in names}
        return counts | {_row_id(name): self._beside[name] for name in names}

    def close(self) -> None:
        """Look at nothing more."""
        self._topics.follow(self, None)

    def _measure(self, names: Iterable[str]) -> None:
        for name in names:
            self._beside[name] = self._rate_and_age(name)
            count = self._topics.count(name)
            self._counts[name] = "not known yet" if count is None else f"{count:,}"

    def _made(self) -> Iterator[Row]:
        words = self._words.lower().split()
        found = [
            name
            for name in self._topics.names
            if all(word in name.lower() for word in words)
        ]
        if self._names != found[: limits.TOPIC_ROWS.value]:
            self._names, self._next = found[: limits.TOPIC_ROWS.value], 0
            self._beside.clear()
            self._counts.clear()
            self._topics.follow(self, self._names, self._chosen)
            self._measure(self._names[:AGES])
        for name in self._names:
            yield from self._rows_of(name)
        if len(found) > limits.TOPIC_ROWS.value:
            more = f"{len(found) - limits.TOPIC_ROWS.value:,} more: use the search"
            yield Row("topics/more", "", "note", value=more)
        elif not found:
            none = "No name has this in it" if words else self._topics.nothing
            yield Row("topics/none", "", "note", value=none)

    def _rows_of(self, name: str) -> Iterator[Row]:
        row_id = _row_id(name)
        account = self._topics.account(name)
        display = reasons.display_of(name, account.type_name)
        reason = account.reason
        level = None if reason is None else _LEVELS[reason.severity]
        yield Row(
            row_id,
            "",
            "readonly",
            name,
            value=self._beside.get(name, ""),
            level=level or "ok",
            expanded=level == "warn",
            extra={"display": display} if display else None,
        )
        if reason is not None:
            text = f"{capitalized(reason.text)}."
            yield Row(f"{row_id}/reason", row_id, "note", value=text, level=level)
        yield from self._facts(account)

    def _facts(self, account: Account) -> Iterator[Row]:
        """Yield the type and the number of the messages, and what else is known."""
        name, row_id = account.name, _row_id(account.name)
        kind = account.type_name or "not known"
        yield Row(f"{row_id}/type", row_id, "readonly", "Type", value=kind)
        count = self._counts.get(name, "not known yet")
        yield Row(_count_id(name), row_id, "readonly", "Messages", value=count)
        for label, words in self._topics.facts(name).items():
            fact_id = f"{row_id}/{label.lower()}"
            yield Row(fact_id, row_id, "readonly", label, value=words)

    def _rate_and_age(self, name: str) -> str:
        rate, age = self._topics.rate(name), self._topics.age(name)
        parts = [] if rate is None else [f"{rate:.3g} Hz"]
        if age is not None:
            parts.append(f"{age:.1f} s ago")
        return ", ".join(parts)

    # What the page asks for

    @command("topics/show", FLAG, client_local=True)
    def _show(self, shown: bool) -> None:
        """Follow the time, or do not: the panel is on the screen, or is not."""
        if self._shown != shown:
            self._shown = shown
            self._topics.follow(self, self._names if shown else None, self._chosen)
            self._remake(self)

    @command("topics/find", TEXT, client_local=True)
    def _find(self, words: str) -> None:
        """Show the topics with all these words in their names."""
        self._words = words
        self._remake(self)

    @command("topics/choose", TEXT, client_local=True)
    def _choose(self, name: str) -> None:
        """Listen to one topic though its messages are large; "" for none."""
        if self._chosen != name:
            self._chosen = name
            if self._shown:
                self._topics.follow(self, self._names, name)
                self._remake(self)


def _row_id(name: str) -> str:
    return f"topic:{name}"


def _count_id(name: str) -> str:
    return f"topic:{name}/count"
