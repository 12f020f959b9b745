"""One page of a running browser: its script, its picture, its input, its records."""

from __future__ import annotations

import base64
import json
from dataclasses import dataclass
from typing import Any

from sambot_viz.export.browser_input import Keyboard, Mouse, Touch
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
    // A page that is not drawn gets no animation frames, so a timer looks as well.
    let looked = false;
    const again = () => { if (!looked) { looked = true; look(); } };
    requestAnimationFrame(again);
    setTimeout(again, 100);
  };
  look();
})
"""


@dataclass(frozen=True, slots=True)
class ConsoleMessage:
    """A line of the page's console.

    Attributes:
        level: "error", "warning", "log", "info", "debug", …
        text: what it says.
        url: the script or address it is about; may be empty.
    """

    level: str
    text: str
    url: str = ""


class BrowserPage:
    """A page in a window of its own. Made by `Chromium.open`.

    Attributes:
        console: every console line so far, of the page and of its workers.
        exceptions: every exception that no script caught.
        requests: the address of everything that was asked for, websockets included.
        failures: (address, reason) of every request that got no answer.
        mouse: its mouse.
        keyboard: its keyboard.
        touch: fingers on it.
    """

    def __init__(
        self, devtools: DevTools, context: str, session: str, timeout: float
    ) -> None:
        """Only for `create`."""
        self._devtools = devtools
        self._context = context
        self._session = session
        self._timeout = timeout
        self._loads = 0
        self._urls_by_request: dict[str, str] = {}
        self.console: list[ConsoleMessage] = []
        self.exceptions: list[str] = []
        self.requests: list[str] = []
        self.failures: list[tuple[str, str]] = []
        self.mouse = Mouse(self)
        self.keyboard = Keyboard(self)
        self.touch = Touch(self)

    @classmethod
    def create(cls, devtools: DevTools, timeout: float = 30.0) -> BrowserPage:
        """Open an empty window with storage of its own and start recording.

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
        devtools.listen(session, page._on_event)
        for domain in ("Page", "Runtime", "Network", "Log"):
            page.call(f"{domain}.enable")
        # viser's page reconnects only while it has the focus, and so does each of ours.
        page.call("Emulation.setFocusEmulationEnabled", {"enabled": True})
        page.call(
            "Target.setAutoAttach",
            {"autoAttach": True, "waitForDebuggerOnStart": True, "flatten": True},
        )
        return page

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
            BrowserError: nobody answers there, or it takes too long.
        """
        before = self._loads
        answer = self.call("Page.navigate", {"url": url})
        if answer.get("errorText"):
            raise BrowserError(f"cannot open {url}: {answer['errorText']}")
        if not self._devtools.wait_until(lambda: self._loads > before, self._timeout):
            raise BrowserError(f"{url} did not load in {self._timeout:g} s")

    def evaluate(self, expression: str, timeout: float | None = None) -> Any:
        """The value of a JavaScript expression; a promise is waited for.

        Args:
            expression: its value must be one that JSON can say.
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
            raise BrowserError(f"script failed: {_explain(answer['exceptionDetails'])}")
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

    def set_viewport(
        self, width: int, height: int, *, scale: float = 1.0, touch: bool = False
    ) -> None:
        """Give the page a size.

        Args:
            width: of its content [CSS pixels].
            height: of its content [CSS pixels].
            scale: device pixels per CSS pixel.
            touch: whether it is a phone or tablet, with fingers.
        """
        self.call(
            "Emulation.setDeviceMetricsOverride",
            {
                "width": width,
                "height": height,
                "deviceScaleFactor": scale,
                "mobile": touch,
            },
        )
        self.call("Emulation.setTouchEmulationEnabled", {"enabled": touch})

    def set_dark(self, dark: bool) -> None:
        """Let the page believe that the system is dark, or light."""
        feature = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.call("Emulation.setEmulatedMedia", {"features": [feature]})

    def screenshot(
        self, clip: tuple[float, float, float, float] | None = None
    ) -> bytes:
        """The page as a PNG file.

        Args:
            clip: x, y, width, height of a part of it [CSS pixels]; None for all.

        Raises:
            BrowserError: the browser cannot take it.
        """
        params: Fields = {"format": "png"}
        if clip is not None:
            names = ("x", "y", "width", "height")
            params["clip"] = dict(zip(names, clip, strict=True)) | {"scale": 1}
        return base64.b64decode(self.call("Page.captureScreenshot", params)["data"])

    def close(self) -> None:
        """Close the window and forget its storage."""
        self._devtools.call(
            "Target.disposeBrowserContext", {"browserContextId": self._context}
        )

    # What the page does by itself. These run on the reading thread.

    def _on_event(self, method: str, fields: Fields) -> None:
        match method:
            case "Page.loadEventFired":
                self._loads += 1
            case "Runtime.consoleAPICalled":
                text = " ".join(_show(part) for part in fields["args"])
                self.console.append(ConsoleMessage(fields["type"], text))
            case "Runtime.exceptionThrown":
                self.exceptions.append(_explain(fields["exceptionDetails"]))
            case "Log.entryAdded":
                entry = fields["entry"]
                self.console.append(
                    ConsoleMessage(entry["level"], entry["text"], entry.get("url", ""))
                )
            case "Network.requestWillBeSent":
                self._record_request(fields["requestId"], fields["request"]["url"])
            case "Network.webSocketCreated":
                self.requests.append(fields["url"])
            case "Network.loadingFailed":
                url = self._urls_by_request.get(fields["requestId"], "")
                self.failures.append((url, fields["errorText"]))
            case "Target.attachedToTarget":
                self._record_child(fields["sessionId"])
            case _:
                pass

    def _record_request(self, request: str, url: str) -> None:
        # What the page carries within itself is no request, and can be very long.
        if not url.startswith(("data:", "blob:")):
            self._urls_by_request[request] = url
            self.requests.append(url)

    def _record_child(self, session: str) -> None:
        """Record a worker or frame as part of the page, then let it run."""
        self._devtools.listen(session, self._on_event)
        for method in ("Network.enable", "Runtime.enable"):
            self._devtools.post(method, session=session)
        self._devtools.post("Runtime.runIfWaitingForDebugger", session=session)


def _explain(details: Fields) -> str:
    """An exception's text with its first lines of stack."""
    thrown = details.get("exception", {})
    text = thrown.get("description") or thrown.get("value") or details.get("text", "")
    return str(text)


def _show(part: Fields) -> str:
    """One argument of console.log as text."""
    if "value" in part:
        value = part["value"]
        return value if isinstance(value, str) else json.dumps(value)
    return str(part.get("description", part.get("type", "")))
