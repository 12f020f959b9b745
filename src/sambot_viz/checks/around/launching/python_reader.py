"""Follow a Python launch file through its syntax tree, without running it."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping, Sequence
from functools import partial

from sambot_viz import limits
from sambot_viz.checks.around.launching.actions import (
    Action,
    Joined,
    ShareFolder,
    UnknownAction,
)
from sambot_viz.checks.around.launching.python_parts import (
    Call,
    Listing,
    Names,
    Pair,
    PythonValue,
    Table,
    added,
    as_actions,
    as_text,
    assign,
    either,
    formatted,
    item_of,
    truth_of,
)
from sambot_viz.checks.launch_files import call_name
from sambot_viz.errors import Place

_ENTRY = "generate_launch_description"
_SAME = frozenset("as_posix copy items perform read resolve toprettyxml toxml".split())
"""Methods whose result has the same meaning."""
_OF_MODULES = ("join", "glob", "iglob")
"""Functions of modules; methods of texts and paths with these names differ."""
_ADDING = ("add_action", "append")


class PythonReader:
    """Follows the statements of a launch file.

    Args:
        tree: the file.
        shown: its path, for places.
        calls: name of a call → the function that makes its result.

    Attributes:
        values: the id of an expression → its value, None where it has several.
    """

    def __init__(
        self,
        tree: ast.Module,
        shown: str,
        calls: Mapping[str, Callable[[Call], PythonValue]],
    ) -> None:
        self._tree, self._shown, self._calls = tree, shown, calls
        self._left = limits.LAUNCH_STEPS.value
        self._depth = 0
        self._followed: set[int] = set()
        self.values: dict[int, PythonValue] = {}

    def read(self) -> tuple[Action, ...]:
        """Return the actions of the launch file."""
        # Paths of other files begin at the folder of this one.
        names: Names = {"__file__": Joined((ShareFolder(""), "launch.py"), True)}
        self._run(self._tree.body, names, [])
        entry = names.get(_ENTRY)
        if isinstance(entry, ast.FunctionDef):
            found = as_actions(self.result_of(entry, names), self._shown, entry)
        else:
            # The fault of such a file is a finding; the names in it still count.
            bare = [s.value for s in self._tree.body if isinstance(s, ast.Expr)]
            made = [self.value(call, names) for call in bare]
            found = tuple(each for each in made if isinstance(each, Action))
            place = Place(self._shown, 1)
            found = found or (UnknownAction(place, "true", "an action"),)
        self._read_the_rest(names)
        return found

    def _read_the_rest(self, names: Names) -> None:
        """Follow the functions that nothing calls, for the values in them."""
        for node in ast.walk(self._tree):
            if isinstance(node, ast.FunctionDef) and id(node) not in self._followed:
                self.result_of(node, names)

    def result_of(self, function: ast.FunctionDef, names: Names) -> PythonValue:
        """Return the result of a function for unknown arguments."""
        return self._result(function, names, ())

    def _result(
        self, function: ast.FunctionDef, names: Names, given: Sequence[PythonValue]
    ) -> PythonValue:
        if self._depth > limits.YAML_DEPTH.value:
            return None
        self._followed.add(id(function))
        inner: Names = dict(names)
        for at, argument in enumerate(function.args.args):
            inner[argument.arg] = given[at] if at < len(given) else None
        results: list[PythonValue] = []
        self._depth += 1
        self._run(function.body, inner, results)
        self._depth -= 1
        found = results[0] if results else None
        for other in results[1:]:
            found = either(found, other)
        return found

    def _run(
        self, body: Sequence[ast.stmt], names: Names, results: list[PythonValue]
    ) -> bool:
        """Follow statements; return True when they certainly end with a return."""
        return any(self._step(step, names, results) for step in body)

    def _step(self, step: ast.stmt, names: Names, results: list[PythonValue]) -> bool:
        match step:
            case ast.Return(value=value):
                results.append(self.value(value, names))
                return True
            case ast.FunctionDef(name=name):
                names[name] = step
            case ast.Assign(targets=targets, value=value):
                found = self.value(value, names)
                for target in targets:
                    assign(target, found, names)
            case ast.AnnAssign(target=target, value=ast.expr() as value):
                assign(target, self.value(value, names), names)
            case ast.AugAssign(target=ast.Name(id=name), op=ast.Add(), value=value):
                names[name] = added(names.get(name), self.value(value, names))
            case ast.Expr(value=ast.Call() as call):
                self._change(call, names)
            case ast.Expr(value=value):
                self.value(value, names)
            case ast.If(test=test, body=body, orelse=orelse):
                return self._branch(test, (body, orelse), names, results)
            case ast.For(target=target, iter=over, body=body):
                self._loop(target, over, body, names, results)
            case ast.With(items=items, body=body):
                for item in items:
                    if item.optional_vars is not None:
                        found = self.value(item.context_expr, names)
                        assign(item.optional_vars, found, names)
                return self._run(body, names, results)
            case ast.Try(body=body, orelse=orelse, finalbody=finalbody):
                return self._run([*body, *orelse, *finalbody], names, results)
            case _:
                pass
        return False

    def _branch(
        self,
        test: ast.expr,
        branches: tuple[Sequence[ast.stmt], Sequence[ast.stmt]],
        names: Names,
        results: list[PythonValue],
    ) -> bool:
        known = truth_of(test, partial(self.value, names=names))
        if known is not None:
            return self._run(branches[0 if known else 1], names, results)
        one, other = dict(names), dict(names)
        ends = [
            self._run(branch, inner, results)
            for branch, inner in zip(branches, (one, other), strict=True)
        ]
        for name in {**one, **other}:
            names[name] = either(one.get(name), other.get(name))
        return all(ends)

    def _loop(
        self,
        target: ast.expr,
        over: ast.expr,
        body: Sequence[ast.stmt],
        names: Names,
        results: list[PythonValue],
    ) -> None:
        found = self.value(over, names)
        if isinstance(found, Listing) and found.complete:
            for item, _ in found.items:
                assign(target, item, names)
                self._run(body, names, results)
            return
        inner = dict(names)
        assign(target, None, inner)
        self._run(body, inner, results)
        for name, value in inner.items():
            changed = either(names.get(name), value)
            if isinstance(changed, Listing) and value is not names.get(name):
                changed = Listing(changed.items, complete=False)
            names[name] = changed

    def _change(self, call: ast.Call, names: Names) -> None:
        """Follow a call that extends a list or a description."""
        match call.func:
            case ast.Attribute(value=ast.Name(id=name), attr=method) if call.args:
                more = self.value(call.args[0], names)
                if method in _ADDING:
                    more = Listing(((more, call.args[0]),))
                elif method not in ("extend", "update"):
                    self.value(call, names)
                    return
                names[name] = added(names.get(name), more)
            case _:
                self.value(call, names)

    def value(self, node: ast.expr | None, names: Names) -> PythonValue:
        """Return the value of an expression."""
        self._left -= 1
        if node is None or self._left < 0:
            return None
        value = self._value(node, names)
        known = self.values.setdefault(id(node), value)
        self.values[id(node)] = either(known, value)
        return value

    def _value(self, node: ast.expr, names: Names) -> PythonValue:
        match node:
            case ast.Constant(value=str() | bool() | int() | float() as value):
                return str(value)
            case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=value)):
                return f"-{value}"
            case ast.Name(id=name):
                return names.get(name)
            case ast.List(elts=parts) | ast.Tuple(elts=parts) | ast.Set(elts=parts):
                return self._listing(parts, names)
            case ast.Dict():
                return self._table(node, names)
            case ast.JoinedStr(values=parts):
                return Joined(tuple(as_text(self.value(p, names)) for p in parts))
            case ast.FormattedValue(value=inner, conversion=-1, format_spec=None):
                return self.value(inner, names)
            case ast.BinOp(left=left, op=ast.Add() | ast.BitOr(), right=right):
                return added(self.value(left, names), self.value(right, names))
            case ast.BinOp(left=left, op=ast.Div(), right=right):
                both = (self.value(left, names), self.value(right, names))
                return Joined(tuple(as_text(each) for each in both), is_path=True)
            case ast.BinOp(left=left, op=ast.Mod(), right=right):
                return formatted(self.value(left, names), self.value(right, names))
            case ast.IfExp(test=test, body=body, orelse=orelse):
                known = truth_of(test, partial(self.value, names=names))
                both = [self.value(each, names) for each in (body, orelse)]
                return either(*both) if known is None else both[0 if known else 1]
            case ast.ListComp(elt=inner, generators=[loop]):
                return self._comprehension(inner, loop, names)
            case ast.Subscript(value=inner, slice=key):
                return item_of(self.value(inner, names), self.value(key, names))
            case ast.Call():
                return self._call(node, names)
            case _:
                return None

    def _listing(self, parts: Sequence[ast.expr], names: Names) -> Listing:
        found = Listing(())
        for part in parts:
            if isinstance(part, ast.Starred):
                more = added(found, self.value(part.value, names))
                found = more if isinstance(more, Listing) else found
            else:
                item = (self.value(part, names), part)
                found = Listing((*found.items, item), found.complete)
        return found

    def _table(self, node: ast.Dict, names: Names) -> Table:
        found = Table(())
        for key, inner in zip(node.keys, node.values, strict=True):
            value = self.value(inner, names)
            if key is not None:
                name = as_text(self.value(key, names))
                pair = Pair(name, value, key, inner)
                found = Table((*found.pairs, pair), found.complete)
            elif isinstance(value, Table):
                found = Table((*found.pairs, *value.pairs), found.complete)
            else:
                found = Table(found.pairs, complete=False)
        return found

    def _comprehension(
        self, inner: ast.expr, loop: ast.comprehension, names: Names
    ) -> Listing:
        over = self.value(loop.iter, names)
        if not isinstance(over, Listing) or not over.complete or loop.ifs:
            return Listing((), complete=False)
        items: list[tuple[PythonValue, ast.expr]] = []
        for item, _ in over.items:
            local = dict(names)
            assign(loop.target, item, local)
            items.append((self.value(inner, local), inner))
        return Listing(tuple(items))

    def _call(self, call: ast.Call, names: Names) -> PythonValue:
        name = call_name(call.func)
        given = [*call.args, *(each.value for each in call.keywords)]
        values = {id(node): self.value(node, names) for node in given}
        if isinstance(call.func, ast.Attribute):
            owner = self.value(call.func.value, names)
            if name in _SAME:
                return owner
            if name in _OF_MODULES and isinstance(owner, (str, Joined)):
                return None
            if name == "find" and isinstance(owner, ShareFolder) and call.args:
                return ShareFolder(as_text(values[id(call.args[0])]))
        elif isinstance(known := names.get(name), ast.FunctionDef):
            return self._result(known, names, [values[id(each)] for each in call.args])
        build = self._calls.get(name)
        if build is None:
            return None
        result = partial(self.result_of, names=names)
        return build(Call(call, self._shown, lambda node: values.get(id(node)), result))
