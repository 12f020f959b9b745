"""Groups of joints, by what their names begin with."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

UNGROUPED = 30
"""So many joints are shown in one list."""
LARGEST = 8
"""A larger group is divided, where the names say how."""
_RUN = 25
"""Joints that only a number tells apart are divided into groups of so many."""
_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+|[^\W\d_A-Za-z]+")


@dataclass(frozen=True, slots=True)
class JointGroup:
    """Some joints of a robot.

    Attributes:
        label: what their names have in common; empty for a joint without a group.
        names: the joints, in the order of the robot.
    """

    label: str
    names: tuple[str, ...]


def joint_groups(names: Sequence[str]) -> list[JointGroup]:
    """Divide joints into groups, such as "arm_left", "arm_right" and "leg".

    Args:
        names: the joints, in the order of the robot.

    Returns:
        All joints, each in one group; a single group without a label if they are few,
        or if their names have nothing in common.
    """
    if len(names) <= UNGROUPED:
        return [JointGroup("", tuple(names))]
    words = {name: [*_WORD.finditer(name)] for name in names}
    return [*_groups(words, 0)]


def _groups(words: dict[str, list[re.Match[str]]], depth: int) -> Iterator[JointGroup]:
    """Divide joints whose names have the same `depth` first words."""
    names = list(words)
    parts = _parts(words, depth)
    while len(parts) == 1 and len(names) > 1 and _word(words[names[0]], depth):
        depth += 1
        parts = _parts(words, depth)
    label = names[0][: words[names[0]][depth - 1].end()] if depth else ""
    if len(names) <= LARGEST or len(parts) == 1:
        yield JointGroup(label if len(names) > 1 else "", tuple(names))
    elif len(parts) > len(names) / 2:
        yield from _runs(tuple(names), label)
    else:
        for part in parts.values():
            yield from _groups(part, depth + 1)


def _parts(
    words: dict[str, list[re.Match[str]]], depth: int
) -> dict[str, dict[str, list[re.Match[str]]]]:
    parts: dict[str, dict[str, list[re.Match[str]]]] = {}
    for name, found in words.items():
        parts.setdefault(_word(found, depth), {})[name] = found
    return parts


def _word(words: list[re.Match[str]], depth: int) -> str:
    return words[depth].group().lower() if depth < len(words) else ""


def _runs(names: tuple[str, ...], label: str) -> Iterator[JointGroup]:
    """Divide a long list into equal parts."""
    if len(names) <= UNGROUPED:
        yield JointGroup(label, names)
        return
    for at in range(0, len(names), _RUN):
        run = names[at : at + _RUN]
        yield JointGroup(f"{run[0]} … {run[-1]}", run)
