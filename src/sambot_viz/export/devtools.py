"""The DevTools protocol: one websocket to a browser, calls with answers, and events.

It has only what a snapshot and a browser test need; everything about one page is in
`browser_page`. A thread reads the socket, so that events are recorded while
no call waits for an answer.
"""

from __future__ import annotations

import json
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, cast

from sambot_viz.errors import ServerError

if TYPE_CHECKING:
    from websockets.sync.client import ClientConnection

Fields = dict[str, Any]
Listener = Callable[[str, Fields], None]


class BrowserError(ServerError):
    """There is no browser, it ended, or it could not do what it was asked for."""


class DevTools:
    """A connection to a browser's debugging address.

    Several threads may call at the same time. Listeners run on the reading thread and
    must not wait for an answer; they may `post`.
    """

    def __init__(self, url: str, timeout: float = 30.0) -> None:
        """Connect.

        Args:
            url: the ws:// address that the browser printed.
            timeout: how long a call may take at most [s].

        Raises:
            BrowserError: there is no answer at this address.
        """
        # The import is late because most commands never start a browser.
        from websockets.exceptions import WebSocketException
        from websockets.sync.client import connect

        self._timeout = timeout
        self._changed = threading.Condition()
        self._answers: dict[int, Fields] = {}
        self._listeners: dict[str, Listener] = {}
        self._waiting: set[int] = set()
        self._last_id = 0
        self._ended = False
        try:
            # The browser is on this machine; a proxy would not find it.
            self._socket: ClientConnection = connect(
                url, max_size=None, compression=None, proxy=None
            )
        except (OSError, WebSocketException) as error:
            raise BrowserError(f"the browser does not answer at {url}: {error}") from (
                error
            )
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def call(
        self,
        method: str,
        params: Fields | None = None,
        session: str = "",
        timeout: float | None = None,
    ) -> Fields:
        """Ask the browser for something and wait for its answer.

        Args:
            method: such as "Page.navigate".
            params: the method's fields.
            session: the attached page it is for; empty for the browser itself.
            timeout: how long it may take [s]; None for the connection's own.

        Raises:
            BrowserError: the browser refuses, ends, or does not answer in time.
        """
        seconds = self._timeout if timeout is None else timeout
        number = self._send(method, params or {}, session, waits=True)
        with self._changed:
            self._changed.wait_for(
                lambda: number in self._answers or self._ended, seconds
            )
            self._waiting.discard(number)
            answer = self._answers.pop(number, None)
        if answer is None:
            why = "the browser ended" if self._ended else f"no answer in {seconds:g} s"
            raise BrowserError(f"{method}: {why}")
        if "error" in answer:
            raise BrowserError(f"{method}: {answer['error'].get('message', answer)}")
        return cast(Fields, answer.get("result", {}))

    def post(
        self, method: str, params: Fields | None = None, session: str = ""
    ) -> None:
        """Ask for something without waiting; an answer is thrown away."""
        self._send(method, params or {}, session, waits=False)

    def listen(self, session: str, listener: Listener) -> None:
        """Give every event of `session` to ``listener(method, fields)``."""
        with self._changed:
            self._listeners[session] = listener

    def wait_until(self, condition: Callable[[], bool], timeout: float) -> bool:
        """Wait until `condition` is true, asked after every event; False if never.

        Raises:
            BrowserError: the browser ended meanwhile.
        """
        with self._changed:
            self._changed.wait_for(lambda: condition() or self._ended, timeout)
            if condition():
                return True
            if self._ended:
                raise BrowserError("the browser ended")
            return False

    def close(self) -> None:
        """Close the connection; the browser goes on."""
        self._socket.close()
        self._thread.join(timeout=5.0)

    def _send(self, method: str, params: Fields, session: str, *, waits: bool) -> int:
        from websockets.exceptions import ConnectionClosed

        with self._changed:
            self._last_id += 1
            number = self._last_id
            if waits:
                self._waiting.add(number)
        message: Fields = {"id": number, "method": method, "params": params}
        if session:
            message["sessionId"] = session
        try:
            self._socket.send(json.dumps(message))
        except ConnectionClosed as error:
            raise BrowserError(f"{method}: the browser ended") from error
        return number

    def _read(self) -> None:
        from websockets.exceptions import ConnectionClosed

        try:
            for text in self._socket:
                self._take(cast(Fields, json.loads(text)))
        except ConnectionClosed:
            pass
        finally:
            with self._changed:
                self._ended = True
                self._changed.notify_all()

    def _take(self, message: Fields) -> None:
        with self._changed:
            number = message.get("id")
            if number is not None:
                if number in self._waiting:
                    self._answers[number] = message
            else:
                session = str(message.get("sessionId", ""))
                listener = self._listeners.get(session)
                if listener is not None:
                    listener(str(message["method"]), message.get("params", {}))
            self._changed.notify_all()
