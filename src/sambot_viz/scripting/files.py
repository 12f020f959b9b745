"""What a program writes of a robot that is shown: a picture, a page in one file."""

from __future__ import annotations

from sambot_viz.errors import UsageError
from sambot_viz.export import LARGEST_SIDE
from sambot_viz.export.chromium import Chromium
from sambot_viz.export.view_picture import LONGEST_WAIT, png, snapshot
from sambot_viz.server.server import Server

Size = tuple[int, int]
"""Width and height [pixels]."""


def picture_of(server: Server, size: Size) -> bytes:
    """Return the 3D view as a PNG file, as `Visualizer.snapshot` says."""
    session = server.sessions.shared
    if session is None:
        raise UsageError("a picture is taken of a shared session, not of private ones")
    width, height = _checked(size)
    with Chromium() as chromium:
        server.sessions.wait_for_meshes(LONGEST_WAIT)
        with session.lock:
            view = session.document_view
            near = view.view.gives_nearness
            camera = view.camera if near else view.camera_on_robot(width, height)
        return png(snapshot(server, chromium, width, height, camera))


def _checked(size: Size) -> Size:
    try:
        width, height = map(int, size)
    except (TypeError, ValueError):
        raise UsageError(f"{size!r} is not a width and a height [pixels]") from None
    if not (1 <= width <= LARGEST_SIDE and 1 <= height <= LARGEST_SIDE):
        raise UsageError(f"{size}: each side must be 1 to {LARGEST_SIDE} pixels")
    return width, height
