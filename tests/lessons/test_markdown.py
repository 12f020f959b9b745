"""The Markdown of lessons becomes blocks."""

from __future__ import annotations

import pytest

from sambot_viz.lessons.markdown import TextBlock, TextSpan, blocks, faults


def test_headings_paragraphs_and_spans() -> None:
    assert blocks("# A *b*\n\none\n`two` **three** [four](https://x.org)\n") == [
        TextBlock("heading", ((TextSpan("A "), TextSpan("b", "em")),), word="1"),
        TextBlock(
            "paragraph",
            (
                (
                    TextSpan("one "),
                    TextSpan("two", "code"),
                    TextSpan(" "),
                    TextSpan("three", "strong"),
                    TextSpan(" "),
                    TextSpan("four", "link", "https://x.org"),
                ),
            ),
        ),
    ]


def test_lists_code_and_pictures() -> None:
    found = blocks("- a\n  b\n- c\n1. d\n\n```xml\n<a>\n\n</a>\n```\n![x](y.png)")
    assert [(one.kind, one.text, one.word) for one in found] == [
        ("list", "", ""),
        ("numbers", "", ""),
        ("code", "<a>\n\n</a>", "xml"),
        ("picture", "x", "y.png"),
    ]
    assert found[0].lines == ((TextSpan("a b"),), (TextSpan("c"),))


def test_what_a_step_says_is_json() -> None:
    (block,) = blocks("a `b`")
    assert block.as_json() == {
        "kind": "paragraph",
        "lines": [[["a ", "", ""], ["b", "code", ""]]],
        "text": "",
        "word": "",
    }


@pytest.mark.parametrize(
    "text",
    ["a < b and c > d", "`<b>`", "```\n<b>\n```", "2 * 3 * 4", "x_y", "1 <2", ""],
)
def test_text_that_is_no_html_is_fine(text: str) -> None:
    assert list(faults(text)) == []
    assert "".join(s.text for b in blocks(text) for line in b.lines for s in line) in (
        text.replace("`", ""),
        "",
    )


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("a\n<script>x</script>", 1),
        ("<!-- a -->", 0),
        ("[a](file:///x)", 0),
        ("```\nx", 1),
    ],
)
def test_what_lessons_do_not_have_is_found_with_its_line(text: str, line: int) -> None:
    assert next(faults(text))[0] == line
