"""What surfaces look like, and the images that files name."""

from __future__ import annotations

from dataclasses import dataclass

from sambot_viz.meshes.assembly.assemble import MeshFindings
from sambot_viz.meshes.mesh import Texture
from sambot_viz.meshes.textures import TextureError, TextureStore, find_beside
from sambot_viz.robot.model import Rgba


@dataclass(frozen=True, slots=True)
class MeshMaterial:
    """Colour and texture of a surface."""

    rgba: Rgba
    texture: Texture | None = None


def load_texture(
    name: str, findings: MeshFindings, images: TextureStore
) -> Texture | None:
    """The image that a mesh names; None, with a warning, when it cannot be had."""
    path = find_beside(findings.path, name)
    if path is None:
        findings.warn(
            "mesh-texture-missing",
            f"the texture '{name}' is not there; the surface is shown without it",
            "put the image beside the mesh",
        )
        return None
    try:
        texture = images.from_file(path)
    except TextureError as error:
        findings.warn(
            "mesh-texture-broken",
            f"the texture '{name}' cannot be used: {error}; the surface is shown "
            "without it",
        )
        return None
    findings.read(path)
    return texture
