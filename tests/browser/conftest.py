"""A real Chromium for the tests that look at the page."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from viewer_page import ViewerPage

    from sambot_viz.export.chromium import Chromium


@pytest.fixture
def open_viewer(chromium: Chromium) -> Iterator[Callable[..., ViewerPage]]:
    """Open a viewer in a page of its own: ``open_viewer(url_or_port)``.

    The pages are closed at the end of the test. The test fails there when a page had
    an error or asked another server for anything, unless it set `expects_errors`. What
    depends on the pixels that the view has before they are read asks for resolution=1.
    """
    from recorded_page import open_page
    from viewer_page import COARSE, ViewerPage, viewer_url

    viewers: list[ViewerPage] = []

    def open_one(
        address: str | int,
        *,
        width: int = 1280,
        height: int = 720,
        touch: bool = False,
        dark: bool = False,
        resolution: float = COARSE,
    ) -> ViewerPage:
        page = open_page(chromium, width, height, touch=touch)
        page.set_dark(dark)
        url = viewer_url(address, resolution)
        page.goto(url)
        viewers.append(ViewerPage(page, url, touch))
        return viewers[-1]

    yield open_one
    for viewer in viewers:
        viewer.page.close()
    for viewer in viewers:
        assert viewer.foreign_requests() == []
        if not viewer.expects_errors:
            assert viewer.errors() == []
