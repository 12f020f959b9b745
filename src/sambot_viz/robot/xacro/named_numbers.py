"""Properties and arguments of a xacro model that are numbers, and their uses.

The text is read as it is written, without xacro: what a name is for, and so its unit,
follows from the elements that it reaches through other properties and macros.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal, NamedTuple

from sambot_viz.edits import Extent
from sambot_viz.robot.xacro.diagnose.failed_expansion import parameters
from sambot_viz.robot.xml.diagnose.lexer import Attribute, Token
from sambot_viz.robot.xml.diagnose.source_text import SourceText

Unit = Literal["m", "rad", "°", "kg", ""]

_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*")
_EXPRESSION = re.compile(r"\$\{([^}]*)\}|\$\(\s*arg\s+([\w.-]+)\s*\)")
_FORMULA = re.compile(r"""\s*\$\{[^}'"\[]*\}\s*""")
"""An expression that may be a number: no text, no list."""
_STRING = re.compile(r"""'[^']*'|"[^"]*\"""")
_WORD = re.compile(r"(?<![\w.])[A-Za-z_]\w*(?!\w)")
_ARG = re.compile(r"""xacro\.arg\(\s*['"]([\w.-]+)['"]\s*\)""")
_DEFAULT = re.compile(r"([\w-]+)\s*:?=\s*(\S+)")
_ANGLE_OF = re.compile(r"\b(?:sin|cos|tan)\(([^()]*)\)")
_DEGREES_OF = re.compile(r"\bradians\(([^()]*)\)|([\w.]+)\s*(?:\*\s*pi\s*/|/)\s*180\b")


class _Use(NamedTuple):
    """What an element takes a number for; a signed one may be below zero."""

    unit: Unit
    signed: bool


_LENGTH, _PLACE = _Use("m", False), _Use("m", True)
_ANGLE, _DEGREES, _MASS = _Use("rad", True), _Use("°", True), _Use("kg", False)
_OTHER = _Use("", True)
_USES: Mapping[tuple[str, str], _Use] = {
    ("box", "size"): _LENGTH,
    ("cylinder", "radius"): _LENGTH,
    ("cylinder", "length"): _LENGTH,
    ("capsule", "radius"): _LENGTH,
    ("capsule", "length"): _LENGTH,
    ("sphere", "radius"): _LENGTH,
    ("origin", "xyz"): _PLACE,
    ("origin", "rpy"): _ANGLE,
    ("mass", "value"): _MASS,
    # The text of elements of SDF.
    ("size", ""): _LENGTH,
    ("radius", ""): _LENGTH,
    ("length", ""): _LENGTH,
    ("mass", ""): _MASS,
}
_LIMITS = {"prismatic": _PLACE, "revolute": _ANGLE}


@dataclass(frozen=True, slots=True)
class NamedNumber:
    """A property or an argument whose value is a number, or an expression.

    Attributes:
        kind: which of the two.
        name: its name.
        file: where it is written.
        line: the line of its element, from 1.
        count: how many of this kind and name are before it in the file.
        extent: where the value is in the text [characters].
        value: the number; None for an expression.
        written: the value as it is written.
        unit: of what it is used for; "" when that is not known, or differs.
        signed: whether it may be below zero.
    """

    kind: Literal["property", "arg"]
    name: str
    file: str
    line: int
    count: int
    extent: Extent
    value: float | None
    written: str
    unit: Unit = ""
    signed: bool = True

    @property
    def is_whole(self) -> bool:
        """Whether it counts something: a whole number without a unit."""
        return not self.unit and self.written.lstrip("+-").isdigit()


_Node = tuple[str, str]
"""A name: of a property (""), an argument ("$") or a parameter (of its macro)."""


@dataclass
class _NumberUses:
    """What is used for what, in all files."""

    parameters: dict[str, set[str]] = field(default_factory=dict[str, "set[str]"])
    given: list[NamedNumber] = field(default_factory=list[NamedNumber])
    uses: dict[_Node, list[tuple[str, _Use]]] = field(
        default_factory=dict[_Node, "list[tuple[str, _Use]]"]
    )
    passed: dict[_Node, list[tuple[str, _Node]]] = field(
        default_factory=dict[_Node, "list[tuple[str, _Node]]"]
    )
    calls: dict[str, set[str]] = field(default_factory=dict[str, "set[str]"])
    """In the body of which macros ("" for outside) another one is called."""

    def note_macros(self, source: SourceText) -> None:
        for token in source.tags:
            if token.name == "xacro:macro" and not token.closes:
                name = (token.get("name") or "").removeprefix("xacro:")
                self.parameters[name] = {*parameters(token.get("params") or "")}

    def read(self, file: str, source: SourceText) -> None:
        inside, joint = [""], ""
        counted: dict[tuple[str, str], int] = {}
        tags = source.tags
        for number, token in enumerate(tags):
            if token.name == "xacro:macro":
                if not token.closes:
                    inside.append((token.get("name") or "").removeprefix("xacro:"))
                    self._default(inside[-1], token.get("params") or "")
                if token.kind != "open" and len(inside) > 1:
                    inside.pop()
                continue
            if token.closes:
                continue
            if token.name == "joint":
                joint = token.get("type") or ""
            if token.name in ("xacro:property", "xacro:arg"):
                self._give(file, source, token, inside[-1], counted)
                continue
            end = tags[number + 1].start if number + 1 < len(tags) else token.end
            text = source.text[token.end : end]
            self._element(token, text, inside[-1], joint)

    def _default(self, macro: str, params: str) -> None:
        for name, value in _DEFAULT.findall(params):
            self._take(value, "", (macro, name))

    def _give(
        self,
        file: str,
        source: SourceText,
        token: Token,
        macro: str,
        counted: dict[tuple[str, str], int],
    ) -> None:
        kind = "arg" if token.name == "xacro:arg" else "property"
        names = ("default",) if kind == "arg" else ("value", "default")
        found = [a for a in token.attributes if a.name in names]
        name = token.get("name") or ""
        if not found or not name:
            return
        count = counted.get((kind, name), 0)
        counted[kind, name] = count + 1
        self._take(found[0].value, macro, ("$" if kind == "arg" else "", name))
        extent = _extent(source.text, found[0])
        number = _NUMBER.fullmatch(found[0].value)
        if number is not None:
            start = extent.start + number.start(1)
            extent = Extent(start, start + len(number[1]))
        elif _FORMULA.fullmatch(found[0].value) is None:
            return
        value = None if number is None else float(number[1])
        written = found[0].value if number is None else number[1]
        line = source.line(token.start)
        self.given.append(
            NamedNumber(kind, name, file, line, count, extent, value, written)
        )

    def _element(self, token: Token, text: str, macro: str, joint: str) -> None:
        name = token.name.rpartition(":")[2].rpartition(".")[2]
        is_call = token.name.startswith("xacro:") and name in self.parameters
        if is_call:
            self.calls.setdefault(name, set()).add(macro)
        if "$" in text:
            self._use(text, macro, _USES.get((token.name, ""), _OTHER))
        for attribute in token.attributes:
            if "$" not in attribute.value:
                continue
            if is_call:
                self._take(attribute.value, macro, (name, attribute.name))
                continue
            use = _USES.get((token.name, attribute.name), _OTHER)
            if token.name == "limit" and attribute.name in ("lower", "upper"):
                use = _LIMITS.get(joint, _OTHER)
            self._use(attribute.value, macro, use)

    def _use(self, text: str, macro: str, use: _Use) -> None:
        for node, other in self._names(text, macro):
            self.uses.setdefault(node, []).append((macro, other or use))

    def _take(self, text: str, macro: str, to: _Node) -> None:
        """Note that what a text names is a part of the value of another name."""
        for node, other in self._names(text, macro):
            if other is None:
                self.passed.setdefault(node, []).append((macro, to))
            else:
                # What a sine gives is no angle.
                self.uses.setdefault(node, []).append((macro, other))

    def _names(self, text: str, macro: str) -> Iterator[tuple[_Node, _Use | None]]:
        """Yield the names in a text, and what they are taken for where that says it."""
        own = self.parameters.get(macro, set[str]())
        for expression, argument in _EXPRESSION.findall(text):
            if argument:
                yield ("$", argument), None
                continue
            for name in _ARG.findall(expression):
                yield ("$", name), None
            plain = _STRING.sub("", expression)
            angles = _words(m[1] for m in _ANGLE_OF.finditer(plain))
            degrees = _words(m[1] or m[2] for m in _DEGREES_OF.finditer(plain))
            for name in _words([plain]):
                use = _DEGREES if name in degrees else None
                use = _ANGLE if use is None and name in angles else use
                yield (macro if name in own else "", name), use

    def reached(self, node: _Node) -> set[_Use]:
        """Return what the value of a name is used for, wherever it is passed to."""
        found, seen, waiting = set[_Use](), {node}, [node]
        while waiting:
            at = waiting.pop()
            found.update(use for macro, use in self.uses.get(at, ()) if self._in(macro))
            for macro, to in self.passed.get(at, ()):
                if self._in(macro) and to not in seen:
                    seen.add(to)
                    waiting.append(to)
        return found

    def _in(self, macro: str) -> bool:
        """Tell whether what is in a macro becomes a part of the model."""
        seen, waiting = {macro}, [macro]
        while waiting:
            at = waiting.pop()
            if not at:
                return True
            new = self.calls.get(at, set[str]()) - seen
            seen |= new
            waiting += new
        return False


def named_numbers(sources: Mapping[str, SourceText]) -> list[NamedNumber]:
    """Return the properties and arguments that a model uses, in the order of its files.

    Of arguments with one name only the first counts, as for xacro.

    Args:
        sources: file → its text; the model and what it includes.
    """
    reader = _NumberUses()
    for source in sources.values():
        reader.note_macros(source)
    for file, source in sources.items():
        reader.read(file, source)
    return list(_used(reader))


def _used(reader: _NumberUses) -> Iterator[NamedNumber]:
    arguments: set[str] = set()
    for one in reader.given:
        if one.kind == "arg" and one.name in arguments:
            continue
        uses = reader.reached(("$" if one.kind == "arg" else "", one.name))
        if not uses:
            continue
        if one.kind == "arg":
            arguments.add(one.name)
        known = uses - {_OTHER}
        units = {use.unit for use in known}
        if (one.value is None and not units) or _is_pi(one.value):
            continue
        signed = not known or all(use.signed for use in known)
        yield replace(one, unit=units.pop() if len(units) == 1 else "", signed=signed)


def _is_pi(value: float | None) -> bool:
    """Tell whether a number is π, which is to stay what it is."""
    return value is not None and abs(value - math.pi) < 0.01


def _words(texts: Iterable[str]) -> set[str]:
    return {word for text in texts for word in _WORD.findall(text)}


def _extent(text: str, attribute: Attribute) -> Extent:
    start = text.index("=", attribute.offset) + 1
    start += len(text[start:]) - len(text[start:].lstrip()) + 1
    return Extent(start, start + len(attribute.value))
