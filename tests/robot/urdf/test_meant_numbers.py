"""Numbers with a letter or a sign too many are written as they were meant."""

from __future__ import annotations

import pytest

from sambot_viz.robot.slips.units import meant_number


@pytest.mark.parametrize(
    ("wrong", "right"),
    [("O.5", "0.5"), ("0.l", "0.1"), ("0..5", "0.5"), ("--2", "-2"), ("1e--3", "1e-3")],
)
def test_a_slip_has_its_number(wrong: str, right: str) -> None:
    assert meant_number(wrong) == right


@pytest.mark.parametrize("text", ["0.5", "abc", "1.2.3", "lll.o.o", ""])
def test_other_texts_have_none(text: str) -> None:
    assert meant_number(text) is None
