"""Images: found beside the mesh, made fit for a browser once, shared by all.

A browser is sent the original PNG or JPEG bytes when the image is small enough;
otherwise it is decoded, made smaller and encoded once: real robots have photographs
of 4096 pixels on parts of a few centimetres.
"""

from __future__ import annotations

import hashlib
import io
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Literal
from weakref import WeakValueDictionary

from sambot_viz import limits
from sambot_viz.errors import SambotVizError
from sambot_viz.files import Stamp, is_lfs_pointer, read_limited, reason_of, stamp
from sambot_viz.meshes.mesh import Texture

if TYPE_CHECKING:
    from PIL.Image import Image

_MIME: dict[str, Literal["image/png", "image/jpeg"]] = {
    "PNG": "image/png",
    "JPEG": "image/jpeg",
}
_FORMATS = (*_MIME, "TGA", "BMP", "TIFF", "WEBP", "GIF")
"""Others are not opened: Pillow starts Ghostscript for an EPS."""


class TextureError(SambotVizError):
    """An image that cannot be used; the text says why."""


class TextureStore:
    """Textures by content: the same file or the same bytes give the same object.

    An image is kept as long as a mesh or a shape uses it.
    """

    def __init__(self, longest_side: int = limits.TEXTURE_SIDE.value) -> None:
        """Set the cap `longest_side` [pixels]; larger images are made smaller."""
        self.longest_side = longest_side
        self._lock = threading.Lock()
        self._by_content: WeakValueDictionary[bytes, Texture] = WeakValueDictionary()
        self._by_file: WeakValueDictionary[tuple[Path, Stamp | None], Texture]
        self._by_file = WeakValueDictionary()

    def from_file(self, path: Path) -> Texture:
        """Return the image in a file.

        Raises:
            TextureError: it cannot be read, or is not an image.
        """
        key = (path, stamp(path))
        known = self._by_file.get(key)
        if known is None:
            try:
                data = read_limited(path, limits.TEXTURE.value)
            except (OSError, ValueError) as error:
                raise TextureError(reason_of(error)) from error
            known = self._by_file[key] = self.from_bytes(data)
        return known

    def from_bytes(self, data: bytes) -> Texture:
        """Return the image in these bytes (PNG, JPEG, TGA, BMP, TIFF, WebP, …).

        Raises:
            TextureError: not an image, or one that is broken.
        """
        key = hashlib.sha256(data).digest()
        with self._lock:
            known = self._by_content.get(key)
            if known is None:
                known = encode_texture(data, self.longest_side)
                self._by_content[key] = known
        return known


def encode_texture(
    data: bytes, longest_side: int = limits.TEXTURE_SIDE.value
) -> Texture:
    """Make an image fit for a browser.

    Args:
        data: an image file of any kind that Pillow reads.
        longest_side: the cap [pixels].

    Raises:
        TextureError: not an image, or one that is broken.
    """
    if is_lfs_pointer(data):
        raise TextureError("it is a git-LFS pointer; run 'git lfs pull'")
    # Pillow takes a twentieth of a second to import, most robots have no texture.
    from PIL import Image, UnidentifiedImageError

    try:
        image = Image.open(io.BytesIO(data), formats=_FORMATS)
        if image.width * image.height > limits.TEXTURE_PIXELS.value:
            raise TextureError(
                f"it has {image.width:,} × {image.height:,} pixels, more than the "
                f"{limits.TEXTURE_PIXELS.value:,} that are read"
            )
        if max(image.size) <= longest_side and _ready(image, data):
            return Texture(data, _MIME[image.format or ""], *image.size)
        return _encode(Image.open(io.BytesIO(data), formats=_FORMATS), longest_side)
    except UnidentifiedImageError as error:
        raise TextureError("it is not an image that can be read") from error
    except (Image.DecompressionBombError, Image.DecompressionBombWarning) as error:
        raise TextureError("it has too many pixels") from error
    except (OSError, SyntaxError, ValueError, EOFError) as error:
        raise TextureError(f"the image is broken ({error})") from error


def _ready(image: Image, data: bytes) -> bool:
    """Check if a browser shows these bytes as they are; raise when they are broken.

    The check sums of a PNG and the end mark of a JPEG show whether a file was cut off,
    without the time that decoding takes.
    """
    if image.format == "PNG":
        image.verify()
        return True
    if image.format == "JPEG" and image.mode in ("RGB", "L"):
        return b"\xff\xd9" in data[-1024:]
    return False


def _encode(image: Image, longest_side: int) -> Texture:
    fits = max(image.size) <= longest_side
    if not fits:
        # A JPEG can be decoded at a half, a quarter or an eighth of its size.
        image.draft("RGB", (longest_side, longest_side))
    kind = image.format
    image.load()
    if image.mode.startswith("I"):
        # Sixteen bits of grey: the upper eight are what a screen can show.
        image = image.convert("I").point(lambda value: value / 256).convert("L")
    alpha = "A" in image.getbands() or "transparency" in image.info
    image = image.convert("RGBA" if alpha else "RGB")
    if alpha and image.getchannel("A").getextrema() == (255, 255):
        # An alpha channel that hides nothing would only forbid JPEG.
        alpha, image = False, image.convert("RGB")
    if not fits:
        image.thumbnail((longest_side, longest_side))
    lossy = not alpha and (kind == "JPEG" or not fits)
    out = io.BytesIO()
    mime: Literal["image/png", "image/jpeg"] = "image/png"
    if lossy:
        mime = "image/jpeg"
        image.save(out, "JPEG", quality=92, subsampling=0)
    else:
        image.save(out, "PNG", compress_level=4)
    return Texture(out.getvalue(), mime, *image.size)
