"""A picture of the view at a chosen size, as a file for the browser that asks.

The browser draws it, so what comes back is checked: it may be late, no picture at all,
or one that takes gigabytes to unpack.
"""

from __future__ import annotations

import asyncio
import io
import struct
from dataclasses import replace

import numpy as np
import viser
from PIL import Image

from sambot_viz.errors import SambotVizError
from sambot_viz.geometry import wxyz_from_matrix
from sambot_viz.panels.widgets import watch
from sambot_viz.session import Session
from sambot_viz.views.camera import components
from sambot_viz.viser_private import drawn_by

LONGEST_SIDE = 4096
"""A browser cannot draw a larger picture [pixels]."""
_PNG_MARK = b"\x89PNG\r\n\x1a\n"
RENDER_TIME = 20.0
"""A browser that has not drawn a picture by then does not get it [s]."""


class PictureRows:
    """Width, height and a button, in the current container.

    Args:
        session: whose view is drawn.
    """

    def __init__(self, session: Session) -> None:
        gui = session.audience.gui
        self._session = session
        self._size = [1280, 720]
        self._busy: set[int] = set()
        with gui.add_folder("Picture", expand_by_default=False):
            for index, label in enumerate(("Width", "Height")):
                number = gui.add_number(
                    f"{label} [pixels]",
                    self._size[index],
                    min=16,
                    max=LONGEST_SIDE,
                    step=1,
                )
                watch(
                    self._session,
                    number,
                    side,
                    lambda value, i=index: self._set(i, value),
                )
            save = gui.add_button("Save picture", hint="The 3D view as a PNG file.")
            save.on_click(self._save)

    def _set(self, index: int, value: int) -> None:
        self._size[index] = value

    async def _save(self, event: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
        """Send a picture to the browser that asks, one at a time."""
        client = event.client
        if client is None or client.client_id in self._busy:
            return
        self._busy.add(client.client_id)
        try:
            await send_picture(self._session, client, *self._size)
        except PictureError as error:
            client.add_notification("No picture", str(error), auto_close_seconds=10.0)
        finally:
            self._busy.discard(client.client_id)


class PictureError(SambotVizError):
    """A browser did not send the picture that it was asked for."""


def side(value: object) -> int:
    """The length of a side of a picture [pixels].

    Raises:
        ValueError: too short or too long for a browser.
    """
    if not isinstance(value, int | float) or not 16 <= value <= LONGEST_SIDE:
        raise ValueError(f"a side has 16 to {LONGEST_SIDE} pixels")
    return int(value)


async def send_picture(
    session: Session, client: viser.ClientHandle, width: int, height: int
) -> None:
    """Have a browser draw its view at a size, and send it the file.

    Args:
        session: what the browser shows.
        client: the browser.
        width: of the picture [pixels].
        height: of the picture [pixels]; it shows as much as the window's does.

    Raises:
        PictureError: the browser did not draw it.
    """
    camera = session.browsers[client.client_id].view.camera
    if camera.scale is not None:
        scale = camera.scale * height / client.camera.image_height
        # The page's own camera is farther away than viser draws into pictures.
        camera = replace(camera, scale=scale).as_perspective(height)
    R = np.stack([camera.right, -camera.image_up, camera.forward], 1)
    pose = {
        "wxyz": tuple(map(float, wxyz_from_matrix(R))),
        "position": tuple(map(float, components(camera.position))),
        "fov": float(camera.fov),
    }
    try:
        answer = await drawn_by(client, width, height, pose, RENDER_TIME)
    except TimeoutError:
        raise PictureError(
            f"the browser did not draw the picture within {RENDER_TIME:g} s"
        ) from None
    background = session.context.background
    file = await asyncio.to_thread(finished, answer, (width, height), background)
    client.send_file_download("sambot-viz.png", file)


def finished(
    answer: bytes, size: tuple[int, int], background: tuple[int, int, int]
) -> bytes:
    """The PNG file of a picture, made from what a browser has drawn.

    Args:
        answer: what the browser sent.
        size: the width and height that it was asked for [pixels].
        background: colour behind what was drawn, 0 to 255.

    Raises:
        PictureError: that is not a PNG file of this size.
    """
    # The size is in the first bytes: nothing larger is ever unpacked.
    if answer[:8] == _PNG_MARK and answer[16:24] != struct.pack(">II", *size):
        raise PictureError("the browser drew a picture of another size")
    try:
        picture: Image.Image = Image.open(io.BytesIO(answer), formats=["PNG"])
        drawn = np.asarray(picture.convert("RGBA"))
    except (OSError, ValueError, SyntaxError):
        raise PictureError("the browser sent something that is not a picture") from None
    file = io.BytesIO()
    on_background(drawn, background).save(file, "PNG")
    return file.getvalue()


def on_background(drawn: np.ndarray, color: tuple[int, int, int]) -> Image.Image:
    """A picture with its background behind it.

    viser puts the background where the window's camera sees it; a picture of
    another shape has none at its sides.

    Args:
        drawn: (height, width, 4) uint8, RGBA.
        color: of the background, 0 to 255.
    """
    picture = Image.fromarray(np.ascontiguousarray(drawn, np.uint8), "RGBA")
    behind = Image.new("RGBA", picture.size, (*color, 255))
    return Image.alpha_composite(behind, picture).convert("RGB")
