"""The blocks of a text as HTML; all that comes from a file is escaped."""

from __future__ import annotations

from html import escape

from sambot_viz.lessons.markdown import TextBlock, TextSpan

_LISTS = {"list": "ul", "numbers": "ol"}


def block_html(block: TextBlock, paragraph: str = "p", pictures: str = "") -> str:
    """Return a block as an element.

    Args:
        block: the block.
        paragraph: name of the element for a paragraph.
        pictures: folder of the pictures, relative to the page.
    """
    if block.kind == "code":
        return f"<pre><code>{escape(block.text)}</code></pre>\n"
    if block.kind == "picture":
        source = escape(f"{pictures}/{block.word}")
        return f'<p><img src="{source}" alt="{escape(block.text)}"></p>\n'
    lines = ["".join(map(_span, line)) for line in block.lines]
    if block.kind in _LISTS:
        items = "".join(f"<li>{line}</li>" for line in lines)
        return f"<{_LISTS[block.kind]}>{items}</{_LISTS[block.kind]}>\n"
    tag = "h3" if block.kind == "heading" else paragraph
    return f"<{tag}>{'<br>'.join(lines)}</{tag}>\n"


def _span(span: TextSpan) -> str:
    words = escape(span.text)
    if span.style == "link":
        return f'<a href="{escape(span.href)}" rel="noopener noreferrer">{words}</a>'
    return f"<{span.style}>{words}</{span.style}>" if span.style else words
