"""A browser page that records what happens in it, with mouse, keyboard and touch."""

from __future__ import annotations

import base64
import json
from dataclasses import dataclass
from pathlib import Path

from browser_input import Keyboard, Mouse, Touch

from sambot_viz.export.browser_page import BrowserPage, explain_exception
from sambot_viz.export.chromium import Chromium
from sambot_viz.export.devtools import DevTools, Fields

# Keeps the page's own websocket, once it has sent something, for `page_fence`.
_RECORD_CHANNEL = """(() => {
  const send = WebSocket.prototype.send;
  WebSocket.prototype.send = function (data) {
    if (this.protocol === "sambot-viz-1") {
      if (window.fenceSocket !== this) {
        window.fenceSocket = this;
        this.fence = { asked: 0, answered: 0 };
        this.addEventListener("message", ({ data }) => {
          if (data === '"pong"') this.fence.answered += 1;
        });
      }
      if (data === '"ping"') this.fence.asked += 1;
    }
    return send.call(this, data);
  };
})()"""


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


class RecordedPage(BrowserPage):
    """A page with its records and its input devices. Made by `open_page`.

    Attributes:
        console: every console line so far, of the page and of its workers.
        exceptions: every exception that no script caught.
        requests: the address of everything that was asked for, websockets included.
        failures: (address, reason) of every request that got no answer.
        messages: how many messages came and went over websockets so far.
        mouse: its mouse.
        keyboard: its keyboard.
        touch: fingers on it.
    """

    def __init__(
        self, devtools: DevTools, context: str, session: str, timeout: float
    ) -> None:
        """Only for `create`."""
        super().__init__(devtools, context, session, timeout)
        self._urls_by_request: dict[str, str] = {}
        self.console: list[ConsoleMessage] = []
        self.exceptions: list[str] = []
        self.requests: list[str] = []
        self.failures: list[tuple[str, str]] = []
        self.messages = 0
        self.mouse = Mouse(self)
        self.keyboard = Keyboard(self)
        self.touch = Touch(self)

    def begin(self) -> None:
        """Record from the start, also what workers and frames do."""
        super().begin()
        for domain in ("Runtime", "Network", "Log"):
            self.call(f"{domain}.enable")
        self.call("Page.addScriptToEvaluateOnNewDocument", {"source": _RECORD_CHANNEL})
        self.call(
            "Target.setAutoAttach",
            {"autoAttach": True, "waitForDebuggerOnStart": True, "flatten": True},
        )

    def set_touch(self, width: int, height: int) -> None:
        """Make it a phone or tablet of this size [CSS pixels], with fingers."""
        self.call(
            "Emulation.setDeviceMetricsOverride",
            {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": True},
        )
        self.call("Emulation.setTouchEmulationEnabled", {"enabled": True})

    def set_dark(self, dark: bool) -> None:
        """Let the page believe that the system is dark, or light."""
        feature = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.call("Emulation.setEmulatedMedia", {"features": [feature]})

    def take_downloads(self, folder: Path) -> None:
        """Put what the page downloads into a folder."""
        self._devtools.call(
            "Browser.setDownloadBehavior",
            {
                "behavior": "allow",
                "browserContextId": self._context,
                "downloadPath": str(folder),
            },
        )

    def allow(self, *permissions: str) -> None:
        """Let the page do what a user is asked for otherwise."""
        self._devtools.call(
            "Browser.grantPermissions",
            {"permissions": list(permissions), "browserContextId": self._context},
        )

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

    def on_event(self, method: str, fields: Fields) -> None:
        """Record an event; runs on the thread that reads the connection."""
        super().on_event(method, fields)
        match method:
            case "Runtime.consoleAPICalled":
                text = " ".join(_show(part) for part in fields["args"])
                self.console.append(ConsoleMessage(fields["type"], text))
            case "Runtime.exceptionThrown":
                self.exceptions.append(explain_exception(fields["exceptionDetails"]))
            case "Log.entryAdded":
                entry = fields["entry"]
                self.console.append(
                    ConsoleMessage(entry["level"], entry["text"], entry.get("url", ""))
                )
            case "Network.requestWillBeSent":
                self._record_request(fields["requestId"], fields["request"]["url"])
            case "Network.webSocketCreated":
                self.requests.append(fields["url"])
            case "Network.webSocketFrameSent" | "Network.webSocketFrameReceived":
                self.messages += 1
            case "Network.loadingFailed":
                url = self._urls_by_request.get(fields["requestId"], "")
                self.failures.append((url, fields["errorText"]))
            case "Target.attachedToTarget":
                self._record_child(fields["sessionId"])
            case _:
                pass

    def _record_request(self, request: str, url: str) -> None:
        # What the page carries within itself is not a request, and can be very long.
        if not url.startswith(("data:", "blob:")):
            self._urls_by_request[request] = url
            self.requests.append(url)

    def _record_child(self, session: str) -> None:
        """Record a worker or frame as part of the page, then let it run."""
        self._devtools.listen(session, self.on_event)
        for method in ("Network.enable", "Runtime.enable"):
            self._devtools.post(method, session=session)
        self._devtools.post("Runtime.runIfWaitingForDebugger", session=session)


def open_page(
    chromium: Chromium,
    width: int = 1280,
    height: int = 720,
    *,
    scale: float = 1.0,
    touch: bool = False,
) -> RecordedPage:
    """Open an empty window of a running browser.

    Args:
        chromium: the browser.
        width: of the page's content [CSS pixels].
        height: of the page's content [CSS pixels].
        scale: device pixels per CSS pixel.
        touch: whether it is a phone or tablet.
    """
    page = RecordedPage.create(chromium.devtools, timeout=60.0)
    page.set_viewport(width, height, scale)
    if touch:
        page.set_touch(width, height)
    return page


def _show(part: Fields) -> str:
    """One argument of console.log as text."""
    if "value" in part:
        value = part["value"]
        return value if isinstance(value, str) else json.dumps(value)
    return str(part.get("description", part.get("type", "")))
