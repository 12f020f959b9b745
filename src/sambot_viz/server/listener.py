"""Open the port: only the steps that a browser needs before it can open a page.

This module imports only viser, so that the address is available as early as viser
allows. The rest of the program is imported while a browser loads the page.
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
"""Option of a socket that probes for a free port. SO_REUSEADDR skips the wait after a
program has released the port; on Windows it would let two programs share one port."""
_ANYWHERE = {"0.0.0.0": "127.0.0.1", "": "127.0.0.1", "::": "::1"}
"""Addresses that mean all networks → one that a browser can open."""


class Listener:
    """A listening viser server whose clients pass the inbound filter.

    Args:
        server: the viser server, still without clients.
        options: the address, the base path, and the secrets of the links.
        channels: channels of the pages.
        answers: answers to requests for anything but the page.

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
        """Prepare the connection of a client before any message passes."""
        own = cast(Connection, connection)
        own.client_id = client_id
        own.writer.prepare()
        outbox.prepare_own(self.viser, client_id)
        own.close_timeout = CLOSE_TIME
        own.read = InboundFilter(
            self.viser, lambda: self.channels.handler, client_id, own
        ).read

    def give(self, handler: ClientHandler) -> None:
        """Set the handler of edits, which also provides the rows of the pages."""
        self.channels.handler = handler

    def tell_joined(self) -> None:
        """Send rows to the clients that have new ones; call it in any thread."""
        # A loop that has ended has no clients left.
        with suppress(RuntimeError):
            loop = self.viser.get_event_loop()
            loop.call_soon_threadsafe(self.channels.tell_joined)

    async def tell_stop(self) -> None:
        """Notify all pages that the server stops; call it on the event loop."""
        await self.channels.tell_stop()

    def url(self, host: str = "", *, presenter: bool = False) -> str:
        """Return the address to open in a browser: "http://127.0.0.1:8080".

        A socket in the file system, which browsers cannot open, becomes "unix:PATH".

        Args:
            host: host name in the address; "" for the address it listens on.
            presenter: return the presenter's link instead of the one for everyone.
        """
        port = self.viser.get_port()
        return page_url(self._options, host, port, presenter=presenter)

    def __enter__(self) -> Listener:
        """Return this listener; the end of the block closes it."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close."""
        self.close()

    def close(self) -> None:
        """Stop the server and print nothing; further calls do nothing."""
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
        options: address to listen on, and the secrets.
        host: host name in the address; "" for the address it listens on.
        port: port it listens on.
        below: path of the page below the base path.
        presenter: return the presenter's link instead of the one for everyone.
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
    """Return the address of a page with its secret, in a parameter that names the role.

    Users would confuse two links that look alike. `below` has no slash at its end, so
    that a browser sends the cookie of the answer to the neighbouring paths too.
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
    """Return the link at the first allowed origin, where a proxy serves the page.

    The arguments are those of `page_url`.

    Returns:
        None when no origin is allowed.
    """
    if not options.allowed_origins:
        return None
    path = "" if options.base_path == "/" else options.base_path
    base = f"{options.allowed_origins[0]}{path}"
    return with_secret(base, options, below, presenter=presenter)


def reachable_at(host: str) -> str:
    """Return the address at which other machines reach a server listening on `host`.

    For a server on all networks, this is the address of the interface that leads to
    other machines. Finding it sends no packet.
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
    """Start a viser server on exactly the address in the options.

    viser itself takes the next free port without a message, and retries forever on an
    address that this machine does not have.

    Args:
        options: the address, and who may use the server.
        knows: recognises users who need no token (see `TokenCheck`).

    Raises:
        ServerError: the address cannot be listened on; the message gives a remedy.
        UsageError: a package of an extra is missing.
    """
    if options.metrics:
        needs = "--metrics needs the package prometheus-client, which is not installed"
        extras.require("metrics", "prometheus_client", needs)
    host, port = options.host, options.port
    path = None if options.unix_socket is None else os.fspath(options.unix_socket)
    listening: socket.socket | None = bound_socket(options)
    if path is None:
        # The probe only provides the error message; viser opens its own socket.
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
    # Clients that connect earlier wait for this event. It is also set for a server that
    # closes at once, because closing waits for those clients.
    server.get_event_loop().call_soon_threadsafe(ready.set)
    if path is None and port not in (0, server.get_port()):
        listener.close()
        raise _taken(host, port)
    return listener


def bound_socket(options: Options) -> socket.socket:
    """Return a socket at exactly the address in the options.

    Raises:
        ServerError: the address cannot be listened on; the message gives a remedy.
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
        ServerError: the socket cannot be created.
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
    """Remove the socket that a killed program has left."""
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
