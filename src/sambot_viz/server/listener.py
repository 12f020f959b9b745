"""Open the port: all that must happen before a page can be opened, and no more.

Nothing but viser is imported here, so that the address is there as soon as viser
itself can have it; the rest of the program is imported while a browser loads the page.
"""

from __future__ import annotations

import errno
import os
import socket
import stat
from contextlib import suppress
from typing import cast

import viser
from websockets.asyncio.server import ServerConnection

from sambot_viz import extras, limits, viser_private
from sambot_viz.errors import ServerError
from sambot_viz.options import Options
from sambot_viz.server import handshake
from sambot_viz.server.connections.connection import Connection
from sambot_viz.server.outgoing import outbox
from sambot_viz.server.protection.inbound_filter import (
    CLOSE_TIME,
    ClientHandler,
    InboundFilter,
)
from sambot_viz.server.protection.token_check import Knows
from sambot_viz.server.tickets import Channels

_OF_A_PROBE: int = getattr(socket, "SO_EXCLUSIVEADDRUSE", socket.SO_REUSEADDR)
"""Of a socket that asks if a port is free. SO_REUSEADDR does without the port's pause
after a program; on Windows it would let two programs have one port."""
_ANYWHERE = {"0.0.0.0": "127.0.0.1", "": "127.0.0.1", "::": "::1"}
"""Addresses that mean all networks, and one of them that a browser can open."""


class Listener:
    """A viser server that listens, and whose clients pass the inbound filter.

    Args:
        server: the viser server; it has no client yet.
        options: the address, the base path, and the secrets of the links.
        channels: the channels of the pages.
        answers: what it answers beside the page.

    Attributes:
        viser: the viser server.
        answers: as given.
        channels: as given.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        options: Options,
        channels: Channels,
        answers: handshake.Answers,
    ) -> None:
        self.viser = server
        self.answers = answers
        self.channels = channels
        self._options = options
        self._socket_file = options.unix_socket
        outbox.prepare(server)
        viser_private.on_connection(server, self._prepare)

    def _prepare(self, client_id: int, connection: ServerConnection) -> None:
        """Prepare the connection of a client before anything is read or sent."""
        own = cast(Connection, connection)
        own.client_id = client_id
        own.writer.prepare()
        outbox.prepare_own(self.viser, client_id)
        own.close_timeout = CLOSE_TIME
        own.read = InboundFilter(
            self.viser, lambda: self.channels.handler, client_id, own
        ).read

    def give(self, handler: ClientHandler) -> None:
        """Give what the clients edit to a program, which has the rows of the pages."""
        self.channels.handler = handler

    def tell_joined(self) -> None:
        """Send rows to the clients that have some now; in any thread."""
        # A loop that has ended already has no clients.
        with suppress(RuntimeError):
            loop = self.viser.get_event_loop()
            loop.call_soon_threadsafe(self.channels.tell_joined)

    async def tell_stop(self) -> None:
        """Tell all pages that the server stops; on the loop."""
        await self.channels.tell_stop()

    def url(self, host: str = "", *, presenter: bool = False) -> str:
        """Return the address to open in a browser: "http://127.0.0.1:8080".

        A socket in the file system, which no browser can open, is named "unix:PATH".

        Args:
            host: the name to reach it by, instead of the address it listens on.
            presenter: the presenter's link, instead of that for everyone.
        """
        port = self.viser.get_port()
        return page_url(self._options, host, port, presenter=presenter)

    def __enter__(self) -> Listener:
        """Return this listener, which the end of the block closes."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close."""
        self.close()

    def close(self) -> None:
        """Stop the server and print nothing; a second call does nothing."""
        with viser_private.without_banner():
            self.viser.stop()
        path, self._socket_file = self._socket_file, None
        if path is not None:
            with suppress(OSError):
                os.unlink(path)


def page_url(
    options: Options, host: str, port: int, below: str = "", *, presenter: bool = False
) -> str:
    """Return the address to open in a browser, or the socket in the file system.

    Args:
        options: where the program listens, and its secrets.
        host: the name to reach it by; "" for the address it listens on.
        port: on which it listens.
        below: where the page is below the base path.
        presenter: the presenter's link, instead of that for everyone.
    """
    if options.unix_socket is not None:
        return f"unix:{options.unix_socket}"
    host = host or _ANYWHERE.get(options.host, options.host)
    name = f"[{host}]" if ":" in host else host
    path = "" if options.base_path == "/" else options.base_path
    base = f"http://{name}:{port}{path}"
    return with_secret(base, options, below, presenter=presenter)


def with_secret(
    base: str, options: Options, below: str = "", *, presenter: bool = False
) -> str:
    """Return the address of a page with its secret, under a name that says whose it is.

    Two links that look alike end up in the wrong chat. What is below has no slash at
    its end: so a browser sends the cookie of the answer to all that is beside it.
    """
    secret = options.presenter if presenter else options.token
    if secret is None:
        return f"{base}{below}"
    name = "token" if options.presenter is None else "view"
    place = f"{base.rstrip('/')}{below or '/'}"
    return f"{place}?{'present' if presenter else name}={secret}"


def public_url(
    options: Options, below: str = "", *, presenter: bool = False
) -> str | None:
    """Return the link at the first allowed origin, where a proxy shows the page.

    The arguments are those of `page_url`.

    Returns:
        None when no origin was allowed.
    """
    if not options.allowed_origins:
        return None
    path = "" if options.base_path == "/" else options.base_path
    base = f"{options.allowed_origins[0]}{path}"
    return with_secret(base, options, below, presenter=presenter)


def reachable_at(host: str) -> str:
    """Return the address by which other machines reach a server that listens on `host`.

    For a server on all networks that is the address of the one through which this
    machine reaches others; nothing is sent to find it out.
    """
    if host not in _ANYWHERE:
        return host
    family, far = (
        (socket.AF_INET6, "2001:db8::1")
        if ":" in host
        else (socket.AF_INET, "192.0.2.1")
    )
    with socket.socket(family, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect((far, 9))
        except OSError:
            return socket.gethostname()
        return str(probe.getsockname()[0])


def listen(options: Options, knows: Knows | None = None) -> Listener:
    """Start a viser server on exactly the address that the options name.

    viser itself takes the next free port without a message, and tries forever on an
    address that this machine does not have.

    Args:
        options: the address, and who may use the server.
        knows: whom it lets in without the token too (see `TokenCheck`).

    Raises:
        ServerError: the address cannot be listened on, with what to do about it.
        UsageError: a package of an extra is missing.
    """
    if options.metrics:
        needs = "--metrics needs the package prometheus-client, which is not installed"
        extras.require("metrics", "prometheus_client", needs)
    host, port = options.host, options.port
    path = None if options.unix_socket is None else os.fspath(options.unix_socket)
    listening: socket.socket | None = bound_socket(options)
    if path is None:
        # It was tried for the message; viser makes its own.
        listening.close()
        listening = None
    viser_private.quiet_websockets()
    viser_private.remember_prop_types()
    viser_private.compare_poses_quickly()
    viser_private.tell_poses_of_remade_nodes()
    channels, answers = Channels(), handshake.Answers()
    checked = handshake.checked(
        options, listening, limits.PAGE_MESSAGE.value, channels, answers, knows
    )
    with viser_private.without_banner(), checked as ready:
        server = viser.ViserServer(host=host, port=port, verbose=False)
    listener = Listener(server, options, channels, answers)
    # Clients that were quicker than this wait for it; also those of a server that is
    # closed at once, which would wait for them.
    server.get_event_loop().call_soon_threadsafe(ready.set)
    if path is None and port not in (0, server.get_port()):
        listener.close()
        raise _taken(host, port)
    return listener


def bound_socket(options: Options) -> socket.socket:
    """Return a socket at exactly the address that the options name.

    Raises:
        ServerError: the address cannot be listened on, with what to do about it.
    """
    if options.unix_socket is not None:
        return _bind_in_file_system(os.fspath(options.unix_socket))
    return _bind(options.host, options.port)


def _bind(host: str, port: int) -> socket.socket:
    if not 0 <= port <= 65535:
        raise ServerError(f"port {port} does not exist; choose one from 1 to 65535")
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    made = socket.socket(family, socket.SOCK_STREAM)
    made.setsockopt(socket.SOL_SOCKET, _OF_A_PROBE, 1)
    try:
        made.bind((host, port))
    except (OSError, UnicodeError) as error:
        made.close()
        code = error.errno if isinstance(error, OSError) else None
        if code == errno.EADDRINUSE:
            raise _taken(host, port) from error
        if code == errno.EACCES:
            raise ServerError(
                f"port {port} needs the rights of an administrator; choose one "
                "from 1024 on, or --port 0 for any free one"
            ) from error
        raise ServerError(
            f"cannot listen on '{host}': this machine has no such address; use "
            "127.0.0.1 for this machine only, or 0.0.0.0 for all its networks"
        ) from error
    return made


def _bind_in_file_system(path: str) -> socket.socket:
    """Make a socket that only programs of the same user can open.

    Raises:
        ServerError: it cannot be made.
    """
    if not hasattr(socket, "AF_UNIX"):
        raise ServerError("this system has no sockets in the file system; give a port")
    made = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    before = os.umask(0o177)
    try:
        _remove_left_over(path)
        made.bind(path)
    except OSError as error:
        made.close()
        reason = "a program listens there already, or it is a file"
        if error.errno != errno.EADDRINUSE:
            reason = error.strerror or str(error)
        raise ServerError(f"cannot listen on the socket '{path}': {reason}") from error
    finally:
        os.umask(before)
    return made


def _remove_left_over(path: str) -> None:
    """Remove the socket of a program that was killed."""
    with suppress(FileNotFoundError):
        if stat.S_ISSOCK(os.stat(path).st_mode):
            with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as probe:
                if probe.connect_ex(path) == errno.ECONNREFUSED:
                    os.unlink(path)


def _taken(host: str, port: int) -> ServerError:
    return ServerError(
        f"port {port} on {host} is taken by another program; choose another with "
        "--port, or --port 0 for any free one"
    )
