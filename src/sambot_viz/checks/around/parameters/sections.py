"""Check names and levels of the parts that lists of well-known nodes name."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

import yaml

from sambot_viz.checks.around.files.parameters import Parameter, place_of
from sambot_viz.checks.around.parameters.known import KnownParameter
from sambot_viz.checks.around.parameters.node_parts import (
    Given,
    NodePart,
    names_in,
    parts_by_node,
)
from sambot_viz.checks.around.place import moved, where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import write, write_between
from sambot_viz.errors import Fix, Place, Problem, nearest
from sambot_viz.robot.slips.vocabulary import is_one_slip

_DIGIT = re.compile(r"\d")
_LIKENESS = 0.8
_LAYER = "nav2_costmap_2d::Layer"
"""The plugins that nobody else asks for by their names."""


def unknown_sections(around: Surroundings) -> Iterator[Problem]:
    """Report layers, plugins and sensors with another name, or at another level."""
    for parts in parts_by_node(around):
        for part in parts:
            named = {name for one, _ in part.lists() for name in names_in(one)}
            for one, known in part.lists():
                for name in names_in(one):
                    yield from _split_section(name, named, part)
                if not known.pattern:
                    yield from _lacking(one, known, part, parts, around)


def _lacking(
    one: Parameter,
    known: KnownParameter,
    part: NodePart,
    parts: Sequence[NodePart],
    around: Surroundings,
) -> Iterator[Problem]:
    """Report the names of a list without a part."""
    is_plugin = known.base != ""
    named = {name for each, _ in part.lists() for name in names_in(each)}
    filled = [s for s, inner in part.sections.items() if "plugin" in inner]
    present = filled if is_plugin else list(part.sections)
    left = [section for section in present if section not in named]
    lacking = [name for name in names_in(one) if name not in present]
    for name in lacking:
        near = left[0] if len(left) == 1 else nearest(name, left, _LIKENESS)
        level = _other_level(name, one, part, parts, is_plugin=is_plugin)
        group = _without_name(name, one, part, around) if len(lacking) == 1 else None
        if level is not None:
            yield level
        elif group is not None:
            yield group
        elif near is not None:
            yield _other_section(one, name, near, part, known, around)
        elif is_plugin and _lacks(one, name, known, part, around):
            yield _no_section(one, name, part)


def _key_of(head: str, inner: Given) -> yaml.ScalarNode | None:
    """Return the key of a part; None where its lines have it before a dot."""
    above = (key for each in inner.values() for key in each.above)
    return next((key for key in above if key.value == head), None)


def _other_section(
    one: Parameter,
    name: str,
    near: str,
    part: NodePart,
    known: KnownParameter,
    around: Surroundings,
) -> Problem:
    """Report a part with another name, and correct the one that nothing else uses."""
    inner, at = part.sections[near], one.value_place
    key = _key_of(near, inner)
    place = next(iter(inner.values())).place
    place = place if key is None else place_of(key, one.place.file)
    follows = f"{part.node} stops with an error"
    is_usual = _rank(name, known) < _rank(near, known)
    is_asked = known.base != _LAYER or is_one_slip(near, name)
    if key is not None and is_usual and is_asked and not around.said_elsewhere(near):
        return Problem.at(
            place,
            "error",
            "nav2-section",
            f"{one.name} names {name} ({where(at, place)}), but this section is called "
            f"{near}: {follows}",
            write(place, near, name),
        )
    return Problem.at(
        at,
        "error" if known.base else "warning",
        "nav2-section",
        f"{one.name} names {name}, but the section is called {near} "
        f"({where(place, one.place)}): "
        + (follows if known.base else "what is below it is not used"),
        write(at, name, near),
    )


def _rank(name: str, known: KnownParameter) -> int:
    """Return which of the usual lists has a name, 0 for the first one."""
    ranks = (rank for rank, names in enumerate(known.own) if name in names)
    return next(ranks, len(known.own))


def _other_level(
    name: str,
    one: Parameter,
    part: NodePart,
    parts: Sequence[NodePart],
    *,
    is_plugin: bool,
) -> Problem | None:
    """Report a part of a listed name that is inside or beside another part."""
    for other, inner in part.sections.items():
        below = {n: p for n, p in inner.items() if n.startswith(f"{name}.")}
        key, above = _key_of(name, below), _key_of(other, below)
        if (
            key is None
            or above is None
            or (is_plugin and f"{name}.plugin" not in below)
        ):
            continue
        place = place_of(key, one.place.file)
        level = (place.column or 1) - (place_of(above, one.place.file).column or 1)
        return _at_level(place, name, one, f"inside {other}", moved(place, -level))
    outer = part.section.rpartition(".")[0]
    parent = next((each for each in parts if each.section == outer), None)
    key = None
    if part.section and parent is not None and name in parent.sections:
        key = _key_of(name, parent.sections[name])
    if key is None or parent is None:
        return None
    place, last = place_of(key, one.place.file), list(part.given.values())[-1]
    is_next = last.written.end_mark.line in (place.line - 1, place.line - 2)
    fix = Fix(f"move {name}: and what is below it into {part.section}:")
    fix = moved(place, 2) if is_next else fix
    return _at_level(place, name, one, f"beside {part.section}", fix)


def _at_level(place: Place, name: str, one: Parameter, level: str, fix: Fix) -> Problem:
    return Problem.at(
        place,
        "error",
        "nav2-section",
        f"{one.name} names {name} ({where(one.place, place)}), but this section is "
        f"{level}, at another level: it is not read",
        fix,
    )


def _without_name(
    name: str, one: Parameter, part: NodePart, around: Surroundings
) -> Problem | None:
    """Report the lines of a part that follow those of another, without its name."""
    file = next((f for f in around.yaml_files if f.shown == one.place.file), None)
    for other, inner in part.sections.items():
        above, last = _key_of(other, inner), inner.get("plugin")
        if file is None or above is None or last is None:
            continue
        same = [p for p in file.parameters if p.above[-1:] == (above,)]
        first, *more = [p for p in same if p.name == last.name] or [None]
        if first is None or len(more) != 1 or first.fact.value == last.fact.value:
            continue
        at, blanks = Place(file.shown, last.place.line, 1), above.start_mark.column
        return Problem.at(
            last.place,
            "error",
            "nav2-section",
            f"{one.name} names {name} ({where(one.place, at)}), which has no section, "
            f"and {other} has a second plugin here: the line {name}: is missing above",
            write_between(
                at, at, f"{' ' * blanks}{name}:\n", f"add a line {name}: above this one"
            ),
        )
    return None


def _split_section(name: str, named: set[str], part: NodePart) -> Iterator[Problem]:
    """Report lines in a misspelt section, beside the right one of a listed name."""
    for other, inner in part.sections.items():
        is_slip = other not in named and is_one_slip(other, name)
        if not is_slip or name not in part.sections or _DIGIT.search(name + other):
            continue
        for below, parameter in inner.items():
            yield Problem.at(
                parameter.place,
                "warning",
                "nav2-section",
                f"{part.title} lists {name}, but this is for {other}: it does not read "
                "this line",
                write(
                    parameter.place,
                    f"{other}.{below}",
                    f"{name}.{below}",
                    hint=f"write {name}",
                ),
            )


def _lacks(
    one: Parameter,
    name: str,
    known: KnownParameter,
    part: NodePart,
    around: Surroundings,
) -> bool:
    """Return whether a file has other plugins of a list, and none has this one."""
    names = names_in(one)
    if tuple(names) in known.own or known.kind == "section":
        return False
    others = any("plugin" in part.sections.get(other, {}) for other in names)
    wanted = f"{name}.plugin"
    elsewhere = any(p.name.endswith(wanted) for p in around.parameters)
    return others and not elsewhere and not around.said_elsewhere(wanted)


def _no_section(one: Parameter, name: str, part: NodePart) -> Problem:
    return Problem.at(
        one.value_place,
        "error",
        "nav2-section",
        f"{one.name} names {name}, but nothing says the plugin of {name}: {part.node} "
        "stops with an error",
        f"add {name}: with its plugin: to the parameters of {part.title}, or delete "
        f"{name} from the list",
    )
