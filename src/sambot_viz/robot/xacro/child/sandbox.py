"""The untrusted mode: evaluate xacro without access to Python and to other files.

Expressions are rebuilt from a list of allowed syntax: no attribute of a foreign
object, no function bodies, no comprehension, no names with two underscores, bounded
powers and repetitions. Files are read only below the model's own folder, its package
and the folders that the user gave, links followed, and never by a climbing path.
"""

from __future__ import annotations

import ast
import importlib
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

from sambot_viz import limits

_ALLOWED = (
    ast.Expression, ast.Constant, ast.Name, ast.Load, ast.Call, ast.keyword,
    ast.Attribute, ast.Subscript, ast.Slice, ast.Tuple, ast.List, ast.Dict, ast.Set,
    ast.BoolOp, ast.And, ast.Or, ast.IfExp, ast.Compare, ast.Eq, ast.NotEq, ast.Lt,
    ast.LtE, ast.Gt, ast.GtE, ast.Is, ast.IsNot, ast.In, ast.NotIn, ast.UnaryOp,
    ast.UAdd, ast.USub, ast.Not, ast.Invert, ast.BinOp, ast.Add, ast.Sub, ast.Mult,
    ast.Div, ast.FloorDiv, ast.Mod, ast.Pow, ast.Starred,
)  # fmt: skip
_FORBIDDEN_NAMES = frozenset({"vars", "type"})


class Refused(Exception):
    """The model uses something that the untrusted mode does not allow."""


class Guard:
    """Replaces xacro's evaluator and checks its paths.

    Attributes:
        roots: folders, beside the model's own, from which files may come.
    """

    def __init__(self, folder: str | None) -> None:
        """Prepare.

        Args:
            folder: the model's folder, or None when it has none.
        """
        self.roots: list[Path] = []
        self._folder = Path(os.path.realpath(folder)) if folder else None
        self._namespaces: tuple[type, ...] = ()

    def install(self, xacro: Any) -> None:
        """Patch the imported xacro package."""
        substitution: Any = importlib.import_module("xacro.substitution_args")
        self._namespaces = (xacro.NameSpace, xacro.YamlDictWrapper)
        xacro.safe_eval = self.evaluate
        for names in (xacro._global_symbols, xacro._global_symbols["python"]):
            for name in _FORBIDDEN_NAMES:
                names.pop(name, None)

        def evaluate_extension(text: str, context: Mapping[str, Any]) -> str:
            functions = dict(substitution._eval_dict)
            functions.pop("__builtins__", None)
            arguments = context.get("arg", {})

            def argument(name: str) -> Any:
                return arguments[name]

            functions["arg"] = argument
            return str(self.evaluate(text, functions))

        substitution._eval = evaluate_extension

    def evaluate(self, text: str, names: Any, local: Any = None) -> Any:
        """Evaluate one expression.

        Raises:
            Refused: it uses something that is not allowed.
        """
        tree = ast.parse(text.strip(), "<expression>", "eval")
        for node in ast.walk(tree):
            self._check(node)
        guarded = ast.fix_missing_locations(_Rewriter().visit(tree))
        code = compile(guarded, "<expression>", "eval")
        tools: dict[str, Any] = {
            "__builtins__": {},
            "_sambot_get": self._get,
            "_sambot_power": _power,
            "_sambot_times": _times,
        }
        return eval(code, tools, cast("Mapping[str, object]", _Names(names, local)))

    def _check(self, node: ast.AST) -> None:
        if not isinstance(node, _ALLOWED):
            kind = type(node).__name__
            raise Refused(f"{kind} is not allowed in an untrusted model")
        name = node.id if isinstance(node, ast.Name) else ""
        name = node.attr if isinstance(node, ast.Attribute) else name
        if name.startswith(("__", "_sambot")):
            raise Refused(f"the name {name} is not allowed in an untrusted model")

    def _get(self, value: Any, name: str) -> Any:
        if isinstance(value, self._namespaces) and not name.startswith("_"):
            return value[name]
        raise Refused(
            f"the attribute .{name} of a {type(value).__name__} is not allowed in an "
            "untrusted model"
        )

    def check_spec(self, spec: str) -> None:
        """Refuse a file name that, as written, leaves the model's folder.

        Raises:
            Refused: it is absolute outside the allowed folders, or contains "..".
        """
        if ".." in Path(spec.replace("\\", "/")).parts:
            raise Refused(f"the path {spec} climbs out with ..")
        if os.path.isabs(spec):
            self.check_path(spec)

    def check_path(self, path: str) -> None:
        """Refuse a file outside the model's folder and `roots`.

        Raises:
            Refused: the real path, links followed, is elsewhere.
        """
        real = Path(os.path.realpath(path))
        allowed = [Path(os.path.realpath(root)) for root in self.roots]
        if self._folder is not None:
            allowed.append(self._folder)
        if not any(real.is_relative_to(root) for root in allowed):
            raise Refused(f"the file {path} is outside the model's folder")


class _Names:
    """xacro's tables as the local names of an evaluation."""

    def __init__(self, names: Any, local: Any) -> None:
        self._names = names
        self._local = local

    def __getitem__(self, name: str) -> Any:
        if self._local is not None and name in self._local:
            return self._local[name]
        return self._names[name]


class _Rewriter(ast.NodeTransformer):
    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        self.generic_visit(node)
        return _call("_sambot_get", node.value, ast.Constant(node.attr))

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        self.generic_visit(node)
        if isinstance(node.op, ast.Pow):
            return _call("_sambot_power", node.left, node.right)
        if isinstance(node.op, ast.Mult):
            return _call("_sambot_times", node.left, node.right)
        return node


def _call(name: str, *arguments: ast.expr) -> ast.Call:
    return ast.Call(ast.Name(name, ast.Load()), list(arguments), [])


def _power(base: Any, exponent: Any) -> Any:
    if isinstance(base, int) and isinstance(exponent, int):
        if abs(base).bit_length() * abs(exponent) > limits.XACRO_BITS.value:
            raise Refused(
                f"the power has more than {limits.XACRO_BITS.value:,} bits, too many "
                "for an untrusted model"
            )
    return base**exponent


def _times(left: Any, right: Any) -> Any:
    for many, count in ((left, right), (right, left)):
        if isinstance(count, int) and hasattr(many, "__len__"):
            if len(many) * count > limits.XACRO_TEXT.value:
                raise Refused(
                    f"the repetition is longer than {limits.XACRO_TEXT.value:,}, too "
                    "long for an untrusted model"
                )
    return left * right
