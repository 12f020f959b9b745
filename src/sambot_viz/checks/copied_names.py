"""Name a copied link or joint by the name that other files ask for."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from sambot_viz.checks.targets import CheckedModel
from sambot_viz.edits import source_of, together, write_attribute
from sambot_viz.errors import Fix, Place, Problem
from sambot_viz.robot.slips.twin_names import swap, swapped

_COPIED = {"link-duplicate": "link", "joint-duplicate": "joint"}
"""Code → the duplicate element."""
_VALUES = re.compile(r"=\s*[\"']([\w-]+)[\"']|>\s*([\w-]+)\s*<")


def with_missing_names(
    problems: Sequence[Problem], target: CheckedModel
) -> list[Problem]:
    """Return problems; a copy gets the unused name that a file asks for.

    Args:
        problems: the problems for which ROS refuses the model.
        target: the model, and the packages whose files name its links and joints.
    """
    copied = [p for p in problems if p.code in _COPIED and not p.edits and p.line]
    if not copied:
        return list(problems)
    files = {problem.file or "" for problem in copied} | {str(target.model)}
    texts = [source.text for source in map(source_of, files) if source is not None]
    said = {one or two for text in texts for one, two in _VALUES.findall(text)}
    said.update(_around(target))
    swaps: list[tuple[str, str]] = []
    found: dict[Problem, Problem] = {}
    for problem in sorted(copied, key=lambda each: each.code):
        kind = _COPIED[problem.code]
        given = {
            name
            for text in texts
            for name in re.findall(rf"<{kind}\b[^>]*?\bname=[\"']([^\"']+)", text)
        }
        named = _renamed(problem, said - given, swaps)
        if named is not None:
            found[problem] = replace(problem, hint=named.hint, edits=named.edits)
    return [found.get(problem, problem) for problem in problems]


def _around(target: CheckedModel) -> Iterator[str]:
    """Yield the texts in launch files and parameters."""
    for package in target.packages:
        for launch in package.launches:
            yield from launch.strings
        for file in package.yaml_files:
            for parameter in file.parameters:
                yield from parameter.values


def _renamed(
    problem: Problem, wanted: Iterable[str], swaps: list[tuple[str, str]]
) -> Fix | None:
    """Return the fix that gives a copy the only wanted name of its kind."""
    place = Place(problem.file or "", problem.line or 1, problem.column)
    source = source_of(place.file)
    tag = None if source is None else source.tag(source.offset(place))
    extent = None if tag is None else tag.values.get("name")
    if source is None or tag is None or extent is None:
        return None
    name = source.text[slice(*extent)]
    pairs = {other: pair for other in wanted if (pair := swap(name, other))}
    if not pairs:
        pairs = {swapped(name, pair): pair for pair in swaps} | pairs
        pairs.pop(name, None)
    if len(pairs) != 1:
        return None
    ((right, pair),) = pairs.items()
    swaps.append(pair)
    hint = f'write name="{right}", which other elements or files name'
    fixes = [write_attribute(place, "name", name, right)]
    end = source.end_of(tag) or tag.end
    child = re.compile(r"<child\b").search(source.text, tag.end, end)
    inner = None if child is None else source.tag(child.start())
    link = None if inner is None else inner.values.get("link")
    if child is not None and link is not None:
        old = source.text[slice(*link)]
        line = source.text.count("\n", 0, child.start()) + 1
        column = child.start() - source.text.rfind("\n", 0, child.start())
        at = Place(place.file, line, column)
        new = swapped(old, pair)
        if new != old:
            fixes.append(write_attribute(at, "link", old, new))
            hint += f', and <child link="{new}"/>'
    return together(hint, *fixes)
