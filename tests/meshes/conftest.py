"""Small mesh files, written by the tests that read them."""

from __future__ import annotations

import io
import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

Write = Callable[[str, "bytes | str"], Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Writes a file into the test's folder and gives its path."""

    def write_file(name: str, content: bytes | str) -> Path:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        data = content.encode() if isinstance(content, str) else content
        path.write_bytes(data)
        return path

    return write_file


@pytest.fixture
def png() -> Callable[..., bytes]:
    """A PNG (or another format) of one colour."""

    def make(width: int = 4, height: int = 4, kind: str = "PNG") -> bytes:
        out = io.BytesIO()
        mode = "RGB" if kind in ("JPEG", "BMP") else "RGBA"
        Image.new(mode, (width, height), "orange").save(out, kind)
        return out.getvalue()

    return make


@pytest.fixture
def binary_stl() -> Callable[..., bytes]:
    """A binary STL of (M, 3, 3) corners."""

    def make(corners: object, header: bytes = b"test") -> bytes:
        triangles = np.asarray(corners, dtype="<f4").reshape(-1, 3, 3)
        body = b"".join(
            b"\0" * 12 + triangle.tobytes() + b"\0\0" for triangle in triangles
        )
        return header.ljust(80, b"\0") + struct.pack("<I", len(triangles)) + body

    return make
