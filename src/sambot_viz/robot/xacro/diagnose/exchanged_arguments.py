"""Macro calls that swap the values of two parameters."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import permutations
from typing import Literal, NamedTuple

from sambot_viz.edits import exchange_attributes
from sambot_viz.errors import Fix, Place, Problem, Severity
from sambot_viz.robot.xacro.diagnose.source_files import SourceSet
from sambot_viz.robot.xml.diagnose.lexer import Token

_CODE = "xacro-arguments-exchanged"
_NUMBER = re.compile(r"[+-]?[\d.]+(?:e[+-]?\d+)?|\$\{[^{}]*[-+*/][^{}]*\}")
_WORD = re.compile(r"(?:\$\{\w+\})?[A-Za-z_][\w-]*")
_PROPERTY = re.compile(r"\$\{\s*(\w+)\s*\}")
_SHORT = {
    "d": ("depth", "diameter"),
    "h": ("height",),
    "l": ("length",),
    "m": ("mass",),
    "r": ("radius",),
    "w": ("width",),
}
"""One-letter parameter → words that it stands for."""
_OF_BOX = frozenset({"depth", "height", "length", "width"})

_Kind = Literal["word", "number"]


class _MacroCall(NamedTuple):
    """A call of a macro: its place and its tag."""

    place: Place
    tag: Token

    def problem(self, severity: Severity, one: str, other: str, why: str) -> Problem:
        first, second = (self.tag.get(name) or "" for name in (one, other))
        return Problem.at(
            self.place,
            severity,
            _CODE,
            f"the values of {one} and {other} in this call of "
            f"{self.tag.name.removeprefix('xacro:')} are exchanged: {why}",
            Fix(
                f'write {one}="{second}" and {other}="{first}"',
                exchange_attributes(self.place, one, other),
            ),
        )


def exchanged_arguments(sources: SourceSet) -> Iterator[Problem]:
    """Yield calls that give each of two parameters the other's value.

    Args:
        sources: files that xacro reads.
    """
    calls: dict[str, list[_MacroCall]] = {}
    macros = {macro.name for macro in sources.named("macro")}
    for name in macros:
        for place, tag in sources.calls(f"xacro:{name}"):
            calls.setdefault(name, []).append(_MacroCall(place, tag))
    for of_macro in calls.values():
        for call in of_macro:
            others = [other for other in of_macro if other is not call]
            found = _of_kinds(call, others) or _of_names(call)
            if found is not None:
                yield found


def without_consequences(
    problems: Sequence[Problem], exchanged: Sequence[Problem]
) -> list[Problem]:
    """Replace problems by the calls that cause them.

    Of two calls that differ, the one without a problem of its own is right.
    """
    found: list[Problem] = []
    kept = list(problems)
    for call in exchanged:
        ending = f"from the macro call on line {call.line}"
        own = [problem for problem in kept if problem.message.endswith(ending)]
        kept = [problem for problem in kept if problem not in own]
        if own or call.severity != "error":
            found.append(call)
    return [*found, *kept]


def _of_kinds(call: _MacroCall, others: Sequence[_MacroCall]) -> Problem | None:
    """Report a word in place of a number and vice versa, unlike in all other calls."""
    names = [each.name for each in call.tag.attributes]
    for one, other in permutations(names, 2):
        if (_kind(call, one), _kind(call, other)) != ("number", "word"):
            continue
        usual = [(_kind(each, one), _kind(each, other)) for each in others]
        if usual and set(usual) == {("word", "number")}:
            line = others[0].place.line
            why = f"{one} is a word and {other} a number on line {line}"
            return call.problem("error", one, other, why)
    return None


def _kind(call: _MacroCall, name: str) -> _Kind | None:
    value = (call.tag.get(name) or "").strip()
    if _NUMBER.fullmatch(value):
        return "number"
    return "word" if _WORD.fullmatch(value) else None


def _of_names(call: _MacroCall) -> Problem | None:
    """Report two properties, one of which has the name of the other parameter."""
    names = [each.name for each in call.tag.attributes]
    for one, other in permutations(names, 2):
        values = [_PROPERTY.fullmatch(call.tag.get(n) or "") for n in (one, other)]
        if values[0] is None or values[1] is None:
            continue
        first, second = (set(value[1].lower().split("_")) for value in values if value)
        own, its = (set(_SHORT.get(n, (n.lower(),))) for n in (one, other))
        if own & second and not own & first and not its & second:
            foreign = _OF_BOX.difference(its, map(str.lower, names))
            if own & second & _OF_BOX and first & foreign:
                # The call names the sides of a box otherwise than the macro does.
                continue
            why = f"{values[1][1]} is a {min(own & second)}"
            severity = "warning" if its & first else "info"
            return call.problem(severity, one, other, why)
    return None
