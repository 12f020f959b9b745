"""Report names without the prefix that the link or joint itself has."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from sambot_viz.checks.rule import Subject
from sambot_viz.edits import SourceFile
from sambot_viz.errors import Fix, Problem
from sambot_viz.robot.xacro.macro_texts import Written, sources, tags_in

_NAMED = {"parent": "link", "child": "link", "mimic": "joint"}
"""Element → the kind of part that it names, in the attribute of that name."""
_PREFIXED = re.compile(r"((?:\$\{[^}]*\}|\$\(arg [^)]*\))[_/]?)([^$]+)")


def names_without_prefix(subject: Subject) -> Iterator[Problem]:
    """Report parents, children and mimics that are right for the empty prefix only.

    ${prefix}base_link is base_link where the prefix is empty; with any other one, ROS
    refuses the model.
    """
    read = sources(subject.files)
    values = {value.text for _, value in _values(read)}
    if not any(map(_PREFIXED.fullmatch, values)):
        return
    given = {v.text for (tag, key), v in _values(read) if _makes_names(tag, key)}
    for file, source in read:
        own = list(_values([(file, source)]))
        for (tag, key), value in own:
            kind = _NAMED.get(tag, "")
            if key != kind or "$" in value.text or value.text in given:
                continue
            names = {v.text for where, v in own if where == (kind, "name")}
            found = [name for name in names if _is_of(name, value.text)]
            if len(found) == 1:
                yield _problem(tag, value, kind, found[0], key)


def _makes_names(tag: str, key: str) -> bool:
    """Return whether a part gets its name there, or from a call of a macro."""
    return key == "name" if tag in ("link", "joint") else _is_call(tag, key)


def _is_call(tag: str, key: str) -> bool:
    return tag.startswith("xacro:") and "parent" not in key


def _is_of(name: str, bare: str) -> bool:
    prefixed = _PREFIXED.fullmatch(name)
    return prefixed is not None and prefixed[2] == bare


def _problem(tag: str, value: Written, kind: str, name: str, key: str) -> Problem:
    prefix = name.removesuffix(value.text)
    return Problem.at(
        value.place,
        "warning",
        "name-without-prefix",
        f'<{tag} {key}="{value.text}"> lacks {prefix}, which the name of the {kind} '
        "has: unless that is empty, ROS refuses the model",
        Fix(f'write {key}="{name}"', (value.edit(name),)),
    )


def _values(
    read: Sequence[tuple[str, SourceFile]],
) -> Iterator[tuple[tuple[str, str], Written]]:
    """Yield the attributes of all elements: ((element, attribute), value)."""
    for file, source in read:
        for tag in tags_in(source):
            element = source.text[slice(*tag.name)]
            for key, extent in tag.values.items():
                yield (element, key), Written(file, source, extent)
