"""Follow rays through the scene of a session without blocking clients."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

from sambot_viz.displays.picking.handle import Handle
from sambot_viz.displays.picking.rays import Array
from sambot_viz.displays.picking.selectable import Selectable, Selection
from sambot_viz.displays.picking.selected import SelectedData
from sambot_viz.displays.picking.triangle_mesh import Corners
from sambot_viz.geometry import Matrix
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.worker import Worker
from sambot_viz.tools.picking.pick_scene import PickScene, PickSnapshot
from sambot_viz.views.view import Name

T = TypeVar("T")

INLINE = 100_000
"""Rays through this many triangles take milliseconds; more are left to a thread."""


class Picker:
    """Follows the rays of all clients of a session, one click after the other.

    Args:
        worker: acts on what was found.
    """

    def __init__(self, scene: Scene, worker: Worker) -> None:
        self._worker = worker
        self._scene = PickScene(lambda: scene.displays)
        self._thread = ThreadPoolExecutor(1, "sambot-viz-rays")
        self._lock = threading.Lock()
        self._waiting: dict[object, Callable[[], None]] = {}

    def follow(
        self,
        of: object,
        rays: Callable[[PickSnapshot], T],
        then: Callable[[T], None],
        facing: Matrix | None = None,
    ) -> None:
        """Follow rays through the present scene, then act on the hits.

        A rectangle over millions of triangles takes seconds, so this runs in a separate
        thread: neither clients nor the session wait.

        Args:
            of: client and purpose; of several waiting calls only the latest is done.
            rays: follows the rays.
            then: acts on the hits, in the session's worker.
            facing: rotation of markers that face the view, (4, 4), if movable markers
                count as hits; None if they do not.
        """
        scene = self._scene
        snapshot = scene.snapshot() if facing is None else scene.with_handles(facing)
        if snapshot.triangles <= INLINE:
            then(rays(snapshot))
            return

        def work() -> None:
            future: Future[T] = Future()
            try:
                future.set_result(rays(snapshot))
            except Exception as error:
                # It is raised, and reported, in the worker.
                future.set_exception(error)
            self._worker.post(lambda: then(future.result()))

        with self._lock:
            known = of in self._waiting
            self._waiting[of] = work
        if not known:
            self._thread.submit(self._work, of)

    def _work(self, of: object) -> None:
        with self._lock:
            work = self._waiting.pop(of)
        work()

    @property
    def has_handles(self) -> bool:
        """Whether something is shown that a hand can move."""
        return self._scene.has_handles

    def handle(self, item: Selectable) -> Handle | None:
        """Return the movable marker that a ray has hit; None without one."""
        return self._scene.handle(item)

    def boxes_of(self, selection: Selection) -> dict[Selectable, Array]:
        """Return the edges of the boxes around a selection.

        Args:
            selection: the selected things; those not drawn now have no box.
        """
        return self._scene.boxes_of(selection)

    def box_of(self, selection: Selection) -> Corners | None:
        """Return the box around a selection; None if nothing of it is drawn."""
        return self._scene.box_of(selection)

    def data_of(self, item: Selectable) -> SelectedData | None:
        """Return a display's details of data; None if they are no longer drawn."""
        return self._scene.data_of(item)

    def kept(self, selection: Selection) -> Selection:
        """Return a selection without data that is gone."""
        return self._scene.kept(selection)

    def robot_box(self) -> Corners | None:
        """The box around all links, or else around all that is drawn."""
        return self._scene.robot_box()

    def link_box(self) -> Corners | None:
        """The box around all links; None while none is drawn."""
        return self._scene.link_box()

    def first_box(self) -> Corners | None:
        """The box around the robot and all data, or else around all that is drawn."""
        return self._scene.first_box()

    @property
    def data_drawn(self) -> int:
        """How many displays have drawn data."""
        return self._scene.data_drawn

    def names_in(self, box: Corners) -> list[Name]:
        """The names that are drawn of frames in a box."""
        return self._scene.names_in(box)

    def close(self) -> None:
        """Follow no more rays."""
        self._thread.shutdown(wait=False, cancel_futures=True)
