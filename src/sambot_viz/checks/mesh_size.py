"""Meshes that are a thousand times too large or too small."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import numpy.typing as npt

from sambot_viz.checks.rule import Finding, Rule, Subject, number
from sambot_viz.robot.model import Link, MeshFile, Shape

_TOO_LARGE = 15.0
_TOO_SMALL = 0.0005
_LARGEST_FILE = 60_000_000
_OBJ_VERTEX = re.compile(rb"^v[ \t]+(\S+)[ \t]+(\S+)[ \t]+(\S+)", re.MULTILINE)
_STL_VERTEX = re.compile(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)")
_TRIANGLE = np.dtype([("points", "<f4", (4, 3)), ("attribute", "<u2")])

Points = npt.NDArray[np.float64]
Extents = tuple[float, float, float]


def mesh_extents(path: Path) -> Extents | None:
    """The size of the bounding box in the file's own unit, along x, y and z.

    STL and OBJ only: they have no unit, so that a wrong one can hide. None for
    everything else and for what cannot be read cheaply.
    """
    try:
        if path.stat().st_size > _LARGEST_FILE:
            return None
        ending = path.suffix.lower()
        if ending == ".stl":
            points = _stl_points(path.read_bytes())
        elif ending == ".obj":
            points = _text_points(_OBJ_VERTEX, path.read_bytes())
        else:
            return None
    except (OSError, ValueError):
        return None
    if points is None or not len(points) or not np.isfinite(points).all():
        return None
    size = points.max(axis=0) - points.min(axis=0)
    return (float(size[0]), float(size[1]), float(size[2]))


def _stl_points(data: bytes) -> Points | None:
    if len(data) >= 84:
        count = int.from_bytes(data[80:84], "little")
        if len(data) == 84 + 50 * count:
            triangles = np.frombuffer(data, _TRIANGLE, count, 84)
            corners: npt.NDArray[np.float32] = triangles["points"][:, 1:, :]
            return np.reshape(corners, (-1, 3)).astype(np.float64)
    if data[:5] == b"solid":
        return _text_points(_STL_VERTEX, data)
    return None


def _text_points(pattern: re.Pattern[bytes], data: bytes) -> Points | None:
    words = pattern.findall(data)
    return np.array(words, dtype=np.bytes_).astype(np.float64) if words else None


def _shapes(subject: Subject) -> Iterator[tuple[Link, Shape, MeshFile]]:
    if subject.robot is None:
        return
    for link in subject.robot.links.values():
        for shape in (*link.visuals, *link.collisions):
            if isinstance(shape.geometry, MeshFile):
                yield link, shape, shape.geometry


def _sizes(subject: Subject) -> Iterator[Finding]:
    known: dict[Path, Extents | None] = {}
    told: set[tuple[Path, tuple[float, ...]]] = set()
    for link, shape, mesh in _shapes(subject):
        if mesh.path is None or (mesh.path, mesh.scale) in told:
            continue
        if mesh.path not in known:
            known[mesh.path] = mesh_extents(mesh.path)
        extents = known[mesh.path]
        if extents is None:
            continue
        told.add((mesh.path, mesh.scale))
        size = max(abs(e * s) for e, s in zip(extents, mesh.scale, strict=True))
        saying = _saying(size, mesh)
        if saying:
            place = subject.inside(shape.place, "geometry", "mesh")
            yield Finding(f"link {link.name}: {saying[0]}", saying[1], place)


def _saying(size: float, mesh: MeshFile) -> tuple[str, str] | None:
    name = mesh.filename.rpartition("/")[2]
    if size > _TOO_LARGE:
        factors = " ".join(number(s / 1000) for s in mesh.scale)
        return (
            f"the mesh {name} is {size:.3g} m large: it is probably drawn in "
            "millimetres",
            f'write scale="{factors}", or export it in metres',
        )
    if 0 < size < _TOO_SMALL and max(abs(s) for s in mesh.scale) < 0.1:
        return (
            f"the mesh {name} is only {size:.3g} m large: it is probably in metres "
            "already",
            "delete the scale",
        )
    return None


MESH_SIZE = Rule(
    code="mesh-size",
    severity="warning",
    title="A mesh in millimetres",
    why="STL and OBJ files have no unit; ROS takes metres. A mesh in millimetres is a "
    'thousand times too large until it gets scale="0.001 0.001 0.001".',
    example="""\
<robot name="r">
  <link name="a">
    <visual>
      <geometry><mesh filename="part.obj"/></geometry>
    </visual>
  </link>
</robot>
""",
    find=_sizes,
    example_files=(("part.obj", "v 0 0 0\nv 250 0 0\nv 0 120 40\nf 1 2 3\n"),),
)
