"""A browser page with the window of the program, and what tests want to know about it.

`WindowPage.page` is the page of the browser itself: mouse, keyboard, console, requests;
`WindowPage.user` is someone who uses it.
"""

from __future__ import annotations

import io
from typing import cast
from urllib.parse import urlsplit

import numpy as np
import numpy.typing as npt
from patience import patience
from PIL import Image
from recorded_page import RecordedPage
from user import User

COARSE = 0.1
"""Pixels per CSS pixel where nobody looks: software takes a small part of the time."""
Pixels = npt.NDArray[np.uint8]
_STOPPED = ("net::ERR_CONNECTION_REFUSED", "status of 503 (Service Unavailable)")
"""What a page is answered while its server stops, and after that."""


def viewer_url(
    address: str | int, resolution: float = COARSE, view: bool = True
) -> str:
    """The address to open: a port or URL, with viser's resolution held still.

    Without ``fixedDpr`` viser lowers its resolution when the machine is busy.

    Args:
        address: of the server.
        resolution: of the 3D view [pixels per CSS pixel].
        view: whether the page has one.
    """
    url = f"http://127.0.0.1:{address}" if isinstance(address, int) else address
    url, mark, link = url.partition("#")
    asked = f"fixedDpr={resolution:g}" if view else "view=none"
    url = f"{url.rstrip('/')}/{'&' if '?' in url else '?'}{asked}"
    return f"{url.replace('/&', '&')}{mark}{link}"


class WindowPage:
    """One page of the program.

    Attributes:
        page: the browser's page.
        user: who uses it.
        url: where it is.
        expects_errors: set this in a test that provokes errors, or else the fixture
            fails at the end when there were any.
    """

    def __init__(self, page: RecordedPage, url: str, finger: bool = False) -> None:
        self.page = page
        self.user = User(page, finger)
        self.url = url
        self.expects_errors = False

    def reload(self) -> None:
        """Load the page again; returns when the old one is gone."""
        # A page that is going away answers nothing.
        self.page.evaluate("window.isOld = true; setTimeout(() => location.reload())")
        self.user.until(lambda: not self.page.evaluate("window.isOld === true"))

    def view_box(self) -> tuple[float, float, float, float]:
        """Left, top, width and height of the view, or of the place for it."""
        # It has the whole page until the window is there.
        self.wait_for("document.getElementById('root').style.position === 'fixed'")
        found = self.page.evaluate(
            "(r => [r.x, r.y, r.width, r.height])"
            "(document.getElementById('root').getBoundingClientRect())"
        )
        left, top, width, height = cast("list[float]", found)
        return left, top, width, height

    def wait_for(self, condition: str, timeout: float = 10.0) -> None:
        """Wait until a JavaScript expression is true."""
        self.page.wait_for(condition, patience(timeout))

    @property
    def text(self) -> str:
        """All text that the page shows."""
        return str(self.page.evaluate("document.body.innerText"))

    def screenshot(self) -> Pixels:
        """The whole page as it is seen: (height, width, 4), RGBA, 0 to 255."""
        return decoded(self.page.screenshot())

    # Judging.

    def errors(self) -> list[str]:
        """What went wrong in the page: exceptions, console errors, failed requests.

        Its own server refuses connections only when a test has stopped it; whether the
        page still asks it for something then is chance.
        """
        lines = [m for m in self.page.console if m.level in ("error", "assert")]
        errors = [
            *self.page.exceptions,
            *(f"{line.text} {line.url}".strip() for line in lines),
            *(f"{url}: {reason}" for url, reason in self.page.failures),
        ]
        own = urlsplit(self.url).netloc
        stopped = [e for e in errors if any(said in e for said in _STOPPED)]
        return [e for e in errors if not (e in stopped and f"//{own}/" in e)]

    def foreign_requests(self) -> list[str]:
        """The addresses asked for that are not on the viewer's own server."""
        own = urlsplit(self.url).netloc
        return [url for url in self.page.requests if urlsplit(url).netloc != own]


def decoded(png: bytes) -> Pixels:
    """The pixels of a picture: (height, width, 4), RGBA, 0 to 255."""
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGBA"), np.uint8)
