"""A recording is looked through once, from a time back or from its start on."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from lower_limit import lower

from sambot_viz.sources.bag import Recording, open_recording
from sambot_viz.topics import seconds
from sambot_viz.topics.seconds import BLOCK, Seconds


class Looking:
    """Looks at a recording of ten seconds with a message each: what, and how often."""

    def __init__(self, recording: Recording, nearest: int = 0) -> None:
        self.looked: list[int] = []
        self.recording = recording
        self.start = recording.start_ns or 0
        self.seconds = Seconds(recording, self.look, nearest)

    def look(self, begin: int, end: int) -> tuple[int, int]:
        number = (begin - self.start) // BLOCK
        self.looked.append(number)
        return number, sum(1 for _ in self.recording.messages(begin, end))

    def back_from(self, second: float, *, lacks: bool = False) -> list[int]:
        at_ns = self.start + round(second * BLOCK)
        return list(self.seconds.back_from(at_ns, lambda: lacks))


@pytest.fixture
def ten(write_recording: Callable[..., Path]) -> Iterator[Recording]:
    told = [(float(n), {"map": "base"}) for n in range(10)]
    with open_recording(write_recording(told)) as recording:
        yield recording


def test_each_second_is_looked_at_once_whoever_asks(ten: Recording) -> None:
    looking = Looking(ten)
    assert looking.seconds.look_on() and looking.seconds.look_on()
    assert looking.back_from(3.5) == [3, 2, 1, 0]
    assert looking.looked == [0, 1, 3, 2]
    while looking.seconds.look_on():
        pass
    assert sorted(looking.looked) == list(range(10))
    assert looking.back_from(9.0) == list(range(9, -1, -1))
    assert list(looking.seconds.from_start()) == list(range(10))
    assert not looking.seconds.gave_up


def test_it_is_looked_further_back_for_what_is_missing(
    ten: Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(seconds, "FEW", 2)
    assert Looking(ten).back_from(9.0) == [9, 8]
    # Those nearest are looked at in any case.
    assert Looking(ten, nearest=4).back_from(9.0) == [9, 8, 7, 6, 5]
    lower(monkeypatch, "SEARCHED", 6)
    looking = Looking(ten)
    assert looking.back_from(9.0, lacks=True) == [9, 8, 7, 6, 5, 4]
    assert looking.seconds.gave_up
    assert sum(looking.seconds.look_on() for _ in range(20)) < 20
