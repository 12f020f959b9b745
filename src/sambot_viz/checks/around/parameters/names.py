"""Check names of parameters and plugins of well-known nodes."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache

from sambot_viz.checks.around.files.parameters import Parameter, place_of
from sambot_viz.checks.around.parameters.known import (
    KnownParameter,
    PluginClass,
    known_parameters,
)
from sambot_viz.checks.around.parameters.node_parts import (
    CLASS_KEYS,
    NodePart,
    names_in,
    parts_by_node,
)
from sambot_viz.checks.around.parameters.text import instead, type_of
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import source_of, together, write, write_between
from sambot_viz.errors import Fix, Place, Problem, nearest

_LIKENESS = 0.85
_DIGIT = re.compile(r"\d")


def unknown_parameters(around: Surroundings) -> Iterator[Problem]:
    """Report names that a node does not read: misspelt, old or of another part."""
    newest = _newest(around)
    for parts in parts_by_node(around):
        for part in parts:
            for name, parameter in part.given.items() if part.block else ():
                known = part.block.find(name) if part.block else None
                if _of_hidden(name, parameter, around):
                    continue
                if known is None and part.is_known:
                    yield from _unknown(name, parameter, part, parts)
                elif known is not None and known.age.successor:
                    last = newest.get(parameter.place.file, 0)
                    yield from _old(parameter, known, part, last)
            yield from _unknown_groups(part)


def _of_hidden(name: str, parameter: Parameter, around: Surroundings) -> bool:
    """Return whether a plugin knows a name that a second plugin of the part hides."""
    section = parameter.name.removesuffix(name)
    hidden = _hidden(around).get((parameter.place.file, parameter.node, section), ())
    return any(kind.block.find(name) is not None for kind in hidden)


@lru_cache(maxsize=1)
def _hidden(
    around: Surroundings,
) -> Mapping[tuple[str, str, str], Sequence[PluginClass]]:
    """Return file, node and part → its plugins that a later one replaces."""
    found: dict[tuple[str, str, str], list[PluginClass]] = {}
    for file in around.yaml_files:
        for parameter in file.parameters:
            head, _, last = parameter.name.rpartition(".")
            kind = known_parameters().classes.get(parameter.fact.value)
            is_last = file.of(parameter.node)[parameter.name] is parameter
            if last in CLASS_KEYS and kind is not None and not is_last:
                key = (file.shown, parameter.node, f"{head}." if head else "")
                found.setdefault(key, []).append(kind)
    return found


def _unknown_groups(part: NodePart) -> Iterator[Problem]:
    """Report misspelt first parts of names with dots."""
    block = part.block if part.is_known and part.block is not None else None
    free = (
        block.groups - {name.partition(".")[0] for name in part.given} if block else ()
    )
    for head, inner in part.sections.items():
        near = nearest(head, free, _LIKENESS)
        first = next(iter(inner.values()))
        key = next((key for key in first.above if key.value == head), None)
        if near is not None:
            file = first.place.file
            place = place_of(key, file) if key is not None else first.place
            yield Problem.at(
                place,
                "warning",
                "parameter-unknown",
                f"{part.title} has no {head}, but {near}: it does not read what is "
                "below it",
                write(place, head, near),
            )


@lru_cache(maxsize=1)
def _newest(around: Surroundings) -> Mapping[str, int]:
    """Return file → the first distribution that has all its plugins."""
    found: dict[str, int] = {}
    for parameter in around.parameters:
        kind = known_parameters().classes.get(parameter.fact.value)
        if kind is not None:
            file = parameter.place.file
            found[file] = max(found.get(file, 0), kind.age.first)
    return found


def _old(
    parameter: Parameter, known: KnownParameter, part: NodePart, newest: int
) -> Iterator[Problem]:
    """Report a name that no distribution has, or only older ones than the file's."""
    age, block = known.age, part.block
    certain = not age.ends or newest > age.last
    if age.successor in part.given or block is None or not (certain or age.is_old):
        return
    fix = _renamed(parameter, known.name, age.successor)
    new = block.find(age.successor)
    if new is not None and new.kind == "sections" and known.kind == "section":
        text = f'["{parameter.fact.value}"]'
        listed = instead(parameter.written, parameter.place.file, text, "")
        fix = together(f"write {age.successor}: {text}", fix, listed)
    name = known.name + (f" after {age.last_name}" if age.ends else "")
    yield Problem.at(
        parameter.place,
        "warning" if certain else "info",
        "parameter-unknown",
        f"{part.node} has no parameter {name}, but {age.successor}: it does not "
        "read this line",
        fix,
    )


def _renamed(parameter: Parameter, wrong: str, right: str) -> Fix:
    """Return the fix that writes another name, also for one with dots before it."""
    fix, whole = write(parameter.place, wrong, right), parameter.name
    if fix.edits or not whole.endswith(f".{wrong}"):
        return fix
    better = f"{whole.removesuffix(wrong)}{right}"
    return write(parameter.place, whole, better, hint=fix.hint)


def _unknown(
    name: str, parameter: Parameter, part: NodePart, parts: Sequence[NodePart]
) -> Iterator[Problem]:
    """Report a name that misspells another one, or that belongs to another part."""
    right = part.block.meant(name, part.given) if part.block is not None else None
    if right is not None:
        wrong, right = name.rpartition(".")[2], right.rpartition(".")[2]
        cause = f"{part.node} has no parameter {wrong}, but {right}, which is not given"
        fix = _renamed(parameter, wrong, right)
    elif part.section and "plugin" not in part.given and not part.base:
        return
    else:
        common = known_parameters().common
        owners = [
            each
            for each in parts
            if each.block and name not in each.given and not common.find(name)
            if each.block.find(name) is not None
        ]
        if len(owners) != 1:
            return
        cause = f"{part.title} has no parameter {name}, but {owners[0].title} has"
        fix = _moved(parameter, owners[0])
    yield Problem.at(
        parameter.place,
        "warning",
        "parameter-unknown",
        f"{cause}: it does not read this line",
        fix,
    )


def _moved(parameter: Parameter, to: NodePart) -> Fix:
    """Return the fix that moves a line to the parameters of another part."""
    hint, file = f"move this line below {to.title}:", parameter.place.file
    source, first = source_of(file), next(iter(to.given.values()), None)
    if source is None or first is None or type_of(parameter.written) == "list":
        return Fix(hint)
    lines = source.text.splitlines()
    line, target = parameter.place.line, first.place.line
    below = lines[target - 1]
    blanks = below[: len(below) - len(below.lstrip())]
    if not below.lstrip().startswith(f"{first.name.rpartition('.')[2]}:"):
        return Fix(hint)
    here, there = Place(file, line, 1), Place(file, target, 1)
    taken = write_between(here, Place(file, line + 1, 1), "", hint)
    text = f"{blanks}{lines[line - 1].strip()}\n"
    return together(hint, taken, write_between(there, there, text, hint))


def unknown_plugins(around: Surroundings) -> Iterator[Problem]:
    """Report misspelt plugins, and those that do not fit the others of the file."""
    newest = _newest(around)
    for part in (part for parts in parts_by_node(around) for part in parts):
        named = [(p, k.base) for p, k in part.known() if k.base and k.kind == "string"]
        if "plugin" in part.given:
            named.append((part.given["plugin"], part.base))
        for parameter, base in named:
            said, last = parameter.fact.value, newest.get(parameter.place.file, 0)
            found = known_parameters().classes.get(said)
            right = _right_class(said, base, last)
            if found is not None and right is not None:
                yield _old_plugin(parameter, found, right, part, last)
            elif right is not None and not around.said_elsewhere(said):
                yield _no_plugin(parameter, said, right, part, "Nav2 has no plugin")
        for parameter, known in part.lists():
            for name in names_in(parameter) if known.pattern else ():
                right = _right_name(name, known, part)
                if right is not None:
                    cause = f"Nav2 has no {known.base.rpartition('::')[2]}"
                    yield _no_plugin(parameter, name, right, part, cause)


def _no_plugin(
    parameter: Parameter, said: str, right: str, part: NodePart, cause: str
) -> Problem:
    return Problem.at(
        parameter.value_place,
        "error",
        "nav2-plugin",
        f"{cause} {said}: {part.node} stops with an error",
        write(parameter.value_place, said, right),
    )


def _old_plugin(
    parameter: Parameter, old: PluginClass, right: str, part: NodePart, newest: int
) -> Problem:
    """Report a plugin with another name in newer distributions."""
    if certain := newest > old.age.last:
        follows = f"this file has plugins that came later: {part.node} stops"
    else:
        follows = f"later it is {right}"
    return Problem.at(
        parameter.value_place,
        "error" if certain else "info",
        "nav2-plugin",
        f"Nav2 has no plugin {old.name} after {old.age.last_name}, and {follows}",
        write(parameter.value_place, old.name, right),
    )


def _right_class(said: str, base: str, newest: int) -> str | None:
    """Return the class that a text misspells; None for a right or dissimilar one.

    Args:
        said: the class as the file has it.
        base: its base class; empty for an unknown one.
        newest: the first distribution that has all plugins of the file.
    """
    known = known_parameters().classes
    found = known.get(said)
    if found is not None and found.age.last >= newest and not found.age.is_old:
        return None
    likely = {
        name.replace("::", "/"): name
        for name, each in known.items()
        if base in ("", each.base) and each.age.last >= newest
    }
    if found is not None and (found.age.successor or found.age.last >= newest):
        return found.age.successor or None
    near = nearest(said.replace("::", "/"), likely, _LIKENESS)
    return likely[near] if near is not None and said.count("/") < 2 else None


def _right_name(name: str, known: KnownParameter, part: NodePart) -> str | None:
    """Return the plugin for a name without its package."""
    head, _, tail = known.pattern.partition("*")
    classes = [
        k.name for k in known_parameters().classes.values() if k.base == known.base
    ]
    names = [each.removeprefix(head).removesuffix(tail) for each in classes]
    if name in names or name.removesuffix(tail or " ") in names or ":" in name:
        return None
    if any(key in part.sections.get(name, {}) for key in ("class", "plugin")):
        return None
    return nearest(name, names, _LIKENESS)
