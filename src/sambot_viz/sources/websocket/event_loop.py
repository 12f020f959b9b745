"""An event loop whose look-up of names never holds up the end of the program."""

from __future__ import annotations

import asyncio
import socket
import threading
from contextlib import suppress
from typing import Any


class SourceLoop(asyncio.SelectorEventLoop):
    """Looks up names in a daemon thread.

    asyncio does so in a pool of threads, and Python waits for those when it ends: a
    name server that does not answer would hold up Ctrl-C for half a minute.
    """

    async def getaddrinfo(self, *args: Any, **options: Any) -> Any:
        """Return what `socket.getaddrinfo` does."""
        found: asyncio.Future[Any] = self.create_future()

        def settle(result: Any, error: Exception | None) -> None:
            if found.done():
                return
            if error is not None:
                found.set_exception(error)
            else:
                found.set_result(result)

        def look_up() -> None:
            result, error = None, None
            try:
                result = socket.getaddrinfo(*args, **options)
            except Exception as caught:
                error = caught
            # The loop may have been closed meanwhile.
            with suppress(RuntimeError):
                self.call_soon_threadsafe(settle, result, error)

        threading.Thread(target=look_up, name="sambot-viz names", daemon=True).start()
        return await found
