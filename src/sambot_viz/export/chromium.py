"""A Chromium or Chrome of this machine, started as a child and ended with its tree.

Nothing here downloads a browser. The child gets a fresh profile, draws with software
OpenGL so that pictures are the same on every machine, and can reach only the names of
this machine.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from contextlib import suppress
from pathlib import Path
from types import TracebackType

from sambot_viz.export.browser_page import BrowserPage
from sambot_viz.export.browser_process import (
    ENVIRONMENT_VARIABLE,
    BrowserProcess,
    find_browser,
    how_to_get_a_browser,
)
from sambot_viz.export.devtools import BrowserError, DevTools

_FLAGS = (
    "--headless=new",
    # The same software renderer everywhere, also where there is no GPU.
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--force-color-profile=srgb",
    # Only the 3D view needs OpenGL; software draws the rest of a page sooner so.
    "--disable-gpu-rasterization",
    "--disable-gpu-compositing",
    # Pages of the browser's own, which it loads for the address bar of each window.
    "--disable-features=WebUIOmniboxPopup,WebUIOmniboxAimPopup",
    # No traffic of the browser's own, and none to other machines.
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-default-apps",
    "--disable-domain-reliability",
    "--disable-extensions",
    "--disable-quic",
    "--disable-sync",
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE localhost, EXCLUDE 127.0.0.1",
    "--no-default-browser-check",
    "--no-first-run",
    "--no-service-autorun",
    "--no-startup-window",
    "--password-store=basic",
    "--use-mock-keychain",
    # A page must go on drawing while another one is in front of it.
    "--disable-background-timer-throttling",
    "--disable-backgrounding-occluded-windows",
    "--disable-renderer-backgrounding",
    # Crash reports would be written by a process that outlives the browser.
    "--disable-breakpad",
    "--disable-crash-reporter",
    # Containers often have too little /dev/shm for one page.
    "--disable-dev-shm-usage",
    "--remote-debugging-port=0",
)


class Chromium:
    """A running browser; use it in a ``with`` block.

    with Chromium() as browser:
        page = browser.open(url, width=800, height=600)
        title = page.evaluate("document.title")
    """

    def __init__(
        self,
        executable: Path | None = None,
        *,
        timeout: float = 30.0,
        scroll_bars: bool = False,
    ) -> None:
        """Remember what to start; `__enter__` starts it.

        Args:
            executable: the browser's program; None to look for one.
            timeout: how long its start, and later each call, may take [s].
            scroll_bars: show them as on a desktop; a picture has none.
        """
        self._executable = executable
        self._timeout = timeout
        self._flags = () if scroll_bars else ("--hide-scrollbars",)
        self._process: BrowserProcess | None = None
        self._profile: Path | None = None
        self._devtools: DevTools | None = None

    def __enter__(self) -> Chromium:
        """Start the browser.

        Raises:
            BrowserError: there is none, or it ends at once or does not answer.
        """
        executable = self._executable or find_browser()
        if executable is None:
            raise BrowserError(
                f"no Chromium or Chrome found on this machine; {how_to_get_a_browser()}"
            )
        try:
            self._start(executable)
        except BaseException:
            self.close()
            raise
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """End the browser, whatever happened."""
        self.close()

    @property
    def devtools(self) -> DevTools:
        """The connection to the browser.

        Raises:
            BrowserError: the browser is not running.
        """
        if self._devtools is None:
            raise BrowserError("the browser is not running; use it in a 'with' block")
        return self._devtools

    def open(
        self,
        url: str = "about:blank",
        *,
        width: int = 1280,
        height: int = 720,
        scale: float = 1.0,
    ) -> BrowserPage:
        """Open a separate window, with separate cookies and storage.

        Args:
            url: the page to go to.
            width: of the page's content [CSS pixels].
            height: of the page's content [CSS pixels].
            scale: device pixels per CSS pixel.

        Raises:
            BrowserError: the page does not load.
        """
        page = BrowserPage.create(self.devtools, timeout=self._timeout)
        page.set_viewport(width, height, scale)
        if url != "about:blank":
            page.goto(url)
        return page

    def close(self) -> None:
        """End the browser with its whole process tree; remove its profile.

        Closing twice is fine.
        """
        devtools, self._devtools = self._devtools, None
        patience = 0.0
        if devtools is not None:
            # A browser that is asked to end also ends its children.
            with suppress(BrowserError):
                devtools.call("Browser.close", timeout=2.0)
                patience = 3.0
            devtools.close()
        process, self._process = self._process, None
        if process is not None:
            process.end(patience)
        profile, self._profile = self._profile, None
        if profile is not None:
            shutil.rmtree(profile, ignore_errors=True)

    def _start(self, executable: Path) -> None:
        self._profile = Path(tempfile.mkdtemp(prefix="sambot-viz-browser-"))
        command = [str(executable), *_FLAGS, *self._flags]
        # Chromium refuses to start its sandbox for root, which is who runs containers.
        if hasattr(os, "geteuid") and os.geteuid() == 0:
            command.append("--no-sandbox")
        try:
            self._process = BrowserProcess(command, self._profile)
        except OSError as error:
            raise BrowserError(
                f"the browser {executable} cannot be started: {error.strerror}; "
                f"{how_to_get_a_browser()}"
            ) from error
        address = self._process.wait_for_address(self._timeout)
        if address is None:
            raise BrowserError(
                f"the browser {executable} ended or did not answer in "
                f"{self._timeout:g} s; its last output: {self._process.last_lines()}; "
                f"name another one in {ENVIRONMENT_VARIABLE}"
            )
        self._devtools = DevTools(address, self._timeout)
