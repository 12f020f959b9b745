"""Nodes that a display declares: made, shown to rays and removed with the display."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any, Generic, Protocol, TypeVar

import viser

from sambot_viz.displays.picking.placed import Placed
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.geometry import Matrix


class Drawable(Protocol):
    """What draws something in the scene."""

    def placed(
        self, T_fixed_above: Matrix, item: Selectable | None, /
    ) -> Iterable[Placed]:
        """Yield it for rays (see `scene.points.PointNode.placed`)."""
        ...

    def remove(self) -> None:
        """Take it out of the scene."""
        ...


N = TypeVar("N", bound=Drawable)


class HasNodes(Protocol):
    """A display that keeps the nodes that its class declares."""

    nodes: dict[DisplayNode[Any], Any]


class DisplayNode(Generic[N]):
    """Declares a node in the body of the class of a display.

    Args:
        make: makes it, from the scene and its name.
        suffix: ends its name, after the key of the display.
    """

    def __init__(self, make: Callable[[viser.SceneApi, str], N], suffix: str) -> None:
        self.make, self.suffix = make, suffix

    def __get__(self, display: HasNodes, owner: type | None = None) -> N:
        """Return the node of a display."""
        return display.nodes[self]


def nodes_of(
    owner: type, scene: viser.SceneApi, key: str
) -> dict[DisplayNode[Any], Any]:
    """Return the nodes that a class declares, those of its bases first.

    Args:
        owner: the class of a display.
        scene: where to draw.
        key: of the display.
    """
    return {one: one.make(scene, f"/{key}{one.suffix}") for one in _declared(owner)}


def _declared(owner: type) -> Iterator[DisplayNode[Any]]:
    for base in reversed(owner.__mro__):
        for one in vars(base).values():
            if isinstance(one, DisplayNode):
                yield one
