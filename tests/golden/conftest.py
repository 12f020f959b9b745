"""The page in which all tests of this folder show their scenes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from shared_page import SharedPage

    from sambot_viz.export.chromium import Chromium


@pytest.fixture(scope="session")
def shared_page(chromium: Chromium) -> Iterator[SharedPage]:
    """A page of RViz's look, without panels; it draws only when a test asks."""
    from shared_page import SharedPage

    page = SharedPage(chromium)
    yield page
    page.close()
