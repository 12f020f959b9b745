"""Images are made fit for a browser once."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from sambot_viz.meshes.textures import (
    TextureError,
    TextureStore,
    encode_texture,
)

Write = Callable[..., Path]
Png = Callable[..., bytes]


@pytest.mark.parametrize("kind", ["PNG", "JPEG"])
def test_small_images_are_sent_as_they_are(png: Png, kind: str) -> None:
    data = png(1024, 3, kind)
    texture = encode_texture(data)
    assert texture.data is data
    assert texture.mime == f"image/{kind.lower()}"
    assert (texture.width, texture.height) == (1024, 3)


@pytest.mark.parametrize("kind", ["PNG", "JPEG"])
def test_large_images_are_made_smaller(png: Png, kind: str) -> None:
    texture = encode_texture(png(2048, 512, kind))
    assert (texture.width, texture.height) == (1024, 256)
    assert texture.mime == "image/jpeg"
    with Image.open(io.BytesIO(texture.data)) as image:
        assert image.size == (1024, 256) and image.format == "JPEG"


def test_large_images_with_holes_keep_them() -> None:
    out = io.BytesIO()
    Image.new("RGBA", (2048, 8), (255, 0, 0, 40)).save(out, "PNG")
    texture = encode_texture(out.getvalue())
    assert texture.mime == "image/png"
    with Image.open(io.BytesIO(texture.data)) as image:
        assert image.getpixel((5, 2)) == (255, 0, 0, 40)


def test_the_cap_can_be_chosen(png: Png) -> None:
    assert TextureStore(longest_side=16).from_bytes(png(64, 32)).width == 16


def test_a_postscript_image_starts_no_interpreter(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    out = io.BytesIO()
    Image.new("RGB", (8, 8)).save(out, "EPS")
    started: list[object] = []
    monkeypatch.setattr("subprocess.Popen", lambda *args, **_: started.append(args))
    with pytest.raises(TextureError, match="it is not an image that can be read"):
        encode_texture(out.getvalue())
    assert started == []


@pytest.mark.parametrize("kind", ["BMP", "TIFF", "WEBP", "GIF", "TGA"])
def test_other_formats_become_png(png: Png, kind: str) -> None:
    texture = encode_texture(png(8, 8, kind))
    assert texture.mime == "image/png" and texture.data.startswith(b"\x89PNG")


def test_large_sixteen_bit_images_keep_their_brightness() -> None:
    out = io.BytesIO()
    Image.fromarray(np.full((8, 2048), 0x8000, dtype=np.uint16)).save(out, "PNG")
    with Image.open(io.BytesIO(encode_texture(out.getvalue()).data)) as image:
        assert abs(np.asarray(image.convert("L")).mean() - 128) <= 1


def test_cmyk_images_become_rgb() -> None:
    out = io.BytesIO()
    Image.new("CMYK", (8, 8)).save(out, "JPEG")
    with Image.open(io.BytesIO(encode_texture(out.getvalue()).data)) as image:
        assert image.mode == "RGB"


@pytest.mark.parametrize(
    ("damage", "reason"),
    [
        (lambda data: data[:-20], "broken"),
        (lambda data: data[:40] + b"????" + data[44:], "image"),
        (lambda data: b"not an image", "not an image"),
        (lambda data: b"", "not an image"),
        (lambda data: b"version https://git-lfs.github.com/spec/v1", "git lfs pull"),
    ],
)
def test_broken_images_are_refused(
    png: Png, damage: Callable[[bytes], bytes], reason: str
) -> None:
    with pytest.raises(TextureError, match=reason):
        encode_texture(damage(png()))


def test_a_jpeg_that_is_cut_off_is_refused(png: Png) -> None:
    with pytest.raises(TextureError, match="broken"):
        encode_texture(png(64, 64, "JPEG")[:-60])


def test_the_same_image_is_the_same_object(write: Write, png: Png) -> None:
    store = TextureStore()
    first = store.from_file(write("a.png", png()))
    assert store.from_file(write("copy.png", png())) is first
    assert store.from_bytes(png()) is first
    with pytest.raises(TextureError, match="no such file"):
        store.from_file(Path("gone.png"))


def test_an_image_with_too_many_pixels_is_refused_before_it_is_decoded() -> None:
    out = io.BytesIO()
    Image.new("1", (13000, 13000)).save(out, "PNG")
    with pytest.raises(TextureError, match="too many pixels"):
        encode_texture(out.getvalue())


def test_an_image_file_that_is_too_large_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "huge.png"
    with path.open("wb") as stream:
        stream.truncate(2**31)
    with pytest.raises(TextureError, match="more than 67,108,864 bytes"):
        TextureStore().from_file(path)
