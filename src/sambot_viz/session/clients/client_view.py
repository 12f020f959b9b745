"""The view of one client: its type, its numbers, and the camera that they describe.

A client begins with a copy of the document's view, which is its own from then on.
Where the file does not say how near the camera is, it shows the whole robot until the
user takes another view. The mouse moves the camera, and the numbers follow; with the
target frame it moves by itself, and they stay. The document takes over the view of the
client that saves it (`store`).
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from types import MappingProxyType
from typing import Any

import viser

from sambot_viz.displays.picking.triangle_mesh import Corners
from sambot_viz.errors import UsageError
from sambot_viz.rviz import ViewConfig
from sambot_viz.rviz.declarations import short_name
from sambot_viz.session.clients import viser_camera
from sambot_viz.session.clients.client_camera import (
    ClientCamera,
    Followed,
    followed_of,
    same_picture,
)
from sambot_viz.session.clients.robot_framing import RobotFraming, window_of
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.document.document_view import (
    as_kind,
    require_kind,
    target_of,
    view_of,
)
from sambot_viz.session.document.saved_views import SavedViews
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.picker import Picker
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Change, Signal, connect
from sambot_viz.session.undo import History
from sambot_viz.session.worker import Throttle, Worker
from sambot_viz.views.camera import Camera, Vector, length, on_sphere
from sambot_viz.views.orbit import ORTHOGRAPHIC, SIDES, OrbitView
from sambot_viz.views.registry import VIEWS
from sambot_viz.views.top_down_ortho import TopDownOrthoView
from sambot_viz.views.view import WORLD, Name, Target, Values, View, rounded

READ_PERIOD = 0.1
"""The numbers follow a moving camera this often [s]."""


class ViewOwner:
    """Whose view the edits of a page change: its own, or that of the page it is now.

    Args:
        view: that view.
    """

    def __init__(self, view: ClientView) -> None:
        self.view = view

    def restore(self, shown: ViewConfig, config: ViewConfig, values: Values) -> None:
        """Undo an edit of the view, or do it again; see `ClientView.restore`."""
        self.view.restore(shown, config, values)


class ClientView:
    """Keeps the view and the camera of one client in agreement.

    A page that comes back after a broken connection keeps the camera it has.

    Args:
        client: whose view it is.
        change: sends the camera to this client.
        document: its view comes first.
        robot: it is followed, and shown whole at first.
        picker: finds how large the robot is.
        history: records changes of the view.
        saved: the saved views of the document.
        worker: acts on what the camera reports.
        lead: called with this view when it has moved.

    Attributes:
        changed: the type or the numbers of the view.
        client_id: the number of the client.
        shown: what the page shows, as it reports.
        saved: the saved views of the document.
        view: the view; one of an unknown type is shown as Orbit.
    """

    view: View

    def __init__(
        self,
        client: viser.ClientHandle,
        change: Change,
        document: ShownDocument,
        scene: Scene,
        robot: RobotState,
        picker: Picker,
        history: History,
        saved: SavedViews,
        worker: Worker,
        lead: Callable[[ClientView], None],
    ) -> None:
        self.changed = Signal(change, None)
        self.client_id = client.client_id
        self.saved = saved
        self._client = client
        self._change = change
        self._document = document
        self._scene = scene
        self._picker = picker
        self._history = history
        self._owner = ViewOwner(self)
        self._tell_others = lead
        self._last_target = WORLD
        self._framing = RobotFraming(client, document, scene, robot, picker)
        self._take(document.config.detached_view())
        self.shown = ClientCamera(self.view.local_camera(), self._followed)
        self._reader = Throttle(worker, READ_PERIOD, self._read)
        kept = viser_camera.camera_of(client.camera)
        if kept is None or viser_camera.is_fresh(client.camera):
            self._begin()
        else:
            self._keep(kept)
        self._follow_window(worker)
        self._disconnect = (
            connect([robot.changed, scene.frames], self._follow_target),
            connect([robot.changed, scene.statuses], self._frame_robot),
        )

    def _follow_window(self, worker: Worker) -> None:
        """Show the robot whole in a window of another size, where that is wanted."""
        size = window_of(self._client)

        async def reported(handle: viser.CameraHandle) -> None:
            nonlocal size
            del handle
            before, size = size, window_of(self._client)
            if size != before:
                worker.post(self._resized, latest_of=self, client=self.client_id)

        self._client.camera.on_update(reported)

    def _resized(self) -> None:
        with self._change.lock:
            self._frame_robot()

    def close(self) -> None:
        """Follow the session no longer: the page was closed."""
        for disconnect in self._disconnect:
            disconnect()
        self._reader.close()

    # Asking

    @property
    def values(self) -> Mapping[str, Any]:
        """Every value of the view, by its path; read-only."""
        return MappingProxyType(self.view.config.properties)

    @property
    def supported(self) -> bool:
        """Whether the type of the view is known."""
        return self._config.kind in VIEWS

    @property
    def confirmed(self) -> bool:
        """Whether the page has shown the camera that it was asked for last."""
        return self.shown.confirmed

    @property
    def camera(self) -> Camera:
        """The camera as it is now, in the fixed frame."""
        return self.view.in_fixed(self.shown.camera, self.target)

    @property
    def waits_for_robot(self) -> bool:
        """Whether it is not the user's: it shows the robot when there is one."""
        return self._framing.waiting

    # Changing it

    def set(self, path: str, value: Any) -> None:
        """Set one value.

        Raises:
            UsageError: there is no such value, or it cannot be set to that.
        """
        with self._edit(f"View: {path}", merge=("view", path)):
            before = self.target
            self.view.config.set(path, value)
            if path == "Target Frame":
                now = target_of(self._scene, self.view)
                # The picture stays as it is, except for a turn of the target.
                self._apply(self.view.shifted(before.position - now.position))

    def set_kind(self, kind: str) -> None:
        """Choose a type of view; the new one takes over what the old one showed.

        Raises:
            UsageError: an unknown type.
        """
        require_kind(kind)
        with self._edit(f"View: {short_name(kind)}"):
            _, height = window_of(self._client)
            self._take(as_kind(self._document.config, self.view, kind, height))

    def look_from(self, side: str, *, again: bool = False) -> None:
        """Look at the whole robot and its names from one side, without perspective.

        Args:
            side: one of `SIDES`, along the axes of the fixed frame, or "top".
            again: whether to look from the opposite side if it is seen already.

        Raises:
            UsageError: an unknown side.
        """
        if side not in (*SIDES, "top"):
            raise UsageError(f"there is no side '{side}'; {', '.join(SIDES)} or top")
        if again and side in SIDES and self._is_seen(side):
            side = _opposite(side)
        with self._edit(f"View: {side}"):
            kind = TopDownOrthoView.kind if side == "top" else OrbitView.kind
            if kind != self.view.kind:
                _, height = window_of(self._client)
                self._take(as_kind(self._document.config, self.view, kind, height))
            if side == "top":
                self._apply({"Angle": 0.0})
            else:
                self._apply({"Yaw": SIDES[side], "Pitch": 0.0, ORTHOGRAPHIC: True})
            box = self._picker.robot_box()
            if box is not None:
                self._apply(self._values_for(box, self._picker.names_in(box)))

    def _is_seen(self, side: str) -> bool:
        view = self.view
        if not (type(view) is OrbitView and view.orthographic):
            return False
        seen = view.local_camera().forward
        return length(seen + on_sphere(SIDES[side], 0.0)) < 1e-3

    def zero(self) -> None:
        """Bring the view to where RViz's "Zero" brings it."""
        with self._edit("Zero the view"):
            self._apply(self.view.zero())

    def look_at(self, point: Vector) -> None:
        """Look at a point of the fixed frame, (3,) [m]."""
        self._move(lambda: self.view.look_at(point, self.target))

    def fit(self, box: Corners | None = None) -> None:
        """Show a box whole, from the same direction.

        Args:
            box: its lowest and highest corner in the fixed frame [m]; the box around
                the robot when not given, or around all that is drawn without one.
        """
        found = self._picker.robot_box() if box is None else box
        if found is not None:
            self._move(lambda: self._values_for(found))

    def pan(self, offset: Vector) -> None:
        """Move the camera, (3,) [m]."""
        self._move(lambda: self.view.shifted(offset))

    def show(self) -> None:
        """Take the document's view, after a program has set another one."""
        with self._change(self.changed):
            self._take(self._document.config.detached_view())
            self._begin()

    def show_first(self) -> None:
        """Follow a change of the document's view, unless the client has its own."""
        if self._framing.wanted:
            self.show()

    def store(self) -> None:
        """Write the view into the document, which is about to be saved."""
        self._document.config.store_view(self._config)

    # The saved views of the document

    def save(self) -> ViewConfig:
        """Add the view to the saved ones, named after its type."""
        return self.saved.add(self._config)

    def use(self, saved: ViewConfig) -> None:
        """Show a copy of a saved view."""
        with self._edit(f"Use view {saved.name}"):
            self._take(self._document.config.detached_view(saved))

    # Inside

    def _begin(self) -> None:
        """Show a view of the document for the first time."""
        self._point()
        self._framing.begin(self.view)
        self._frame_robot()

    def _frame_robot(self) -> None:
        box = self._framing.box()
        if box is not None:
            # Of frames alone, the names are most of the picture.
            is_bare = self._picker.link_box() is None
            names = self._picker.names_in(box) if is_bare else ()
            with self._change(self.changed):
                self._apply(self._values_for(box, names))
                self._point()

    def _values_for(self, box: Corners, names: Sequence[Name] = ()) -> Values:
        return self.view.fit(*box, *window_of(self._client), self.target, names)

    def _take(self, config: ViewConfig) -> None:
        self._config = config
        self.view = view_of(config)

    @property
    def target(self) -> Target:
        """The target frame now; where it was, while it has no place."""
        self._last_target = target_of(self._scene, self.view, self._last_target)
        return self._last_target

    @property
    def _followed(self) -> Followed:
        return followed_of(self._scene, self.view, self.target)

    def _keep(self, camera: Camera) -> None:
        """Take over the camera of a page that came back, given in the fixed frame."""
        if camera.orthographic != self.view.from_above:
            kind = TopDownOrthoView if camera.orthographic else OrbitView
            self._take(self._document.config.new_view(kind.kind, self.view.config))
        if ORTHOGRAPHIC in self.view.config.declared:
            self.view.config.set(ORTHOGRAPHIC, camera.is_parallel)
        self.shown = ClientCamera(
            self.view.in_target(camera, self.target), self._followed
        )
        self._take_camera()

    @contextmanager
    def _edit(self, label: str, merge: object = None) -> Generator[None]:
        """Change the view, move the camera, and record that."""
        config, before = self._config, dict(self.values)
        self._framing.stop()
        with self._change(self.changed):
            yield
            self._point()
        self._tell_others(self)
        after = dict(self.values)
        if config is self._config:
            before = {p: v for p, v in before.items() if after[p] != v}
            after = {path: after[path] for path in before}
        if before or after:
            self._history.record(
                label,
                partial(self._owner.restore, self._config, config, before),
                partial(self._owner.restore, config, self._config, after),
                merge,
                of_document=False,
                page=self._owner,
            )

    def go_on(self, owner: ViewOwner) -> bool:
        """Take over the view of a page that was loaded again, for its edits.

        Returns:
            Whether both show a view of one type; otherwise nothing happens.
        """
        before = owner.view
        if before.view.kind != self.view.kind:
            return False
        values = dict(self.values)
        with self._change(self.changed):
            # Its edits know it by that.
            self._take(before.config)
            self._apply(values)
        owner.view = self
        return True

    @property
    def config(self) -> ViewConfig:
        """The view with its numbers, which no file has."""
        return self._config

    def restore(self, shown: ViewConfig, config: ViewConfig, values: Values) -> None:
        """Show the view as it was before or after an edit.

        Raises:
            UsageError: `shown` is no longer there.
        """
        if self._config is not shown:
            raise UsageError("another view was shown since")
        self._framing.stop()
        with self._change(self.changed):
            if config is not shown:
                self._take(config)
            self._apply(values)
            self._point()
        self._tell_others(self)

    def _apply(self, values: Values) -> None:
        for path, value in values.items():
            self.view.config.set(path, value)

    def _move(self, values: Callable[[], Values]) -> None:
        """Move the camera from its present place; as with a mouse, this is no edit."""
        self._framing.stop()
        with self._change(self.changed):
            self._take_camera()
            self._apply(values())
            self._point()
        self._tell_others(self)

    def _point(self) -> None:
        self.shown.ask(self.view.local_camera(), self._followed)

    def _take_camera(self) -> None:
        """The numbers take over the camera, unless they describe it already."""
        shown = self.shown.camera
        if not same_picture(shown, self.view.local_camera()):
            self._apply(rounded(self.view.read_local(shown)))

    def take_report(self, number: int, camera: Camera) -> None:
        """Take what the page reports of its camera; see `ClientCamera.take`."""
        with self._change.lock:
            if not self.shown.take(number, camera):
                return
            self._framing.stop()
        self._reader.request()

    def _read(self) -> None:
        """The numbers take over the camera."""
        with self._change.lock:
            if same_picture(self.shown.camera, self.view.local_camera()):
                return
            with self._change(self.changed):
                self._take_camera()
            self._tell_others(self)

    def follow(self, presenter: ClientView) -> None:
        """Show what another client shows."""
        self._framing.stop()
        with self._change(self.changed):
            if self._config.class_id != presenter._config.class_id:
                self._take(self._document.config.detached_view(presenter._config))
            self._apply(presenter.values)
            self.shown.ask(presenter.shown.camera, self._followed)

    def _follow_target(self) -> None:
        """Tell the page when the frame that it follows is another node."""
        self.shown.follow(self._followed)


def _opposite(side: str) -> str:
    names = [*SIDES]
    return names[(names.index(side) + 2) % len(names)]
