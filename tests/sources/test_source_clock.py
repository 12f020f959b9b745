"""The clock of a robot, told from what it sends."""

from __future__ import annotations

from sambot_viz.sources.live.clock import SourceClock

SECOND = 1_000_000_000
EPOCH = 1_700_000_000 * SECOND


class Wall:
    """The time here."""

    now = EPOCH

    def __call__(self) -> int:
        return self.now


def test_without_anything_known_it_is_the_time_here() -> None:
    clock = SourceClock(Wall())
    assert clock.now_ns() == EPOCH
    assert clock.lag_s() is None


def test_the_time_of_the_server_stands_still_when_it_does() -> None:
    wall = Wall()
    clock = SourceClock(wall)
    clock.note_time(5)
    wall.now += 7 * SECOND
    assert clock.now_ns() == 5
    assert clock.lag_s() is None
    clock.reset()
    assert clock.now_ns() == wall.now


def test_the_fastest_message_shows_how_the_clocks_differ() -> None:
    wall = Wall()
    clock = SourceClock(wall)
    ahead = 60 * SECOND
    for delay in (0.3, 0.1, 0.2):
        wall.now += SECOND
        clock.note_message(wall.now + ahead - int(delay * SECOND))
    assert clock.now_ns() == wall.now + ahead - SECOND // 10
    assert clock.lag_s() == 0.1


def test_messages_that_come_later_and_later_are_a_lag() -> None:
    wall = Wall()
    clock = SourceClock(wall)
    clock.note_message(wall.now)
    for n in range(1, 8):
        wall.now += SECOND
        clock.note_message(wall.now - n * SECOND // 2)
    assert clock.lag_s() == 3.5
    wall.now += 10 * SECOND
    assert clock.lag_s() is None, "nothing came for a while"


def test_a_clock_that_is_set_counts_after_a_while() -> None:
    wall = Wall()
    clock = SourceClock(wall)
    clock.note_message(wall.now + 30 * SECOND)
    for _ in range(30):
        wall.now += SECOND
        clock.note_message(wall.now)
    assert clock.now_ns() == wall.now
    assert clock.lag_s() == 0


def test_a_clock_that_is_set_back_is_no_lag() -> None:
    wall = Wall()
    clock = SourceClock(wall)
    for ahead in (0, 0, -60, -60, -59.5):
        wall.now += SECOND
        clock.note_message(wall.now + int(ahead * SECOND))
        assert clock.lag_s() == 0
    # Later messages that take longer are one again.
    for n in range(1, 5):
        wall.now += SECOND
        clock.note_message(wall.now - 60 * SECOND - n * SECOND // 2)
    assert clock.lag_s() == 2.5


def test_simulated_stamps_are_no_lag() -> None:
    wall = Wall()
    clock = SourceClock(wall)
    clock.note_message(17 * SECOND)
    assert clock.lag_s() is None
    assert clock.now_ns() == wall.now


def test_a_clock_that_is_hours_off_is_told_until_it_is_set() -> None:
    wall = Wall()
    clock = SourceClock(wall)
    clock.note_message(wall.now - 2 * 3600 * SECOND)
    assert clock.apart_s == -7200
    clock.note_message(wall.now + 30 * SECOND)
    assert clock.apart_s is None
    clock.note_message(wall.now + 5000 * SECOND)
    clock.reset()
    assert clock.apart_s is None
