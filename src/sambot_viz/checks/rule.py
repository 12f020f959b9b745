"""Define the input of a rule, and text helpers of several rules.

A rule is a function, and one line in `RULES`. It only reads the robot, its mesh
files, and the text it came from.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.errors import Edit, Problem
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Language, Link, Shape

if TYPE_CHECKING:
    from sambot_viz.checks.around.workspace import Package
    from sambot_viz.meshes.mesh import Mesh


@dataclass(frozen=True, slots=True)
class Subject:
    """The robot that a rule checks.

    Attributes:
        robot: the robot.
        files: its source files, as the user would write them, the model first; empty
            for a model from text.
        mesh: reads a mesh file; returns a Problem for one that RViz cannot draw, and
            None for an unread one.
        packages: the packages of the robot, the model's first.
        edited: edits → the subject with the edited robot, as a cache.
        texts: whole path of an edited file → its text.
    """

    robot: Robot
    files: tuple[str, ...]
    mesh: Callable[[Path], Mesh | Problem | None]
    packages: tuple[Package, ...] = ()
    edited: dict[tuple[Edit, ...], Subject | None] = field(
        default_factory=dict["tuple[Edit, ...]", "Subject | None"], compare=False
    )
    texts: Mapping[str, str] = field(default_factory=dict[str, str], compare=False)

    def shapes(self) -> Iterator[tuple[Link, Shape]]:
        """Yield the visuals and collisions of all links, each with its link."""
        for link in self.robot.links.values():
            for shape in (*link.visuals, *link.collisions):
                yield link, shape


Rule = Callable[[Subject], Iterable[Problem]]
"""Finds one kind of mistake that ROS accepts and that causes trouble later."""


def listed(names: Iterable[str], most: int = 6) -> str:
    """List names as a person would: "a, b and c"."""
    known = list(names)
    if len(known) > most:
        return f"{', '.join(known[:most])} and {len(known) - most} more"
    if len(known) < 2:
        return "".join(known)
    return f"{', '.join(known[:-1])} and {known[-1]}"


def axis_text(xyz: str, language: Language) -> str:
    """Write the direction of a joint's axis, as SDF or URDF has it."""
    return f"<xyz>{xyz}</xyz>" if language == "sdf" else f'<axis xyz="{xyz}"/>'


def number(value: float) -> str:
    """Write a number without noise: 1.5708, -90, 0.5."""
    return f"{value:.5g}"
