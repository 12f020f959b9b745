"""A small GLB writer: the triangles of one look, the texture's own bytes inside.

Written by hand because the general one decodes and encodes every texture again for
every part, which takes seconds.
"""

from __future__ import annotations

import json
import struct
import weakref
from dataclasses import replace
from typing import Any

import numpy as np

from sambot_viz.geometry import Rgba
from sambot_viz.meshes.mesh import WHITE, FloatArray, MeshPart

_FLOAT, _UINT32, _UINT16 = 5126, 5125, 5123
_VERTICES, _INDICES = 34962, 34963
OPAQUE_FROM = 0.9998
"""RViz blends below this alpha and writes no depth."""
_SEEN, _A_BIT = 4 / 255, 0.02
"""A change of the brightness that is seen, and a part of a surface that counts."""

_last: weakref.WeakKeyDictionary[MeshPart, tuple[tuple[Rgba | None, float], bytes]] = (
    weakref.WeakKeyDictionary()
)


def shared_glb(part: MeshPart, rgba: Rgba | None, alpha: float) -> bytes:
    """Return `to_glb` of a part; the same object for the look asked for last.

    So do all browsers of a class with a robot each.
    """
    key = rgba, alpha
    known = _last.get(part)
    if known is None or known[0] != key:
        known = _last[part] = key, to_glb(part, rgba=rgba, alpha=alpha)
    return known[1]


_own_normals: weakref.WeakKeyDictionary[MeshPart, bool] = weakref.WeakKeyDictionary()


def has_own_normals(part: MeshPart) -> bool:
    """Return whether a part is shaded otherwise than by its faces alone.

    Browsers compute normals from the faces around each vertex, which is what most files
    say; where the sides of an edge have different textures it is not.
    """
    if part.normals is None:
        return False
    known = _own_normals.get(part)
    if known is None:
        known = _own_normals[part] = _differ(part, part.normals)
    return known


def _differ(part: MeshPart, normals: FloatArray) -> bool:
    """Whether the brightness of more than a bit of the surface would be another."""
    corners = part.vertices[part.faces].astype(np.float64)
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    at, count = np.ravel(part.faces), len(part.vertices)

    def sums(of_faces: np.ndarray[Any, np.dtype[np.float64]]) -> Any:
        return np.bincount(at, np.repeat(of_faces, 3), count)

    computed = np.stack([sums(across[:, axis]) for axis in range(3)], axis=1)
    lengths = np.linalg.norm(computed, axis=1, keepdims=True)
    computed /= np.where(lengths > 0, lengths, 1)
    area = sums(np.linalg.norm(across, axis=1))
    other = np.abs(computed - normals).max(axis=1) > _SEEN
    return bool((area * other).sum() > _A_BIT * area.sum())


def to_glb(
    part: MeshPart,
    *,
    rgba: Rgba | None = None,
    alpha: float = 1.0,
    two_sided: bool = False,
    blended: bool = False,
    over: Rgba | None = None,
) -> bytes:
    """Return a GLB file that a browser shows as RViz shows the part.

    The material is not metallic and quite rough, back faces are culled, and a flat part
    has no normals, by which a glTF reader knows it. viser replaces normals by those of
    the faces; the page takes `_NORMAL` instead.

    Args:
        part: the triangles.
        rgba: colour factors instead of the part's own (a URDF material); white
            where neither says anything.
        alpha: multiplies the colour's own; below 0.9998 the result is blended.
        two_sided: back faces are not culled.
        blended: the alpha of the texture counts.
        over: a colour in which the part is drawn once more, on top, without a texture.
    """
    numbers = _Numbers()
    position = numbers.add(part.vertices, "VEC3")
    lows, highs = np.min(part.vertices, axis=0), np.max(part.vertices, axis=0)
    numbers.accessors[position]["min"] = [float(value) for value in lows]
    numbers.accessors[position]["max"] = [float(value) for value in highs]
    attributes = {"POSITION": position}
    if part.normals is not None:
        attributes["NORMAL"] = numbers.add(part.normals, "VEC3")
        if has_own_normals(part):
            attributes["_NORMAL"] = numbers.add(part.normals, "VEC3")
    if part.uv is not None and part.texture is not None:
        # The first row of an image is v = 0 in glTF.
        uv = np.column_stack([part.uv[:, 0], 1 - part.uv[:, 1]])
        attributes["TEXCOORD_0"] = numbers.add(uv, "VEC2")
    small = len(part.vertices) < 65536
    indices = np.ravel(part.faces).astype("<u2" if small else "<u4")
    primitive = {
        "attributes": attributes,
        "indices": numbers.add(indices, "SCALAR"),
        "material": 0,
    }
    primitives = [primitive]
    material = _material(part, rgba, alpha) | {"doubleSided": two_sided}
    materials = [material | {"alphaMode": "BLEND"} if blended else material]
    if over is not None:
        primitives.append({**primitive, "material": 1})
        materials.append(_material(replace(part, texture=None), over, 1.0))
    images: dict[str, Any] = {}
    if part.texture is not None and part.uv is not None:
        image = {
            "bufferView": numbers.view(part.texture.data),
            "mimeType": part.texture.mime,
        }
        images = {
            "images": [image],
            "samplers": [{"wrapS": 10497, "wrapT": 10497}],
            "textures": [{"source": 0, "sampler": 0}],
        }
    body = b"".join(numbers.chunks)
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": primitives}],
        "materials": materials,
        "accessors": numbers.accessors,
        "bufferViews": numbers.views,
        "buffers": [{"byteLength": len(body)}],
        **images,
    }
    return glb_file(document, body)


def _material(part: MeshPart, rgba: Rgba | None, alpha: float) -> dict[str, Any]:
    """Return the look of a part."""
    red, green, blue, opacity = rgba or part.rgba or WHITE
    opacity *= alpha
    pbr: dict[str, Any] = {
        "baseColorFactor": [*map(srgb_to_linear, (red, green, blue)), opacity],
        "metallicFactor": 0.0,
        "roughnessFactor": 1.0,
    }
    if part.texture is not None and part.uv is not None:
        pbr["baseColorTexture"] = {"index": 0}
    material: dict[str, Any] = {"pbrMetallicRoughness": pbr}
    if opacity < OPAQUE_FROM:
        material["alphaMode"] = "BLEND"
    return material


class _Numbers:
    """The one buffer of a document, its views and accessors."""

    def __init__(self) -> None:
        self.chunks: list[bytes] = []
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def view(self, data: bytes, target: int | None = None) -> int:
        """Append bytes to the buffer, padded to four."""
        start = sum(map(len, self.chunks))
        entry = {"buffer": 0, "byteOffset": start, "byteLength": len(data)}
        self.views.append(entry if target is None else {**entry, "target": target})
        self.chunks.append(data + b"\0" * (-len(data) % 4))
        return len(self.views) - 1

    def add(self, rows: np.ndarray[Any, np.dtype[Any]], shape: str) -> int:
        """Append an array: floats, or the indices of corners."""
        indices = _UINT16 if rows.itemsize == 2 else _UINT32
        kind = indices if rows.dtype.kind == "u" else _FLOAT
        data = rows.astype("<f4") if kind == _FLOAT else rows
        target = _INDICES if shape == "SCALAR" else _VERTICES
        self.accessors.append(
            {
                "bufferView": self.view(data.tobytes(), target),
                "componentType": kind,
                "count": len(rows),
                "type": shape,
            }
        )
        return len(self.accessors) - 1


def glb_file(document: dict[str, Any], *body: bytes | memoryview) -> bytes:
    """Return a GLB container.

    Args:
        document: the glTF document.
        body: the parts of its one binary buffer, padded to a multiple of 4.

    Raises:
        ValueError: a number of the document is not finite.
    """
    text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    length = sum(map(len, body))
    total = 12 + 8 + len(text) + 8 + length
    return b"".join(
        [
            struct.pack("<4sII", b"glTF", 2, total),
            struct.pack("<I4s", len(text), b"JSON"),
            text,
            struct.pack("<I4s", length, b"BIN\0"),
            *body,
        ]
    )


def srgb_to_linear(value: float) -> float:
    """Convert a colour value as shown, 0 to 1, to the linear light of glTF."""
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4
