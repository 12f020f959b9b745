"""The browser itself: that it starts clean, obeys, and ends with all its processes."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import pytest
from recorded_page import open_page

from sambot_viz.export.chromium import Chromium
from sambot_viz.export.devtools import BrowserError

pytestmark = pytest.mark.browser


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_it_ends_with_its_processes_and_its_profile(
    chromium: Chromium, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The session's browser is asked for only to be skipped where there is none.
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    with Chromium() as browser:
        assert len(list(tmp_path.iterdir())) >= 1
        information = browser.devtools.call("SystemInfo.getProcessInfo")
        processes = [int(p["id"]) for p in information["processInfo"]]
    assert list(tmp_path.glob("sambot-viz-browser-*")) == []
    running = [p for p in processes if is_running(p)]
    assert running == []
    with pytest.raises(BrowserError, match="not running"):
        browser.open()


def is_running(process: int) -> bool:
    """Whether a process runs; one that only waits to be buried does not."""
    try:
        state = Path(f"/proc/{process}/stat").read_text("utf-8")
    except (FileNotFoundError, ProcessLookupError):
        return False
    return state.rpartition(")")[2].split()[0] != "Z"


def test_a_page_has_its_exact_size_and_scale(chromium: Chromium) -> None:
    page = open_page(chromium, 320, 200, scale=2.0)
    assert page.evaluate("[innerWidth, innerHeight, devicePixelRatio]") == [320, 200, 2]
    png = page.screenshot()
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    size = [int.from_bytes(png[at : at + 4], "big") for at in (16, 20)]
    assert size == [640, 400]
    clipped = page.screenshot(clip=(0, 0, 10, 20))
    assert [int.from_bytes(clipped[at : at + 4], "big") for at in (16, 20)] == [20, 40]
    page.close()


def test_values_and_promises_come_back_and_errors_are_raised(
    chromium: Chromium,
) -> None:
    page = open_page(chromium)
    assert page.evaluate("({a: [1, 'b', null]})") == {"a": [1, "b", None]}
    assert page.evaluate("new Promise(done => setTimeout(() => done(7), 1))") == 7
    with pytest.raises(BrowserError, match="script failed: ReferenceError: nothing"):
        page.evaluate("nothing.here")
    with pytest.raises(BrowserError, match=r"not true after 0\.05 s: 1 > 2"):
        page.wait_for("1 > 2", timeout=0.05)
    with pytest.raises(BrowserError, match=r"nowhere is not defined"):
        page.wait_for("nowhere.to.be.found", timeout=0.05)
    page.close()


def test_a_page_that_nobody_serves_is_an_error(chromium: Chromium) -> None:
    page = open_page(chromium)
    with pytest.raises(BrowserError, match=r"cannot open http://127\.0\.0\.1:9/: net"):
        page.goto("http://127.0.0.1:9/")
    page.close()


def test_no_other_machine_can_be_reached(chromium: Chromium) -> None:
    page = open_page(chromium)
    asked = "fetch('http://example.com/').then(() => 'reached', () => 'not reached')"
    assert page.evaluate(asked) == "not reached"
    assert page.requests[-1] == "http://example.com/"
    assert page.failures == [("http://example.com/", "net::ERR_NAME_NOT_RESOLVED")]
    page.close()


def test_fingers_and_keys_arrive(chromium: Chromium) -> None:
    page = open_page(chromium, 200, 200, touch=True)
    page.evaluate(
        "window.seen = []; for (const kind of ['touchstart', 'touchend', 'keydown'])"
        " addEventListener(kind, e => seen.push(e.key || e.type)); null"
    )
    page.touch.tap(50.0, 60.0)
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("x")
    page.wait_for("seen.length === 4")
    assert page.evaluate("seen") == ["touchstart", "touchend", "ArrowLeft", "x"]
    page.close()
