"""A picture of the 3D view alone, at an exact size, from a Chromium of this machine."""

from __future__ import annotations

import io
import time

import numpy as np
import numpy.typing as npt
import viser

from sambot_viz import viser_private
from sambot_viz.errors import ServerError
from sambot_viz.export.browser_page import BrowserPage
from sambot_viz.export.chromium import Chromium
from sambot_viz.server.server import Server
from sambot_viz.session.clients import viser_camera
from sambot_viz.views.camera import Camera

Picture = npt.NDArray[np.uint8]

LONGEST_WAIT = 60.0
"""For the page to show a small scene [s]; software rendering takes its time."""
WAIT_PER_MEGABYTE = 2.0
"""What a slow machine takes to receive, parse and draw 1 MB of meshes [s]."""

_TICKET = "new URL(sambotSocket).searchParams.get('ticket')"
DRAW_WHEN_ASKED = """(() => {
  const begin = () => {
    const root = window.__viserMutable?.scene?.__r3f?.root;
    if (!root) return void setTimeout(begin, 10);
    const { gl } = root.getState();
    const draw = gl.render;
    gl.render = (scene, eye) => {
      const own = eye === root.getState().camera;
      if (own && window.sambotVizDrawn) return;
      window.sambotVizDrawn ||= own;
      draw.call(gl, scene, eye);
    };
  };
  begin();
})()"""
"""Draws the page's own view, which nobody sees, once, and again when that is asked for:
software takes longer for its frames than for the picture."""
_EVERYTHING_IS_THERE = """(() => {
  const look = window.sambotVizLook, page = window.__viserMutable;
  if (!look || !page) return false;
  const nodes = Object.entries(window.__viserSceneTree.getState());
  const names = nodes.filter(([, node]) => node.message.type === "LabelMessage");
  if (nodes.length < %d || !nodes.every(([name, node]) =>
    node.message.type === "LabelMessage" || page.nodeRefFromName[name])) return false;
  if (look.frames && !look.waiting && look.labels >= names.length) return true;
  window.sambotVizDrawn = false;
  page.requestRender?.();
  return false;
})()"""
"""Holds when the page has as many nodes as the server, each with its object (a mesh
has one when it is parsed; a label has none), and all names are laid out, which a frame
of the page's own tells."""


def snapshot(
    server: Server, chromium: Chromium, width: int, height: int, camera: Camera
) -> Picture:
    """Render what a session shows.

    Args:
        server: what to show, with a shared session.
        chromium: a running browser.
        width: of the picture [pixels].
        height: of the picture [pixels].
        camera: where to look from, such as `Session.camera`.

    Returns:
        (height, width, 3) uint8, RGB.

    Raises:
        ServerError: the page did not show everything in time.
    """
    page = chromium.open(page_address(server.url), width=width, height=height)
    try:
        page.evaluate(DRAW_WHEN_ASKED)
        client = server.clients.wait_for_page(page.evaluate(_TICKET), LONGEST_WAIT)
        server.sessions.wait_for_meshes(LONGEST_WAIT)
        return picture_in(page, client, server.viser.scene, width, height, camera)
    finally:
        page.close()


def picture_in(
    page: BrowserPage,
    client: viser.ClientHandle,
    scene: viser.SceneApi,
    width: int,
    height: int,
    camera: Camera,
) -> Picture:
    """Render a scene in a page, as soon as the page has all of it.

    Args:
        page: it has `DRAW_WHEN_ASKED`, and an address of `page_address`.
        client: the same page, as the server knows it.
        scene: what the page is to show.
        width: as for `snapshot`.
        height: as for `snapshot`.
        camera: as for `snapshot`.

    Raises:
        ServerError: the page did not show everything in time.
    """
    longest = longest_wait(viser_private.scene_bytes(scene))
    count = viser_private.node_count(scene)
    page.wait_for(_EVERYTHING_IS_THERE % count, timeout=longest)
    before: Picture | None = None
    placed: tuple[float, ...] | None = None
    # Loading may have taken all of the time that was meant for it.
    end = time.monotonic() + longest
    while time.monotonic() < end:
        # viser draws a picture's background at the page's own camera, and nothing
        # beyond 1000 m from it, so the page's camera must be moved too. A page that
        # was just opened may report its first camera after another one was set.
        if placed is None or not np.allclose(
            _place(client), placed, rtol=1e-4, atol=1e-3
        ):
            viser_camera.point(client, camera, ortho_fov=None)
            placed, before = _place(client), None
        picture = render(client, width, height, longest)
        # Meshes and names appear some frames after their messages; two equal
        # pictures in a row mean that nothing more is coming.
        if before is not None and np.array_equal(picture, before):
            return picture
        before = picture
    raise _too_slow(longest)


def longest_wait(scene: int) -> float:
    """Return how long a page may take to show a scene of that many bytes [s]."""
    return LONGEST_WAIT + WAIT_PER_MEGABYTE * scene / 1e6


def render(
    client: viser.ClientHandle, width: int, height: int, longest: float
) -> Picture:
    """Have a page draw its scene once.

    Args:
        client: the page.
        width: of the picture [pixels].
        height: of the picture [pixels].
        longest: how long it may take [s].

    Returns:
        (height, width, 3) uint8, RGB.

    Raises:
        ServerError: it took longer.
    """
    with viser_private.larger_messages(client, 8 * width * height + 2**16):
        try:
            image = client.get_render(
                height, width, transport_format="png", timeout=longest
            )
        except TimeoutError:
            raise _too_slow(longest) from None
    return image[..., :3].astype(np.uint8)


def _too_slow(longest: float) -> ServerError:
    return ServerError(
        f"the page did not show everything within {longest:.0f} s; on a slow machine a "
        "smaller picture (--size) or a display less helps"
    )


def page_address(url: str) -> str:
    """Return the address of a page whose pixels are those of its picture."""
    query = "fixedDpr=1&channel=none"
    return f"{url}&{query}" if "?" in url else f"{url}/?{query}"


def png(picture: Picture) -> bytes:
    """Return a picture as the bytes of a PNG file."""
    from PIL import Image

    encoded = io.BytesIO()
    Image.fromarray(picture).save(encoded, format="PNG")
    return encoded.getvalue()


def _place(client: viser.ClientHandle) -> tuple[float, ...]:
    """Return where the page's camera is and looks, as far as is known [m]."""
    camera = client.camera
    return tuple(float(v) for v in (*camera.position, *camera.look_at))
