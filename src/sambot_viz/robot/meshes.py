"""The names of `sambot_viz.robot.mesh` that the rest of the program draws with."""

from sambot_viz.robot.mesh.glb import to_glb
from sambot_viz.robot.mesh.model import (
    Mesh,
    MeshError,
    MeshPart,
    Texture,
    apply_scale,
    scaled,
)
from sambot_viz.robot.mesh.reader import read_mesh
from sambot_viz.robot.mesh.store import MeshStore
from sambot_viz.robot.mesh.textures import TextureError

__all__ = [
    "Mesh",
    "MeshError",
    "MeshPart",
    "MeshStore",
    "Texture",
    "TextureError",
    "apply_scale",
    "read_mesh",
    "scaled",
    "to_glb",
]
