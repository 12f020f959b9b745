"""Find names that are easily confused or hard to type."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from sambot_viz.checks.rule import Subject
from sambot_viz.errors import Problem
from sambot_viz.robot.joint import Joint
from sambot_viz.robot.model import Link


def names_that_differ_in_case(subject: Subject) -> Iterator[Problem]:
    """Two links, or two joints, such as "arm" and "Arm"."""
    yield from _case_among("link", subject.robot.links.values())
    yield from _case_among("joint", subject.robot.joints.values())


def _case_among(kind: str, named: Iterable[Link | Joint]) -> Iterator[Problem]:
    seen: dict[str, Link | Joint] = {}
    for item in named:
        other = seen.setdefault(item.name.lower(), item)
        if other is item:
            continue
        where = f" (line {other.place.line})" if other.place else ""
        yield Problem.at(
            item.place,
            "warning",
            "names-differ-in-case",
            f"the {kind} names {other.name}{where} and {item.name} differ only "
            "in capital letters; ROS treats them as two different names",
            "rename one of them, or use one name if the other is a typing error",
        )


def names_with_spaces(subject: Subject) -> Iterator[Problem]:
    """A link or joint such as "left wheel"."""
    robot = subject.robot
    for item in (*robot.links.values(), *robot.joints.values()):
        if any(c.isspace() for c in item.name):
            kind = "link" if isinstance(item, Link) else "joint"
            yield Problem.at(
                item.place,
                "info",
                "name-with-blank",
                f'the {kind} name "{item.name}" contains a space: it works, but '
                "commands and launch files split it in two",
                f'write "{"_".join(item.name.split())}"',
            )
