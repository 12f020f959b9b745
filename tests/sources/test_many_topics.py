"""Ten thousand topics of a robot over zenoh: the work for each, counted."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from lower_limit import lower
from work import steps

from sambot_viz.sources.live.address import Address
from sambot_viz.sources.live.assets import AssetStore
from sambot_viz.sources.live.clock import SourceClock
from sambot_viz.sources.live.conversation import Ends
from sambot_viz.sources.registry import live_address
from sambot_viz.sources.zenoh.conversation import ZenohConversation

FEW, MANY = 500, 10_000
TYPE = "std_msgs::msg::dds_::String_"


class Tokens:
    """Stands for a session: a router is slow to tell so many tokens."""

    name, router, is_closed = "own", "router", False

    def declare_token(self, key: str) -> object:
        return key

    def watch(
        self,
        key: str,
        told: Callable[[str, bool], object],
        all_told: Callable[[], object],
    ) -> None:
        self.told, self.all_told = told, all_told

    def tell(self, count: int, is_there: bool = True) -> None:
        head = "@ros2_lv/0/z/0"
        for number in range(count):
            rest = f"%/%/node{number % 50}/%t{number}/{TYPE}/RIHS01_0/::,10:,:,:,,"
            self.told(f"{head}/{number}/MP/{rest}", is_there)
            self.told(f"{head}/{count + number}/MS/{rest}", is_there)


def conversation(tokens: Tokens) -> ZenohConversation:
    address: Address = live_address("zenoh://robot")
    ends = Ends(
        address,
        lambda frame: None,
        lambda message: None,
        SourceClock(),
        AssetStore(),
        lambda action: None,
    )
    made = ZenohConversation(tokens, ends)  # pyright: ignore[reportArgumentType]
    made.begin()
    return made


def test_the_work_for_a_topic_does_not_grow_with_their_number() -> None:
    def work(count: int) -> int:
        tokens = Tokens()
        made = conversation(tokens)

        def come_and_go() -> None:
            tokens.tell(count)
            tokens.all_told()
            assert len(made.topics()) == count
            made.update(frozenset())
            made.tick(0.0)
            tokens.tell(count, is_there=False)
            made.tick(1.0)
            assert not made.topics()

        return steps(come_and_go)

    assert work(MANY) < 1.1 * (MANY / FEW) * work(FEW)


def test_no_more_than_the_limit_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    lower(monkeypatch, "ENDPOINTS", 100)
    tokens = Tokens()
    made = conversation(tokens)
    tokens.tell(MANY)
    assert len(made.topics()) == 50
    tokens.tell(MANY, is_there=False)
    made.tick(0.0)
    assert not made.topics()


def test_a_router_that_is_slow_to_tell_is_not_called_empty() -> None:
    tokens = Tokens()
    made = conversation(tokens)
    for _ in range(10):
        made.tick(0.0)
    assert "has not told yet" in made.sentence()
    tokens.all_told()
    assert "no node is connected" in made.sentence()
    tokens.tell(1)
    assert made.sentence() == "Connected to robot:7447"
