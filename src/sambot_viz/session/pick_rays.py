"""Rays through what a session draws, followed where nobody has to wait for them."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TYPE_CHECKING, TypeVar

from sambot_viz.tools.picking.hit import Selectable
from sambot_viz.tools.picking.pick_scene import PickScene, PickSnapshot
from sambot_viz.tools.picking.rays import Array

if TYPE_CHECKING:
    from sambot_viz.session import Session

T = TypeVar("T")

INLINE = 100_000
"""Rays through this many triangles take milliseconds; more are left to a thread."""


class PickRays:
    """Follows the rays of all browsers of a session, one click after the other.

    Args:
        session: what is drawn.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._scene = PickScene(session.context, lambda: session.displays)
        self._thread = ThreadPoolExecutor(1, "sambot-viz-rays")

    def follow(
        self, rays: Callable[[PickSnapshot], T], then: Callable[[T], None]
    ) -> None:
        """Follow rays through what is drawn now, then act.

        Millions of triangles take most of a second. A thread of its own does that, so
        that neither browsers nor the session wait.
        """
        snapshot = self._scene.snapshot()
        if snapshot.triangles <= INLINE:
            then(rays(snapshot))
            return

        def followed(future: Future[T]) -> None:
            # An exception of the rays is raised, and reported, in the worker.
            self._session.worker.post(lambda: then(future.result()))

        self._thread.submit(rays, snapshot).add_done_callback(followed)

    def box_of(self, item: Selectable) -> tuple[Array, Array] | None:
        """The corners of the box around a link's shapes or a frame's axes [m]."""
        return self._scene.box_of(item)

    def close(self) -> None:
        """Follow no more rays."""
        self._thread.shutdown(wait=False, cancel_futures=True)
