"""Errors before the first tag: another kind of file, encoding, declaration."""

from __future__ import annotations

import re

from sambot_viz.errors import Problem
from sambot_viz.robot.xml.diagnose.source_text import SourceText

_DECLARATION = re.compile(r"<\?xml(?=[\s?])(.*?)\?>", re.DOTALL)
_GOOD_DECLARATION = re.compile(
    r"""\s+version\s*=\s*(?:"1\.[0-9]+"|'1\.[0-9]+')"""
    r"""(?:\s+encoding\s*=\s*(?:"[A-Za-z][\w.\-]*"|'[A-Za-z][\w.\-]*'))?"""
    r"""(?:\s+standalone\s*=\s*(?:"(?:yes|no)"|'(?:yes|no)'))?\s*"""
)
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff]")
_NOT_UTF8 = re.compile("[\ufffd\ud800-\udfff]")
_WRITE = '<?xml version="1.0"?>'


_OTHER_FILES: tuple[tuple[str, str, str, str], ...] = (
    ("$", "model-empty", "the file is empty", "write <robot> and links into it"),
    (
        "version https://git-lfs",
        "model-lfs-pointer",
        "this is a git-LFS pointer, not the file itself",
        "run git lfs pull in its repository",
    ),
    (
        r"(?i)<!doctype\s+html|<html[\s>]",
        "model-html-page",
        "this is a web page (HTML), not a robot: the page around the file was saved "
        "instead of the file",
        "download the raw file",
    ),
    (
        "PK\x03\x04",
        "model-not-xml",
        "this is a zip archive",
        "unpack it and give the model",
    ),
    (
        "\x1f[\ufffd\udc8b]",
        "model-not-xml",
        "this is a gzip archive",
        "unpack it and give the model",
    ),
    (
        r"(?s)(?=.{0,199}\x00).{0,400}?(?:<\x00|\x00<)",
        "xml-encoding",
        "the file is written in UTF-16",
        "save it as UTF-8 (in the editor: Save with encoding)",
    ),
    (
        r"(?s).{0,199}\x00",
        "model-not-xml",
        "this is a binary file, not XML",
        "give a URDF or xacro file",
    ),
    (
        r"(?s)[{\[](?!.{0,18}<)",
        "model-not-xml",
        "this is JSON, not XML",
        "give a URDF or xacro file",
    ),
    (
        "solid [^<]*$",
        "model-not-xml",
        "this is an STL mesh, not a robot",
        "give a URDF or xacro file: it begins with <robot name=…>",
    ),
    (
        r"(?:#!.*python|import \w|from [\w.]+ import )[^<]*$",
        "model-not-xml",
        "this is a Python program, not a robot",
        "give a URDF or xacro file: it begins with <robot name=…>",
    ),
    (
        r"(?:---\s*\n|[\w /]+:(?:\s|$))[^<]*$",
        "model-not-xml",
        "this is YAML, not XML",
        "give a URDF or xacro file: it begins with <robot name=…>",
    ),
    (
        "[^<]*$",
        "model-not-xml",
        "this is not XML: it contains no tags",
        "give a URDF or xacro file: it begins with <robot name=…>",
    ),
)
"""How a file of another kind begins: pattern, code, message, hint."""


def other_file_problem(text: str, file: str) -> Problem | None:
    """Report a file of another kind, such as a mesh or JSON; None for XML."""
    start = text.lstrip("\ufeff \t\r\n")
    for pattern, code, message, hint in _OTHER_FILES:
        if re.match(pattern, start):
            return Problem("error", code, message, hint, file, 1, 1)
    return None


def prolog_problems(source: SourceText, file: str) -> list[Problem]:
    """Encoding, control characters, the declaration, text before the root."""
    problems = [*_characters(source, file), *_declaration(source, file)]
    first_tag = source.tags[0].start if source.tags else len(source.text)
    for token in source.tokens:
        text = source.text[token.start : token.end].lstrip("\ufeff")
        if token.kind == "text" and token.end <= first_tag and text.strip():
            at = token.start + len(text) - len(text.lstrip())
            problems.append(
                source.error(
                    file,
                    "xml-text-before-root",
                    at,
                    f"there is text before the first tag: “{text.strip()[:40]}”",
                    "delete it, or make it a comment: <!-- … -->",
                )
            )
            break
    return problems


def _characters(source: SourceText, file: str) -> list[Problem]:
    problems: list[Problem] = []
    foreign = _NOT_UTF8.search(source.text)
    if foreign and not re.search(
        r"encoding\s*=\s*[\"'](?!utf)", source.text[:200], re.I
    ):
        problems.append(
            source.error(
                file,
                "xml-encoding",
                foreign.start(),
                "these bytes are not UTF-8: the file was saved in "
                "another encoding (such as CP949, Shift-JIS or Latin-1)",
                "save it as UTF-8, or name the encoding in the first line: "
                '<?xml version="1.0" encoding="…"?>',
            )
        )
    control = _CONTROL.search(source.text)
    if control:
        code = ord(control[0])
        problems.append(
            source.error(
                file,
                "xml-control-character",
                control.start(),
                f"this is an invisible control character (U+{code:04X})",
                "delete it",
            )
        )
    return problems


def _declaration(source: SourceText, file: str) -> list[Problem]:
    text = source.text
    start = 1 if text.startswith("\ufeff") else 0
    found = _DECLARATION.search(text)
    if not found or any(
        t.kind == "comment" and t.start < found.start() < t.end for t in source.tokens
    ):
        return []
    problems: list[Problem] = []
    if found.start() > start:
        problems.append(_not_first(source, file, found.start(), start))
    if not _GOOD_DECLARATION.fullmatch(found[1]):
        problems.append(
            source.error(
                file,
                "xml-declaration-wrong",
                found.start(),
                f"the declaration {found[0].splitlines()[0][:60]} is not valid: it "
                'needs version="1.0" and can name an encoding',
                f"write {_WRITE}",
            )
        )
    return problems


def _not_first(source: SourceText, file: str, at: int, start: int) -> Problem:
    before = source.text[start:at]
    line = source.line(at)
    earlier = source.first("robot")
    if earlier is not None and earlier.start < at:
        message = f"there is a second <?xml …?> on line {line}, inside the file"
        hint = "delete it: two files were joined here"
    elif not before.strip():
        blank = "an empty line" if "\n" in before else "a blank"
        message = f"{blank} is before <?xml …?>, which must be the very first thing"
        hint = "delete it: <?xml …?> begins at line 1, column 1"
    else:
        what = "the comment" if before.lstrip().startswith("<!--") else "the text"
        message = (
            f"<?xml …?> is on line {line}, after {what}, but it must be the very "
            "first thing in the file"
        )
        hint = f"put {what} after it, or delete <?xml …?>"
    return source.error(file, "xml-declaration-not-first", at, message, hint)
