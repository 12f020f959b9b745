"""A glTF file: its JSON, the bytes that it names, colours and textures as in RViz.

Bytes are in its own chunk, in data URIs and in files beside it. The JSON is not
checked; an invalid one raises any exception of Python, which `read_gltf` turns into a
sentence.
"""

from __future__ import annotations

import base64
import json
import struct
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from sambot_viz import limits
from sambot_viz.geometry import Rgba
from sambot_viz.meshes.mesh import WHITE, Texture
from sambot_viz.meshes.mesh_source import MeshMaterial, MeshSource
from sambot_viz.meshes.named_files import NamedFileError
from sambot_viz.meshes.textures import TextureError

Json = dict[str, Any]

_KINDS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {
    "SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16,
}  # fmt: skip


class GltfFile:
    """The JSON of a .gltf or .glb file, and the bytes that it names.

    Attributes:
        document: the JSON.
        data: the file, as trimesh is given it.
        is_glb: the kind of the file.

    Raises:
        ValueError: cut off, older than 2.0, or it announces what it does not have.
    """

    def __init__(self, source: MeshSource) -> None:
        self.source = source
        self.data = text = source.data
        self.is_glb = text[:4] == b"glTF"
        self._binary = b""
        self._known: dict[str, bytes] = {}
        if self.is_glb:
            text, self._binary = self._chunks()
        try:
            document: object = json.loads(text)
        except ValueError as error:
            raise ValueError(f"its JSON cannot be read ({error})") from error
        if not isinstance(document, dict):
            raise ValueError("its JSON is not an object")
        self.document = cast(Json, document)
        self._compare_sizes()

    def __getitem__(self, uri: str) -> bytes:
        """Return the bytes of a URI; trimesh requests its buffers this way."""
        if uri not in self._known:
            self._known[uri] = self._load(uri)
        return self._known[uri]

    def view(self, number: int) -> memoryview:
        """Return the bytes of a buffer view, not copied."""
        view: Json = self.document["bufferViews"][number]
        uri = self.document["buffers"][view["buffer"]].get("uri")
        data = self._binary if uri is None else self[uri]
        start = view.get("byteOffset", 0)
        end = start + view["byteLength"]
        if not 0 <= start <= end <= len(data):
            raise ValueError(f"a buffer view ends at byte {end} of {len(data)}")
        return memoryview(data)[start:end]

    def array(self, accessor: Json) -> npt.NDArray[Any]:
        """Return the rows of an accessor, not copied."""
        width = _WIDTHS[accessor["type"]]
        dtype = np.dtype((_KINDS[accessor["componentType"]], (width,)))
        data, view = accessor["bufferView"], self.view(accessor["bufferView"])
        stride = self.document["bufferViews"][data].get("byteStride", dtype.itemsize)
        count, start = accessor["count"], accessor.get("byteOffset", 0)
        end = start + stride * (count - 1) + dtype.itemsize if count else start
        # numpy takes a negative offset or count as it is.
        if min(start, count, stride - 1) < 0 or end > len(view):
            raise ValueError(
                f"an accessor of {count} entries does not fit its buffer view"
            )
        return np.ndarray(count, dtype, view, start, stride)

    def _load(self, uri: str) -> bytes:
        _, encoded, text = uri.partition("base64,")
        try:
            # Encoded bytes are found as trimesh finds them, but read strictly.
            if encoded:
                return base64.b64decode(text, validate=True)
            return self.source.files.read(uri, limits.MESH.value)
        except ValueError as error:
            raise ValueError("a data URI is not valid base64") from error
        except NamedFileError as error:
            raise type(error)(f"'{uri[:80]}': {error}") from error

    def _chunks(self) -> tuple[bytes, bytes]:
        """Return the JSON and the binary part of a GLB."""
        if len(self.data) < 20:
            raise ValueError(f"it has only {len(self.data)} bytes")
        version, total, length = struct.unpack_from("<III", self.data, 4)
        if version != 2:
            raise ValueError(f"it is of version {version}, and only 2 can be read")
        if not 20 + length <= total <= len(self.data):
            raise ValueError(f"it announces {total} bytes but has {len(self.data)}")
        self.data = self.data[:total]
        return self.data[20 : 20 + length], self.data[28 + length :]

    def _compare_sizes(self) -> None:
        """Refuse a file that announces numbers which it has no bytes for."""
        for name in ("bufferViews", "accessors"):
            if len(self.document.get(name, ())) > limits.MESH_NODES.value:
                raise ValueError(f"it has more than {limits.MESH_NODES.value:,} {name}")
        views = range(len(self.document.get("bufferViews", ())))
        announced = sum(len(self.view(number)) for number in views)
        for accessor in self.document.get("accessors", ()):
            if "bufferView" in accessor:
                announced += self.array(accessor).nbytes
            else:
                self.source.budget.spend_without_data(accessor["count"])
        size = len(self.data) + sum(map(len, self._known.values()))
        if announced > 8 * size + 2**26:
            raise ValueError(
                f"it announces {announced} bytes of numbers but has {size}"
            )


_GLOSSINESS = "KHR_materials_pbrSpecularGlossiness"
_IMAGE_EXTENSIONS = ("EXT_texture_webp", "KHR_texture_basisu")


class GltfMaterials:
    """The materials of a file, each read once."""

    def __init__(self, file: GltfFile) -> None:
        self._file = file
        self._looks: dict[int, tuple[MeshMaterial, str]] = {}

    def look(self, number: int | None) -> tuple[MeshMaterial, str]:
        """Return colour and texture of a material, and the attribute with its uv.

        Without a material glTF says white.
        """
        if number is None:
            return MeshMaterial(WHITE), ""
        if number not in self._looks:
            self._looks[number] = self._read(self._file.document["materials"][number])
        return self._looks[number]

    def _read(self, material: Json) -> tuple[MeshMaterial, str]:
        pbr = material.get("pbrMetallicRoughness", {})
        old = material.get("extensions", {}).get(_GLOSSINESS, {})
        factor = old.get("diffuseFactor", pbr.get("baseColorFactor"))
        info = old.get("diffuseTexture") or pbr.get("baseColorTexture")
        red, green, blue, alpha = _shares(factor, WHITE)
        if material.get("alphaMode", "OPAQUE") != "BLEND" or alpha == 0:
            alpha = 1.0
        # RViz adds emission to the diffuse colour and multiplies both by the texture.
        light = _shares(material.get("emissiveFactor"), (0.0, 0.0, 0.0))
        lit = [min(1.0, a + b) for a, b in zip((red, green, blue), light, strict=True)]
        rgba: Rgba = (lit[0], lit[1], lit[2], alpha)
        if not info:
            return MeshMaterial(rgba), ""
        look = MeshMaterial(rgba, self._texture(info.get("index")))
        return look, f"TEXCOORD_{info.get('texCoord', 0)}"

    def _texture(self, number: Any) -> Texture | None:
        hint = "export the mesh again with its textures"
        try:
            return self._file.source.images.from_bytes(self._image(number))
        except (LookupError, TypeError, AttributeError) as error:
            reason = f"the file has no such image ({type(error).__name__}: {error})"
        except (ValueError, TextureError) as error:
            reason = str(error)
        except NamedFileError as error:
            reason, hint = str(error), "put the image beside the mesh"
        self._file.source.warn(
            "mesh-texture-broken",
            f"texture {number} of the glTF file cannot be used: {reason}; the surface "
            "is shown without it",
            hint,
        )
        return None

    def _image(self, number: Any) -> bytes:
        """Return the original bytes of an image."""
        texture: Json = self._file.document["textures"][number]
        sources = [texture.get("source")]
        for name in _IMAGE_EXTENSIONS:
            sources.append(texture.get("extensions", {}).get(name, {}).get("source"))
        known = [source for source in sources if source is not None]
        image: Json = self._file.document["images"][known[0]]
        if "uri" in image:
            return self._file[image["uri"]]
        return bytes(self._file.view(image["bufferView"]))


def _shares(values: Any, default: tuple[float, ...]) -> tuple[float, ...]:
    """Return as many numbers from 0 to 1 as the default has; it, if they are not."""
    try:
        shares = tuple(min(1.0, max(0.0, float(value))) for value in values)
    except (TypeError, ValueError):
        return default
    return shares if len(shares) == len(default) else default
