"""Reports a text that is not a number where the file defines it, not at each use.

A property, an argument or a macro's parameter has one definition; its value fails in
every element that uses it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from sambot_viz.edits import write
from sambot_viz.errors import Place, Problem
from sambot_viz.robot.urdf.attributes import BadNumber, read_number, read_numbers
from sambot_viz.robot.xacro.diagnose.failed_expansion import line_in, parameters
from sambot_viz.robot.xacro.diagnose.source_files import SourceSet, token_place
from sambot_viz.robot.xml.diagnose.lexer import Token

_NUMBERS = ("number-malformed", "sdf-value", "sdf-number-cut-off")
"""Codes of problems with a text in place of a number."""

_FILLED_UP = re.compile(r'write rpy="(\S+) 0 0"')
_SAID = re.compile(r'(?:\w+="(?P<value>[^"]*)"|<(\w+)>(?P<text>[^<]*)</\w+>)')
_AROUND = re.compile(r"(?<=[\">])[^\"<>]+(?=\"|</)")
_BARE = re.compile(r"(?<![\w.$}{])[A-Za-z_]\w*(?![\w.}])")
_USE = re.compile(r"\$(?:\{([^}]*)\}|\(\s*arg\s+([^)]*)\))")
_NAME = re.compile(r"[A-Za-z_]\w*")
_MINUS = re.compile(r"(?<![\w}])-\$\{([^}]*)\}")
_NEGATIVE = re.compile(r"\s*-[\d.]+\s*")
_PLACES = re.compile(r"xyz\s*=\s*\"[^\"]*\"|<pose[^>]*>[^<]*")
_DEFAULT = re.compile(r"(\w+):?=(\S+)")
_LOOKS_LIKE_A_NUMBER = re.compile(r"\s*[+-]?[.,]?\d")


@dataclass(frozen=True, slots=True)
class _Given:
    """The value of a name.

    Attributes:
        name: property, argument or parameter.
        place: element that gives the value.
        owner: that element, for messages.
        before: text before the value: ``value=`` or ``radius:=``.
        value: value as written.
    """

    name: str
    place: Place
    owner: str
    before: str
    value: str

    def written(self, value: str) -> str:
        """Write another value in the same notation."""
        quote = '"' if self.before.endswith('"') else ""
        return f"{self.before}{value}{quote}"

    @property
    def bad(self) -> BadNumber | None:
        """The fault as one number, or as several; None without a fault."""
        if "$" in self.value or not _LOOKS_LIKE_A_NUMBER.match(self.value):
            return None
        try:
            if self.value.count(",") > 1 or re.search(r",\s", self.value):
                read_numbers(self.value, 3)
            parts = self.value.split()
            if len(parts) > 1:
                read_numbers(self.value, len(parts))
            else:
                read_number(self.value)
        except BadNumber as bad:
            return bad
        return None


def name_given_values(
    problems: Sequence[Problem], files: Iterable[str]
) -> list[Problem]:
    """Merge the problems that come from one wrong value, and return all problems.

    Args:
        problems: problems of a model that comes from xacro.
        files: files that xacro has read, as the user would write them.
    """
    if not any(problem.code in _NUMBERS for problem in problems):
        return list(problems)
    sources = SourceSet.of(files)
    given = list(_given(sources))
    found: dict[_Given, Problem] = {}
    kept: list[Problem] = []
    for problem in problems:
        causes = _causes(problem, sources, given)
        twice = None if causes else _minus_twice(problem, sources, given)
        if twice is not None:
            kept.append(twice)
            continue
        for cause, bad in causes:
            there = found.get(cause)
            if there is None or there.severity != "error":
                found[cause] = _report(problem, cause, bad)
        if not causes:
            kept.append(_bare_name(problem, sources) or _as_written(problem, sources))
    return [*found.values(), *kept]


def _report(problem: Problem, cause: _Given, bad: BadNumber) -> Problem:
    used = Place(problem.file or "", problem.line or 0)
    better = re.fullmatch('write "(.*)"', bad.hint)
    return replace(
        problem,
        message=f"{cause.written(cause.value)} of {cause.owner} {bad.reason} (used on "
        f"{line_in(used, cause.place)})",
        hint=f"write {cause.written(better[1])}" if better else bad.hint,
        file=cause.place.file,
        line=cause.place.line,
        column=cause.place.column,
    )


def _minus_twice(
    problem: Problem, sources: SourceSet, given: Sequence[_Given]
) -> Problem | None:
    """Report a minus before an expression whose value is negative."""
    minus = _MINUS.search(_written(problem, sources))
    if problem.code not in _NUMBERS or "--" not in problem.message or minus is None:
        return None
    values = [one for one in given if one.name == minus[1].strip()]
    used = Place(problem.file or "", problem.line or 0, problem.column)
    if len(values) != 1 or not values[0].value.strip().startswith("-"):
        hint = f"write ${{-({minus[1]})}} for {minus[0]}"
        return replace(problem, hint=hint, edits=())
    (one,) = values
    if not _NEGATIVE.fullmatch(one.value) or _is_usually_bare(sources, one.name):
        bare = minus[0].removeprefix("-")
        fix = write(used, minus[0], bare, f" for {minus[0]}")
        message = f"{problem.message}; {one.owner} is {one.value.strip()} already"
        return replace(problem, message=message, hint=fix.hint, edits=fix.edits)
    return replace(
        problem,
        message=f"{one.written(one.value)} of {one.owner} is negative, and "
        f"{line_in(used, one.place)} writes {minus[0]}, which becomes "
        f"-{one.value.strip()} and is not a number; ROS refuses the model",
        hint=f"write {one.written(one.value.strip().removeprefix('-'))}; or, if it "
        f"has to be negative, ${{-{one.name}}} for {minus[0]}",
        file=one.place.file,
        line=one.place.line,
        column=one.place.column,
        edits=(),
    )


def _is_usually_bare(sources: SourceSet, name: str) -> bool:
    """Return whether most places have a name without a minus before it."""
    texts = (source.text for _, source in sources.sources())
    places = [place[0] for text in texts for place in _PLACES.finditer(text)]
    uses = [use for p in places for use in re.findall(rf"(-?)\$\{{\s*{name}\s*\}}", p)]
    return uses.count("") > uses.count("-")


def _bare_name(problem: Problem, sources: SourceSet) -> Problem | None:
    """Report a property's or parameter's name without ${ and }."""
    said = _SAID.match(problem.message)
    value = "" if said is None else said["value"] or said["text"] or ""
    if problem.code not in _NUMBERS or said is None or not value:
        return None
    known = {p.name for p in sources.named("property") if p.prefixed}
    known.update(_parameters_at(problem, sources))
    bare = [name for name in _BARE.findall(value) if name in known]
    if not bare or value not in _written(problem, sources):
        return None
    better = re.sub(r"\S+", lambda one: _calculated(one[0], known), value)
    _, loss, rest = problem.message.partition("; ROS")
    return replace(
        problem,
        message=f"{said[0]} has the name {bare[0]} as text: xacro replaces it only in "
        f"${{ and }}{loss}{rest}",
        hint=f"write {better.join(_AROUND.split(said[0]))}",
        edits=(),
    )


def _calculated(part: str, known: set[str]) -> str:
    """Write what calculates with names in ${ and }, or else each name."""
    if not known.isdisjoint(_BARE.findall(part)) and not set("${}") & set(part):
        return f"${{{part}}}"
    return _BARE.sub(lambda one: f"${{{one[0]}}}" if one[0] in known else one[0], part)


def _parameters_at(problem: Problem, sources: SourceSet) -> list[str]:
    """Return the parameters of the macro that contains a problem."""
    source, found = sources.get(problem.file or ""), list[str]()
    for token in source.tags if source is not None else ():
        if source is None or source.line(token.start) > (problem.line or 0):
            break
        if token.name == "xacro:macro":
            found = [] if token.closes else parameters(token.get("params") or "")
    return found


def _as_written(problem: Problem, sources: SourceSet) -> Problem:
    """Advise to complete the expression itself, not the number that it gives."""
    one = _FILLED_UP.match(problem.hint)
    if one is None:
        return problem
    value = re.search(r'\brpy\s*=\s*"(\$\{[^}"]*\})"', _written(problem, sources))
    return (
        replace(problem, hint=problem.hint.replace(one[1], value[1]))
        if value
        else problem
    )


def _given(sources: SourceSet) -> Iterator[_Given]:
    """Yield the values of properties, arguments and macro parameters."""
    for file, source in sources.sources():
        for token in source.tags:
            if token.closes or not token.name.startswith("xacro:"):
                continue
            place = token_place(source, file, token)
            yield from _given_by(token, place)


def _given_by(token: Token, place: Place) -> Iterator[_Given]:
    kind, name = token.name.removeprefix("xacro:"), token.get("name") or ""
    if kind == "macro":
        for parameter, value in _DEFAULT.findall(token.get("params") or ""):
            before = f"{parameter}:="
            yield _Given(parameter, place, f"the macro {name}", before, value)
        return
    only = {"property": "value", "arg": "default"}.get(kind)
    for attribute in token.attributes:
        before = f'{attribute.name}="'
        if only is None:
            owner = f"<{token.name}>"
            yield _Given(attribute.name, place, owner, before, attribute.value)
        elif attribute.name == only:
            owner = f"the {'property' if kind == 'property' else 'argument'} {name}"
            yield _Given(name, place, owner, before, attribute.value)


def _causes(
    problem: Problem, sources: SourceSet, given: Sequence[_Given]
) -> list[tuple[_Given, BadNumber]]:
    """Return the wrong values that end up in the element of a problem."""
    if problem.code not in _NUMBERS or problem.file is None or problem.line is None:
        return []
    waiting = _names_in(_written(problem, sources))
    seen: set[str] = set()
    found: list[tuple[_Given, BadNumber]] = []
    while waiting:
        name = waiting.pop()
        if name in seen:
            continue
        seen.add(name)
        for one in given:
            if one.name == name:
                bad = one.bad
                if bad is not None:
                    found.append((one, bad))
                waiting += _names_in(one.value)
    return found


def _names_in(text: str) -> list[str]:
    uses = (f"{use[0]} {use[1]}" for use in _USE.findall(text))
    return [name for use in uses for name in _NAME.findall(use)]


def _written(problem: Problem, sources: SourceSet) -> str:
    """Return an element as written, with the text after its tag."""
    source = sources.get(problem.file or "")
    if source is None or problem.line is None:
        return ""
    tags: list[Token] = source.tags
    for number, token in enumerate(tags):
        first, last = source.line(token.start), source.line(token.end - 1)
        column = source.column(token.start)
        if first <= problem.line <= last and problem.column in (None, column):
            following = tags[number + 1].start if number + 1 < len(tags) else token.end
            return source.text[token.start : following]
    return ""
