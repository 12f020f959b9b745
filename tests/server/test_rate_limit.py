"""A browser that sends faster than its session works."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from protocol_client import ROW_PATCH, ProtocolClient

from sambot_viz.options import Options
from sambot_viz.panels.rows.row_store import ClientRows, RowStore
from sambot_viz.server.connections.rate_limit import WINDOW
from sambot_viz.server.listener import Listener, listen
from sambot_viz.server.protection.inbound_filter import NoSessions


@pytest.fixture
def listener() -> Iterator[Listener]:
    with listen(Options()) as listener:
        yield listener


def test_what_a_session_has_not_done_yet_waits_in_the_connection(
    listener: Listener, protocol: Callable[..., ProtocolClient]
) -> None:
    taken: list[object] = []
    waiting: list[Callable[[], None]] = []

    stores = RowStore("session"), RowStore("browser")
    for store in stores:
        store.replace("panel", [])

    class Slow(NoSessions):
        def take_edit(self, client_id: int, edit: object) -> None:
            taken.append(edit)

        def behind(self, client_id: int, action: Callable[[], None]) -> None:
            waiting.append(action)

        def rows_of(self, client_id: int) -> ClientRows:
            return ClientRows(stores)

    listener.give(Slow())
    client = protocol(listener.viser.get_port())
    listener.tell_joined()
    client.wait_until(lambda: ROW_PATCH in client.types())
    last = 5 * WINDOW
    for number in range(last):
        client.edit("row", number)
    done = 0
    while len(taken) < last:
        seen = len(taken)
        assert seen < (done + 2) * WINDOW
        if waiting:
            waiting.pop(0)()
            done += 1
        client.wait_until(lambda: bool(waiting) or len(taken) > seen)  # noqa: B023
    assert taken == [["row", number] for number in range(last)]
