"""Content after the end of the root element."""

from __future__ import annotations

from sambot_viz.errors import Problem
from sambot_viz.robot.xml.diagnose.source_text import SourceText
from sambot_viz.robot.xml.diagnose.tokens import Token


def after_root(
    source: SourceText, file: str, root: Token, root_end: Token
) -> Problem | None:
    """Report content after the root element, or return None.

    Args:
        source: the text.
        file: its name, for the place.
        root: the tag that opens the root.
        root_end: the tag that ends it; `root` itself for <robot …/>.
    """
    rest = [tag for tag in source.tags if tag.start >= root_end.end]
    if not rest:
        return _text(source, file, root, root_end)
    token, end = rest[0], source.line(root_end.start)
    line = source.line(token.start)
    if token.name == root.name and not token.closes:
        return source.error(
            file,
            "xml-two-robots",
            token.start,
            f"a second <{root.name}> begins on line {line} after the first was closed "
            f"on line {end}: a file has only one",
            f"move its content into the first <{root.name}>, or into another file",
        )
    if token.closes and len(rest) == 1:
        return source.error(
            file,
            "xml-closing-tag-surplus",
            token.start,
            f"</{token.name}> on line {line} closes nothing: </{root.name}> on line "
            f"{end} has already closed the root element",
            f"delete </{token.name}> on line {line}",
        )
    return _closed_early(source, file, root, root_end, rest)


def _closed_early(
    source: SourceText, file: str, root: Token, root_end: Token, rest: list[Token]
) -> Problem:
    name, end = root.name, source.line(root_end.start)
    line, last = source.line(rest[0].start), rest[-1]
    begins = f"the content that starts with {rest[0].shown} on line {line}"
    message = f"line {end} closes </{name}> too early, before {begins}"
    if root_end.kind == "empty":
        message = f"<{name} …/> on line {end} is closed by its slash, before "
        message += begins
        hint = f"write > instead of /> on line {end} and </{name}> as the last line"
    elif last.closes and last.name == name:
        right = f"the one on line {source.line(last.start)} is the right one"
        hint = f"delete </{name}> on line {end}; {right}"
    else:
        hint = f"move </{name}> from line {end} to the last line of the file"
    # The place is the early tag, because that is what has to be changed.
    return source.error(file, "xml-root-closed-early", root_end.start, message, hint)


def _text(
    source: SourceText, file: str, root: Token, root_end: Token
) -> Problem | None:
    for token in source.tokens:
        text = source.text[token.start : token.end]
        if token.start < root_end.end or token.kind not in ("text", "cdata"):
            continue
        if text.strip():
            return source.error(
                file,
                "xml-text-after-root",
                token.start + len(text) - len(text.lstrip()),
                f"there is text after </{root.name}>: "
                f"“{text.strip().splitlines()[0][:40]}”",
                "delete it, or make it a comment: <!-- … -->",
            )
    return None
