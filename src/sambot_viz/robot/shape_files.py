"""The files that the shapes of a robot are drawn from: meshes and textures."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from sambot_viz.robot.model import MeshFile, Robot, Shape


@dataclass(frozen=True, slots=True)
class Asset:
    """A file that has to be read before a shape can be drawn."""

    kind: Literal["mesh", "texture"]
    path: Path


def asset_of(shape: Shape) -> Asset | None:
    """The file of a shape, or None when it needs none, or has none on this machine."""
    if isinstance(shape.geometry, MeshFile):
        path = shape.geometry.path
        return None if path is None else Asset("mesh", path)
    material = shape.material
    if material is None or material.texture_path is None:
        return None
    return Asset("texture", material.texture_path)


def shapes_of(robot: Robot) -> Iterator[Shape]:
    """All shapes of all links."""
    for link in robot.links.values():
        yield from link.visuals
        yield from link.collisions


def assets_of(robot: Robot) -> Iterator[Asset]:
    """The files of all shapes; one that is used twice comes twice."""
    for shape in shapes_of(robot):
        asset = asset_of(shape)
        if asset is not None:
            yield asset


def something_missing(robot: Robot) -> bool:
    """Whether a mesh or a texture was not found on this machine."""
    for shape in shapes_of(robot):
        geometry, material = shape.geometry, shape.material
        if isinstance(geometry, MeshFile) and geometry.path is None:
            return True
        if material is not None and material.texture and material.texture_path is None:
            return True
    return False
