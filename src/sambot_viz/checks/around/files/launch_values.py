"""The texts that a Python launch file builds, found without running it."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from sambot_viz import limits
from sambot_viz.checks.launch_files import call_name

SHARE = "package://"
"""A path in the share folder of a package begins so, as in a model."""

_SHARE_CALLS = frozenset(
    {"FindPackageShare", "get_package_share_directory", "get_package_share_path"}
)
_JOINS = frozenset({"join", "PathJoinSubstitution"})
_WRAPPERS = frozenset(
    {
        "Path",
        "str",
        "TextSubstitution",
        "PythonLaunchDescriptionSource",
        "ParameterValue",
    }
)


def keyword(call: ast.Call, name: str, position: int | None = None) -> ast.expr | None:
    """Return an argument of a call by its name, or by its position."""
    for given in call.keywords:
        if given.arg == name:
            return given.value
    if position is not None and position < len(call.args):
        return call.args[position]
    return None


def values_for(table: ast.Dict, key: str) -> Iterator[ast.expr]:
    """Give the values that a dict of the file has for a text as its key."""
    for node, value in zip(table.keys, table.values, strict=True):
        if isinstance(node, ast.Constant) and node.value == key:
            yield value


class LaunchValues:
    """Works out texts: paths in packages, names, defaults of launch arguments.

    Args:
        tree: the launch file.
        calls: all calls in it.
    """

    def __init__(self, tree: ast.Module, calls: Sequence[ast.Call]) -> None:
        self._texts: dict[int, str | None] = {}
        self._variables: dict[str, ast.expr | None] = {}
        self._arguments: dict[str, ast.expr] = {}
        for node in ast.walk(tree):
            if isinstance(node, ast.Assign) and len(node.targets) == 1:
                self._assign(node.targets[0], node.value)
            elif isinstance(node, (ast.For, ast.AugAssign, ast.arg)):
                self._forget(node)
        for call in calls:
            if call_name(call.func) == "DeclareLaunchArgument":
                name = self.text(keyword(call, "name", 0))
                default = keyword(call, "default_value", 1)
                if name is not None and default is not None:
                    self._arguments[name] = default

    def _assign(self, target: ast.expr, value: ast.expr) -> None:
        if isinstance(target, ast.Name):
            # A variable with two values has none that is certain.
            again = target.id in self._variables
            self._variables[target.id] = None if again else value

    def _forget(self, node: ast.For | ast.AugAssign | ast.arg) -> None:
        if isinstance(node, ast.arg):
            self._variables[node.arg] = None
        elif isinstance(node.target, ast.Name):
            self._variables[node.target.id] = None

    def text(self, node: ast.expr | None, depth: int = 0) -> str | None:
        """Return the text that an expression stands for, None when it is not certain.

        A launch argument stands for its default value, and the share folder of a
        package for ``package://NAME``.
        """
        if node is None or depth > limits.YAML_DEPTH.value:
            return None
        # Each is worked out once: variables of variables could take for ever.
        if id(node) not in self._texts:
            found = self._text(node, depth + 1)
            short = found is not None and len(found) <= limits.LAUNCH_VALUE.value
            self._texts[id(node)] = found if short else None
        return self._texts[id(node)]

    def _text(self, node: ast.expr, deeper: int) -> str | None:
        match node:
            case ast.Constant(value=str() | bool() as value):
                return str(value)
            case ast.Name(id=name):
                return self.text(self._variables.get(name), deeper)
            case ast.List(elts=parts) | ast.Tuple(elts=parts):
                return self._together(parts, "", deeper)
            case ast.JoinedStr(values=parts):
                return self._together(parts, "", deeper)
            case ast.FormattedValue(value=inner):
                return self.text(inner, deeper)
            case ast.BinOp(left=left, op=ast.Add(), right=right):
                return self._together([left, right], "", deeper)
            case ast.BinOp(left=left, op=ast.Div(), right=right):
                return self._together([left, right], "/", deeper)
            case ast.Call():
                return self._of_call(node, deeper)
            case _:
                return None

    def is_declared(self, node: ast.expr) -> bool:
        """Tell whether an expression has no launch argument that is not declared."""
        waiting: list[ast.AST] = [node]
        seen: set[str] = set()
        while waiting:
            inner = waiting.pop()
            waiting += ast.iter_child_nodes(inner)
            if isinstance(inner, ast.Name) and inner.id not in seen:
                seen.add(inner.id)
                waiting += filter(None, [self._variables.get(inner.id)])
            elif isinstance(inner, ast.Call) and (
                call_name(inner.func) == "LaunchConfiguration"
                and self.text(keyword(inner, "variable_name", 0)) not in self._arguments
            ):
                return False
        return True

    def joined(self, call: ast.Call) -> ast.expr | None:
        """Return the list whose items a call joins to a path, or None."""
        inner = call.args[0] if call.args else None
        return inner if call_name(call.func) in _JOINS else None

    def _together(
        self, parts: Sequence[ast.expr], between: str, depth: int
    ) -> str | None:
        texts = [self.text(part, depth) for part in parts]
        known = [text for text in texts if text is not None]
        if len(known) < len(texts):
            return None
        if between:
            known = [known[0].rstrip("/"), *(text.strip("/") for text in known[1:])]
        return between.join(known)

    def _of_call(self, call: ast.Call, depth: int) -> str | None:
        name, arguments = call_name(call.func), call.args
        if name in _SHARE_CALLS:
            package = self.text(keyword(call, "package", 0), depth)
            return None if package is None else SHARE + package
        if name == "find" and arguments:
            found = self.text(arguments[0], depth)
            return None if found is None else SHARE + found
        if name in _JOINS and arguments:
            parts = arguments[0] if isinstance(arguments[0], ast.List) else None
            return self._together(parts.elts if parts else arguments, "/", depth)
        if name == "LaunchConfiguration":
            argument = self.text(keyword(call, "variable_name", 0), depth)
            default = keyword(call, "default")
            return self.text(self._arguments.get(argument or "", default), depth)
        if name in _WRAPPERS and arguments:
            return self.text(arguments[0], depth)
        return None

    def texts(self, node: ast.expr | None) -> Iterator[str]:
        """Give the texts in a list, or the one text of another expression."""
        if isinstance(node, ast.Name):
            node = self._variables.get(node.id) or node
        if isinstance(node, (ast.List, ast.Tuple)):
            for part in node.elts:
                yield from (t for t in (self.text(part),) if t is not None)
        else:
            yield from (t for t in (self.text(node),) if t is not None)

    def items(self, node: ast.expr | None) -> list[ast.expr]:
        """Return the items of a list, also when a variable stands for it or for one."""
        if isinstance(node, ast.Name):
            node = self._variables.get(node.id)
        found = node.elts if isinstance(node, (ast.List, ast.Tuple)) else []
        return [self._item(part) for part in found]

    def _item(self, part: ast.expr) -> ast.expr:
        value = self._variables.get(part.id) if isinstance(part, ast.Name) else None
        return part if value is None else value

    def resolved(self, node: ast.expr | None) -> ast.expr | None:
        """Return the expression that variables and wrappers stand for."""
        for _ in range(limits.YAML_DEPTH.value):
            value = self._item(node) if node is not None else None
            if isinstance(value, ast.Call) and call_name(value.func) in _WRAPPERS:
                value = value.args[0] if value.args else value
            if value is node:
                break
            node = value
        return node

    def named(self, text: str) -> str | None:
        """Return the variable that stands for a text, or None."""
        for name, value in self._variables.items():
            if value is not None and self.text(value) == text:
                return name
        return None
