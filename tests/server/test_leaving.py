"""Pages that have left before it was their turn to be let in."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Callable

import pytest
import viser
from inside import session_of, viser_server
from protocol_client import ProtocolClient, wait_for_workers

from sambot_viz import Visualizer

Protocol = Callable[..., ProtocolClient]


def come(viz: Visualizer, protocol: Protocol, path: str) -> ProtocolClient:
    """Open a page, until viser has its client; its rows are not waited for."""
    there = set(viser_server(viz).get_clients())
    client = protocol(viz.viser.get_port(), path=path)
    client.wait_until(lambda: not set(viser_server(viz).get_clients()) <= there)
    return client


def all_gone(handles: list[weakref.ref[viser.ClientHandle]]) -> bool:
    gc.collect()
    return not any(handle() for handle in handles)


@pytest.mark.parametrize("path", ["", "/copy"])
def test_nothing_is_kept_of_pages_that_were_let_in_and_left(
    make_viz: Callable[..., Visualizer], protocol: Protocol, path: str
) -> None:
    viz = make_viz(presenter="teach-the-class")
    server = viser_server(viz)
    stays = come(viz, protocol, "")
    handles: list[weakref.ref[viser.ClientHandle]] = []
    for _ in range(3):
        client = come(viz, protocol, path)
        handles.append(weakref.ref(list(server.get_clients().values())[-1]))
        client.wait_until(lambda: "role/me" in client.rows)  # noqa: B023
        client.close()
        stays.wait_until(lambda: len(server.get_clients()) == 1)
    wait_for_workers()
    stays.wait_until(lambda: all_gone(handles))


@pytest.mark.parametrize("path", ["", "/copy"])
def test_pages_that_left_while_joining_was_held_back_leave_nothing(
    make_viz: Callable[..., Visualizer], protocol: Protocol, path: str
) -> None:
    viz = make_viz(presenter="teach-the-class")
    session, server = session_of(viz), viser_server(viz)
    stays = come(viz, protocol, "")
    stays.wait_until(lambda: "role/me" in stays.rows)
    joined: list[int] = []
    session.clients.listeners.append(lambda client, _: joined.append(client.client_id))
    handles: list[weakref.ref[viser.ClientHandle]] = []
    # Nobody is let in while a program holds the session.
    with session.lock:
        for _ in range(6):
            client = come(viz, protocol, path)
            handles.append(weakref.ref(list(server.get_clients().values())[-1]))
            client.close()
            stays.wait_until(lambda: len(server.get_clients()) == 1)
    wait_for_workers()
    wait_for_workers()
    assert joined == []
    assert len(session.roles.people) == len(session.clients.all) == 1
    assert len(viz.server.sessions.all()) == 1
    stays.settle(server)
    assert sum(row.startswith("person/") for row in stays.rows) == 1
    stays.wait_until(lambda: all_gone(handles))
