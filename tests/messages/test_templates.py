"""Layouts of messages that are kept."""

from __future__ import annotations

from sambot_viz.messages.templates import Templates


def test_frames_that_change_for_ever_fill_no_memory() -> None:
    """Of large messages fewer are kept: those of 1 MB take 9 MB at most."""
    small, large = Templates[int, str](), Templates[int, str]()
    for key in range(1000):
        small.keep(key, "layout", 100)
        large.keep(key, "layout", 1 << 20)
        assert len(small) <= 32
        assert len(large) <= 9
    assert large.of(999) == ("layout",)


def test_the_newest_of_a_key_come_first_and_older_ones_go() -> None:
    kept = Templates[int, int]()
    for number in range(6):
        kept.keep(1, number, 100)
    assert list(kept.of(1)) == [5, 4, 3, 2]
    assert list(kept.of(2)) == []
