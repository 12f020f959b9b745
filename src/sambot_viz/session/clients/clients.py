"""The clients of a session."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import viser

from sambot_viz.displays.picking.selectable import Selection
from sambot_viz.publishing.publisher import Publisher
from sambot_viz.session.clients.client import Client
from sambot_viz.session.clients.client_tools import ClientTools
from sambot_viz.session.clients.client_view import ClientView, ViewOwner
from sambot_viz.session.clients.pointer import Pointer
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.document.saved_views import SavedViews
from sambot_viz.session.people.roles import Roles
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.picker import Picker
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Change, Signal
from sambot_viz.session.undo import History
from sambot_viz.session.worker import Worker


class Clients:
    """Makes the view and tools of each client, and drops them when its page closes.

    Args:
        document: its views and tools come first.
        scene: the drawn scene.
        robot: views follow it.
        picker: follows the rays of clicks.
        history: records views.
        roles: knows whose view the others may follow.
        publisher: sends goals, poses and points to a robot.
        worker: acts on the messages of clients.

    Attributes:
        leading: whether all clients follow the view of one in control: of these, the
            one whose camera moved last.
        free: the clients that do not follow it.
        brought: the client that last brought all others to its view, and the number
            of times.
        pointer: shows one client's selection to all.
        listeners: called with a client that joined (True) or left (False), with the
            session locked.
    """

    def __init__(
        self,
        document: ShownDocument,
        scene: Scene,
        robot: RobotState,
        picker: Picker,
        history: History,
        roles: Roles,
        publisher: Publisher,
        change: Change,
        worker: Worker,
    ) -> None:
        self.leading = Signal(change, False)
        self.free: Signal[frozenset[int]] = Signal(change, frozenset())
        self.brought: Signal[tuple[int, int] | None] = Signal(change, None)
        self.pointer = Pointer(scene, picker, robot, change, worker)
        self._leader: ClientView | None = None
        self.listeners: list[Callable[[Client, bool], None]] = []
        self._document = document
        self._scene = scene
        self._robot = robot
        self._picker = picker
        self._history = history
        self._roles = roles
        self._publisher = publisher
        self._saved_views = SavedViews(document, history, change)
        self._worker = worker
        self._clients: dict[int, Client] = {}
        history.take_page = self._take_page

    @property
    def all(self) -> Mapping[int, Client]:
        """The clients that see the session, by their numbers; read-only."""
        return MappingProxyType(self._clients)

    def _take_page(self, client_id: int, page: object) -> bool:
        """Give a client the view of the page that it was before it was loaded again."""
        client = self._clients.get(client_id)
        return (
            client is not None
            and isinstance(page, ViewOwner)
            and client.view.go_on(page)
        )

    def join(self, handle: viser.ClientHandle) -> Client:
        """Make what belongs to a client that has opened the page."""
        change = Change(self._worker, handle)
        view = ClientView(
            handle,
            change,
            self._document,
            self._scene,
            self._robot,
            self._picker,
            self._history,
            self._saved_views,
            self._worker,
            self._lead,
        )
        tools = ClientTools(
            handle,
            change,
            view,
            self._document,
            self._scene,
            self._robot,
            self._picker,
            self._worker,
            self._point,
            self._publisher,
            self._roles,
        )
        client = self._clients[handle.client_id] = Client(handle, change, view, tools)
        for listener in tuple(self.listeners):
            listener(client, True)
        if self.leading.value and self._leader is not None:
            view.follow(self._leader)
        return client

    def leave(self, client_id: int) -> None:
        """Forget what belongs to a client that has closed the page."""
        client = self._clients.pop(client_id, None)
        if client is not None:
            if self._leader is client.view:
                self._leader = None
            client.close()
            self._history.leave(client_id)
            for listener in tuple(self.listeners):
                listener(client, False)

    def show_view(self) -> None:
        """Give all clients the document's view."""
        for client in self._clients.values():
            client.view.show()

    def show_first_view(self) -> None:
        """Give the document's view to the clients that have not moved from it."""
        for client in self._clients.values():
            client.view.show_first()

    def store_view(self) -> None:
        """Let the document's view be that of the client that came first, if any did."""
        first = next(iter(self._clients.values()), None)
        if first is not None:
            first.view.store()

    def close(self) -> None:
        """Stop following changes; clients that leave later are not handled."""
        self.pointer.hide()
        clients, self._clients = self._clients, {}
        for client in clients.values():
            client.close()

    def lead(self, client_id: int, on: bool) -> None:
        """Show all clients what this one shows, now and from now on; or no longer."""
        self.leading.set(on)
        self.free.set(frozenset())
        if on:
            self._lead(self._clients[client_id].view)

    def bring(self, client_id: int) -> int:
        """Show all clients once what this one shows; returns how many others."""
        view = self._clients[client_id].view
        others = [c.view for c in self._clients.values() if c.view is not view]
        for other in others:
            other.follow(view)
        times = 0 if self.brought.value is None else self.brought.value[1]
        self.brought.set((client_id, times + 1))
        return len(others)

    def _point(self, client_id: int, items: Selection) -> None:
        """Show the selection of a presenter to all clients."""
        if self._roles.presented and self._roles.may_edit(client_id) and items:
            self.pointer.show(items)

    def follow(self, client_id: int, on: bool) -> None:
        """Let a client follow, while all are led, or look where it likes."""
        free = self.free.value
        self.free.set(free - {client_id} if on else free | {client_id})
        if on and self.leading.value and self._leader is not None:
            self._clients[client_id].view.follow(self._leader)

    def _lead(self, view: ClientView) -> None:
        """Show others the same, where they are to follow."""
        if self.leading.value and self._roles.may_edit(view.client_id):
            self._leader = view
            for other in tuple(self._clients.values()):
                if other.view is not view and other.client_id not in self.free.value:
                    other.view.follow(view)
