"""A fence for a page: what has been done there, or in Python, is in the picture.

A page has two connections, ours for rows and edits and viser's for the scene and the
camera, and neither says anything about the other; nor do those of two pages. A test
that reads a picture after a click, or turns a camera after it was set, has to know that
nothing is on its way any more: ``settle(viewer.page, viz)``.

It lasts until

1. the page shows the camera that it was asked for, the server has read what the page
   sent, and has the camera that the page shows;
2. the sessions' workers have done what came of it, also what they put off;
3. the page has got everything that was sent until then, by each way that leads to it;
4. all of it is drawn, and none of it has moved the camera: or else once more.

Clicks into the view go by viser's way, where the page has nothing to ask; and meshes,
files and motions take their time in other threads: wait for the effects of these.
"""

from __future__ import annotations

import asyncio
import itertools
import json
import weakref
from typing import Any

import numpy as np
import viser
from patience import patience, until
from protocol_client import wait_for_workers
from recorded_page import RecordedPage

from sambot_viz import Visualizer, viser_private
from sambot_viz.export.devtools import BrowserError
from sambot_viz.server.connections.connection import ClientContext
from sambot_viz.session.clients.client_view import READ_PERIOD

_HAS_READ = """(() => {
  const socket = window.fenceSocket;
  if (socket?.readyState !== WebSocket.OPEN) return true;
  socket.send('"ping"');
  const wanted = socket.fence.asked;
  return new Promise(done => {
    const look = () => socket.fence.answered >= wanted || socket.readyState > 1
      ? done(true) : setTimeout(look, 5);
    look();
  });
})()"""
_ROWS = """import("sambot/wire/channel.js").then(({ rows }) => {
  window.fenceRows = rows;
})"""
_HAS_ROWS = """((rows, number) => rows.every(id => fenceRows.data(id) >= number))"""
_GOT = """((nodes, rows, number) => {
  const { nodePoseData, messageQueue } = __viserMutable;
  return nodes.every(name => nodePoseData[name]?.position[0] >= number)
    && rows.every(id => fenceRows.data(id) >= number) && messageQueue.length === 0;
})"""
# The camera in our coordinates, the size of the view, and whether the view has the size
# of the place that the window leaves it.
_CAMERA = """(({ cameraControl, camera, nodeRefFromName, canvas }) => {
  const world = nodeRefFromName[""], vector = camera.position.clone();
  const ends = ["getPosition", "getTarget"].map(
    (end) => world.worldToLocal(cameraControl[end](vector)).toArray());
  const root = document.getElementById("root"), box = canvas.getBoundingClientRect();
  return [ends, [canvas.clientWidth, canvas.clientHeight],
    Math.abs(root.clientWidth - box.width) < 2];
})(__viserMutable)"""
_NUMBERS = itertools.count(1)
_nodes: weakref.WeakKeyDictionary[viser.SceneApi, viser.FrameHandle] = (
    weakref.WeakKeyDictionary()
)
_TIME = 20.0
"""How long each step may take [s]."""


def settle(page: RecordedPage, viz: Visualizer) -> None:
    """Wait until nothing is on its way between a page and the program (see above)."""
    for _ in range(20):
        (client,) = until(
            lambda: _clients_of(page, viz), _TIME, "the page is not there"
        )
        before = _wait_for_report(page, viz, client)
        page.evaluate(_HAS_READ, patience(_TIME))
        wait_for_workers(put_off=READ_PERIOD)
        _pass_fence(page, viz, client)
        if np.allclose(before, _numbers(page, viz, client)[:-1], atol=1e-6):
            return
    raise AssertionError("the camera does not come to rest")


def settle_rows(page: RecordedPage, viz: Visualizer) -> None:
    """The same for a page without a view: what was done is in its rows."""
    (client,) = until(lambda: _clients_of(page, viz), _TIME, "the page is not there")
    page.evaluate(_HAS_READ, patience(_TIME))
    wait_for_workers(put_off=READ_PERIOD)
    number = next(_NUMBERS)
    ids = _tell_rows(page, viz, client, number)
    page.wait_for(f"{_HAS_ROWS}({json.dumps(ids)}, {number})", patience(_TIME))


def _clients_of(page: RecordedPage, viz: Visualizer) -> list[int]:
    """The number of the client that a page is; none until it has one."""
    ticket = page.evaluate("sambotSocket").partition("ticket=")[2]
    contexts = {c: _context_of(viz, c) for c in viz.viser.get_clients()}
    return [client for client in contexts if contexts[client].ticket == ticket]


def _context_of(viz: Visualizer, client: int) -> ClientContext:
    connection: Any = viser_private.connection_of(viz.viser, client)
    return connection.context


def _numbers(page: RecordedPage, viz: Visualizer, client: int) -> list[float]:
    """The camera and the size that a page shows, those that the server has, and
    whether the view fits its place."""
    ends, size, fits = page.evaluate(_CAMERA)
    handle: viser.CameraHandle = viz.viser.get_clients()[client].camera
    known = [*handle.position, *handle.look_at]
    size = [*size, handle.image_width, handle.image_height]
    return [*ends[0], *ends[1], *known, *size, fits]


def _wait_for_report(page: RecordedPage, viz: Visualizer, client: int) -> list[float]:
    """Wait until the server has the camera that the page shows; returns both."""

    def reported() -> list[float]:
        numbers = _numbers(page, viz, client)
        shown, known = np.reshape(numbers[:12], (2, 2, 3))
        # A far camera, which views from above have, is reported before it has come to
        # the very end.
        near = 1e-6 + 2e-5 * float(np.linalg.norm(shown[0] - shown[1]))
        width, height, across, down = numbers[12:16]
        # A coarse picture has the shape of the view, give or take a pixel.
        same_shape = abs(across * height - down * width) <= width + height
        agree = np.abs(shown - known)
        is_there = agree[0].max() < near and agree[1].max() < 1e-5
        is_there = is_there and _is_as_asked(page, viz, client)
        return numbers[:-1] if is_there and same_shape and numbers[-1] else []

    found = until(
        reported, _TIME, "the camera is not reported", (BrowserError, AssertionError)
    )
    # What is called when it arrives is called on the loop.
    for _ in range(2):
        loop = viz.viser.get_event_loop()
        asyncio.run_coroutine_threadsafe(asyncio.sleep(0), loop).result(patience(_TIME))
    return found


def _is_as_asked(page: RecordedPage, viz: Visualizer, client: int) -> bool:
    """Whether a page shows the camera that it was asked for, and has reported it."""
    views = [s.clients.all.get(client) for s in viz.server.sessions.all()]
    numbers = [client.view.shown.number for client in views if client is not None]
    shown = page.evaluate("sambotVizCamera")
    return bool(shown["reported"]) and numbers == [shown["number"]]


def _pass_fence(page: RecordedPage, viz: Visualizer, client: int) -> None:
    """Send something behind all that was sent, by each way, and wait for it."""
    number, handle = next(_NUMBERS), viz.viser.get_clients()[client]
    ways: list[tuple[str, Any]] = [("/~fence own", handle)]
    # What goes out to all does not reach a page with a copy of its own.
    if not _context_of(viz, client).copy:
        ways.append(("/~fence all", viz.viser))
    for name, to in ways:
        if to.scene not in _nodes:
            _nodes[to.scene] = to.scene.add_frame(name, show_axes=False, visible=False)
        _nodes[to.scene].position = (float(number), 0.0, 0.0)
        to.flush()
    ids = _tell_rows(page, viz, client, number)
    names = json.dumps([name for name, _ in ways])
    page.wait_for(f"{_GOT}({names}, {json.dumps(ids)}, {number})", patience(_TIME))


def _tell_rows(
    page: RecordedPage, viz: Visualizer, client: int, number: int
) -> list[str]:
    """Send a number behind all rows that a page is told; returns the rows it is in."""
    rows = viz.server.clients.rows_of(client)
    ids: list[str] = []
    for store in rows.stores if rows else ():
        row = f"~fence {len(ids)}"
        store.replace(row, [{"id": row, "in": "", "kind": "data", "value": number}])
        store.tell()
        ids.append(row)
    if ids:
        page.evaluate(_ROWS)
    return ids
