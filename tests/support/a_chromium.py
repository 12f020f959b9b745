"""The browser that tests and benchmarks share, or the reason why there is none."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from contextlib import contextmanager

import pytest

from sambot_viz.export.browser_process import find_browser, how_to_get_a_browser
from sambot_viz.export.chromium import Chromium

QUICK = (
    # Only the 3D view needs OpenGL; without a graphics card the rest is quicker so.
    "--disable-gpu-rasterization",
    "--disable-gpu-compositing",
    # Pages of the browser's own, which it loads for the address bar of each window.
    "--disable-features=WebUIOmniboxPopup,WebUIOmniboxAimPopup",
)
"""What saves a third of the computing of a window."""


@contextmanager
def a_chromium(timeout: float, flags: Sequence[str] = ()) -> Generator[Chromium]:
    """A running browser with the scroll bars of a desktop.

    Without one on this machine the test is skipped.

    Args:
        timeout: how long any one answer of it may take [s].
        flags: further command line flags.
    """
    if find_browser() is None:
        pytest.skip(f"no Chromium or Chrome on this machine; {how_to_get_a_browser()}")
    with Chromium(timeout=timeout, scroll_bars=True, flags=flags) as browser:
        yield browser
