"""Follows a Python launch file through its syntax tree, without running it."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping, Sequence
from functools import partial

from sambot_viz import limits
from sambot_viz.checks.around.launching.actions import Action, Joined, ShareFolder
from sambot_viz.checks.around.launching.python_parts import (
    Call,
    Listing,
    Names,
    PythonValue,
    Table,
    added,
    as_actions,
    as_text,
    assign,
    either,
    item_of,
)
from sambot_viz.checks.launch_files import call_name
from sambot_viz.errors import Place

_ENTRY = "generate_launch_description"
_SAME = frozenset("as_posix copy items perform read resolve toprettyxml toxml".split())
"""Methods whose result stands for the same."""
_ADDING = ("add_action", "append")


class PythonReader:
    """Follows the statements of a launch file.

    Args:
        tree: the file.
        shown: its path, for places.
        calls: what makes the result of a call, by its name.
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

    def place(self, node: ast.expr | ast.stmt) -> Place:
        """Return the place of an expression."""
        return Place(self._shown, node.lineno, node.col_offset + 1)

    def read(self) -> tuple[Action, ...]:
        """Return the actions of the launch file."""
        # The folder of the file is what others are looked for in.
        names: Names = {"__file__": Joined((ShareFolder(""), "launch.py"), True)}
        self._run(self._tree.body, names, [])
        entry = names.get(_ENTRY)
        place = Place(self._shown, 1)
        found: PythonValue = None
        if isinstance(entry, ast.FunctionDef):
            place = self.place(entry)
            found = self.result_of(entry, names)
        else:
            # What is wrong with such a file is a finding; what it names is still meant.
            bare = [s.value for s in self._tree.body if isinstance(s, ast.Expr)]
            items = [(self.value(call, names), self.place(call)) for call in bare]
            acting = [item for item in items if isinstance(item[0], Action)]
            found = Listing(tuple(acting)) if acting else None
        return as_actions(found, place)

    def result_of(self, function: ast.FunctionDef, names: Names) -> PythonValue:
        """Return what a function returns that is called with unknown arguments."""
        return self._result(function, names, ())

    def _result(
        self, function: ast.FunctionDef, names: Names, given: Sequence[PythonValue]
    ) -> PythonValue:
        if self._depth > limits.YAML_DEPTH.value:
            return None
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
        """Follow statements; True when they end with a return for certain."""
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
        known = self._truth(test, names)
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
        """Follow a list or a description that gets longer."""
        match call.func:
            case ast.Attribute(value=ast.Name(id=name), attr=method) if call.args:
                more = self.value(call.args[0], names)
                if method in _ADDING:
                    more = Listing(((more, self.place(call.args[0])),))
                elif method not in ("extend", "update"):
                    return
                names[name] = added(names.get(name), more)
            case _:
                pass

    def _truth(self, node: ast.expr, names: Names) -> bool | None:
        """Return whether an expression is true; None when it is not known."""
        match node:
            case ast.Constant(value=value):
                return bool(value)
            case ast.UnaryOp(op=ast.Not(), operand=inner):
                truth = self._truth(inner, names)
                return None if truth is None else not truth
            case ast.Compare(left=left, ops=[ast.Eq()], comparators=[right]):
                texts = self.value(left, names), self.value(right, names)
                known = [text for text in texts if isinstance(text, str)]
                return known[0] == known[1] if len(known) == len(texts) else None
            case _:
                return None

    def value(self, node: ast.expr | None, names: Names) -> PythonValue:
        """Return the value of an expression."""
        self._left -= 1
        if node is None or self._left < 0:
            return None
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
            case ast.IfExp(test=test, body=body, orelse=orelse):
                known = self._truth(test, names)
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
                item = (self.value(part, names), self.place(part))
                found = Listing((*found.items, item), found.complete)
        return found

    def _table(self, node: ast.Dict, names: Names) -> Table:
        found = Table(())
        for key, inner in zip(node.keys, node.values, strict=True):
            value = self.value(inner, names)
            if key is not None:
                name = as_text(self.value(key, names))
                pairs = (*found.pairs, (name, value, self.place(inner)))
                found = Table(pairs, found.complete)
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
        items: list[tuple[PythonValue, Place]] = []
        for item, _ in over.items:
            local = dict(names)
            assign(loop.target, item, local)
            items.append((self.value(inner, local), self.place(inner)))
        return Listing(tuple(items))

    def _call(self, call: ast.Call, names: Names) -> PythonValue:
        name = call_name(call.func)
        if isinstance(call.func, ast.Attribute):
            owner = self.value(call.func.value, names)
            if name in _SAME:
                return owner
            if name == "find" and isinstance(owner, ShareFolder) and call.args:
                return ShareFolder(as_text(self.value(call.args[0], names)))
        elif isinstance(known := names.get(name), ast.FunctionDef):
            given = [self.value(argument, names) for argument in call.args]
            return self._result(known, names, given)
        build = self._calls.get(name)
        if build is None:
            return None
        value, result = (
            partial(self.value, names=names),
            partial(self.result_of, names=names),
        )
        return build(Call(call, self._shown, value, result))
