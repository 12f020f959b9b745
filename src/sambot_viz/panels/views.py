"""The Views panel of one browser: its camera, and the saved views of the document."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from typing import Any, cast

from sambot_viz.errors import UsageError
from sambot_viz.panels.command import TEXT, command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.problems.status_rows import use_other_frame
from sambot_viz.panels.rows.ids import Ids
from sambot_viz.panels.rows.property_rows import property_rows
from sambot_viz.panels.rows.row import Answer, Data, Json, Level, Row
from sambot_viz.panels.validation import validate
from sambot_viz.rviz import ViewConfig
from sambot_viz.rviz.declarations import row_text
from sambot_viz.session.clients.client import Client
from sambot_viz.session.clients.clients import Clients
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.document.document_view import mouse_facts
from sambot_viz.session.people.roles import Roles
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.undo import History
from sambot_viz.views.registry import VIEWS

CURRENT = "view"


class ViewsPanel(Panel):
    """The type of the view, its numbers, and the saved views.

    The numbers are those of this browser's camera: they follow its mouse, and typed
    values move only this camera. The saved views belong to the document.

    Args:
        client: the owner of the camera.
        document: the document with the saved views.
        scene: the scene with the frames that a view may follow.
        clients: all clients, which may follow the presenter.
        roles: knows whether there is a presenter.
        history: does not record the values that a page restores.
        say: shows the user that the presenter leads the view.
    """

    name = "views"

    def __init__(
        self,
        client: Client,
        document: ShownDocument,
        scene: Scene,
        clients: Clients,
        roles: Roles,
        history: History,
        say: Callable[[str, Level], None],
    ) -> None:
        self._clients, self._client = clients, client
        # A client that joins later gets the notice too.
        self._say, self._led = say, False
        self._brought = clients.brought.value
        self.remade_by = (
            document.views,
            scene.frames,
            clients.leading,
            clients.brought,
            clients.free,
            roles.changed,
            client.view.changed,
        )
        self._document = document
        self._scene = scene
        self._roles = roles
        self._history = history
        self._ids = Ids[ViewConfig]("saved")

    def rows(self) -> Sequence[Row]:
        """Return the type, the current view, then the saved ones."""
        return [
            self._type(),
            *self._current(),
            *self._follow_rows(),
            *map(self._saved, self._document.config.saved_views),
        ]

    def data(self) -> Sequence[Data]:
        """Return what the mouse does to the view, and whether that is the first one."""
        view = self._client.view
        return [
            Data("view/shown", mouse_facts(view.view)),
            Data("view/waits", view.waits_for_robot),
        ]

    def _type(self) -> Row:
        view = self._client.view.view
        return Row(
            "view/type",
            "",
            "enum",
            "Type",
            value=row_text(view.kind),
            options=tuple(KINDS),
            help=view.help,
            extra={"apart": True},
            client_local=True,
            set=lambda label: self._client.view.set_kind(KINDS[label]),
        )

    def _current(self) -> Iterator[Row]:
        view = self._client.view.view
        yield Row(
            CURRENT,
            "",
            "readonly",
            "Current View",
            value=row_text(view.kind),
            help=view.help,
            expanded=True,
            bold=True,
        )
        if not self._client.view.supported:
            yield Row("view/:unknown", CURRENT, "note", value=_UNKNOWN, level="warn")
        change = self._client.view.set
        for row in property_rows(view.config, CURRENT, change, client_local=True):
            yield row
            if row.kind == "frame":
                yield from self._missing_target(row)

    def _missing_target(self, row: Row) -> Iterator[Row]:
        """Say that the frame does not exist that the view is to follow."""
        frame = str(row.value)
        other = use_other_frame(frame, row.id, row.options[0], self._scene)
        if other is not None:
            said = f"Frame [{frame}] does not exist"
            status = f"{CURRENT}/:target"
            yield Row(
                status, CURRENT, "status", "Status", said, level="warn", extra=other
            )

    def _follow_rows(self) -> Iterator[Row]:
        clients, client_id = self._clients, self._client.client_id
        led = clients.leading.value and not self._roles.may_edit(client_id)
        if led and not self._led:
            self._say("The presenter leads your view; Views can turn that off", "ok")
        self._led = led
        before, self._brought = self._brought, clients.brought.value
        if self._brought not in (None, before) and self._brought[0] != client_id:
            people = self._roles.people
            who = people[self._brought[0]].name if self._brought[0] in people else ""
            self._say(f"{who or 'Someone'} moved your view", "ok")
        if self._roles.may_edit(client_id):
            camera = "you show, while you have control"
            if not self._roles.presented:
                camera = "the camera shows that moved last"
            yield Row(
                "view/:lead",
                CURRENT,
                "bool",
                "Lead all views",
                value=clients.leading.value,
                help=f"All browsers show what {camera}.",
                set=lambda on: clients.lead(client_id, on),
            )
        elif led:
            yield Row(
                "view/:follow",
                CURRENT,
                "bool",
                "Follow the presenter",
                value=client_id not in clients.free.value,
                help="The presenter leads all views. Untick this to look around.",
                client_local=True,
                set=lambda on: clients.follow(client_id, on),
            )

    @command("views/bring", name="Bring everyone to my view")
    def _bring(self) -> Answer:
        others = self._clients.bring(self._client.client_id)
        pages = "page shows" if others == 1 else "pages show"
        return Answer(f"{others} other {pages} your view")

    @command("views/restore", TEXT, TEXT, client_local=True)
    def _restore(self, label: str, sent: str) -> None:
        """Show what the page showed before it lost the connection, or was loaded again.

        That is not an edit to undo: the user sees what was there before.
        """
        values = _read(sent)
        kind = KINDS.get(label)
        self.look_as(kind, lambda row: values.get(row.id))

    @command("views/side", TEXT, client_local=True)
    def _side(self, side: str) -> None:
        self._client.view.look_from(side)

    @command("views/press_side", TEXT, client_local=True)
    def _press_side(self, side: str) -> None:
        """Look from the opposite side when the key is pressed again."""
        self._client.view.look_from(side, again=True)

    @command("views/first", client_local=True)
    def _first(self) -> None:
        """Show the config's view: the page had only waited for a robot."""
        self._client.view.show()

    def look_as(self, kind: str | None, wanted: Callable[[Row], Json]) -> None:
        """Show the view of another page, or of another time; no edit to undo.

        Args:
            kind: the type of the view; None keeps it.
            wanted: the value for each row of the view, not checked yet; None keeps it.

        Raises:
            UsageError: a value that it cannot have.
        """
        view = self._client.view
        with self._history.unrecorded():
            if kind is not None and kind != view.view.kind:
                view.set_kind(kind)
            rows = property_rows(view.view.config, CURRENT, view.set)
            # Another target turns the numbers that come after it.
            for row in sorted(rows, key=lambda row: row.kind != "frame"):
                value = None if row.set is None else wanted(row)
                if row.set is not None and value is not None:
                    row.set(validate(row, value))

    # The saved views

    def _saved(self, saved: ViewConfig) -> Row:
        name = saved.name or saved.kind.rpartition("/")[2]
        return Row(
            self._ids.of(saved),
            "",
            "readonly",
            name,
            value=row_text(saved.kind),
            icon="view",
            help="A saved view. A double click or Enter shows it.",
            extra={"saved": True},
        )

    def _saved_view(self, row_id: str) -> ViewConfig:
        saved = self._ids.find(row_id)
        if saved is None or saved not in self._document.config.saved_views:
            raise UsageError("this saved view no longer exists")
        return saved

    @command("views/use", TEXT, client_local=True)
    def _use(self, row_id: str) -> None:
        self._client.view.use(self._saved_view(row_id))

    @command("views/save")
    def _save(self) -> None:
        self._client.view.save()

    @command("views/rename", TEXT, TEXT)
    def _rename(self, row_id: str, name: str) -> None:
        if not name.strip():
            raise UsageError("a saved view needs a name")
        self._client.view.saved.rename(self._saved_view(row_id), name.strip())

    @command("views/remove", TEXT)
    def _remove(self, row_id: str) -> None:
        self._client.view.saved.remove(self._saved_view(row_id))


def _read(sent: str) -> dict[str, Any]:
    """Return the values of rows by their ids; none from another text."""
    try:
        values = json.loads(sent)
    except (ValueError, RecursionError):
        return {}
    return cast("dict[str, Any]", values) if isinstance(values, dict) else {}


KINDS = {row_text(kind): kind for kind in VIEWS}
"""Type of view as it is shown → its name in a file."""
_UNKNOWN = (
    "The config asks for a type of view that is not known here: shown as Orbit, and "
    "kept as it is in the file."
)
