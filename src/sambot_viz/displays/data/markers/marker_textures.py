"""The picture that the triangles of a marker bring along."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import numpy.typing as npt

from sambot_viz.meshes.mesh import Texture
from sambot_viz.meshes.textures import TextureStore
from sambot_viz.topics.decoding import numbers_of

_EMBEDDED = "embedded://"
_pictures = TextureStore()


def has_texture(marker: Any) -> bool:
    """Return whether triangles bring a picture, and a place in it for each corner."""
    return (
        # ROS 1 and ROS 2 Foxy have no textures.
        str(getattr(marker, "texture_resource", "")).startswith(_EMBEDDED)
        and len(marker.uv_coordinates) == len(marker.points) > 0
    )


def texture_of(marker: Any) -> Texture:
    """Return the picture of a marker that has one.

    Raises:
        TextureError: it is not a picture, or a broken one.
    """
    return _pictures.from_bytes(np.asarray(marker.texture.data, np.uint8).tobytes())


def is_clear(texture: Texture) -> bool:
    """Return whether one can see through parts of a picture."""
    from PIL import Image

    image: Image.Image = Image.open(io.BytesIO(texture.data))
    return "A" in image.getbands() or "transparency" in image.info


def uv_of(marker: Any) -> npt.NDArray[np.float32]:
    """Return the places in the picture, (N, 2), v upwards from its last row."""
    uv = numbers_of(marker.uv_coordinates, "u", "v")
    return np.where([False, True], 1.0 - uv, uv).astype(np.float32)
