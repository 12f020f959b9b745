"""A small GLB writer: one primitive per part, the texture's own bytes inside.

Written by hand because the general one decodes and encodes every texture again for
every part, which takes seconds.
"""

from __future__ import annotations

import json
import struct
import weakref
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from sambot_viz.geometry import Rgba
from sambot_viz.meshes.mesh import WHITE, Mesh, MeshPart, Texture

_FLOAT, _UINT32, _UINT16 = 5126, 5125, 5123
_VERTICES, _INDICES = 34962, 34963
_OPAQUE = 0.9998
"""From this alpha on RViz draws without blending."""


_last: weakref.WeakKeyDictionary[MeshPart, tuple[tuple[Rgba | None, float], bytes]] = (
    weakref.WeakKeyDictionary()
)


def shared_glb(part: MeshPart, rgba: Rgba | None, alpha: float) -> bytes:
    """Return `to_glb` of one part; the same object for the look asked for last.

    So do all browsers of a class with a robot each.
    """
    key = rgba, alpha
    known = _last.get(part)
    if known is None or known[0] != key:
        known = _last[part] = key, to_glb(part, rgba=rgba, alpha=alpha)
    return known[1]


def to_glb(
    what: MeshPart | Mesh | Sequence[MeshPart],
    *,
    rgba: Rgba | None = None,
    alpha: float = 1.0,
) -> bytes:
    """Return a GLB file that a browser shows as RViz shows the parts.

    Materials are not metallic and quite rough, back faces are culled, and flat parts
    have no normals, by which a glTF reader knows them.

    Args:
        what: one part, several, or a whole mesh.
        rgba: colour factors instead of each part's own (a URDF material); white
            where neither says anything.
        alpha: multiplies the colour's own; below 0.9998 the result is blended.
    """
    parts = (
        (what,)
        if isinstance(what, MeshPart)
        else what.parts
        if isinstance(what, Mesh)
        else tuple(what)
    )
    writer = _Writer()
    primitives = [writer.primitive(part, rgba, alpha) for part in parts]
    return writer.file(primitives)


@dataclass(slots=True)
class _Writer:
    """The lists of a glTF document and its one buffer."""

    chunks: list[bytes] = field(default_factory=list[bytes])
    length: int = 0
    views: list[dict[str, Any]] = field(default_factory=list[dict[str, Any]])
    accessors: list[dict[str, Any]] = field(default_factory=list[dict[str, Any]])
    materials: list[dict[str, Any]] = field(default_factory=list[dict[str, Any]])
    images: list[dict[str, Any]] = field(default_factory=list[dict[str, Any]])
    known: dict[int, int] = field(default_factory=dict[int, int])

    def view(self, data: bytes, target: int | None = None) -> int:
        """Append bytes to the buffer, padded to four."""
        entry: dict[str, Any] = {
            "buffer": 0,
            "byteOffset": self.length,
            "byteLength": len(data),
        }
        if target is not None:
            entry["target"] = target
        padded = data + b"\0" * (-len(data) % 4)
        self.chunks.append(padded)
        self.length += len(padded)
        self.views.append(entry)
        return len(self.views) - 1

    def accessor(self, data: bytes, kind: int, shape: str, count: int) -> int:
        """Return a typed view."""
        target = _INDICES if shape == "SCALAR" else _VERTICES
        self.accessors.append(
            {
                "bufferView": self.view(data, target),
                "componentType": kind,
                "count": count,
                "type": shape,
            }
        )
        return len(self.accessors) - 1

    def primitive(
        self, part: MeshPart, rgba: Rgba | None, alpha: float
    ) -> dict[str, Any]:
        """Return the triangles of a part with their material."""
        count = len(part.vertices)
        position = self.accessor(_floats(part.vertices), _FLOAT, "VEC3", count)
        self.accessors[position]["min"] = [
            float(value) for value in np.min(part.vertices, axis=0)
        ]
        self.accessors[position]["max"] = [
            float(value) for value in np.max(part.vertices, axis=0)
        ]
        attributes = {"POSITION": position}
        if part.normals is not None:
            attributes["NORMAL"] = self.accessor(
                _floats(part.normals), _FLOAT, "VEC3", count
            )
        if part.uv is not None and part.texture is not None:
            # The first row of an image is v = 0 in glTF.
            uv = np.column_stack([part.uv[:, 0], 1 - part.uv[:, 1]])
            attributes["TEXCOORD_0"] = self.accessor(_floats(uv), _FLOAT, "VEC2", count)
        small = count < 65536
        indices = part.faces.astype("<u2" if small else "<u4")
        return {
            "attributes": attributes,
            "indices": self.accessor(
                indices.tobytes(),
                _UINT16 if small else _UINT32,
                "SCALAR",
                3 * len(part.faces),
            ),
            "material": self.material(part, rgba, alpha),
        }

    def material(self, part: MeshPart, rgba: Rgba | None, alpha: float) -> int:
        """Return the look of a part."""
        red, green, blue, opacity = rgba or part.rgba or WHITE
        opacity *= alpha
        pbr: dict[str, Any] = {
            "baseColorFactor": [
                srgb_to_linear(red),
                srgb_to_linear(green),
                srgb_to_linear(blue),
                opacity,
            ],
            "metallicFactor": 0.0,
            "roughnessFactor": 1.0,
        }
        if part.texture is not None and part.uv is not None:
            pbr["baseColorTexture"] = {"index": self.texture(part.texture)}
        material: dict[str, Any] = {"pbrMetallicRoughness": pbr, "doubleSided": False}
        if opacity < _OPAQUE:
            material["alphaMode"] = "BLEND"
        self.materials.append(material)
        return len(self.materials) - 1

    def texture(self, texture: Texture) -> int:
        """Return the number of an image, which is written once."""
        number = self.known.get(id(texture))
        if number is None:
            number = self.known[id(texture)] = len(self.images)
            self.images.append(
                {"bufferView": self.view(texture.data), "mimeType": texture.mime}
            )
        return number

    def file(self, primitives: list[dict[str, Any]]) -> bytes:
        """Return the finished file."""
        document: dict[str, Any] = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": primitives}],
            "materials": self.materials,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": self.length}],
        }
        if self.images:
            document["images"] = self.images
            document["samplers"] = [{"wrapS": 10497, "wrapT": 10497}]
            document["textures"] = [
                {"source": number, "sampler": 0} for number in range(len(self.images))
            ]
        return glb_file(document, b"".join(self.chunks))


def glb_file(document: dict[str, Any], body: bytes) -> bytes:
    """Return a GLB container.

    Args:
        document: the glTF document.
        body: its one binary buffer, padded to a multiple of 4.

    Raises:
        ValueError: a number of the document is not finite.
    """
    text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    total = 12 + 8 + len(text) + 8 + len(body)
    return b"".join(
        [
            struct.pack("<4sII", b"glTF", 2, total),
            struct.pack("<I4s", len(text), b"JSON"),
            text,
            struct.pack("<I4s", len(body), b"BIN\0"),
            body,
        ]
    )


def srgb_to_linear(value: float) -> float:
    """Convert a colour value as shown, 0 to 1, to the linear light of glTF."""
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def _floats(values: np.ndarray[Any, np.dtype[Any]]) -> bytes:
    return values.astype("<f4").tobytes()
