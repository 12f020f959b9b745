"""Makes the pages that browsers ask for, one after the other, beside all other work."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any

from sambot_viz.errors import SambotVizError, UsageError
from sambot_viz.export.page_file import Looking, page_file
from sambot_viz.export.recorded_scene import Shown
from sambot_viz.session import Session
from sambot_viz.session.browser.browser import Browser

LARGEST = 100_000_000
"""A page of more bytes is not sent to a browser."""

_ONE = ThreadPoolExecutor(1, "sambot-viz-export")
"""One page is made at a time, so that many browsers take the memory of one."""


class PageError(SambotVizError):
    """There is no page that could be sent."""


def ask_page(
    session: Session, browser: Browser, motion: str
) -> Callable[[], Coroutine[Any, Any, bytes]]:
    """Note what a browser sees now, for `panels.files`.

    Args:
        session: what is shown.
        browser: who looks at it.
        motion: what is to move (see `page_file`).

    Returns:
        What makes the HTML file, while other work of the event loop goes on. It raises
        PageError when the file is too large to be sent.

    Raises:
        UsageError: there is no such motion, or nothing has moved.
    """
    with session.lock:
        past = session.past.last_minute()
        if motion == "past" and not past[1]:
            raise UsageError("nothing has moved in the last minute")
        if motion not in ("sweep", "past", "none"):
            raise UsageError(f"there is no motion '{motion}'")
        make = partial(page_file, Shown.by(session), Looking.of(browser), motion, past)
    return partial(_made, make)


async def _made(make: Callable[[], bytes]) -> bytes:
    page = await asyncio.get_running_loop().run_in_executor(_ONE, make)
    if len(page) > LARGEST:
        raise PageError(
            f"the page would have {len(page) / 1e6:.0f} MB: `sambot-viz export` "
            "writes it on the computer of the program"
        )
    return page
