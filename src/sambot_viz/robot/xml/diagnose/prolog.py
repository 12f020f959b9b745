"""Errors before the first tag: another kind of file, encoding, declaration."""

from __future__ import annotations

import re
from pathlib import Path

from sambot_viz.errors import Problem
from sambot_viz.robot.xml.diagnose.source_text import ROOTS, Change, SourceText

_DECLARATION = re.compile(r"<\?xml(?=[\s?]).*?\?>", re.DOTALL)
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff]")
_NOT_UTF8 = re.compile("[\ufffd\ud800-\udfff]")

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
        r"(Panels|Visualization Manager):\s",
        "model-not-xml",
        "this is a config of RViz, not a robot: it is not XML",
        "give the model, and this file with -d",
    ),
    (
        r"(?s)[^<]*$|.{0,199}\x00",
        "model-not-xml",
        "this is not XML",
        "give a URDF or SDF file: it begins with <robot name=…> or <sdf version=…>",
    ),
)
"""The beginning of a file of another kind: pattern, code, message, hint."""


def other_file_problem(text: str, file: str) -> Problem | None:
    """Report a file of another kind, such as a web page; None for XML."""
    start = text.lstrip("\ufeff \t\r\n")
    for pattern, code, message, hint in _OTHER_FILES:
        if re.match(pattern, start):
            if code == "model-empty" and ".sdf" in Path(file).suffixes:
                hint = 'write <sdf version="1.8">, a <model> in it, and links into that'
            return Problem("error", code, message, hint, file, 1, 1)
    return None


def prolog_problems(source: SourceText, file: str) -> list[Problem]:
    """Report the encoding, control characters, and what is before <?xml …?>."""
    problems: list[Problem] = []
    foreign = _NOT_UTF8.search(source.text)
    if foreign and not re.search(
        r"encoding\s*=\s*[\"'](?!utf)", source.text[:200], re.I
    ):
        message = (
            "these bytes are not UTF-8: the file was saved in another encoding (such "
            "as CP949, Shift-JIS or Latin-1)"
        )
        hint = (
            "save it as UTF-8, or name the encoding in the first line: "
            '<?xml version="1.0" encoding="…"?>'
        )
        problems.append(
            source.error(file, "xml-encoding", foreign.start(), message, hint)
        )
    control = _CONTROL.search(source.text)
    if control:
        message = f"this is an invisible control character (U+{ord(control[0]):04X})"
        problems.append(
            source.error(
                file,
                "xml-control-character",
                control.start(),
                message,
                "delete it",
                [(control.start(), control.end(), "")],
            )
        )
    return problems + _declaration_not_first(source, file)


def _declaration_not_first(source: SourceText, file: str) -> list[Problem]:
    text = source.text
    start = 1 if text.startswith("\ufeff") else 0
    found = _DECLARATION.search(text)
    if found is None or found.start() == start or source.in_comment(found.start()):
        return []
    at, before = found.start(), text[start : found.start()]
    line, changes = source.line(at), list[Change]()
    if any(tag.name in ROOTS and tag.start < at for tag in source.tags):
        message = f"there is a second <?xml …?> on line {line}, inside the file"
        hint = "delete it: two files were joined here"
        changes = [(at, found.end(), "")]
    elif not before.strip():
        blank = "an empty line" if "\n" in before else "a blank"
        message = f"{blank} is before <?xml …?>, which must be the very first thing"
        hint = "delete it: <?xml …?> begins at line 1, column 1"
        changes = [(start, at, "")]
    else:
        what = "the comment" if before.lstrip().startswith("<!--") else "the text"
        message = (
            f"<?xml …?> is on line {line}, after {what}, but it must be the very "
            "first thing in the file"
        )
        hint = f"put {what} after it, or delete <?xml …?>"
    code = "xml-declaration-not-first"
    return [source.error(file, code, at, message, hint, changes)]
