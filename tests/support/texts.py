"""Every text of the program that a person reads, to be read in one go.

    python tests/support/texts.py            all of them, by file
    python tests/support/texts.py panels     those of files whose path has this word

A text is a string of two words or more, or one that begins with a capital letter.
Values that are put in are shown as {…}.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Literal

SOURCE = Path(__file__).resolve().parents[2] / "src" / "sambot_viz"
VALUE = "{…}"
Kind = Literal["help", "notice", "refusal", ""]
"""What a text is for, where the code says so."""
_WORDS = re.compile(r"[^\W\d_]{2,}[,.:;!?)”…]* [({“]*([^\W\d_]|\{…)|^[A-Z][a-z]+[.…]?$")
_CODE = re.compile(r"[=<>{}\[\]\\|]|\b(px|rgba?|var|calc|auto)\b|--|::|\$\(")
_NOTICES = {"Answer", "say", "_say", "tell", "notice"}
_NOTICE = re.compile(r"\b(tell|refuse|sayRefused)\(\s*$")
_SCRIPT = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/)
    |(?P<text>"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*')
    |(?P<template>`(?:[^`\\]|\\.)*`)
    |(?P<regex>(?<=[(,=:!&|?;])\s*/(?![*/])(?:[^/\\\n\[]|\\.|\[(?:[^\]\\\n]|\\.)*\])+/)
    """,
    re.DOTALL | re.VERBOSE,
)


@dataclass(frozen=True, slots=True)
class Text:
    """A text and its place.

    Attributes:
        file: its path below the source.
        line: its line.
        words: the text; values that are put in are {…}.
        kind: what it is for, if the code says so.
    """

    file: str
    line: int
    words: str
    kind: Kind


@cache
def texts() -> list[Text]:
    """Return all texts, in the order of files and lines."""
    found = [*_of_modules(), *_of_scripts()]
    return sorted(found, key=lambda text: (text.file, text.line))


def _is_read(words: str) -> bool:
    return bool(_WORDS.search(words)) and not _CODE.search(words.replace(VALUE, ""))


def _of_modules() -> Iterator[Text]:
    for path in SOURCE.rglob("*.py"):
        tree = ast.parse(path.read_text("utf-8"))
        kinds = dict(_kinds(tree))
        silent = {id(node) for node in _silent(tree)}
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant | ast.JoinedStr):
                words = _words(node)
                if id(node) not in silent and _is_read(words):
                    file = str(path.relative_to(SOURCE))
                    yield Text(file, node.lineno, words, kinds.get(id(node), ""))


def _kinds(tree: ast.AST) -> Iterator[tuple[int, Kind]]:
    """Yield the strings whose place in the code tells what they are for."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
            yield from ((id(one), "refusal") for one in node.exc.args)
        elif isinstance(node, ast.Call):
            for keyword in node.keywords:
                if keyword.arg == "help":
                    yield id(keyword.value), "help"
            name = getattr(node.func, "attr", getattr(node.func, "id", ""))
            if name in _NOTICES:
                yield from ((id(one), "notice") for one in node.args[:1])


def _silent(tree: ast.AST) -> Iterator[ast.AST]:
    """Yield the strings that nobody reads: docstrings, and parts of others."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            yield node.value
        elif isinstance(node, ast.JoinedStr):
            yield from (part for part in ast.walk(node) if part is not node)


def _words(node: ast.Constant | ast.JoinedStr) -> str:
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else ""
    return "".join(
        str(part.value) if isinstance(part, ast.Constant) else VALUE
        for part in node.values
    )


def _of_scripts() -> Iterator[Text]:
    for path in (SOURCE / "page").rglob("*.js"):
        script = path.read_text("utf-8")
        for found in _SCRIPT.finditer(script):
            if "vendor" in path.parts or found.lastgroup not in ("text", "template"):
                continue
            words = found[0][1:-1]
            if found.lastgroup == "template":
                words = re.sub(r"\$\{[^{}]*(\{[^{}]*\}[^{}]*)*\}", VALUE, words)
            words = re.sub(r"\\([\"'`])", r"\1", words).replace("\\n", "\n")
            if _is_read(words):
                line = script.count("\n", 0, found.start()) + 1
                told = _NOTICE.search(script, max(0, found.start() - 30), found.start())
                file = str(path.relative_to(SOURCE))
                yield Text(file, line, words, "notice" if told else "")


if __name__ == "__main__":
    before = ""
    for text in texts():
        if any(word not in text.file for word in sys.argv[1:]):
            continue
        if text.file != before:
            before = text.file
            print(f"\n{before}")
        print(f"{text.line:5} {text.words}")
