"""The colours and textures of COLLADA, as RViz reads them through Assimp."""

from __future__ import annotations

import xml.etree.ElementTree as ET

from sambot_viz.meshes.formats.collada_xml import ColladaDocument
from sambot_viz.meshes.mesh import GREY, WHITE, Texture
from sambot_viz.meshes.mesh_source import MeshMaterial, MeshSource, load_texture

_SHADERS = ("phong", "lambert", "blinn", "constant")


class Materials:
    """The materials of a document, each read once."""

    def __init__(self, document: ColladaDocument, source: MeshSource) -> None:
        self.document = document
        self.source = source
        self._looks: dict[int, MeshMaterial] = {}

    def bindings(self, instance: ET.Element | None) -> dict[str, str]:
        """Map the material symbols of an <instance_geometry> to references."""
        if instance is None:
            return {}
        return {
            entry.get("symbol", ""): entry.get("target", "")
            for entry in instance.iter("instance_material")
        }

    def look(self, symbol: str | None, bound: dict[str, str]) -> MeshMaterial:
        """Return the look of triangles with a material symbol.

        As in RViz a broken reference falls back to the first material that the node
        binds, then to the first one of the file, then to grey.
        """
        wanted = bound.get(symbol or "")
        if wanted is None and symbol is not None and not bound:
            wanted = symbol
        material = self.document.by_id(wanted) if wanted else None
        effect = self._effect(material)
        if effect is None:
            if symbol is not None:
                self.source.warn(
                    "mesh-material-broken",
                    f"the COLLADA material '{symbol}' leads to no colour; the first "
                    "one of the file, or grey, is shown",
                    "export the mesh again with its materials",
                )
            effect = self._first_effect(bound)
        return MeshMaterial(GREY) if effect is None else self._read(effect)

    def _effect(self, material: ET.Element | None) -> ET.Element | None:
        instance = None if material is None else material.find("instance_effect")
        return None if instance is None else self.document.target(instance)

    def _first_effect(self, bound: dict[str, str]) -> ET.Element | None:
        materials = [self.document.by_id(target) for target in bound.values()]
        materials += self.document.root.findall("library_materials/material")
        effects = (self._effect(material) for material in materials)
        return next((effect for effect in effects if effect is not None), None)

    def _read(self, effect: ET.Element) -> MeshMaterial:
        look = self._looks.get(id(effect))
        if look is None:
            look = self._looks[id(effect)] = self._parse(effect)
        return look

    def _parse(self, effect: ET.Element) -> MeshMaterial:
        shader = next(
            (
                child
                for technique in effect.iterfind("profile_COMMON/technique")
                for child in technique
                if child.tag in _SHADERS
            ),
            None,
        )
        if shader is None:
            return MeshMaterial(GREY)
        emission = _colour(shader.find("emission")) or (0.0, 0.0, 0.0)
        image = shader.find("diffuse/texture")
        if image is not None:
            texture = self._texture(effect, image.get("texture", ""))
            return MeshMaterial(WHITE, texture)
        red, green, blue = _colour(shader.find("diffuse")) or GREY[:3]
        # Emission is light of its own; seen face on it adds to the diffuse colour.
        # <transparent> is not read: RViz shows COLLADA opaque (golden case
        # mesh_dae_yup_cm).
        shown = (red + emission[0], green + emission[1], blue + emission[2])
        r, g, b = (min(1.0, max(0.0, value)) for value in shown)
        return MeshMaterial((r, g, b, 1.0))

    def _texture(self, effect: ET.Element, reference: str) -> Texture | None:
        """Find the image behind a sampler; a texture may also name the image itself."""
        image = self.document.by_id(self._image_id(effect, reference))
        name = "" if image is None else _image_file(image)
        if not name:
            self.source.warn(
                "mesh-texture-missing",
                f"the COLLADA texture '{reference}' leads to no image; white is shown",
                "export the mesh again with its textures",
            )
            return None
        return load_texture(name, self.source)

    def _image_id(self, effect: ET.Element, reference: str) -> str:
        for _ in range(4):
            param = next(
                (p for p in effect.iter("newparam") if p.get("sid") == reference), None
            )
            if param is None:
                break
            instance = param.find("sampler2D/instance_image")
            if instance is not None:
                return instance.get("url", "")
            following = param.findtext("sampler2D/source") or param.findtext(
                "surface/init_from"
            )
            if following is None:
                break
            reference = following.strip()
        return reference


def _image_file(image: ET.Element) -> str:
    start = image.find("init_from")
    if start is None:
        return ""
    return (start.findtext("ref") or start.text or "").strip()


def _colour(element: ET.Element | None) -> tuple[float, float, float] | None:
    try:
        values = [float(v) for v in (_colour_text(element) or "").split()]
    except ValueError:
        return None
    return (values[0], values[1], values[2]) if len(values) >= 3 else None


def _colour_text(element: ET.Element | None) -> str | None:
    return None if element is None else element.findtext("color")
