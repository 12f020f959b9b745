"""The files that the shapes of a robot are drawn from: meshes and textures."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from sambot_viz.meshes.asset import Asset
from sambot_viz.robot.model import MeshFile, Robot, Shape


def asset_of(shape: Shape, file_roots: tuple[Path, ...] | None = None) -> Asset | None:
    """Return the file of a shape, None when it needs none or it is not here.

    Args:
        shape: a visual or a collision.
        file_roots: those of its robot.
    """
    if isinstance(shape.geometry, MeshFile):
        path = shape.geometry.path
        return None if path is None else Asset("mesh", path, file_roots)
    material = shape.material
    if material is None or material.texture_path is None:
        return None
    return Asset("texture", material.texture_path, file_roots)


def shapes_of(robot: Robot) -> Iterator[Shape]:
    """Yield all shapes of all links."""
    for link in robot.links.values():
        yield from link.visuals
        yield from link.collisions


def assets_of(robot: Robot) -> Iterator[Asset]:
    """Yield the files of all shapes; one that is used twice comes twice."""
    for shape in shapes_of(robot):
        asset = asset_of(shape, robot.file_roots)
        if asset is not None:
            yield asset


def something_missing(robot: Robot) -> bool:
    """Tell whether a mesh or a texture was not found on this machine."""
    for shape in shapes_of(robot):
        geometry, material = shape.geometry, shape.material
        if isinstance(geometry, MeshFile) and geometry.path is None:
            return True
        if material is not None and material.texture and material.texture_path is None:
            return True
    return False
