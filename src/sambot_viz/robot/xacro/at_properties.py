"""Move findings about the value of a property to where the property has it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import PurePath

from sambot_viz.edits import Extent, SourceFile, source_of, write
from sambot_viz.errors import Place, Problem
from sambot_viz.robot.xacro.macro_texts import (
    Written,
    as_written,
    macro_around,
    properties_in,
    sources,
)

_NAME = re.compile(r"\$\{\s*([A-Za-z_]\w*)\s*\}")
_WRITE = re.compile(
    r"write (?:(?P<name>[\w:.-]+)=\"(?P<value>[^\"$]*)\"|(?P<text>[^\s,;<>\"=$]+))$"
)
_NUMBER = re.compile(r"[+-]?[\d.]+(?:e[+-]?\d+)?")
_CALL = re.compile(r", from the macro call on .*?:?\d+(?=$|;)")


def at_properties(problems: Iterable[Problem], files: Sequence[str]) -> list[Problem]:
    """Return findings; one whose value is all of a property is at the property.

    Args:
        problems: with their edits.
        files: those of the model, as the user would write them.
    """
    read = list[tuple[str, SourceFile]]()
    found = list(problems)
    for at, problem in enumerate(found):
        said = None if problem.edits else _WRITE.match(problem.hint)
        if said is None or problem.file is None or problem.column is None:
            continue
        name = _only_name(problem, said["name"])
        if name is None:
            continue
        read = read or sources(as_written(files, problem))
        right = said["value"] if said["name"] else said["text"]
        properties = list(properties_in(read))
        given = [value for named, value in properties if named == name]
        others = [named for named, value in properties if value.text == right]
        if len(given) != 1 or "$" in given[0].text or right.startswith("/"):
            continue
        if _NUMBER.fullmatch(right) and _uses(name, read) > 1:
            # Its other uses may need the number that it has.
            continue
        if others:
            found[at] = _with_other(problem, name, others) or problem
        else:
            found[at] = _moved(problem, name, given[0], right)
    return found


def _uses(name: str, files: Iterable[tuple[str, SourceFile]]) -> int:
    """Return how many expressions have a name."""
    pattern = re.compile(rf"\$\{{[^}}]*\b{name}\b")
    return sum(len(pattern.findall(source.text)) for _, source in files)


def _only_name(problem: Problem, attribute: str | None) -> str | None:
    """Return the name that is all of the wrong value; None for a parameter."""
    place = Place(problem.file or "", problem.line or 1, problem.column)
    source = source_of(place.file)
    offset = 0 if source is None else source.offset(place)
    tag = None if source is None else source.tag(offset)
    if source is None or tag is None:
        return None
    extents: list[Extent] = source.values(offset)
    if attribute is not None:
        extents = [tag.values[attribute]] if attribute in tag.values else []
    values = (_NAME.fullmatch(source.text[slice(*extent)]) for extent in extents)
    names = [value[1] for value in values if value is not None]
    macro = macro_around(place.file, source, offset)
    if len(names) != 1 or (macro is not None and names[0] in macro.defaults):
        return None
    return names[0]


def _with_other(problem: Problem, name: str, others: Sequence[str]) -> Problem | None:
    """Return a finding that writes the only property with the right value."""
    place = Place(problem.file or "", problem.line or 1, problem.column)
    fix = write(place, f"${{{name}}}", f"${{{others[0]}}}")
    if len(others) != 1 or not fix.edits:
        return None
    return replace(problem, hint=fix.hint, edits=fix.edits)


def _moved(problem: Problem, name: str, given: Written, right: str) -> Problem:
    where = PurePath(problem.file or "").name
    here = "" if given.file == problem.file else f"{where} "
    message = _CALL.sub("", problem.message)
    return replace(
        problem,
        message=f"{message}; it is the property {name} (used on {here}line "
        f"{problem.line})",
        hint=f'write value="{right}"',
        file=given.file,
        line=given.place.line,
        column=given.place.column,
        edits=(given.edit(right),),
    )
