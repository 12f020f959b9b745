"""The colours and textures of glTF, as RViz reads them through Assimp."""

from __future__ import annotations

from typing import Any

from sambot_viz.geometry import Rgba
from sambot_viz.meshes.assembly.materials import MeshMaterial
from sambot_viz.meshes.formats.gltf_file import GltfFile, Json
from sambot_viz.meshes.mesh import WHITE, Texture
from sambot_viz.meshes.named_files import NamedFileError
from sambot_viz.meshes.textures import TextureError

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
        try:
            return self._file.source.images.from_bytes(self._image(number))
        except (LookupError, TypeError, AttributeError) as error:
            reason = f"the file has no such image ({type(error).__name__}: {error})"
        except (ValueError, NamedFileError, TextureError) as error:
            reason = str(error)
        self._file.source.warn(
            "mesh-texture-broken",
            f"texture {number} of the glTF file cannot be used: {reason}; the surface "
            "is shown without it",
            "export the mesh again with its textures",
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
