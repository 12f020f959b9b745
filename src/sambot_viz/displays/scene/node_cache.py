"""Nodes that are sent to the browsers again only when they would look different."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import viser

from sambot_viz import viser_private

Handle = viser.SceneNodeHandle


class NodeCache:
    """A few nodes, and what they were made from."""

    def __init__(self) -> None:
        self._state: object = None
        self.handles: tuple[Handle, ...] = ()

    def show(self, state: object, make: Callable[[], Iterable[Handle]]) -> None:
        """Make the nodes, unless they were made from the same state and still exist.

        Args:
            state: everything that `make` depends on, the nodes' names included.
            make: adds the nodes to the scene.
        """
        if state == self._state and not any_gone(self.handles):
            return
        self.remove()
        self.handles = tuple(make())
        self._state = state

    def remove(self) -> None:
        """Take the nodes out of the scene."""
        remove_all(self.handles)
        self._state, self.handles = None, ()


def remove_all(handles: Iterable[Handle]) -> None:
    """Take nodes out of the scene, also when their parent is already gone."""
    for handle in handles:
        if not viser_private.is_removed(handle):
            handle.remove()


def any_gone(handles: Iterable[Handle]) -> bool:
    """Return whether some of the nodes were removed together with a node above them."""
    return any(viser_private.is_removed(handle) for handle in handles)
