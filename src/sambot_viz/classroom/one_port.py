"""A small server of one port, in a thread, for pages that need no viewer."""

from __future__ import annotations

import asyncio
import threading
from asyncio import StreamReader, StreamWriter
from collections.abc import Awaitable, Callable, Coroutine

from websockets.http11 import Request, Response

from sambot_viz import limits
from sambot_viz.classroom.requests import BadRequestError, read_request
from sambot_viz.options import Options
from sambot_viz.server.handshake import without_base
from sambot_viz.server.listener import bound_socket
from sambot_viz.server.protection import access
from sambot_viz.server.protection.token_check import TokenCheck
from sambot_viz.server.readiness import readiness

_DRAIN = 15.0
"""Longest time that a client may take for an answer [s]."""
Answer = Callable[[Request, str, StreamWriter], Awaitable[Response | None]]
"""Receives a request that may enter, its path below the base path, and the connection;
returns None when the answer has been written."""
Enter = Callable[[Request, str], Awaitable[Response | None]]
"""Receives a request before its token is checked, and its path below the base path;
returns None to have it checked."""


class OnePort:
    """Serves requests, from `start` to `stop`.

    Args:
        options: address to listen on, and the base path.
        name: name of the thread.
        check: admits requests.
        answer: answers them, on the loop.
        beside: runs on the loop meanwhile; None for nothing.
        enter: a login; None without one.

    Attributes:
        port: port it listens on; 0 for a socket in the file system.

    Raises:
        ServerError: the address cannot be listened on.
    """

    def __init__(
        self,
        options: Options,
        name: str,
        check: TokenCheck,
        answer: Answer,
        beside: Callable[[], Coroutine[object, object, None]] | None = None,
        enter: Enter | None = None,
    ) -> None:
        self._options, self._check, self._reply = options, check, answer
        self._beside, self._enter = beside, enter
        self._socket = bound_socket(options)
        self._socket.listen()
        named = self._socket.getsockname()
        self.port = 0 if options.unix_socket is not None else int(named[1])
        self._open: set[asyncio.Task[None]] = set()
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)

    def start(self) -> None:
        """Start listening."""
        self._thread.start()

    def stop(self) -> None:
        """End all connections, and free the port."""
        self._loop.call_soon_threadsafe(self._end.set)
        self._thread.join()
        self._socket.close()

    # On the loop

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        self._end = asyncio.Event()
        self._loop.run_until_complete(self._serve())
        self._loop.close()

    async def _serve(self) -> None:
        longest = limits.CLASS_REQUEST.value
        server = await asyncio.start_server(
            self._take, sock=self._socket, limit=longest
        )
        if self._beside is not None:
            self._open.add(asyncio.create_task(self._beside()))
        await self._end.wait()
        server.close()
        for task in self._open:
            task.cancel()
        await asyncio.gather(*self._open, return_exceptions=True)

    async def _take(self, reader: StreamReader, writer: StreamWriter) -> None:
        task = asyncio.current_task()
        assert task is not None
        self._open.add(task)
        try:
            if len(self._open) <= limits.CONNECTIONS.value:
                response = await self._answer(await read_request(reader), writer)
                if response is not None:
                    response.headers["Connection"] = "close"
                    writer.write(response.serialize())
                    await asyncio.wait_for(writer.drain(), _DRAIN)
        except (BadRequestError, OSError, UnicodeError, asyncio.CancelledError):
            # The client has left, or sends requests that browsers do not make.
            pass
        finally:
            self._open.discard(task)
            writer.close()

    async def _answer(self, request: Request, writer: StreamWriter) -> Response | None:
        path = without_base(request.path, self._options.base_path)
        found = readiness(request, path, "ready")
        found = found or access.refusal(request, self._options)
        if found is None and self._enter is not None:
            found = await self._enter(request, path)
        found = found or self._check.refusal(request)
        if found is not None:
            return found if isinstance(found, Response) else await found
        return await self._reply(request, path, writer)
