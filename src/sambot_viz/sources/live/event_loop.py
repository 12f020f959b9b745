"""An event loop in which nothing slow holds up the end of the program."""

from __future__ import annotations

import asyncio
import socket
import threading
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import Any, TypeVar

T = TypeVar("T")


class SourceLoop(asyncio.SelectorEventLoop):
    """Looks up names, and does what else takes long, in daemon threads.

    asyncio does so in a pool of threads, and Python waits for those when it ends: a
    name server that does not answer would hold up Ctrl-C for half a minute.
    """

    async def getaddrinfo(self, *args: Any, **options: Any) -> Any:
        """Return what `socket.getaddrinfo` does."""
        return await self.aside(lambda: socket.getaddrinfo(*args, **options))

    async def aside(self, work: Callable[[], T]) -> T:
        """Return what something gives that may take long, done in a daemon thread."""
        found: asyncio.Future[T] = self.create_future()

        def settle(settled: Callable[[], object]) -> None:
            if not found.done():
                settled()

        def do() -> None:
            try:
                result = work()
                settled = partial(found.set_result, result)
            except Exception as error:
                settled = partial(found.set_exception, error)
            # The loop may have been closed meanwhile.
            with suppress(RuntimeError):
                self.call_soon_threadsafe(settle, settled)

        threading.Thread(target=do, name="sambot-viz aside", daemon=True).start()
        return await found
