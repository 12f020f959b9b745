"""Values with listeners: told once, after the change was sent."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, cast

import pytest

from sambot_viz.session.signals import Change, Signal, connect
from sambot_viz.session.worker import Worker


class Log(list[str]):
    """An audience that notes what is sent."""

    @contextmanager
    def atomic(self) -> Iterator[None]:
        yield
        self.append("drawn")

    def flush(self) -> None:
        self.append("sent")


@pytest.fixture
def log() -> Log:
    return Log()


@pytest.fixture
def errors() -> list[Exception]:
    return []


@pytest.fixture
def change(log: Log, errors: list[Exception]) -> Iterator[Change]:
    loop = asyncio.new_event_loop()
    worker = Worker(loop)
    worker.on_error = lambda error, client: errors.append(error)
    yield Change(worker, cast(Any, log))
    worker.close()
    loop.close()


def test_listeners_are_told_after_the_change_was_sent(change: Change, log: Log) -> None:
    signal = Signal(change, 0)
    connect([signal], lambda: log.append(f"told {signal.value}"))
    with change():
        signal.set(1)
        signal.set(2)
        log.append("set")
    assert log == ["set", "drawn", "sent", "told 2"]


def test_a_change_in_a_change_is_sent_and_told_with_the_outer_one(
    change: Change, log: Log
) -> None:
    one, two = Signal(change, None), Signal(change, None)
    connect([one, two], lambda: log.append("told"))
    with change(one):
        with change(two):
            log.append("inner")
        log.append("outer")
    assert log == ["inner", "drawn", "outer", "drawn", "sent", "told"]


def test_the_same_value_is_told_to_nobody(change: Change, log: Log) -> None:
    signal = Signal(change, (1, 2))
    connect([signal], lambda: log.append("told"))
    signal.set((1, 2))
    assert log == []
    signal.touch()
    assert log == ["told"]


def test_senders_come_last_and_once(change: Change, log: Log) -> None:
    one, two = Signal(change, None), Signal(change, None)
    connect([one, two], lambda: log.append("sender"), sends=True)
    connect([one], lambda: log.append("first"))
    connect([two], lambda: log.append("second"))
    with change(one, two):
        pass
    assert log[2:] == ["first", "second", "sender"]


def test_a_listener_that_fails_stops_no_other(
    change: Change, log: Log, errors: list[Exception]
) -> None:
    signal = Signal(change, 0)
    connect([signal], lambda: 1 / 0)
    connect([signal], lambda: log.append("told"))
    signal.set(1)
    assert log == ["told"]
    assert [type(error) for error in errors] == [ZeroDivisionError]


def test_what_a_failed_change_has_set_is_told(change: Change, log: Log) -> None:
    """A part that is set stays set: who shows it has to know."""
    one, two = Signal(change, 0), Signal(change, 0)
    connect([one], lambda: log.append("one"))
    connect([two], lambda: log.append("two"))
    with pytest.raises(ValueError), change(two):
        one.set(1)
        raise ValueError
    assert log == ["sent", "one"]


def test_nobody_is_told_after_disconnecting(change: Change, log: Log) -> None:
    signal = Signal(change, 0)
    connect([signal], lambda: log.append("told"))()
    signal.set(1)
    assert log == []
