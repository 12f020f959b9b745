"""Colours and textures of surfaces, and the images that files name."""

from __future__ import annotations

from dataclasses import dataclass

from sambot_viz.geometry import Rgba
from sambot_viz.meshes.mesh import Texture
from sambot_viz.meshes.named_files import NamedFileError
from sambot_viz.meshes.source import MeshSource
from sambot_viz.meshes.textures import TextureError


@dataclass(frozen=True, slots=True)
class MeshMaterial:
    """Colour and texture of a surface."""

    rgba: Rgba
    texture: Texture | None = None


def load_texture(name: str, source: MeshSource) -> Texture | None:
    """Read the image that a mesh names; None, with a warning, when that fails."""
    try:
        path = source.files.find(name)
    except NamedFileError as error:
        source.warn(
            "mesh-texture-missing",
            f"the texture '{name}' was not found: {error}; the surface is shown "
            "without it",
            "put the image beside the mesh",
        )
        return None
    source.files.note(path)
    try:
        return source.images.from_file(path)
    except TextureError as error:
        source.warn(
            "mesh-texture-broken",
            f"the texture '{name}' cannot be used: {error}; the surface is shown "
            "without it",
        )
        return None
