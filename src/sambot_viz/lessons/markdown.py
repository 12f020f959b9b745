"""The Markdown of lessons, as blocks that a page shows without any HTML."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

BlockKind = Literal["heading", "paragraph", "list", "numbers", "code", "picture"]
SpanStyle = Literal["", "strong", "em", "code", "link"]

_FENCE = re.compile(r"```\s*([\w+-]*)\s*")
_HEADING = re.compile(r"(#{1,4}) +(.+)")
_ITEM = re.compile(r"(?:([-*])|\d{1,3}[.)]) +(.+)")
_PICTURE = re.compile(r"!\[([^\]]*)\]\(([^()\s]+)\)")
_HTML = re.compile(r"<(?:!--|/?[A-Za-z][^>]*>)")
_SPAN = re.compile(
    r"`(?P<code>[^`]+)`|\*\*(?P<strong>[^*]+)\*\*|\*(?P<em>[^*\s][^*]*)\*"
    r"|(?<!!)\[(?P<link>[^\]]+)\]\((?P<href>[^()\s]+)\)"
)
_CODE = re.compile(r"`[^`]*`")
_PICTURES = (".png", ".jpg", ".jpeg", ".gif", ".webp", ".svg")


@dataclass(frozen=True, slots=True)
class TextSpan:
    """A piece of a line; `href` is the address of a link."""

    text: str
    style: SpanStyle = ""
    href: str = ""


@dataclass(frozen=True, slots=True)
class TextBlock:
    """A block of a text.

    Attributes:
        kind: kind of the block.
        lines: spans of a heading or a paragraph, or of each item of a list.
        text: code, unchanged; alternative text of a picture.
        word: language of code, file of a picture, level of a heading.
    """

    kind: BlockKind
    lines: tuple[tuple[TextSpan, ...], ...] = ()
    text: str = ""
    word: str = ""

    def as_json(self) -> dict[str, object]:
        """Return the fields of a block in JSON."""
        rows = [[[s.text, s.style, s.href] for s in line] for line in self.lines]
        return {
            "kind": self.kind,
            "lines": rows,
            "text": self.text,
            "word": self.word,
        }


def blocks(text: str) -> list[TextBlock]:
    """Read headings, paragraphs, lists, code and pictures; all else becomes text."""
    found: list[TextBlock] = []
    lines = text.splitlines()
    at = 0
    while at < len(lines):
        block, at = _block(lines, at)
        if block is not None:
            found.append(block)
    return found


def _block(lines: Sequence[str], at: int) -> tuple[TextBlock | None, int]:
    """Return the block that starts on a line, and the number of the next line."""
    line = lines[at].strip()
    if not line:
        return None, at + 1
    if fence := _FENCE.fullmatch(line):
        end = next(
            (n for n in range(at + 1, len(lines)) if lines[n].strip() == "```"),
            len(lines),
        )
        code = "\n".join(lines[at + 1 : end])
        return TextBlock("code", text=code, word=fence[1]), end + 1
    if heading := _HEADING.fullmatch(line):
        words = (_spans(heading[2]),)
        return TextBlock("heading", words, word=str(len(heading[1]))), at + 1
    if picture := _PICTURE.fullmatch(line):
        return TextBlock("picture", text=picture[1], word=picture[2]), at + 1
    if item := _ITEM.fullmatch(line):
        return _list(lines, at, "list" if item[1] else "numbers")
    end = at + 1
    while end < len(lines) and not _begins(lines[end]):
        end += 1
    words = " ".join(each.strip() for each in lines[at:end])
    return TextBlock("paragraph", (_spans(words),)), end


def _begins(line: str) -> bool:
    """Return whether a line starts another block, or is empty."""
    bare = line.strip()
    kinds = (_FENCE, _HEADING, _PICTURE, _ITEM)
    return not bare or any(kind.fullmatch(bare) for kind in kinds)


def _list(
    lines: Sequence[str], at: int, kind: BlockKind
) -> tuple[TextBlock | None, int]:
    items: list[str] = []
    while at < len(lines) and lines[at].strip():
        line = lines[at]
        item = _ITEM.fullmatch(line.strip())
        if item is not None and ("list" if item[1] else "numbers") == kind:
            items.append(item[2])
        elif item is None and line[:1].isspace():
            items[-1] += f" {line.strip()}"
        else:
            break
        at += 1
    return TextBlock(kind, tuple(map(_spans, items))), at


def _spans(words: str) -> tuple[TextSpan, ...]:
    found: list[TextSpan] = []
    end = 0
    for one in _SPAN.finditer(words):
        if one.start() > end:
            found.append(TextSpan(words[end : one.start()]))
        style = one.lastgroup if one.lastgroup != "href" else "link"
        for known in ("strong", "em", "code", "link"):
            if style == known:
                found.append(TextSpan(one[known], known, one["href"] or ""))
        end = one.end()
    return (*found, TextSpan(words[end:])) if end < len(words) else tuple(found)


def pictures(text: str) -> list[str]:
    """Return the picture files in a text."""
    return [block.word for block in blocks(text) if block.kind == "picture"]


def faults(text: str) -> Iterator[tuple[int, str, str]]:
    """Yield parts that lessons do not support: HTML, and addresses outside the web.

    Returns:
        Line from 0, the fault, and the remedy.
    """
    in_code = False
    for number, line in enumerate(text.splitlines()):
        if _FENCE.fullmatch(line.strip()) and (not in_code or line.strip() == "```"):
            in_code = not in_code
            continue
        if in_code:
            continue
        bare = _CODE.sub("", line)
        if html := _HTML.search(bare):
            hint = f"write code in backticks: `{html[0]}`"
            yield number, f"a text has no HTML, and this one has {html[0]}", hint
        for span in _SPAN.finditer(line):
            href = span["href"]
            if href and not href.startswith(("https://", "http://")):
                hint = "write an address that begins with https://"
                yield number, f"the link to {href} leads nowhere", hint
        for picture in _PICTURE.finditer(bare):
            name = picture[2]
            if not name.lower().endswith(_PICTURES) or ".." in name or name[0] == "/":
                hint = f"name a file of the lesson's folder, of {' '.join(_PICTURES)}"
                yield number, f"the picture {name} cannot be shown", hint
    if in_code:
        yield len(text.splitlines()) - 1, "code begins and does not end", "add ```"
