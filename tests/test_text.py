"""The gate for strings from files."""

from __future__ import annotations

import pytest

from sambot_viz.text import html_text, text


def test_a_lone_surrogate_becomes_valid_text() -> None:
    assert text("wheel\udcff").encode("utf-8")


def test_control_characters_and_line_breaks_are_taken_out() -> None:
    assert text("a\nb\tc") == "a b c"
    assert "\x00" not in text("a\x00b") and "\u202e" not in text("a\u202eb")


@pytest.mark.parametrize(
    "mark", ["\u061c", "\u200b", "\u200f", "\u2066", "\u2067", "\u2068", "\u2069"]
)
def test_direction_marks_and_characters_of_no_width_are_made_visible(
    mark: str,
) -> None:
    assert text(f"a{mark}b") == "a\N{REPLACEMENT CHARACTER}b"


@pytest.mark.parametrize("end", ["\n", "\r\n", "\x85", "\u2028", "\u2029"])
def test_every_kind_of_line_break_becomes_a_blank(end: str) -> None:
    assert text(f"a{end}b") == "a b"


def test_joiners_that_scripts_need_pass() -> None:
    assert text("می\u200cخواهم") == "می\u200cخواهم"


def test_korean_letters_pass() -> None:
    assert text("바퀴_link") == "바퀴_link"


def test_a_long_text_is_cut() -> None:
    assert len(text("x" * 1000, 50)) == 50


def test_a_text_as_long_as_allowed_is_not_cut() -> None:
    assert text("x" * 50, 50) == "x" * 50


def test_what_is_not_a_string_is_written_out() -> None:
    assert text(None) == "None" and text(3) == "3"


def test_markup_is_escaped_for_html() -> None:
    assert html_text("<img src=\"x\" onerror='y'>&") == (
        "&lt;img src=&quot;x&quot; onerror=&#x27;y&#x27;&gt;&amp;"
    )
