"""Declared properties with their places in the file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from sambot_viz.errors import UsageError, did_you_mean
from sambot_viz.rviz.properties.property import Property


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
