"""Meshes that are a thousand times too large or too small."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from sambot_viz.checks.mesh_files import meshes_of
from sambot_viz.checks.rule import Subject, listed, number
from sambot_viz.errors import Place, Problem
from sambot_viz.geometry import Vector3
from sambot_viz.robot.model import MeshFile

_WITHOUT_UNIT = (".stl", ".stlb", ".obj", ".ply")
_TOO_LARGE = 15.0
_TOO_SMALL = 0.0005
_FLAT = 0.002
"""A mesh that is thinner than this share of its size is a floor or a wall."""


def meshes_of_wrong_size(subject: Subject) -> Iterator[Problem]:
    """Meshes drawn in millimetres, one finding for those with the same scale.

    Only formats without a unit are judged: in the others a wrong unit is written down.
    """
    seen: set[tuple[Path, Vector3]] = set()
    wrong: dict[tuple[str, str], list[tuple[str, str, float]]] = {}
    places: dict[tuple[str, str], Place | None] = {}
    for link, shape, mesh, path in meshes_of(subject.robot):
        if path.suffix.lower() not in _WITHOUT_UNIT or (path, mesh.scale) in seen:
            continue
        seen.add((path, mesh.scale))
        size = _size(subject, mesh, path)
        advice = None if size is None else _advice(size, mesh.scale)
        if size is None or advice is None:
            continue
        wrong.setdefault(advice, []).append((link.name, path.name, size))
        places.setdefault(advice, shape.geometry_place or shape.place)
    for (cause, hint), found in wrong.items():
        link_name, name, size = max(found, key=lambda entry: entry[2])
        one = len(found) == 1
        yield Problem.at(
            places[cause, hint],
            "warning",
            "mesh-size",
            f"link {link_name}: the mesh {name} is {size:.3g} m large: it {cause}"
            if one
            else f"{len(found)} meshes ({listed(name for _, name, _ in found)}) are up "
            f"to {size:.3g} m large: each {cause}",
            hint,
        )


def _size(subject: Subject, mesh: MeshFile, path: Path) -> float | None:
    """The longest side of the scaled bounding box [m]; None for floors and walls."""
    found = subject.mesh(path)
    if found is None or isinstance(found, Problem):
        return None
    low, high = found.bounds
    sides = np.abs((high - low) * mesh.scale)
    size = float(sides.max())
    return None if sides.min() < _FLAT * size else size


def _advice(size: float, scale: Vector3) -> tuple[str, str] | None:
    """What is probably wrong, and what to do about it."""
    if size > _TOO_LARGE:
        factors = " ".join(number(factor / 1000) for factor in scale)
        return (
            "is probably drawn in millimetres",
            f'write scale="{factors}", or export it in metres',
        )
    if 0 < size < _TOO_SMALL and max(abs(factor) for factor in scale) < 0.1:
        return "is probably in metres already", "delete the scale"
    return None
