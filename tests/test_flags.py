"""The rules for the secret of a link."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.errors import UsageError
from sambot_viz.flags import check_token, new_token
from sambot_viz.options import Options


def test_a_token_without_a_value_is_made_and_never_the_same() -> None:
    one, other = Options(token=""), Options(token="")
    assert one.token and other.token
    assert len(one.token) >= 22
    assert one.token != other.token
    assert check_token(new_token())


@pytest.mark.parametrize(
    ("token", "reason"),
    [
        ("short", "at least 8 characters"),
        ("with space", "letters, digits"),
        ("übermäßig", "letters, digits"),
        ("a&b=c#defgh", "letters, digits"),
    ],
)
def test_a_token_that_is_refused_says_why(token: str, reason: str) -> None:
    with pytest.raises(UsageError, match=reason):
        Options(token=token)


def test_a_model_after_the_flag_is_not_a_token(tmp_path: Path) -> None:
    model = tmp_path / "robot.urdf"
    model.write_text("<robot name='r'/>", "utf-8")
    with pytest.raises(UsageError, match="write the model before --token"):
        check_token(str(model))
