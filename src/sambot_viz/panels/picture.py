"""A picture of the view at a chosen size, as a file for the browser that asks."""

from __future__ import annotations

import asyncio
import io
from dataclasses import replace

import numpy as np
import viser
from PIL import Image

from sambot_viz.geometry import wxyz_from_matrix
from sambot_viz.panels.widgets import watch
from sambot_viz.session import Session
from sambot_viz.views.camera import components

LONGEST_SIDE = 4096
"""A browser cannot draw a larger picture [pixels]."""
RENDER_TIME = 60.0
"""A browser that has not drawn a picture by then is gone [s]."""


class PictureRows:
    """Width, height and a button, in the current container.

    Args:
        session: whose view is drawn.
    """

    def __init__(self, session: Session) -> None:
        gui = session.audience.gui
        self._session = session
        self._size = [1280, 720]
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
        if event.client is not None:
            await send_picture(self._session, event.client, *self._size)


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
    """Have a browser draw its view at a size, and give it to it as a file.

    Args:
        session: what the browser shows.
        client: the browser.
        width: of the picture [pixels].
        height: of the picture [pixels]; it shows as much as the window's does.
    """
    camera = session.views.camera_of(client.client_id)
    if camera.scale is not None:
        scale = camera.scale * height / client.camera.image_height
        # The page's own camera is farther away than viser draws into pictures.
        camera = replace(camera, scale=scale).as_perspective(height)
    R = np.stack([camera.right, -camera.image_up, camera.forward], 1)
    drawn = await asyncio.to_thread(
        client.get_render,
        height,
        width,
        wxyz=wxyz_from_matrix(R),
        position=components(camera.position),
        fov=camera.fov,
        transport_format="png",
        timeout=RENDER_TIME,
    )
    file = io.BytesIO()
    on_background(drawn, session.context.background).save(file, "PNG")
    client.send_file_download("sambot-viz.png", file.getvalue())


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
