"""The colours and textures of glTF, as RViz reads them through Assimp."""

from __future__ import annotations

from typing import Any

from sambot_viz.geometry import Rgba
from sambot_viz.meshes.assembly.materials import MeshMaterial
from sambot_viz.meshes.formats.gltf_file import GltfFile
from sambot_viz.meshes.formats.gltf_json import Broken, Json, entry, section
from sambot_viz.meshes.mesh import WHITE, Texture
from sambot_viz.meshes.textures import TextureError

_GLOSSINESS = "KHR_materials_pbrSpecularGlossiness"
_IMAGE_EXTENSIONS = ("EXT_texture_webp", "KHR_texture_basisu")


class GltfMaterials:
    """The materials of a file, each read once."""

    def __init__(self, file: GltfFile) -> None:
        self._file = file
        self._looks: dict[int, tuple[MeshMaterial, int]] = {}

    def look(self, number: object) -> tuple[MeshMaterial, int]:
        """Colour and texture of a material, and the uv set of the texture.

        Without a material glTF says white.
        """
        if number is None:
            return MeshMaterial(WHITE), 0
        material = entry(self._file.document, "materials", number)
        known = self._looks.get(id(material))
        if known is None:
            known = self._looks[id(material)] = self._read(material)
        return known

    def _read(self, material: Json) -> tuple[MeshMaterial, int]:
        pbr = section(material, "pbrMetallicRoughness")
        factor, info = pbr.get("baseColorFactor"), section(pbr, "baseColorTexture")
        old = section(section(material, "extensions"), _GLOSSINESS)
        if old:
            factor = old.get("diffuseFactor", factor)
            info = section(old, "diffuseTexture") or info
        rgba = _rgba(factor)
        if material.get("alphaMode", "OPAQUE") != "BLEND" or rgba[3] == 0:
            rgba = (*rgba[:3], 1.0)
        rgba = _with_emission(rgba, material.get("emissiveFactor"))
        if not info:
            return MeshMaterial(rgba), 0
        uv_set: object = info.get("texCoord", 0)
        return (
            MeshMaterial(rgba, self._texture(info.get("index"))),
            uv_set if isinstance(uv_set, int) else 0,
        )

    def _texture(self, number: object) -> Texture | None:
        try:
            texture = entry(self._file.document, "textures", number)
            extensions = section(texture, "extensions")
            source: object = texture.get("source")
            for name in _IMAGE_EXTENSIONS:
                if source is None and name in extensions:
                    source = section(extensions, name).get("source")
            return self._file.source.images.from_bytes(self._file.image(source))
        except (Broken, TextureError) as error:
            reason = str(error)
        self._file.source.warn(
            "mesh-texture-broken",
            f"texture {number} of the glTF file cannot be used: {reason}; the surface "
            "is shown without it",
            "export the mesh again with its textures",
        )
        return None


def _with_emission(rgba: Rgba, factor: Any) -> Rgba:
    """RViz adds emission to the diffuse colour and multiplies both by the texture."""
    try:
        light = [min(1.0, max(0.0, float(v))) for v in factor or (0, 0, 0)]
        red, green, blue = (min(1.0, a + b) for a, b in zip(rgba, light, strict=False))
    except (TypeError, ValueError):
        return rgba
    return (red, green, blue, rgba[3])


def _rgba(factor: Any) -> Rgba:
    try:
        red, green, blue, alpha = (min(1.0, max(0.0, float(v))) for v in factor)
    except (TypeError, ValueError):
        return WHITE
    return (red, green, blue, alpha)
