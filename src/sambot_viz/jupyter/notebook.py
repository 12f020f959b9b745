"""A visualizer in a notebook: its address for the browser, and its end.

The browser that shows a notebook is often not on the machine of its kernel. Where the
Jupyter server has jupyter-server-proxy, the page is shown through it, below the address
that the notebook itself has. Users of the same machine could open the port too, so the
page then asks for a token, or for the cookies of a user whom the Jupyter server has
let in: so no token is in the cell, and none in a notebook that is saved. Without that
proxy the frame shows the port of this machine, and without a token, unless the user
gave one: browsers send no cookie to a frame of another site.

The output of a cell is kept in the notebook: a picture of the robot, and in front of it
a frame (`frame.html`) that shows the page as long as its program runs.

What stays weak: jupyter-server-proxy sends the cookies of Jupyter to whatever listens
on a port. Another user of the machine could listen there when a viewer has ended and
its page is still open. The viewer of the tile (`jupyter.tile`) has no port.
"""

from __future__ import annotations

import base64
import html
import http.client
import json
import os
import ssl
import sys
from collections.abc import Callable, Mapping
from contextlib import closing
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from string import Template
from typing import Any, Protocol

from sambot_viz.extras import installation
from sambot_viz.options import Options

HEIGHT = 600
"""Of the page in a cell [CSS pixels]."""
_BELOW = 24
"""Height of the line below it, with the link to a tab [CSS pixels]."""
_FILLS = "position: absolute; top: 0; left: 0; width: 100%"
_ANSWERS_WITHIN = 2.0
"""The Jupyter server is asked for so long at most [s]."""
_ALL_NETWORKS = ("", "*", "0.0.0.0", "::")
_WITHOUT_PROXY = (
    "The page cannot be shown here: your Jupyter server has no jupyter-server-proxy. "
    f"Run {installation('jupyter')} where it is installed, and start it again."
)


class Stoppable(Protocol):
    """The viewer of a cell."""

    def stop(self) -> None:
        """End it; a second call does nothing."""


@dataclass(frozen=True, slots=True)
class Notebook:
    """The notebook whose kernel this process is.

    Attributes:
        proxy: the path below which the Jupyter server shows the ports of this machine,
            such as "/user/ada/proxy/"; None without jupyter-server-proxy.
        in_hub: whether the Jupyter server belongs to a JupyterHub.
        cell: the cell that runs; "" when that is not known.
        run: which run of the cell it is.
        server: what the Jupyter server has written about itself; None when that is
            not known.
    """

    proxy: str | None
    in_hub: bool
    cell: str
    run: str
    server: dict[str, Any] | None = None

    def options(self, options: Options) -> Options:
        """The options, with a token for a page that goes through the proxy."""
        if self.proxy is None or options.token is not None:
            return options
        return replace(options, token="")

    def knows(self, cookies: str) -> bool:
        """Whether the Jupyter server has let in the browser with these cookies."""
        if self.server is None or self.proxy is None:
            return False
        return _status(self.server, "api/me", {"Cookie": cookies}) == 200

    def frame(
        self,
        url: str,
        height: int = HEIGHT,
        panels: bool = True,
        picture: bytes | None = None,
    ) -> str:
        """The page as HTML for the cell.

        Args:
            url: the address of the page on this machine.
            height: height of the page [CSS pixels].
            panels: whether there are panels around the view.
            picture: a PNG file, shown when the page no longer exists.
        """
        if self.proxy is None and self.in_hub:
            return f"<p>{html.escape(_WITHOUT_PROXY)}</p>"
        url, _, query = url.partition("?")
        if self.proxy is not None:
            port = url.removeprefix("http://").partition("/")[0].rpartition(":")[2]
            url = f"{self.proxy}{port}/"
            # The browser's cookies are enough where they can be asked about.
            query = query if self.server is None else ""
        queries = [query] * bool(query) + ["panels=0"] * (not panels)
        url = f"{url}{'?' if queries else ''}{'&'.join(queries)}"
        page = Template(_frame()).substitute(url=html.escape(url))
        shown = "" if picture is None else base64.b64encode(picture).decode()
        behind = (
            f'<img src="data:image/png;base64,{shown}" alt="The robot" '
            f'style="{_FILLS}; height: {height}px; object-fit: contain">'
        )
        return (
            f'<div style="position: relative; height: {height + _BELOW}px">'
            f'{behind if shown else ""}<iframe srcdoc="{html.escape(page)}" '
            f'title="Robot viewer" style="{_FILLS}; height: 100%; border: 0; '
            'color-scheme: light" allow="fullscreen; clipboard-write"></iframe></div>'
        )


class Cell:
    """What the cell of a notebook shows of a visualizer.

    Args:
        bundle: makes it, by its MIME types.
    """

    def __init__(self, bundle: Callable[[], dict[str, str]]) -> None:
        self._bundle = bundle

    def _repr_mimebundle_(self, **_: object) -> dict[str, str]:
        """The page, and a picture of the robot for where no page can be shown."""
        return self._bundle()


_made: dict[str, tuple[str, list[Stoppable]]] = {}
"""Cell → its last run, and what that has made."""


def stop_former(notebook: Notebook) -> None:
    """Stop what the cell has made when it ran before."""
    run, made = _made.get(notebook.cell, (notebook.run, []))
    if run != notebook.run:
        del _made[notebook.cell]
        for each in made:
            each.stop()


def remember(notebook: Notebook, made: Stoppable) -> None:
    """Keep the viewer of a cell until the cell runs again."""
    if notebook.cell:
        _made.setdefault(notebook.cell, (notebook.run, []))[1].append(made)


def notebook() -> Notebook | None:
    """The notebook whose kernel this process is; None when it is not a kernel."""
    ipython: Any = sys.modules.get("IPython")
    shell: Any = None if ipython is None else ipython.get_ipython()
    if shell is None or getattr(shell, "kernel", None) is None:
        return None
    parent: dict[str, Any] = shell.get_parent()
    cell = str(parent.get("metadata", {}).get("cellId", ""))
    run = str(parent.get("header", {}).get("msg_id", ""))
    prefix = os.environ.get("JUPYTERHUB_SERVICE_PREFIX")
    server = _server_of(shell)
    if server is None:
        root = prefix
    else:
        root = str(server["base_url"]) if _has_proxy(server) else None
    proxy = None if root is None else f"{root.rstrip('/')}/proxy/"
    return Notebook(proxy, prefix is not None, cell, run, server)


@cache
def _frame() -> str:
    return Path(__file__).with_name("frame.html").read_text("utf-8")


def _server_of(shell: Any) -> dict[str, Any] | None:
    """Return the data that the Jupyter server of this kernel has written about itself.

    They are beside the connection file of the kernel; None if they are not there, as
    for a kernel on another machine, or one that no Jupyter server has started.
    """
    connection = shell.config.get("IPKernelApp", {}).get("connection_file", "")
    number = os.environ.get("JPY_PARENT_PID", "")
    try:
        path = Path(str(connection)).with_name(f"jpserver-{number}.json")
        found: dict[str, Any] = json.loads(path.read_text("utf-8"))
        return found if "base_url" in found else None
    except (OSError, ValueError, TypeError):
        return None


def _has_proxy(server: dict[str, Any]) -> bool:
    """Whether a Jupyter server has jupyter-server-proxy: it knows a page of that."""
    return (_status(server, "server-proxy/servers-info", {}) or 404) < 404


def _status(
    server: dict[str, Any], path: str, headers: Mapping[str, str]
) -> int | None:
    """The status with which a Jupyter server answers; None when it does not."""
    name, port = str(server.get("hostname", "")), int(server.get("port") or 0)
    name = "127.0.0.1" if name in _ALL_NETWORKS else name
    if server.get("secure"):
        # Its certificate is for the users; nothing is sent, and nothing is read.
        context = ssl.create_default_context()
        context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
        asked: http.client.HTTPConnection = http.client.HTTPSConnection(
            name, port, timeout=_ANSWERS_WITHIN, context=context
        )
    else:
        asked = http.client.HTTPConnection(name, port, timeout=_ANSWERS_WITHIN)
    try:
        with closing(asked):
            asked.request("GET", f"{server['base_url']}{path}", headers=dict(headers))
            return asked.getresponse().status
    except (OSError, ValueError, http.client.HTTPException):
        return None
