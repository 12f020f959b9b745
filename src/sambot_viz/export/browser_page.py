"""One page of a running browser: go to an address, run a script, wait for it."""

from __future__ import annotations

from typing import Any, TypeVar

from sambot_viz.export.devtools import BrowserError, DevTools, Fields

_WAIT = """
new Promise((resolve, reject) => {
  const end = performance.now() + MILLISECONDS;
  let trouble = "";
  const look = async () => {
    try {
      const value = await (CONDITION);
      if (value) { resolve(null); return; }
      trouble = "";
    } catch (error) {
      trouble = String(error);
    }
    if (performance.now() > end) { resolve(trouble); return; }
    // A page that is not drawn gets no animation frames, so there is a timer too.
    let looked = false;
    const again = () => { if (!looked) { looked = true; look(); } };
    requestAnimationFrame(again);
    setTimeout(again, 100);
  };
  look();
})
"""


_Page = TypeVar("_Page", bound="BrowserPage")


class BrowserPage:
    """A page in its own window. Made by `Chromium.open`."""

    def __init__(
        self, devtools: DevTools, context: str, session: str, timeout: float
    ) -> None:
        """Make the object; only for `create`."""
        self._devtools = devtools
        self._context = context
        self._session = session
        self._timeout = timeout
        self._loads = 0

    @classmethod
    def create(cls: type[_Page], devtools: DevTools, timeout: float = 30.0) -> _Page:
        """Open an empty window with storage of its own.

        Raises:
            BrowserError: the browser refuses.
        """
        context = devtools.call("Target.createBrowserContext")["browserContextId"]
        target = devtools.call(
            "Target.createTarget",
            {"url": "about:blank", "browserContextId": context, "newWindow": True},
        )["targetId"]
        session = devtools.call(
            "Target.attachToTarget", {"targetId": target, "flatten": True}
        )["sessionId"]
        page = cls(devtools, context, session, timeout)
        devtools.listen(session, page.on_event)
        page.begin()
        return page

    def begin(self) -> None:
        """Ask the browser for the page's events and settings."""
        self.call("Page.enable")
        # viser's page reconnects only while it has the focus.
        self.call("Emulation.setFocusEmulationEnabled", {"enabled": True})

    def on_event(self, method: str, fields: Fields) -> None:
        """Take an event of the page; runs on the thread that reads the connection."""
        del fields
        if method == "Page.loadEventFired":
            self._loads += 1

    def call(
        self, method: str, params: Fields | None = None, timeout: float | None = None
    ) -> Fields:
        """Ask this page for something of the DevTools protocol.

        Raises:
            BrowserError: it refuses, or does not answer in time.
        """
        seconds = self._timeout if timeout is None else timeout
        return self._devtools.call(method, params, self._session, seconds)

    def goto(self, url: str) -> None:
        """Go to `url` and wait until it has loaded.

        Raises:
            BrowserError: there is no answer, or it takes too long.
        """
        before = self._loads
        answer = self.call("Page.navigate", {"url": url})
        if answer.get("errorText"):
            raise BrowserError(f"cannot open {url}: {answer['errorText']}")
        if not self._devtools.wait_until(lambda: self._loads > before, self._timeout):
            raise BrowserError(f"{url} did not load in {self._timeout:g} s")

    def evaluate(self, expression: str, timeout: float | None = None) -> Any:
        """Return the value of a JavaScript expression; a promise is waited for.

        Args:
            expression: its value must be one that JSON can hold.
            timeout: how long it may take [s]; None for the browser's own.

        Raises:
            BrowserError: the script throws, or takes too long.
        """
        answer = self.call(
            "Runtime.evaluate",
            {
                "expression": expression,
                "awaitPromise": True,
                "returnByValue": True,
                "userGesture": True,
            },
            timeout,
        )
        if "exceptionDetails" in answer:
            raise BrowserError(
                f"script failed: {explain_exception(answer['exceptionDetails'])}"
            )
        return answer["result"].get("value")

    def wait_for(self, condition: str, timeout: float = 10.0) -> None:
        """Wait until a JavaScript expression is true; asked at every frame.

        An expression that throws counts as not true yet.

        Raises:
            BrowserError: it did not become true within `timeout` seconds.
        """
        script = _WAIT.replace("MILLISECONDS", str(timeout * 1000.0))
        script = script.replace("CONDITION", condition)
        trouble = self.evaluate(script, timeout + self._timeout)
        if trouble is not None:
            why = f" ({trouble})" if trouble else ""
            raise BrowserError(f"not true after {timeout:g} s: {condition}{why}")

    def set_viewport(self, width: int, height: int, scale: float = 1.0) -> None:
        """Give the page a size.

        Args:
            width: of its content [CSS pixels].
            height: of its content [CSS pixels].
            scale: device pixels per CSS pixel.
        """
        self.call(
            "Emulation.setDeviceMetricsOverride",
            {
                "width": width,
                "height": height,
                "deviceScaleFactor": scale,
                "mobile": False,
            },
        )

    def close(self) -> None:
        """Close the window and forget its storage."""
        self._devtools.call(
            "Target.disposeBrowserContext", {"browserContextId": self._context}
        )


def explain_exception(details: Fields) -> str:
    """Return the text of a JavaScript exception, with its first lines of stack."""
    thrown = details.get("exception", {})
    text = thrown.get("description") or thrown.get("value") or details.get("text", "")
    return str(text)
