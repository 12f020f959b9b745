"""What is wrong before the first tag: another kind of file, encoding, declaration."""

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
_YAML = re.compile(r"(?:---\s*\n|[\w /]+:(?:\s|$))")
_PYTHON = re.compile(r"(?:#!.*python|import \w|from [\w.]+ import )")
_LFS = "version https://git-lfs.github.com/spec/"
_GIVE = "give a URDF or xacro file"
_WRITE = '<?xml version="1.0"?>'


def whole_file_problem(source: SourceText, file: str) -> Problem | None:
    """The one problem of a file that is no XML text at all, or None."""
    found = _other_kind(source.text)
    if found is None:
        return None
    code, message, hint = found
    return Problem("error", code, message, hint, file, 1, 1)


def _other_kind(text: str) -> tuple[str, str, str] | None:
    start = text.lstrip("\ufeff \t\r\n")
    if not start:
        return "model-empty", "the file is empty", "write <robot> and links into it"
    if start.startswith(_LFS):
        return (
            "model-lfs-pointer",
            "this is a git-LFS pointer, not the file itself",
            "run git lfs pull in its repository",
        )
    if re.match(r"(?i)<!doctype\s+html|<html[\s>]", start):
        return (
            "model-html-page",
            "this is a web page (HTML), not a robot: the page around the file was "
            "saved instead of the file",
            "download the raw file",
        )
    if start.startswith("PK\x03\x04"):
        return "model-not-xml", "this is a zip archive", "unpack it and give the model"
    if start.startswith("\x1f\ufffd") or start.startswith("\x1f\udc8b"):
        return "model-not-xml", "this is a gzip archive", "unpack it and give the model"
    if "\x00" in text[:200]:
        return _with_zeros(text)
    if start[0] in "{[" and "<" not in start[:20]:
        return "model-not-xml", "this is JSON, not XML", _GIVE
    if "<" not in text:
        return _without_tags(start)
    return None


def _with_zeros(text: str) -> tuple[str, str, str]:
    if "<\x00" in text or "\x00<" in text:
        return (
            "xml-encoding",
            "the file is written in UTF-16",
            "save it as UTF-8 (in the editor: Save with encoding)",
        )
    return (
        "model-not-xml",
        "this is a binary file, not XML",
        "give a URDF or xacro file",
    )


def _without_tags(start: str) -> tuple[str, str, str]:
    hint = f"{_GIVE}: it begins with <robot name=…>"
    if start.startswith("solid "):
        return "model-not-xml", "this is an STL mesh, not a robot", hint
    if _PYTHON.match(start):
        return "model-not-xml", "this is a Python program, not a robot", hint
    if _YAML.match(start):
        return "model-not-xml", "this is YAML, not XML", hint
    return "model-not-xml", "this is not XML: there is no tag in it", hint


def prolog_problems(source: SourceText, file: str) -> list[Problem]:
    """Encoding, control characters, the declaration, text before the root."""
    problems = [*_characters(source, file), *_declaration(source, file)]
    first_tag = source.tags[0].start if source.tags else len(source.text)
    for token in source.tokens:
        text = source.text[token.start : token.end].lstrip("\ufeff")
        if token.kind == "text" and token.end <= first_tag and text.strip():
            at = token.start + len(text) - len(text.lstrip())
            problems.append(
                _problem(
                    source,
                    file,
                    "xml-text-before-root",
                    at,
                    f"there is text before the first tag: “{text.strip()[:40]}”",
                    "delete it, or make it a comment: <!-- … -->",
                )
            )
            break
    return problems


def _problem(
    source: SourceText, file: str, code: str, at: int, message: str, hint: str
) -> Problem:
    line, column = source.line(at), source.column(at)
    return Problem("error", code, message, hint, file, line, column)


def _characters(source: SourceText, file: str) -> list[Problem]:
    problems: list[Problem] = []
    foreign = _NOT_UTF8.search(source.text)
    if foreign and not re.search(
        r"encoding\s*=\s*[\"'](?!utf)", source.text[:200], re.I
    ):
        problems.append(
            _problem(
                source,
                file,
                "xml-encoding",
                foreign.start(),
                "there are bytes here that are no UTF-8: the file was saved in "
                "another encoding (such as CP949, Shift-JIS or Latin-1)",
                "save it as UTF-8, or name the encoding in the first line: "
                '<?xml version="1.0" encoding="…"?>',
            )
        )
    control = _CONTROL.search(source.text)
    if control:
        code = ord(control[0])
        problems.append(
            _problem(
                source,
                file,
                "xml-control-character",
                control.start(),
                f"there is an invisible control character (U+{code:04X}) here",
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
            _problem(
                source,
                file,
                "xml-declaration-wrong",
                found.start(),
                f"the declaration {found[0].splitlines()[0][:60]} is not in order: it "
                'wants version="1.0", then perhaps an encoding',
                f"write {_WRITE}",
            )
        )
    return problems


def _not_first(source: SourceText, file: str, at: int, start: int) -> Problem:
    before = source.text[start:at]
    line = source.line(at)
    earlier = source.first("robot")
    if earlier is not None and earlier.start < at:
        message = f"a second <?xml …?> stands on line {line}, inside the file"
        hint = "delete it: two files were joined here"
    elif not before.strip():
        blank = "an empty line" if "\n" in before else "a blank"
        message = f"{blank} stands before <?xml …?>, which must be the very first thing"
        hint = "delete it: <?xml …?> begins at line 1, column 1"
    else:
        what = "the comment" if before.lstrip().startswith("<!--") else "the text"
        message = (
            f"<?xml …?> stands on line {line}, behind {what}, but it must be the very "
            "first thing in the file"
        )
        hint = f"put {what} behind it, or delete <?xml …?>"
    return _problem(source, file, "xml-declaration-not-first", at, message, hint)
