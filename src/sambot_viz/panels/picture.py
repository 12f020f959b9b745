"""A picture of the view at a chosen size, as a file for the browser that asks."""

from __future__ import annotations

import asyncio
import io

import numpy as np
import viser
from PIL import Image

from sambot_viz.panels.widgets import watch

LONGEST_SIDE = 4096
"""A browser cannot draw a larger picture [pixels]."""
RENDER_TIME = 60.0
"""A browser that has not drawn a picture by then is gone [s]."""


class PictureRows:
    """Width, height and a button, in the current container.

    Args:
        gui: where to add them.
    """

    def __init__(self, gui: viser.GuiApi) -> None:
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
                watch(number, side, lambda value, i=index: self._set(i, value))
            save = gui.add_button("Save picture", hint="The 3D view as a PNG file.")
            save.on_click(self._save)

    def _set(self, index: int, value: int) -> None:
        self._size[index] = value

    async def _save(self, event: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
        if event.client is not None:
            await send_picture(event.client, *self._size)


def side(value: object) -> int:
    """The length of a side of a picture [pixels].

    Raises:
        ValueError: too short or too long for a browser.
    """
    if not isinstance(value, int | float) or not 16 <= value <= LONGEST_SIDE:
        raise ValueError(f"a side has 16 to {LONGEST_SIDE} pixels")
    return int(value)


async def send_picture(client: viser.ClientHandle, width: int, height: int) -> None:
    """Have a browser draw its view at a size, and give it to it as a file.

    Args:
        client: the browser.
        width: of the picture [pixels].
        height: of the picture [pixels].
    """
    picture = await asyncio.to_thread(
        client.get_render, height, width, transport_format="png", timeout=RENDER_TIME
    )
    file = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(picture[..., :3])).save(file, "PNG")
    client.send_file_download("sambot-viz.png", file.getvalue())
