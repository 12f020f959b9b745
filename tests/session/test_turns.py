"""A queue for control: who has it when, by a clock that the test moves."""

from __future__ import annotations

import asyncio
import random
from collections.abc import Iterator
from typing import Any, cast

import pytest
from hand_clock import HandClock
from patience import until

from sambot_viz.errors import UsageError
from sambot_viz.options import Options
from sambot_viz.session.people.roles import Roles
from sambot_viz.session.people.turns import PAUSE, Turns
from sambot_viz.session.signals import Change
from sambot_viz.session.worker import Worker

SLOT = 240.0
PRESENTER, ANN, BEN, EVE = 1, 2, 3, 4


class Lab:
    """A session with turns, of which only people are there."""

    def __init__(self) -> None:
        self.clock, self._loop = HandClock(), asyncio.new_event_loop()
        self.worker = Worker(self._loop, self.clock)
        self.roles = Roles(Change(self.worker, cast(Any, None)), presented=True)
        self.turns = Turns(self.roles, SLOT, self.worker)
        for one in (PRESENTER, ANN, BEN, EVE):
            self.roles.join(one, presenter=one == PRESENTER)

    def close(self) -> None:
        self.worker.close()
        self._loop.close()

    def rest(self) -> None:
        """Wait until all that is due was done."""
        for _ in range(3):
            done: list[bool] = []
            self.worker.post(lambda done=done: done.append(True))
            until(lambda done=done: done)

    def ask(self, *clients: int) -> None:
        for client in clients:
            with self.worker.lock:
                self.roles.request(client)
            self.rest()

    def go_on(self, seconds: float) -> None:
        self.clock.advance(seconds)
        self.rest()

    @property
    def holder(self) -> int | None:
        return self.roles.viewer_in_control()


@pytest.fixture
def lab() -> Iterator[Lab]:
    made = Lab()
    yield made
    made.close()


def test_who_asks_first_has_control_at_once_and_others_wait_in_order(lab: Lab) -> None:
    lab.ask(BEN, EVE, ANN)
    assert lab.holder == BEN and lab.roles.may_edit(PRESENTER)
    assert lab.turns.left == SLOT
    assert lab.turns.waiting() == {EVE: (1, SLOT), ANN: (2, 2 * SLOT)}
    lab.go_on(100.0)
    assert lab.turns.waiting() == {EVE: (1, SLOT - 100), ANN: (2, 2 * SLOT - 100)}
    lab.go_on(SLOT - 100.0)
    assert lab.holder == EVE and not lab.roles.may_edit(BEN)
    assert lab.turns.waiting() == {ANN: (1, SLOT)}


def test_a_turn_lasts_until_someone_waits(lab: Lab) -> None:
    lab.ask(ANN)
    lab.go_on(10 * SLOT)
    assert lab.holder == ANN
    lab.ask(BEN)
    assert lab.holder == BEN
    lab.ask(ANN)
    lab.go_on(SLOT / 2)
    assert lab.holder == BEN
    lab.go_on(SLOT / 2)
    assert lab.holder == ANN


@pytest.mark.parametrize("how", ["leave", "release", "return_control"])
def test_after_a_turn_that_was_cut_short_the_next_begins_after_a_pause(
    how: str, lab: Lab
) -> None:
    lab.ask(ANN, BEN, EVE)
    end = getattr(lab.roles, how)
    with lab.worker.lock:
        # STOP is for everybody, and takes control from all viewers.
        end() if how == "return_control" else end(ANN)
    lab.rest()
    assert lab.holder is None
    lab.go_on(PAUSE)
    assert lab.holder == BEN


def test_who_loads_the_page_again_goes_on(lab: Lab) -> None:
    lab.ask(ANN, BEN)
    key = lab.roles.people[ANN].key
    with lab.worker.lock:
        lab.roles.leave(ANN)
    lab.go_on(PAUSE / 2)
    with lab.worker.lock:
        lab.roles.join(9, presenter=False)
        lab.roles.greet(9, "Ann", key)
    lab.go_on(PAUSE)
    assert lab.holder == 9
    assert lab.roles.queue() == [BEN]


def test_a_presenter_may_give_control_out_of_order(lab: Lab) -> None:
    lab.ask(ANN, BEN, EVE)
    with lab.worker.lock:
        lab.roles.give(PRESENTER, EVE)
    lab.rest()
    assert (lab.holder, lab.turns.left, lab.roles.queue()) == (EVE, SLOT, [BEN])


def test_nobody_ever_shares_control_and_all_who_wait_get_it(lab: Lab) -> None:
    chance = random.Random(5)
    there = {ANN, BEN, EVE}
    for _ in range(60):
        who = chance.choice(sorted(there))
        with lab.worker.lock:
            match chance.randrange(4):
                case 0 | 1:
                    lab.roles.request(who)
                case 2:
                    lab.roles.release(who)
                case _:
                    lab.roles.return_control()
        lab.go_on(chance.choice((0.0, 7.0, SLOT / 3)))
        people = lab.roles.people.values()
        assert sum(p.has_control and not p.presenter for p in people) <= 1
        assert not any(p.has_control and p.requests for p in people)
    for _ in range(4):
        lab.go_on(PAUSE)
        lab.go_on(SLOT)
    assert lab.roles.queue() == []


def test_without_anyone_who_waits_nothing_is_to_be_done_later(lab: Lab) -> None:
    told: list[bool] = []
    lab.ask(ANN)
    lab.roles.changed.listeners.append(lambda: told.append(True))
    for _ in range(20):
        lab.go_on(SLOT)
    assert told == []
    lab.ask(BEN)
    assert told


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"slot": 240.0}, "--slot needs --presenter"),
        ({"slot": 1.0, "presenter": ""}, "a turn lasts from 10s to 1440min"),
        ({"slot": float("nan"), "presenter": ""}, "a turn lasts from"),
    ],
)
def test_a_slot_that_cannot_be_is_refused(options: dict[str, Any], said: str) -> None:
    with pytest.raises(UsageError, match=said):
        Options(**options)
