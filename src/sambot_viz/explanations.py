"""What each code of a problem means: the sections of docs/problems.md.

The same file is in the repository, in the wheel and on the site, so that a page without
internet and a terminal show what the documentation says.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from html import escape, unescape

from sambot_viz import bundled
from sambot_viz.errors import UsageError, did_you_mean
from sambot_viz.lessons.html_text import block_html
from sambot_viz.lessons.markdown import TextBlock, TextSpan, blocks

_ESCAPED = re.compile(r"\\([*|\[\]])")
_QUOTE = "> "
_PAGE = """\
<!doctype html><html lang="en"><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>
:root {{ color-scheme: light dark }}
body {{ font: 16px/1.5 sans-serif; max-width: 44em; margin: 0 auto; padding: 1em }}
h1, p, blockquote, a {{ overflow-wrap: anywhere }}
h1 {{ font-size: 1.4em }}
pre {{ overflow-x: auto; padding: .6em; border: 1px solid #8888; border-radius: 4px }}
blockquote {{ margin: 0; padding-left: .8em; border-left: 3px solid #8888 }}
li {{ padding: .3em 0 }}
</style>
<h1>{title}</h1>
{body}
</html>
"""


def codes() -> list[str]:
    """List the codes that have a section, in the order of the page."""
    return list(_sections())


def as_text(code: str) -> str:
    """Return the section of a code for a terminal.

    Raises:
        UsageError: no section has this code; the message has the nearest one.
    """
    parts = (_text_of(block) for block in _section(code))
    return "\n\n".join([code, *parts])


def as_html(code: str) -> str:
    """Return the section of a code as a page.

    Raises:
        UsageError: as for `as_text`.
    """
    parts = [_html_of(block) for block in _section(code)]
    parts.append('<p><a href="./">All codes</a></p>')
    return _PAGE.format(title=escape(code), body="".join(parts))


def index_html() -> str:
    """Return a page with a link to each code."""
    names = map(escape, sorted(codes()))
    items = (f'<li><a href="{name}">{name}</a></li>' for name in names)
    return _PAGE.format(title="All codes", body=f"<ul>\n{''.join(items)}</ul>")


def _section(code: str) -> list[TextBlock]:
    known = _sections()
    if code not in known:
        raise UsageError(f"no code '{code}'; {did_you_mean(code, known)}")
    return known[code]


@cache
def _sections() -> Mapping[str, list[TextBlock]]:
    """Return the blocks below each heading that is a code."""
    found: dict[str, list[TextBlock]] = {}
    below: list[TextBlock] | None = None
    for block in blocks(bundled.problems_page().read_text("utf-8")):
        if block.kind == "heading":
            name = "".join(_plain(span) for span in block.lines[0])
            below = found.setdefault(name, []) if block.word == "3" else None
        elif below is not None:
            below.append(block)
    return found


def _plain(span: TextSpan) -> str:
    """Return the text of a span without the escapes of Markdown, which code has not."""
    if span.style == "code":
        return span.text
    return unescape(_ESCAPED.sub(r"\1", span.text))


def _text_of(block: TextBlock) -> str:
    if block.kind == "code":
        return "\n".join(f"    {line}" for line in block.text.splitlines())
    return "\n".join("".join(map(_plain, line)) for line in block.lines)


def _html_of(block: TextBlock) -> str:
    """Return a block as HTML; links lead to pages that are not here."""
    lines = [[*map(_shown, line)] for line in block.lines]
    is_quote = bool(lines) and lines[0][0].text.startswith(_QUOTE)
    if is_quote:
        lines[0][0] = TextSpan(lines[0][0].text.removeprefix(_QUOTE))
    shown = replace(block, lines=tuple(map(tuple, lines)))
    return block_html(shown, "blockquote" if is_quote else "p")


def _shown(span: TextSpan) -> TextSpan:
    return TextSpan(_plain(span), "" if span.style == "link" else span.style)
