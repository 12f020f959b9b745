"""Declared properties with their places, and what is found when they are read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from sambot_viz.errors import Problem, UsageError, did_you_mean
from sambot_viz.rviz.properties.base import Property
from sambot_viz.rviz.yaml.nodes import Node


class UnknownPropertyError(UsageError):
    """A property that is not declared.

    Attributes:
        path: what was asked for.
    """

    def __init__(self, owner: str, path: str, known: Sequence[str]):
        self.path = path
        super().__init__(f"{owner} has no '{path}'; {did_you_mean(path, known)}")


@dataclass(frozen=True, slots=True)
class Declared:
    """A property with its place in the file.

    Attributes:
        path: keys from the item on, joined by "/".
        keys: the same keys.
        property: the declaration.
        above: the one whose child it is.
    """

    path: str
    keys: tuple[str, ...]
    property: Property
    above: Declared | None = None


class ConfigFindings:
    """Collects what is doubtful in a file.

    Attributes:
        problems: in the order they were found.
    """

    def __init__(self, file: str | None):
        self.file = file
        self.problems: list[Problem] = []

    def add(self, code: str, node: Node, message: str, hint: str = "") -> None:
        """Note a warning at a node; copies are reported at their originals."""
        if node.span is None:
            return
        line, column = node.span.line, node.span.column
        problem = Problem("warning", code, message, hint, self.file, line, column)
        self.problems.append(problem)
