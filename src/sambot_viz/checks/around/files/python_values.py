"""The texts and lists that a Python file builds, found without running it."""

from __future__ import annotations

import ast
import glob
import os
import posixpath
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from sambot_viz import limits
from sambot_viz.checks.launch_files import call_name

_SAME = frozenset({"list", "tuple", "sorted", "set", "str", "Path", "fspath"})


@dataclass(frozen=True, slots=True)
class Items:
    """A list or a tuple of a file.

    Attributes:
        items: each item with its expression; those of a glob share one.
        complete: False when there may be others.
    """

    items: tuple[tuple[ast.expr, Value], ...]
    complete: bool = True

    @property
    def texts(self) -> list[str]:
        """The items that are known texts."""
        return [value for _, value in self.items if isinstance(value, str)]

    @property
    def known(self) -> bool:
        """True when there are no others, and each is a known text."""
        return self.complete and len(self.texts) == len(self.items)


Value = str | Items | None
"""A text, a list, or None for what is not certain."""


class PythonValues:
    """Works out expressions of a file; glob looks at the disk.

    Args:
        tree: the file.
        folder: where the file is run; None does not look at the disk.
    """

    def __init__(self, tree: ast.Module, folder: Path | None) -> None:
        self._folder = folder
        self._known: dict[int, Value] = {}
        self._variables = dict(_variables(tree))

    def __call__(self, node: ast.expr | None, depth: int = 0) -> Value:
        """Return the value of an expression, None when it is not certain."""
        if node is None or depth > limits.YAML_DEPTH.value:
            return None
        # Each is worked out once: variables of variables could take for ever.
        if id(node) not in self._known:
            self._known[id(node)] = None
            self._known[id(node)] = self._short(self._value(node, depth + 1))
        return self._known[id(node)]

    def text(self, node: ast.expr | None) -> str | None:
        """Return the text of an expression, None when it is not certain."""
        value = self(node)
        return value if isinstance(value, str) else None

    def variable(self, name: str) -> Value:
        """Return the value of a variable of the file itself."""
        return self(self._variables.get(name))

    def items(self, node: ast.expr | None) -> Items:
        """Return the items of an expression; incomplete when they are not certain."""
        value = self(node)
        return value if isinstance(value, Items) else Items((), complete=False)

    def _short(self, value: Value) -> Value:
        most = limits.LAUNCH_VALUE.value
        size = len(value.items if isinstance(value, Items) else value or "")
        return value if size <= most else None

    def _value(self, node: ast.expr, deeper: int) -> Value:
        match node:
            case ast.Constant(value=str() as text):
                return text
            case ast.Name(id=name):
                return self(self._variables.get(name), deeper)
            case ast.List(elts=parts) | ast.Tuple(elts=parts) | ast.Set(elts=parts):
                return self._listed(parts, deeper)
            case ast.JoinedStr(values=parts):
                return _joined([self(part, deeper) for part in parts], "")
            case ast.FormattedValue(value=inner, conversion=-1, format_spec=None):
                return self(inner, deeper)
            case ast.BinOp(left=left, op=ast.Add(), right=right):
                return _sum(self(left, deeper), self(right, deeper))
            case ast.BinOp(left=left, op=ast.Div(), right=right):
                return _joined([self(left, deeper), self(right, deeper)], "/")
            case ast.BinOp(left=left, op=ast.Mod(), right=right):
                return _formatted(self(left, deeper), self(right, deeper))
            case ast.Call(func=function, args=arguments, keywords=keywords):
                given = [self(argument, deeper) for argument in arguments]
                name = call_name(function)
                if name in ("glob", "iglob"):
                    deep = any(k.arg == "recursive" for k in keywords)
                    return self._glob(node, given, recursive=deep)
                if name == "join" and isinstance(function, ast.Attribute):
                    return _joined(given, "/") if _is_path(function.value) else None
                return given[0] if name in _SAME and len(given) == 1 else None
            case _:
                return None

    def _listed(self, parts: Sequence[ast.expr], deeper: int) -> Items:
        found: list[tuple[ast.expr, Value]] = []
        complete = True
        for part in parts:
            if isinstance(part, ast.Starred):
                inner = self(part.value, deeper)
                complete = complete and isinstance(inner, Items) and inner.complete
                found += inner.items if isinstance(inner, Items) else ()
            else:
                found.append((part, self(part, deeper)))
        return Items(tuple(found), complete)

    def _glob(
        self, node: ast.expr, given: Sequence[Value], *, recursive: bool
    ) -> Items | None:
        pattern = given[0] if len(given) == 1 else None
        if not isinstance(pattern, str) or self._folder is None:
            return None
        if os.path.isabs(pattern) or ".." in pattern.split("/"):
            return None
        found = glob.iglob(pattern, root_dir=self._folder, recursive=recursive)
        most = limits.LAUNCH_VALUE.value
        try:
            paths = sorted(islice(found, most + 1))
        except OSError:
            return None
        slashed = (posixpath.normpath(path.replace(os.sep, "/")) for path in paths)
        return Items(tuple((node, path) for path in slashed))


def _variables(tree: ast.Module) -> Iterator[tuple[str, ast.expr]]:
    """Give each variable of the file itself with its last value.

    Lists may grow in it. A variable that is changed in a loop or a function, or that
    gets another value, is not certain.
    """
    own: dict[str, ast.expr] = {}
    steps = {id(step) for step in tree.body}
    for step in tree.body:
        name, value = _change(step)
        before = own.get(name)
        if value is not None:
            own[name] = value if before is None else ast.BinOp(before, ast.Add(), value)
    sets: dict[str, int] = {}
    for node in ast.walk(tree):
        name, _ = _change(node) if id(node) not in steps else ("", None)
        if name in own:
            own[name] = ast.BinOp(own[name], ast.Add(), ast.Constant(None))
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            sets[node.id] = sets.get(node.id, 0) + 1
        elif isinstance(node, ast.AugAssign) and isinstance(node.target, ast.Name):
            sets[node.target.id] = sets.get(node.target.id, 0) - 1
    for name, value in own.items():
        if sets.get(name) == 1:
            yield name, value


def _change(step: ast.AST) -> tuple[str, ast.expr | None]:
    """Return which variable a statement sets or makes longer, and by what."""
    match step:
        case ast.Assign(targets=[ast.Name(id=name)], value=value):
            return name, value
        case ast.AugAssign(target=ast.Name(id=name), op=ast.Add(), value=value):
            return name, value
        case ast.Expr(
            value=ast.Call(func=ast.Attribute(ast.Name(id=name), method), args=[value])
        ):
            if method == "extend":
                return name, value
            return name, ast.List([value]) if method == "append" else ast.Constant(None)
        case _:
            return "", None


def _joined(parts: Sequence[Value], between: str) -> str | None:
    """Join texts as os.path.join does, or as they are; None when one is not known."""
    texts = [part for part in parts if isinstance(part, str)]
    if len(texts) < len(parts):
        return None
    return posixpath.join(*texts) if between and texts else between.join(texts)


def _sum(left: Value, right: Value) -> Value:
    if isinstance(left, str) and isinstance(right, str):
        return left + right
    if isinstance(left, Items) or isinstance(right, Items):
        both = [v if isinstance(v, Items) else Items((), False) for v in (left, right)]
        items = both[0].items + both[1].items
        return Items(items, both[0].complete and both[1].complete)
    return None


def _formatted(text: Value, values: Value) -> str | None:
    """Replace each %s of a text."""
    given = values.texts if isinstance(values, Items) and values.known else [values]
    parts = text.split("%s") if isinstance(text, str) else []
    if len(parts) != len(given) + 1 or "%" in "".join(parts):
        return None
    texts = [value for value in given if isinstance(value, str)]
    if len(texts) < len(given):
        return None
    return parts[0] + "".join(
        t + part for t, part in zip(texts, parts[1:], strict=True)
    )


def _is_path(node: ast.expr) -> bool:
    """True for os.path and for what it is imported as."""
    return isinstance(node, ast.Attribute) or (
        isinstance(node, ast.Name) and node.id in ("path", "osp")
    )
