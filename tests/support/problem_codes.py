"""Every problem code in the source, found without running it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

_CODE = re.compile(r"[a-z0-9]+(-[a-z0-9]+)+")


def code_patterns(files: Iterable[Path]) -> set[str]:
    """Regular expressions for the codes that some modules report.

    A code is an argument of anything that has a parameter or a field called `code`, or
    is in a row of a table beside a sentence. An f-string stands for several codes.
    """
    trees = [ast.parse(file.read_text("utf-8")) for file in files]
    reporting = {name for tree in trees for name in _with_a_code(tree)}
    return {pattern for tree in trees for pattern in _reported(tree, reporting)}


def _with_a_code(tree: ast.AST) -> Iterator[str]:
    """Names of functions with a parameter `code` and of classes with such a field."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            arguments = (*node.args.args, *node.args.kwonlyargs)
            if any(argument.arg == "code" for argument in arguments):
                yield node.name
        elif isinstance(node, ast.ClassDef):
            fields = [n.target for n in node.body if isinstance(n, ast.AnnAssign)]
            if any(isinstance(f, ast.Name) and f.id == "code" for f in fields):
                yield node.name


def _reported(tree: ast.AST, reporting: set[str]) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = getattr(node.func, "id", getattr(node.func, "attr", ""))
            if name in reporting or _owner(node.func) in reporting:
                keywords = [k.value for k in node.keywords if k.arg == "code"]
                for argument in (*node.args[:4], *keywords):
                    yield from _patterns(argument)
        elif isinstance(node, ast.Tuple) and len(node.elts) >= 3:
            texts = [e.value for e in node.elts if isinstance(e, ast.Constant)]
            if any(" " in text for text in texts if isinstance(text, str)):
                for element in node.elts[:2]:
                    yield from _patterns(element)


def _owner(function: ast.expr) -> str:
    """The class in ``Problem.at``."""
    return getattr(getattr(function, "value", None), "id", "")


def _patterns(node: ast.expr) -> Iterator[str]:
    if isinstance(node, ast.IfExp):
        yield from _patterns(node.body)
        yield from _patterns(node.orelse)
    elif isinstance(node, ast.Constant) and isinstance(node.value, str):
        if _CODE.fullmatch(node.value):
            yield re.escape(node.value)
    elif isinstance(node, ast.JoinedStr):
        parts = [
            str(part.value) if isinstance(part, ast.Constant) else "x"
            for part in node.values
        ]
        if _CODE.fullmatch("".join(parts)):
            yield "".join("[a-z-]+" if p == "x" else re.escape(p) for p in parts)
