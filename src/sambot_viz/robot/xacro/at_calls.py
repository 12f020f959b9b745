"""Move findings within a macro to where their cause is: a call, or an expression.

What is wrong is known of the expanded model. Where a line of a macro has only a
parameter, its value is wrong in the call; and what is to be written into a macro that
is called for several parts is not the name of one of these.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import PurePath

from sambot_viz.edits import SourceFile, Tag, source_of
from sambot_viz.errors import Place, Problem
from sambot_viz.robot.xacro.at_properties import at_properties
from sambot_viz.robot.xacro.macro_texts import (
    CallText,
    Extent,
    MacroText,
    Written,
    as_written,
    calls_of,
    macro_around,
    property_value,
    sources,
)

_NAME = re.compile(r"\$\{\s*([A-Za-z_]\w*)\s*\}")
_WRITE = re.compile(
    r"write (?:<(?P<tag>\w+)(?: (?P<own>[\w:.-]+)=\"(?P<given>[^\"<>]*)\"/>|>"
    r"(?P<inner>[^<>]+)</\w+>)|(?P<name>[\w:.-]+)=\"(?P<value>[^\"]*)\""
    r"|(?P<text>[^\s,;<>\"=:]+))(?=$|, and |; )"
)
_CALL = re.compile(r", from the macro call on (?:line (\d+)|(.+):(\d+))$")
_HERE = re.compile(r"(?<=\()line (?=\d)")
_NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e-?\d+)?(?![\w.])")
_WORD = re.compile(r"[A-Za-z]\w+")
_QUOTED = re.compile(r'"([^"]*)"')
_BEFORE, _BEHIND = r"(?<![A-Za-z0-9<])(?<!</)", r"(?![A-Za-z0-9])(?!\w*=)"
"""What is around a name, or a part of one, that is no name of an element."""
_VERBS = ("write ", "add ")
_FACTORS = {2.0: "${{{} * 2}}", 0.5: "${{{} / 2}}", -1.0: "${{-{}}}"}
"""Factor between the right number and a wrong one → how to write it."""
_WITHIN = {"mass-in-grams": ("mass", "value")}
"""Code → the element in that of the finding whose value is wrong, and its attribute."""
_DEEPEST = 4


def at_calls(problems: Iterable[Problem], files: Iterable[str]) -> list[Problem]:
    """Return findings with those in macros where their cause is.

    Args:
        problems: with their edits.
        files: those of the model, as the user would write them.
    """
    found, read = list(problems), list[tuple[str, SourceFile]]()
    every = tuple(files)
    for number, problem in enumerate(found):
        spot = _spot(problem)
        if spot is None:
            continue
        read = read or sources(as_written(every, problem))
        moved = _Move(problem, *spot, read).made()
        found[number] = problem if moved is None else moved
    return at_properties(found, every)


def _spot(problem: Problem) -> tuple[Written, Tag, MacroText] | None:
    """Return the element of a finding, and the macro around it; None outside of one."""
    if problem.file is None or problem.line is None or problem.column is None:
        return None
    source = source_of(problem.file)
    if source is None or "<xacro:macro" not in source.text:
        return None
    offset = source.offset(Place(problem.file, problem.line, problem.column))
    tag, macro = source.tag(offset), macro_around(problem.file, source, offset)
    if tag is None or macro is None:
        return None
    end = source.end_of(tag) or tag.end
    return Written(problem.file, source, Extent(offset, end)), tag, macro


@dataclass(frozen=True, slots=True)
class _Move:
    problem: Problem
    element: Written
    tag: Tag
    macro: MacroText
    files: Sequence[tuple[str, SourceFile]]

    def made(self) -> Problem | None:
        """Return the finding where its cause is; None where it is there already."""
        calls = calls_of(self.macro.name, self.files)
        if not calls:
            return None
        return self._into_call(calls) or self._as_expression(calls)

    def _into_call(self, calls: Sequence[CallText]) -> Problem | None:
        said = _WRITE.match(self.problem.hint)
        found = None if said is None else self._parameter(said)
        if found is None:
            return None
        parameter, right = found
        macro, given = self.macro, list[Written]()
        for _ in range(_DEEPEST):
            given = self._given(macro, calls, parameter)
            passed = _NAME.fullmatch(given[0].text) if len(given) == 1 else None
            around = (
                None
                if passed is None
                else macro_around(*given[0][:2], given[0].extent.start)
            )
            if passed is None or around is None or passed[1] not in around.defaults:
                break
            macro, parameter = around, passed[1]
            calls = calls_of(macro.name, self.files)
        return self._at(given, macro, parameter, right) if given else None

    def _parameter(self, said: re.Match[str]) -> tuple[str, str] | None:
        """Return the parameter that is all of the wrong value, and its right value."""
        tag, source = self.tag, self.element.source
        right = said["given"] or said["inner"] or said["value"] or said["text"]
        if said["tag"] and said["tag"] != source.text[slice(*tag.name)]:
            return None
        if (inner := _WITHIN.get(self.problem.code)) is not None:
            written = re.search(
                rf'<{inner[0]}(?:\s+{inner[1]}="|>)(\$\{{\s*\w+\s*\}})',
                self.element.text,
            )
            values = [written[1]] if written else []
        elif name := said["own"] or said["name"]:
            values = (
                [source.text[slice(*tag.values[name])]] if name in tag.values else []
            )
        else:
            start = self.element.extent.start
            values = [source.text[slice(*at)] for at in source.values(start)]
        names = [name[1] for value in values if (name := _NAME.fullmatch(value))]
        if len(names) != 1 or names[0] not in self.macro.defaults or not right:
            return None
        return names[0], right

    def _given(
        self, macro: MacroText, calls: Sequence[CallText], parameter: str
    ) -> list[Written]:
        """Return the values of a parameter that are wrong: one, or equal ones."""
        called = [call for call in calls if self._is_the_call(call)]
        default = macro.defaults.get(parameter)
        values = [c.values.get(parameter, default) for c in called or calls]
        pieces = list(dict.fromkeys(v for v in values if v is not None))
        if len(pieces) == 1 or len({piece.text for piece in pieces}) == 1:
            return pieces
        message = self.problem.message
        numbers = set(map(float, _NUMBER.findall(message)))
        lists = [_numbers(text) for text in _QUOTED.findall(message)]
        found = [
            p
            for p in pieces
            if self._value(p.text) in numbers or (_numbers(p.text) or ()) in lists
        ]
        return found if len(found) == 1 else []

    def _is_the_call(self, call: CallText) -> bool:
        said = _CALL.search(self.problem.message)
        if said is None:
            return False
        file = said[2] or self.element.file
        return (call.tag.file, call.tag.place.line) == (file, int(said[1] or said[3]))

    def _value(self, text: str) -> float | None:
        name = _NAME.fullmatch(text)
        if name is not None:
            return property_value(name[1], self.files)
        try:
            return float(text)
        except ValueError:
            return None

    def _at(
        self, given: Sequence[Written], macro: MacroText, parameter: str, right: str
    ) -> Problem:
        first = given[0]
        is_default = first == macro.defaults[parameter]
        name, old = _NAME.fullmatch(first.text), self._value(first.text)
        if name is not None and old and _NUMBER.fullmatch(right):
            factor = next((f for f in _FACTORS if _near(float(right), f * old)), None)
            right = _FACTORS[factor].format(name[1]) if factor else right
        edits = [piece.edit(right) for piece in given]
        if "$" in first.text and "$" not in right:
            edits = []
        hint = f"{parameter}:={right}" if is_default else f'{parameter}="{right}"'
        message = _CALL.sub("", self.problem.message)
        if first.file != self.element.file:
            message = _HERE.sub(f"{PurePath(self.element.file).name} line ", message)
        what = "the default of this parameter" if is_default else "given in this call"
        line = self.element.place.line
        name = PurePath(self.element.file).name
        here = "" if first.file == self.element.file else f"{name} "
        place = first.place
        return replace(
            self.problem,
            message=f"{message}; it is {what} of {macro.name} ({here}line {line})",
            hint=f"write {hint}",
            file=place.file,
            line=place.line,
            column=place.column,
            edits=tuple(edits),
        )

    def _as_expression(self, calls: Sequence[CallText]) -> Problem | None:
        """Write the parameter for what one call gives for it."""
        if "$" in _new(self.problem):
            return None
        named = [call for call in calls if self._is_the_call(call)]
        if not self.problem.edits and self._names_several(calls):
            return None
        for call in named or calls:
            given = [value.text for value in call.values.values()]
            values = {
                value.text: name
                for name, value in call.values.items()
                if name in self.macro.defaults and _WORD.fullmatch(value.text)
                if given.count(value.text) == 1
            }
            made = self._with_parameters(values)
            if _new(made) != _new(self.problem) and self._is_used(_new(made)):
                return made
        return None

    def _names_several(self, calls: Sequence[CallText]) -> bool:
        """Return whether the hint is about the parts of more than one call."""
        hint, said = self.problem.hint, list[set[str]]()
        for call in calls:
            said.append({v.text for v in call.values.values() if v.text in hint})
        return len({frozenset(words) for words in said if words}) > 1

    def _with_parameters(self, values: dict[str, str]) -> Problem:
        if not values:
            return self.problem
        words = "|".join(sorted(map(re.escape, values), key=len, reverse=True))
        pattern = re.compile(rf"{_BEFORE}(?:{words}){_BEHIND}")

        def changed(text: str) -> str:
            return pattern.sub(lambda one: f"${{{values[one[0]]}}}", text)

        edits = tuple(replace(e, text=changed(e.text)) for e in self.problem.edits)
        return replace(self.problem, hint=changed(self.problem.hint), edits=edits)

    def _is_used(self, written: str) -> bool:
        """Return whether the macro has expressions like these at other places."""
        names = re.findall(r"[\w/]*\$\{\w+\}[\w/]*", written)
        return bool(names) and all(name in self.macro.body.text for name in names)


def _new(problem: Problem) -> str:
    """Return what a finding wants to be written; of one without edits its hint."""
    edits = " ".join(edit.text for edit in problem.edits)
    return edits or (problem.hint if problem.hint.startswith(_VERBS) else "")


def _near(one: float, other: float) -> bool:
    return abs(one - other) <= 1e-4 * abs(one)


def _numbers(text: str) -> tuple[float, ...] | None:
    """Return the numbers of a list; None where something else is in it."""
    try:
        return tuple(float(part) for part in text.split())
    except ValueError:
        return None
