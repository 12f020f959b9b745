"""The browser that tests and benchmarks share, or the reason why there is none."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager

import pytest

from sambot_viz.export.browser_process import find_browser, how_to_get_a_browser
from sambot_viz.export.chromium import Chromium


@contextmanager
def a_chromium(timeout: float) -> Generator[Chromium]:
    """A running browser with the scroll bars of a desktop.

    Without one on this machine the test is skipped.

    Args:
        timeout: how long any one answer of it may take [s].
    """
    if find_browser() is None:
        pytest.skip(f"no Chromium or Chrome on this machine; {how_to_get_a_browser()}")
    with Chromium(timeout=timeout, scroll_bars=True) as browser:
        yield browser
