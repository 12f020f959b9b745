"""The page's own websocket: behind the same checks, and tied to one client."""

from __future__ import annotations

import asyncio
import secrets
import threading
from collections.abc import Awaitable, Callable, Iterator
from contextlib import ExitStack
from types import SimpleNamespace
from typing import Any

import msgspec.msgpack
import pytest
import viser
from inside import all_have_rows
from lower_limit import lower
from page_rows import decode
from patience import patience, until
from protocol_client import CAMERA, ROW_PATCH, ProtocolClient
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.protocol import State
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin, Subprotocol

from sambot_viz import Visualizer, limits, viser_private
from sambot_viz.panels.rows.row_store import ClientRows, RowStore
from sambot_viz.server import tickets
from sambot_viz.server.channel import PING, PONG, SUBPROTOCOL, Channel
from sambot_viz.server.connections import connection, rate_limit
from sambot_viz.server.connections.connection import ClientContext, Connection
from sambot_viz.server.protection.inbound_filter import NoSessions
from sambot_viz.server.tickets import CLIENT_LEFT, PAGE_LEFT, Channels

Protocol = Callable[..., ProtocolClient]
VISER = f"viser-v{viser.__version__}"
JOINT = "j/drivewhl_l_joint"
TOKEN, PRESENTER = "let-me-in-please", "teach-the-class"


class Pages:
    """Connections of pages to one server, closed at the end of the test."""

    def __init__(self, stack: ExitStack) -> None:
        self._stack = stack

    def open(
        self, viz: Visualizer, ticket: str, protocol: str, **more: Any
    ) -> ClientConnection:
        query = f"?ticket={ticket}" + more.pop("query", "")
        socket = connect(
            f"ws://127.0.0.1:{viz.viser.get_port()}/{query}",
            subprotocols=[Subprotocol(protocol)],
            max_size=None,
            compression=None,
            **more,
        )
        return self._stack.enter_context(socket)

    def viser(self, viz: Visualizer, ticket: str, **more: Any) -> ClientConnection:
        """A page's connection to viser, with its first camera."""
        socket = self.open(viz, ticket, VISER, **more)
        socket.send(msgspec.msgpack.encode({"type": "ViewerCameraMessage", **CAMERA}))
        return socket

    def channel(self, viz: Visualizer, ticket: str, **more: Any) -> ClientConnection:
        return self.open(viz, ticket, SUBPROTOCOL, **more)


@pytest.fixture
def pages() -> Iterator[Pages]:
    with ExitStack() as stack:
        yield Pages(stack)


@pytest.fixture
def viz() -> Iterator[Visualizer]:
    with Visualizer(port=0) as viz:
        yield viz


@pytest.fixture
def ticket() -> str:
    return secrets.token_urlsafe(16)


def rows(channel: ClientConnection) -> list[Any]:
    """What a page gets first: the rows of the session, and its own."""
    return [decode(channel.recv(timeout=patience(10.0))) for _ in range(2)]


def until_changed(channel: ClientConnection, row: str) -> Any:
    """What has changed of a row, as soon as something has."""
    while True:
        changed = decode(channel.recv(timeout=patience(10.0))).get("rows", {})
        if row in changed:
            return changed[row]


def answers(channel: ClientConnection) -> None:
    """Wait for the answer to a ping; rows that are made late may come before it."""
    channel.send(PING)
    while channel.recv(timeout=patience(10.0)) != PONG:
        pass


def closed_with(channel: ClientConnection) -> int | None:
    with pytest.raises(ConnectionClosed) as closed:
        while True:
            channel.recv(timeout=patience(10.0))
    return closed.value.rcvd and closed.value.rcvd.code


def status_of(refused: pytest.ExceptionInfo[InvalidStatus]) -> int:
    return refused.value.response.status_code


def test_both_connections_of_a_page_are_one_client_in_any_order(
    viz: Visualizer, pages: Pages
) -> None:
    first, second = secrets.token_urlsafe(16), secrets.token_urlsafe(16)
    early = pages.channel(viz, first)
    pages.viser(viz, first)
    pages.viser(viz, second)
    late = pages.channel(viz, second)
    for channel in (early, late):
        whole = rows(channel)
        assert [part["of"] for part in whole] == ["session", "browser"]
        assert all(part["all"] for part in whole)
    # Who is there is known to both.
    for channel in (early, late):
        answers(channel)
    early.send(f'["{JOINT}",0.5]')
    # Undo is offered where the joint was moved, and nowhere else. What is known late,
    # as that the model was checked, may come between the two.
    told = set[str]()
    while told != {"session", "browser"}:
        told.add(decode(early.recv(timeout=patience(10.0)))["of"])
    assert until_changed(late, JOINT) == {"value": 0.5}
    late.send(PING)
    while (message := late.recv(timeout=patience(10.0))) != PONG:
        assert decode(message)["of"] == "session"


@pytest.mark.parametrize("protocol", [SUBPROTOCOL, VISER])
def test_a_ticket_that_is_in_use_is_refused(
    viz: Visualizer, pages: Pages, ticket: str, protocol: str
) -> None:
    pages.viser(viz, ticket)
    rows(own := pages.channel(viz, ticket))
    with pytest.raises(InvalidStatus) as refused:
        pages.open(viz, ticket, protocol)
    assert status_of(refused) == 409
    answers(own)


def test_a_page_that_lost_its_connections_without_a_word_takes_them_over(
    viz: Visualizer, pages: Pages, ticket: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    gone = pages.viser(viz, ticket), pages.channel(viz, ticket)
    rows(gone[1])
    for socket in gone:
        # It answers no ping from now on, like a page whose network is gone.
        monkeypatch.setattr(socket.protocol, "recv_ping", lambda _: None, raising=False)
        socket.socket.settimeout(None)
        monkeypatch.setattr(socket, "send_data", lambda: None)
    monkeypatch.setattr(tickets, "ANSWER_TIME", 0.1)
    again = pages.channel(viz, ticket)
    pages.viser(viz, ticket)
    assert rows(again)[1]["of"] == "browser"


def test_a_client_that_leaves_as_the_channel_comes_is_not_taken_for_the_next(
    viz: Visualizer, pages: Pages, ticket: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def answers(self: Connection, timeout: float) -> bool:
        # Its answer is the last that comes of it.
        self.transport.abort()
        await self.wait_closed()
        return True

    gone = pages.viser(viz, ticket)
    wait_for_clients(viz, 1)
    until(lambda: all_have_rows(viz))
    monkeypatch.setattr(Connection, "answers", answers)
    channel = pages.channel(viz, ticket)
    closed_with(gone)
    wait_for_clients(viz, 0)
    pages.viser(viz, ticket)
    rows(channel)
    channel.send(f'["{JOINT}",0.5]')
    assert until_changed(channel, JOINT) == {"value": 0.5}


def test_who_leaves_before_it_has_the_ticket_does_not_get_it(ticket: str) -> None:
    async def silent(timeout: float) -> bool:
        return False

    def page(state: State) -> Any:
        return SimpleNamespace(
            context=ClientContext(ticket=ticket),
            state=state,
            removed=False,
            answers=silent,
            transport=SimpleNamespace(abort=lambda: None),
        )

    async def run() -> None:
        channels, holder = Channels(), page(State.OPEN)
        assert channels.claim(holder) is None
        waiting = channels.claim(page(State.CLOSED))
        assert isinstance(waiting, Awaitable)
        refused = await waiting
        assert refused is not None and refused.status_code == 409
        holder.on_lost()
        assert channels.claim(page(State.CONNECTING)) is None

    asyncio.run(run())


def test_both_connections_of_a_page_have_one_limit(
    viz: Visualizer, pages: Pages, ticket: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connection, "BURST", 20.0)
    lower(monkeypatch, "PAGE_MESSAGES", 10)
    # However long this takes, the limit takes none of it for a pause.
    monkeypatch.setattr(rate_limit, "time", SimpleNamespace(monotonic=lambda: 0.0))
    client = pages.viser(viz, ticket)
    rows(channel := pages.channel(viz, ticket))
    # What one of them sends is counted for the other.
    for _ in range(21):
        client.send(msgspec.msgpack.encode({"type": "ViewerCameraMessage", **CAMERA}))
    (client_id,) = viz.viser.get_clients()
    own: Any = viser_private.connection_of(viz.viser, client_id)
    until(lambda: own.rate._left <= -1)
    pauses: list[float] = []
    sleep = asyncio.sleep

    async def pause(seconds: float) -> None:
        pauses.append(seconds)
        await sleep(0)

    monkeypatch.setattr(asyncio, "sleep", pause)
    channel.send(PING)
    while channel.recv(timeout=patience(10.0)) != PONG:
        pass
    assert max(pauses, default=0.0) == pytest.approx(0.2)


def test_a_slow_page_gets_the_newest_state_only() -> None:
    sent: list[Any] = []
    free = asyncio.Event()

    class Writer:
        async def send(self, message: str | bytes) -> None:
            sent.append(decode(message))
            await free.wait()

    async def run() -> None:
        stores = RowStore("session"), RowStore("browser")
        for store in stores:
            store.replace(store._scope, [{"id": store._scope, "value": 0}])
        slow: Any = SimpleNamespace(writer=Writer())
        writing = asyncio.ensure_future(
            Channel(slow, NoSessions).write(1, ClientRows(stores))
        )
        while not sent:
            await asyncio.sleep(0)
        for value in range(1000):
            stores[0].update("session", {"value": value})
            stores[0].tell()
        free.set()
        while len(sent) < 3:
            await asyncio.sleep(0)
        for _ in range(10):
            await asyncio.sleep(0)
        writing.cancel()

    asyncio.run(run())
    assert [part["of"] for part in sent] == ["session", "browser", "session"]
    assert sent[2]["rows"] == {"session": {"value": 999}}


def test_no_change_is_missed_while_rows_are_made_in_another_thread() -> None:
    store, page = RowStore("session"), dict[str, Any]()
    store.replace("p", [{"id": "a", "value": 0}])
    done = threading.Event()

    def change() -> None:
        for value in range(3000):
            ids = ("a", "b", "c")[: 1 + value % 3]
            if value % 50 == 0:
                store.replace("p", [{"id": i, "value": value} for i in ids])
            store.update("a", {"value": value, "help": None if value % 2 else "x"})
        done.set()

    thread = threading.Thread(target=change)
    thread.start()
    version, last = 0, False
    while not last:
        last = done.is_set()
        version, message = store.since(version)
        part = {} if message is None else decode(message)
        for items in part.get("panels", {}).values():
            page = {row["id"]: row for row in items}
        for row_id, patch in part.get("rows", {}).items():
            row = {**page[row_id], **patch}
            page[row_id] = {k: v for k, v in row.items() if v is not None}
    thread.join()
    assert page == {row_id: store.get(row_id) for row_id in page}
    assert page["a"]["value"] == 2999


def wait_for_clients(viz: Visualizer, count: int) -> None:
    until(lambda: len(viz.viser.get_clients()) == count)


def test_a_channel_needs_a_ticket(viz: Visualizer, pages: Pages) -> None:
    for ticket in ("", "short", "x" * 100, "with spaces and more"):
        with pytest.raises(InvalidStatus) as refused:
            pages.channel(viz, ticket.replace(" ", "+"))
        assert status_of(refused) == 409


def test_the_channel_ends_with_the_client_and_comes_back_with_the_next(
    viz: Visualizer, pages: Pages, ticket: str
) -> None:
    client, channel = pages.viser(viz, ticket), pages.channel(viz, ticket)
    rows(channel)
    client.close()
    assert closed_with(channel) == CLIENT_LEFT
    channel = pages.channel(viz, ticket)
    pages.viser(viz, ticket)
    rows(channel)


def test_a_page_that_is_left_is_no_client_any_more(
    viz: Visualizer, pages: Pages, ticket: str
) -> None:
    client, channel = pages.viser(viz, ticket), pages.channel(viz, ticket)
    rows(channel)
    channel.close(PAGE_LEFT)
    assert closed_with(client) == 1000


def test_a_channel_that_is_lost_alone_leaves_the_client_as_it_is(
    viz: Visualizer, pages: Pages, ticket: str
) -> None:
    client, channel = pages.viser(viz, ticket), pages.channel(viz, ticket)
    rows(channel)
    (before,) = viz.viser.get_clients()
    channel.close()
    rows(pages.channel(viz, ticket))
    assert list(viz.viser.get_clients()) == [before]
    assert client.ping().wait(patience(10.0))


def test_a_page_without_a_first_camera_changes_nothing(
    viz: Visualizer, pages: Pages, ticket: str
) -> None:
    client = pages.open(viz, ticket, VISER)
    channel = pages.channel(viz, ticket)
    channel.send(f'["{JOINT}",0.5]')
    channel.send(PING)
    assert channel.recv(timeout=patience(10.0)) == PONG
    client.send(msgspec.msgpack.encode({"type": "ViewerCameraMessage", **CAMERA}))
    rows(channel)
    assert viz.joint_positions[JOINT[2:]] == 0.0


def test_a_foreign_page_gets_no_channel(
    viz: Visualizer, pages: Pages, ticket: str
) -> None:
    with pytest.raises(InvalidStatus) as refused:
        pages.channel(viz, ticket, origin=Origin("https://evil.example"))
    assert status_of(refused) == 403


def test_who_has_no_token_gets_no_channel(pages: Pages, ticket: str) -> None:
    with Visualizer(port=0, token=TOKEN) as viz:
        with pytest.raises(InvalidStatus) as refused:
            pages.channel(viz, ticket)
        assert status_of(refused) == 401
        query = f"&token={TOKEN}"
        pages.viser(viz, ticket, query=query)
        rows(pages.channel(viz, ticket, query=query))


def test_a_viewer_with_the_ticket_of_the_presenter_is_refused_at_once(
    pages: Pages, ticket: str
) -> None:
    with Visualizer(port=0, presenter=PRESENTER) as viz:
        pages.viser(viz, ticket, query=f"&token={PRESENTER}")
        with pytest.raises(InvalidStatus) as refused:
            pages.channel(viz, ticket)
        assert status_of(refused) == 409
        rows(pages.channel(viz, ticket, query=f"&token={PRESENTER}"))


def test_a_viewer_who_waits_with_the_ticket_of_the_presenter_is_closed_at_once(
    pages: Pages, ticket: str
) -> None:
    with Visualizer(port=0, presenter=PRESENTER) as viz:
        viewer = pages.channel(viz, ticket)
        viewer.send(f'["{JOINT}",0.5]')
        pages.viser(viz, ticket, query=f"&token={PRESENTER}")
        with pytest.raises(ConnectionClosed):
            viewer.recv(timeout=patience(10.0))
        assert viz.joint_positions[JOINT[2:]] == 0.0


@pytest.mark.parametrize("data", [b"", b"\x01", b"x" * 1000, "text", "[" * 9000, "{}"])
def test_nonsense_is_dropped_and_the_channel_stays(
    viz: Visualizer, pages: Pages, ticket: str, data: bytes | str
) -> None:
    pages.viser(viz, ticket)
    rows(channel := pages.channel(viz, ticket))
    channel.send(data)
    answers(channel)


def test_a_message_that_is_too_long_ends_the_channel(
    viz: Visualizer, pages: Pages, ticket: str
) -> None:
    pages.viser(viz, ticket)
    rows(channel := pages.channel(viz, ticket))
    channel.send("x" * (limits.PAGE_MESSAGE.value + 1))
    assert closed_with(channel) == 1009


def test_a_long_text_for_the_clipboard_comes_in_one_piece(
    viz: Visualizer, protocol: Protocol
) -> None:
    client = protocol(viz.viser.get_port())
    assert client.rows
    session = viz.server.sessions.all()[0]
    text = "x" * 50_000 + "\nend"
    mark = client.mark()
    window = viz.server.clients._window_of(0)
    assert window is not None
    (panels,) = window._browsers.values()
    with session.lock:
        panels.give(channel_answer(text))
    client.wait_until(lambda: client.types(mark)[ROW_PATCH] == 1)
    (patch,) = [m for m in client.since(mark) if m.type == ROW_PATCH]
    assert patch.fields["rows"]["notice"]["value"]["copy"] == text
    assert patch.frame_size < 1000 < patch.size


def channel_answer(text: str) -> Any:
    from sambot_viz.panels.rows.row import Answer

    return Answer("a text", text)
