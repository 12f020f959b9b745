"""The property, argument or parameter that is text where an expression calculates."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz.errors import Place, Problem
from sambot_viz.robot.slips.units import without_units
from sambot_viz.robot.xacro.diagnose.failed_expansion import FailedExpansion, line_in
from sambot_viz.robot.xacro.diagnose.failing_values import given_in
from sambot_viz.robot.xml.diagnose.lexer import Token

_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*")
_WITH_UNIT = re.compile(r"\s*([+-]?\d*[.,]?\d+)\s*[^\d\s.,+*/()-]*\s*")
_EXPRESSION = re.compile(r"\$\{([^}]*)\}|\$\(\s*arg\s+([^)]*)\)")
_BEGINS_AS_NUMBER = re.compile(r"\s*[+-]?[.,]?\d")
_DEEPEST = 8


def wrong_value(failed: FailedExpansion) -> Problem | None:
    """Name the property or argument that is text where a number is needed."""
    if failed.failure.kind not in ("TypeError", "ValueError"):
        return None
    if not re.search(r"\bstr\b|sequence|string", failed.failure.text):
        return None
    return _text_in(failed, failed.expression, 0, 0)


def _text_in(
    failed: FailedExpansion, expression: str, level: int, depth: int
) -> Problem | None:
    """Look for the text in an expression, as it is so many macro calls further out."""
    for name in dict.fromkeys(re.findall(r"[A-Za-z_]\w*", expression)):
        for place, attribute, value, outside in _values(failed, name, level):
            if "$" in value:
                inner = " ".join(" ".join(use) for use in _EXPRESSION.findall(value))
                found = (
                    _text_in(failed, inner, level + outside, depth + 1)
                    if depth < _DEEPEST
                    else None
                )
                if found is not None:
                    return found
            elif outside and not _NUMBER.fullmatch(value):
                found = _text_in_call(failed, place, attribute, value, level)
                if found is not None:
                    return found
            elif not _NUMBER.fullmatch(value):
                return _not_a_number(failed, name, place, attribute, value)
    return None


def _values(
    failed: FailedExpansion, name: str, level: int
) -> Iterator[tuple[Place, str, str, int]]:
    """Yield where a name gets a value, the attribute, the value, 1 for a macro call."""
    call = _call(failed, level)
    value = call[1].get(name) if call is not None else None
    if call is not None and value is not None:
        yield call[0], name, value, 1
        return
    for kind, attribute in (("property", "value"), ("arg", "default")):
        for place, given in given_in(failed, kind, attribute, name):
            yield place, attribute, given, 0


def _call(failed: FailedExpansion, level: int) -> tuple[Place, Token] | None:
    calls = failed.failure.calls
    if level >= len(calls):
        return None
    call = calls[level]
    place = Place(call.file, call.line)
    token = failed.sources.tag_at(place, f"xacro:{call.macro.removeprefix('xacro:')}")
    source = failed.sources.get(call.file)
    if token is None or source is None:
        return None
    return Place(call.file, call.line, source.column(token.start)), token


def _text_in_call(
    failed: FailedExpansion, place: Place, name: str, value: str, level: int
) -> Problem | None:
    """Report a parameter that is the name of a property, or a number with a unit."""
    call = _call(failed, level)
    if call is None:
        return None
    known = {p.name for p in failed.named("property")}
    if value.strip() not in known:
        if not _BEGINS_AS_NUMBER.match(value):
            return None
        return _not_a_number(failed, name, place, name, value)
    better = " ".join(
        f'{a.name}="${{{a.value.strip()}}}"'
        for a in call[1].attributes
        if a.value.strip() in known
    )
    return failed.pointing_at(place).error(
        "xacro-expression-value",
        f'{name} is the text "{value}" and not the property of that name, but '
        f"{_used(failed, place)}",
        f"write {better}",
    )


def _not_a_number(
    failed: FailedExpansion, name: str, place: Place, attribute: str, value: str
) -> Problem:
    number = _WITH_UNIT.fullmatch(without_units(value.replace(",", ".")))
    better = number[1] if number else None
    return failed.pointing_at(place).error(
        "xacro-expression-value",
        f'{name} is "{value}", which is not a number, but {_used(failed, place)}',
        f'write {attribute}="{better}"' if better else "write a number",
    )


def _used(failed: FailedExpansion, place: Place) -> str:
    used = line_in(failed.expression_place(), place)
    return f"${{{failed.expression}}} on {used} calculates with it"
