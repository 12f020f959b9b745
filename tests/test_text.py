"""The gate for strings from files."""

from __future__ import annotations

from sambot_viz.text import html_text, text


def test_a_lone_surrogate_becomes_valid_text() -> None:
    assert text("wheel\udcff").encode("utf-8")


def test_control_characters_and_line_breaks_are_taken_out() -> None:
    assert text("a\nb\tc") == "a b c"
    assert "\x00" not in text("a\x00b") and "\u202e" not in text("a\u202eb")


def test_korean_letters_pass() -> None:
    assert text("바퀴_link") == "바퀴_link"


def test_a_long_text_is_cut() -> None:
    assert len(text("x" * 1000, 50)) == 50


def test_what_is_no_text_is_written_out() -> None:
    assert text(None) == "None" and text(3) == "3"


def test_markup_is_escaped_for_html() -> None:
    assert html_text("<img src=\"x\" onerror='y'>&") == (
        "&lt;img src=&quot;x&quot; onerror=&#x27;y&#x27;&gt;&amp;"
    )
