"""The origin of a broadcast: publishes the messages to pages for its followers."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Callable, Coroutine
from contextlib import suppress
from typing import Any

from sambot_viz.options import Options
from sambot_viz.panels.rows.row_store import ClientRows
from sambot_viz.server.channel import Channel
from sambot_viz.server.followers import link
from sambot_viz.server.followers.viewer import ViewerConnection
from sambot_viz.server.followers.wire import (
    VERSION,
    Label,
    OriginPage,
    Part,
    Snapshot,
)
from sambot_viz.server.listener import Listener, page_url, public_url, reachable_at
from sambot_viz.server.outgoing.outbox import Outbox
from sambot_viz.server.protection.inbound_filter import ClientHandler
from sambot_viz.server.readiness import ServerState
from sambot_viz.server.tickets import Channels
from sambot_viz.sources.broadcast_place import (
    BroadcastPlace,
    origin_of,
    parse_place,
)
from sambot_viz.sources.zenoh.broadcast_session import BroadcastSession, FramePublisher
from sambot_viz.sources.zenoh.session import ZenohDeclaration

SNAPSHOT_PERIOD = 1.0
"""Shortest time between two snapshots, each for all questions since the last [s]."""
_LOOK_AGAIN = 2.0
"""Time between two checks whether another origin has the same name [s]."""

Answer = Callable[[bytes], object]


def broadcast(
    options: Options,
    listener: Listener,
    outgoing: Outbox,
    handler: ClientHandler,
) -> Callable[[], None]:
    """Broadcast the content of a server from now on.

    Args:
        options: options of the server, with the place.
        listener: the server.
        outgoing: packed frames of its scene.
        handler: provides the rows of its clients.

    Returns:
        A function that stops the broadcast.
    """
    assert options.broadcast is not None
    place = parse_place(options.broadcast, "--broadcast")
    url = _url(options, listener.viser.get_port())
    answers = listener.answers
    made = Broadcast(
        place, url, lambda: answers.state(), outgoing, handler, listener.channels
    )
    return link.run(listener.viser.get_event_loop(), made.run)


def _url(options: Options, port: int) -> str:
    """Return the address of a server's page, without secrets; "" for none."""
    plain = options.having(token=None, presenter=None)
    if plain.unix_socket is not None:
        return public_url(plain) or ""
    return public_url(plain) or page_url(plain, reachable_at(plain.host), port)


class Broadcast:
    """Publishes the content of a server, while no other one has its name.

    Call all methods on the event loop of the server.

    Args:
        place: place of the broadcast.
        url: address of this server's page, without secrets.
        state: returns the state of this server.
        outgoing: packed frames of the scene.
        handler: provides the rows of the clients.
        channels: channels of the pages.

    Attributes:
        id: identifies the start of the program.
    """

    def __init__(
        self,
        place: BroadcastPlace,
        url: str,
        state: Callable[[], ServerState],
        outgoing: Outbox,
        handler: ClientHandler,
        channels: Channels,
    ) -> None:
        self.id = secrets.token_hex(6)
        self._place, self._url, self._state = place, url, state
        self._outgoing, self._handler = outgoing, handler
        self._channels = channels
        self._number = 0
        self._publisher: FramePublisher | None = None
        self._session: BroadcastSession | None = None
        self._held: list[ZenohDeclaration] = []
        self._others = set[str]()
        self._trouble = link.Trouble(f"Broadcast to {place.label}")
        self._rows: ClientRows | None = None
        self._asked: list[Answer] = []
        self._answering: asyncio.Task[None] | None = None
        self._ready = asyncio.Event()

    async def run(self) -> None:
        """Broadcast until cancelled."""
        try:
            await _together(self._connect(), self._watch())
        finally:
            if self._answering is not None:
                self._answering.cancel()

    async def _connect(self) -> None:
        await self._ready.wait()
        await link.hold(self._place.address, self)

    async def _watch(self) -> None:
        """See what a viewer sees; join again after a presenter removes the viewer."""
        while True:
            viewer = ViewerConnection()
            serving = self._channels.serve_viser(viewer.as_connection())
            task = asyncio.ensure_future(serving)
            try:
                self._rows = await self._rows_of(viewer)
                self._ready.set()
                await _together(task, self._send_scene(), self._send_rows(viewer))
            finally:
                viewer.abort()
                await asyncio.gather(task, return_exceptions=True)
            # Changes in between were not published; the gap makes followers ask.
            self._number += 1

    async def _rows_of(self, viewer: ViewerConnection) -> ClientRows:
        while True:
            if viewer.client_id is not None:
                rows = self._handler.rows_of(viewer.client_id)
                if rows is not None:
                    return rows
            await self._channels.joined()

    async def _send_scene(self) -> None:
        async for frame in self._outgoing.frames():
            self._publish("scene", frame)

    async def _send_rows(self, viewer: ViewerConnection) -> None:
        def take(message: str | bytes) -> None:
            self._publish("rows", _as_bytes(message))

        assert viewer.client_id is not None and self._rows is not None
        page = ViewerConnection(take).as_connection()
        await Channel(page, lambda: self._handler).write(viewer.client_id, self._rows)

    def _publish(self, part: Part, content: bytes) -> None:
        self._number += 1
        if self._publisher is not None:
            label = Label(self.id, self._number, part)
            self._publisher.put(content, attachment=label.packed())

    # The connection to the router

    def begin(self, session: BroadcastSession) -> None:
        """Check for other origins; start to broadcast if there are none."""
        self._session = session
        self._others.clear()
        session.watch(self._place.origins, self._take_origin, self._all_told)

    def cut(self, why: str) -> None:
        """Stop publishing until a router is available again."""
        self._stop()
        self._session = None
        self._trouble.set(f"Nothing is broadcast: {why}")

    def _take_origin(self, token: str, is_there: bool) -> None:
        origin, _ = origin_of(token)
        if origin == self.id:
            return
        if is_there:
            self._others.add(origin)
        else:
            self._others.discard(origin)
            self._all_told()
        if is_there and self._publisher is not None and origin < self.id:
            # Both origins checked at the same moment, and neither saw the other.
            self._stop()
            self._all_told()

    def _all_told(self) -> None:
        session = self._session
        if session is None or self._publisher is not None:
            return
        if self._others:
            place = self._place.label
            self._trouble.set(
                f"Nothing is broadcast: another server broadcasts to {place} already, "
                "and it stays; end that one, or give this one another name"
            )
            return
        self._publisher = session.frames(self._place.frames)
        self._held = [
            session.on_question(self._place.snapshot, self._take_question),
            session.on_question(self._place.page, self._take_page_question),
            session.declare_token(self._place.token(self.id, VERSION)),
        ]
        self._trouble.set("")

    def _stop(self) -> None:
        held, self._held, self._publisher = self._held, [], None
        for one in held:
            # A closed session has already withdrawn them.
            with suppress(Exception):
                one.undeclare()

    # Snapshots

    def _take_question(self, answer: Answer) -> None:
        self._asked.append(answer)
        if self._answering is None:
            self._answering = asyncio.ensure_future(self._answer_all())

    def _take_page_question(self, answer: Answer) -> None:
        page = OriginPage(self._url, self._state())
        # Answering takes its time, which the loop does not have.
        asyncio.get_running_loop().run_in_executor(None, answer, page.packed())

    async def _answer_all(self) -> None:
        try:
            while self._asked:
                asked, self._asked = self._asked, []
                content = (await self._snapshot()).packed()
                for answer in asked:
                    await asyncio.to_thread(answer, content)
                await asyncio.sleep(SNAPSHOT_PERIOD)
        finally:
            self._answering = None

    async def _snapshot(self) -> Snapshot:
        """Return the content that a new page gets; later messages are newer."""
        number = self._number
        parts = () if self._rows is None else self._rows.sent
        messages = [part.since(0)[1] for part in parts]
        rows = [_as_bytes(message) for message in messages if message is not None]
        scene = await self._outgoing.backlog()
        return Snapshot(self.id, number, self._url, scene, rows)


def _as_bytes(message: str | bytes) -> bytes:
    return message.encode() if isinstance(message, str) else message


async def _together(*actions: Coroutine[Any, Any, Any] | asyncio.Future[Any]) -> None:
    """Run several actions until the first one ends, and end the others."""
    tasks = [asyncio.ensure_future(one) for one in actions]
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        for one in done:
            one.result()
    finally:
        for one in tasks:
            one.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
