"""Windows of the browser for the pages of Jupyter."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from recorded_page import RecordedPage, open_page

from sambot_viz.export.chromium import Chromium


@pytest.fixture
def open_in_browser(chromium: Chromium) -> Iterator[Callable[[str], RecordedPage]]:
    """Open an address, each in a window with storage of its own."""
    pages: list[RecordedPage] = []

    def open_one(url: str) -> RecordedPage:
        pages.append(open_page(chromium, 1280, 800))
        pages[-1].goto(url)
        return pages[-1]

    yield open_one
    for page in pages:
        page.close()
