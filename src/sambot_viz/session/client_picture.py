"""A picture of the view at a chosen size, drawn by the browser that asks for it.

The answer is checked: it may be late, may be no picture, or may take gigabytes to
unpack.
"""

from __future__ import annotations

import asyncio
import io
import struct
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from sambot_viz.errors import SambotVizError
from sambot_viz.geometry import wxyz_from_matrix
from sambot_viz.session.clients.client import Client
from sambot_viz.views.camera import components
from sambot_viz.viser_private import drawn_by

if TYPE_CHECKING:
    from PIL import Image

SHORTEST_SIDE = 16
"""A browser cannot draw a larger picture [pixels]."""
RENDER_TIME = 20.0
"""A browser that has not drawn a picture by then does not get it [s]."""
_PNG_MARK = b"\x89PNG\r\n\x1a\n"


class PictureError(SambotVizError):
    """A browser did not send the picture that it was asked for."""


async def picture_of(
    client: Client, background: tuple[int, int, int], width: int, height: int
) -> bytes:
    """Have a client draw its view at a size.

    Args:
        client: the client that draws.
        background: background colour, 0 to 255.
        width: of the picture [pixels].
        height: of the picture [pixels]; it shows as much as the window's does.

    Returns:
        A PNG file of this size, with the background.

    Raises:
        PictureError: the browser did not draw it.
    """
    handle, camera = client.client, client.view.camera
    if camera.scale is not None:
        scale = camera.scale * height / max(1, handle.camera.image_height)
        # The page's own camera is farther away than viser draws into pictures.
        camera = replace(camera, scale=scale).as_perspective(height)
    R = np.stack([camera.right, -camera.image_up, camera.forward], 1)
    pose = {
        "wxyz": tuple(map(float, wxyz_from_matrix(R))),
        "position": tuple(map(float, components(camera.position))),
        "fov": float(camera.fov),
    }
    try:
        answer = await drawn_by(handle, width, height, pose, RENDER_TIME)
    except TimeoutError:
        raise PictureError(
            f"the browser did not draw the picture within {RENDER_TIME:g} s"
        ) from None
    return await asyncio.to_thread(finished, answer, (width, height), background)


def finished(
    answer: bytes, size: tuple[int, int], background: tuple[int, int, int]
) -> bytes:
    """Return the PNG file of a picture that a browser has drawn.

    Args:
        answer: the answer of the browser.
        size: the requested width and height [pixels].
        background: background colour, 0 to 255.

    Raises:
        PictureError: the answer is not a PNG file of this size.
    """
    # The size is in the first bytes: nothing larger is ever unpacked.
    if answer[:8] == _PNG_MARK and answer[16:24] != struct.pack(">II", *size):
        raise PictureError("the browser drew a picture of another size")
    try:
        from PIL import Image

        picture: Image.Image = Image.open(io.BytesIO(answer), formats=["PNG"])
        drawn = np.asarray(picture.convert("RGBA"))
    except (OSError, ValueError, SyntaxError):
        raise PictureError("the browser sent something that is not a picture") from None
    file = io.BytesIO()
    on_background(drawn, background).save(file, "PNG")
    return file.getvalue()


def on_background(drawn: np.ndarray, color: tuple[int, int, int]) -> Image.Image:
    """Return a picture with the background under its transparent pixels.

    viser draws the background where the window's camera sees it; a picture of another
    shape has none at its sides.

    Args:
        drawn: (height, width, 4) uint8, RGBA.
        color: of the background, 0 to 255.
    """
    from PIL import Image

    picture = Image.fromarray(np.ascontiguousarray(drawn, np.uint8), "RGBA")
    behind = Image.new("RGBA", picture.size, (*color, 255))
    return Image.alpha_composite(behind, picture).convert("RGB")
