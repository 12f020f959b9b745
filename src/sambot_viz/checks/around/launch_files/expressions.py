"""Report expressions of Python in launch files that Python cannot compute."""

from __future__ import annotations

import ast
import builtins
import math
import re
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from sambot_viz.checks.around.launching.actions import SetArgument
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.launching.python_parts import Call
from sambot_viz.checks.around.launching.texts import LaunchTexts, evaluated
from sambot_viz.checks.around.place import key_place, rewritten
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.launch_files import parse_python
from sambot_viz.errors import Fix, Place, Problem
from sambot_viz.robot.xml.element import Element

_CODE = "launch-code"
_STOPS = "ros2 launch stops with it"
_KNOWN = frozenset({*dir(builtins), *dir(math), "math"})
"""Names that launch knows in an expression."""
_COMPARES = re.compile(r"\s*(==|!=|(not\s+)?in\b|is\b)")
_COMPARED = re.compile(r"(==|!=|\bin|\bis|\bnot)\s*$")
_WORD = re.compile(r"(?<!['\"\w.])([A-Za-z_]\w*)(?!['\"\w.(])")
_OPERATORS = frozenset({"and", "or", "not", "in", "is", "if", "else", "True", "False"})
_PLAIN = re.compile(r"^\$\((eval|command)\s+(?!['\"])(.*\S)\s*\)$", re.DOTALL)


class _ExpressionPart(NamedTuple):
    """A part of an expression.

    Attributes:
        written: the text, or the substitution as it is written.
        value: its text; None when unknown.
        is_text: it is no substitution.
    """

    written: str
    value: str | None
    is_text: bool


def uncomputable_expressions(around: Surroundings) -> Iterator[Problem]:
    """Report words in expressions that are neither names of Python nor in quotes."""
    for launch in around.launches:
        for call in launch.called("PythonExpression"):
            yield from _in_call(call, launch)
    roots = [root for package in around.packages for root in package.frontends]
    if not roots:
        return
    # Import late: many packages have Python launch files only.
    from sambot_viz.checks.around.launching.frontend_reader import read_frontend

    for root in roots:
        texts = LaunchTexts()
        for action in read_frontend(root):
            if isinstance(action, SetArgument) and isinstance(action.name, str):
                texts.arguments.setdefault(action.name, texts.settled(action.value))
        for element in root.iter():
            for name, value in element.attributes.items():
                yield from _in_attribute(element, name, value, texts)


def _in_call(call: Call, launch: LaunchFile) -> Iterator[Problem]:
    given = call.given("expression", 0)
    if given is None:
        return
    nodes = given.elts if isinstance(given, ast.List) else [given]
    parts: list[_ExpressionPart] = []
    for node in nodes:
        said = node.value if isinstance(node, ast.Constant) else None
        is_text = isinstance(said, str)
        value = launch.values.text(node)
        written = str(said) if is_text else ast.unparse(node)
        parts.append(_ExpressionPart(written, value, is_text))

    def fix(right: Sequence[_ExpressionPart]) -> Fix:
        items = [repr(p.written) if p.is_text else p.written for p in right]
        return rewritten(given, launch.shown, f"[{', '.join(items)}]")

    yield from _unknown_words(parts, launch.place(given), fix)


def _in_attribute(
    element: Element, name: str, value: str, texts: LaunchTexts
) -> Iterator[Problem]:
    from sambot_viz.checks.around.launching.frontend_reader import (
        text_of,
        written_parts,
    )

    place = element.place
    if place.file.endswith((".yaml", ".yml")):
        place = key_place(place, name)
    for written, is_text in written_parts(value):
        found = None if is_text else _PLAIN.fullmatch(written)
        plain = found is not None and written_parts(found[2])
        words = "".join(part for part, is_plain in plain or () if is_plain)
        if found is not None and " " in words:
            quoted = found[2].replace("'", "\\'")
            yield Problem.at(
                place,
                "error",
                _CODE,
                f"$({found[1]} …) takes one text, and without quotation marks each "
                f"word is another one: {_STOPS}",
                f"write $({found[1]} '{quoted}')",
            )
        elif written.startswith("$(eval"):
            inner = written.removeprefix("$(eval").removesuffix(")").strip()
            inner = inner[1:-1] if inner[:1] in ("'", '"') else inner
            inner = inner.replace("\\'", "'").replace('\\"', '"')
            parts = [
                _ExpressionPart(part, texts.text(text_of(part)), plain)
                for part, plain in written_parts(inner)
            ]
            yield from _unknown_words(parts, place, _in_eval)


def _in_eval(parts: Sequence[_ExpressionPart]) -> Fix:
    text = "".join(part.written for part in parts).replace("'", "\\'")
    return Fix(f"write $(eval '{text}')")


def _unknown_words(
    parts: Sequence[_ExpressionPart],
    place: Place,
    fix: Callable[[Sequence[_ExpressionPart]], Fix],
) -> Iterator[Problem]:
    """Report the words that Python would not know, with the values of the arguments."""
    words = _names(parts)
    if not words:
        return
    better = _in_quotes(parts, words)
    text = "".join(part.value or "" for part in parts)
    first = min(words, key=text.find)
    is_right = not _names(better) and evaluated(_text(better)) is not None
    yield Problem.at(
        place,
        "error",
        _CODE,
        f"the expression becomes {text}, and Python knows no name {first}: {_STOPS}",
        fix(better) if is_right else f"write {first} in quotation marks",
    )


def _text(parts: Sequence[_ExpressionPart]) -> str:
    return "".join(part.value or "" for part in parts)


def _names(parts: Sequence[_ExpressionPart]) -> set[str]:
    """Return the unknown names of an expression; none when a part is unknown."""
    if any(part.value is None for part in parts):
        return set()
    tree = parse_python(_text(parts).strip())
    if tree is None or any(
        isinstance(n, (ast.Lambda, ast.comprehension)) for n in ast.walk(tree)
    ):
        return set()
    return {
        node.id
        for node in ast.walk(tree)
        if isinstance(node, ast.Name) and node.id not in _KNOWN
    }


def _in_quotes(
    parts: Sequence[_ExpressionPart], words: set[str]
) -> list[_ExpressionPart]:
    """Return the parts with quotation marks around the unknown words."""
    named = [p.value for p in parts if not p.is_text and p.value in words]
    quotes = bool(named) or any("'" in p.written or '"' in p.written for p in parts)

    def word(found: re.Match[str]) -> str:
        text = found[1]
        if text in _OPERATORS or text not in words:
            return text
        is_truth = text.lower() in ("true", "false")
        return text.title() if is_truth and not quotes else f"'{text}'"

    better: list[_ExpressionPart] = []
    for at, part in enumerate(parts):
        before = parts[at - 1].written if at else ""
        after = parts[at + 1].written if at + 1 < len(parts) else ""
        if part.is_text:
            text = _WORD.sub(word, part.written)
            better.append(_ExpressionPart(text, text, is_text=True))
        elif part.value in words:
            compares = _COMPARES.match(after) or (
                _COMPARED.search(before) and not before.rstrip().endswith("not")
            )
            is_truth = (part.value or "").lower() in ("true", "false")
            end = f"' == '{part.value}'" if is_truth and not compares else "'"
            end = end.replace("false", "true").replace("False", "True")
            better += [
                _ExpressionPart("'", "'", is_text=True),
                part,
                _ExpressionPart(end, end, is_text=True),
            ]
        else:
            better.append(part)
    return _merged(better)


def _merged(parts: Sequence[_ExpressionPart]) -> list[_ExpressionPart]:
    """Return the parts with each two texts beside each other as one."""
    found: list[_ExpressionPart] = []
    for part in parts:
        if part.is_text and found and found[-1].is_text:
            text = found[-1].written + part.written
            found[-1] = _ExpressionPart(text, text, is_text=True)
        else:
            found.append(part)
    return found
