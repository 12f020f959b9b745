"""Start either end of a broadcast on the event loop of a server, and stop it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from concurrent.futures import TimeoutError as FutureTimeoutError
from contextlib import suppress
from typing import Any

from sambot_viz.options import Options
from sambot_viz.server.followers.broadcast import Broadcast
from sambot_viz.server.followers.follower import Relay
from sambot_viz.server.listener import Listener, page_url, public_url, reachable_at
from sambot_viz.server.outgoing.outbox import Outbox
from sambot_viz.server.protection.inbound_filter import ClientHandler
from sambot_viz.sources.broadcast_place import parse_place

_LONGEST_END = 2.0
"""Longest wait for the end [s]."""


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
    made = Broadcast(place, url, outgoing, handler, listener.channels)
    return _run(listener, made.run)


def follow(options: Options, listener: Listener) -> Callable[[], None]:
    """Show another server's broadcast in a server; return a function that stops it."""
    assert options.follow is not None
    made = Relay(parse_place(options.follow, "--follow"), listener)
    listener.give(made)
    return _run(listener, made.run)


def _url(options: Options, port: int) -> str:
    """Return the address of a server's page, without secrets; "" for none."""
    plain = options.having(token=None, presenter=None)
    if plain.unix_socket is not None:
        return public_url(plain) or ""
    return public_url(plain) or page_url(plain, reachable_at(plain.host), port)


def _run(
    listener: Listener, main: Callable[[], Coroutine[Any, Any, None]]
) -> Callable[[], None]:
    loop = listener.viser.get_event_loop()
    tasks: list[asyncio.Task[None]] = []

    def begin() -> None:
        tasks.append(loop.create_task(main()))

    async def end() -> None:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    def stop() -> None:
        if not loop.is_closed():
            with suppress(FutureTimeoutError):
                asyncio.run_coroutine_threadsafe(end(), loop).result(_LONGEST_END)

    loop.call_soon_threadsafe(begin)
    return stop
