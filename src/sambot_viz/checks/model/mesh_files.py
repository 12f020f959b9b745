"""Report undrawable mesh files, and those a thousand times too large or small."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz import limits
from sambot_viz.checks.clues import Clues, guess
from sambot_viz.checks.rule import Subject, listed, number
from sambot_viz.errors import Place, Problem, Severity
from sambot_viz.geometry import Vector3
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Language, Link, MeshFile, Shape

if TYPE_CHECKING:
    from sambot_viz.meshes.mesh import Mesh, MeshPart

_AT_ONCE = 1000
"""Triangles in one batch; the first batch nearly always has a visible one."""
_WITHOUT_UNIT = (".stl", ".stlb", ".obj", ".ply")
_TOO_LARGE = 15.0
_NONSENSE = 1e6
"""Size that no mesh in a smaller unit reaches [m]."""
_TOO_SMALL = 0.0005
_BESIDE = 5.0
"""A mesh larger than the places of all joints by this factor is not a robot's part."""
_FLAT = 0.002
"""Thickness, as a share of the size, below which a mesh is a floor or a wall."""


class MeshFiles:
    """Reads mesh files, each once, for at most ten seconds altogether."""

    def __init__(
        self,
        roots: Sequence[Path] | None = None,
        longest: float = limits.CHECKED_TIME.value,
    ) -> None:
        """Set the limits for reading.

        Args:
            roots: the only folders for files; None for no limit.
            longest: the time [s] after which it reads no more files.
        """
        self._roots = roots
        self._read: dict[Path, Mesh | Problem | None] = {}
        self._longest = longest
        self._spent = 0.0

    def __call__(self, path: Path) -> Mesh | Problem | None:
        """Return the mesh, why RViz cannot draw it, or None for an unread one."""
        if path not in self._read:
            start = time.perf_counter()
            self._read[path] = self._open(path)
            self._spent += time.perf_counter() - start
        return self._read[path]

    def _open(self, path: Path) -> Mesh | Problem | None:
        # Robots without meshes must not wait for these to be imported.
        from sambot_viz.meshes.mesh import MeshError
        from sambot_viz.meshes.read_mesh import read_mesh

        if self._spent > self._longest or _is_large(path):
            return None
        try:
            return read_mesh(path, roots=self._roots)
        except MeshError as error:
            return error.problem


def _is_large(path: Path) -> bool:
    try:
        return path.stat().st_size > limits.CHECKED_MESH.value
    except OSError:
        return False


def _meshes_of(subject: Subject) -> Iterator[tuple[Link, Shape, MeshFile, Path]]:
    """Yield the mesh shapes with an existing file, with their links."""
    for link, shape in subject.shapes():
        mesh = shape.geometry
        if isinstance(mesh, MeshFile) and mesh.path is not None:
            yield link, shape, mesh, mesh.path


def unusable_meshes(subject: Subject) -> Iterator[Problem]:
    """Problems of the mesh files, each at the first shape that uses the file."""
    users: dict[Path, tuple[Link, Shape]] = {}
    for link, shape, _, path in _meshes_of(subject):
        users.setdefault(path, (link, shape))
    late: list[Path] = []
    large: list[Path] = []
    for path, (link, shape) in users.items():
        found = subject.mesh(path)
        if found is None:
            (large if _is_large(path) else late).append(path)
            continue
        if not isinstance(found, Problem) and not any(map(_has_area, found.parts)):
            yield _invisible(link, shape, path)
        problems = (found,) if isinstance(found, Problem) else found.problems
        for problem in problems:
            yield Problem.at(
                shape.geometry_place or shape.place,
                _severity(problem),
                problem.code,
                f"link {link.name}: the mesh {path.name}: {problem.message}",
                problem.hint or "export the mesh again",
                cause=problem.cause,
            )
    if late:
        seconds = limits.CHECKED_TIME.value
        yield _not_read(late, f"reading all takes longer than {seconds:,} s")
    if large:
        most = limits.CHECKED_MESH.value
        yield _not_read(large, f"files above {most:,} bytes take too long")


def _has_area(part: MeshPart) -> bool:
    """Return whether one of its triangles is more than a point or a line."""
    import numpy as np

    for start in range(0, len(part.faces), _AT_ONCE):
        corners = part.vertices[part.faces[start : start + _AT_ONCE]]
        corners = corners.astype(np.float64)
        first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        if np.any(np.cross(first, second)):
            return True
    return False


def _invisible(link: Link, shape: Shape, path: Path) -> Problem:
    return Problem.at(
        shape.geometry_place or shape.place,
        "warning",
        "mesh-invisible",
        f"link {link.name}: the mesh {path.name}: all its triangles are points or "
        "lines, so nothing of it can be seen",
        "export it again and check that the part was selected",
    )


def _severity(problem: Problem) -> Severity:
    """Return the severity of a mesh problem for the model."""
    if problem.code == "mesh-lfs-pointer":
        # The model is fine; the clone lacks its large files.
        return "warning"
    # A mesh without an error is drawable, as in RViz.
    return "error" if problem.severity == "error" else "info"


def _not_read(paths: Sequence[Path], why: str) -> Problem:
    some = f"{len(paths)} meshes were" if len(paths) > 1 else "one mesh was"
    return Problem(
        "info",
        "mesh-not-checked",
        f"{some} not checked, because {why}: "
        f"{listed(dict.fromkeys(path.name for path in paths))}",
        "open the robot with sambot-viz; the Problems panel lists what cannot be drawn",
    )


def meshes_of_wrong_size(subject: Subject) -> Iterator[Problem]:
    """Report meshes in millimetres, with one finding for each scale.

    Only formats without a unit count: the others name a wrong unit in the file.
    """
    seen: set[tuple[Path, Vector3]] = set()
    wrong: dict[tuple[str, str], list[tuple[str, str, float]]] = {}
    places: dict[tuple[str, str], Place | None] = {}
    for link, shape, mesh, path in _meshes_of(subject):
        if path.suffix.lower() not in _WITHOUT_UNIT or (path, mesh.scale) in seen:
            continue
        seen.add((path, mesh.scale))
        size = _longest_side(subject, mesh, path)
        advice = (
            None if size is None else _advice(size, mesh.scale, subject.robot.language)
        )
        if size is None or advice is None:
            continue
        wrong.setdefault(advice, []).append((link.name, path.name, size))
        places.setdefault(advice, shape.geometry_place or shape.place)
    for (cause, hint), found in wrong.items():
        link_name, name, size = max(found, key=lambda entry: entry[2])
        one = len(found) == 1
        yield guess(
            places[cause, hint],
            "mesh-size",
            f"link {link_name}: the mesh {name} is {size:.3g} m large: it {cause}"
            if one
            else f"{len(found)} meshes ({listed(name for _, name, _ in found)}) are up "
            f"to {size:.3g} m large: each {cause}",
            hint,
            _clues(subject.robot, size),
        )


def _clues(robot: Robot, size: float) -> Clues:
    """Return the clues for another unit: no joint of a robot is as far away."""
    clues = {"size"}
    if size > _NONSENSE or size < _TOO_SMALL:
        clues.add("scale")
    places = [abs(value) for j in robot.joints.values() for value in j.origin.xyz]
    if robot.joints and max(places) < size / _BESIDE:
        clues.add("places of joints")
    return clues


def _longest_side(subject: Subject, mesh: MeshFile, path: Path) -> float | None:
    """Return the longest side of the scaled bounds [m]; None for floors and walls."""
    found = subject.mesh(path)
    if found is None or isinstance(found, Problem):
        return None
    low, high = found.bounds
    sides = abs((high - low) * mesh.scale)
    size = float(sides.max())
    return None if sides.min() < _FLAT * size else size


def _advice(size: float, scale: Vector3, language: Language) -> tuple[str, str] | None:
    """Name the probable fault, and what to do about it."""
    if size > _NONSENSE:
        return (
            "has coordinates that make no sense",
            "export the mesh again, or copy the file again",
        )
    if size > _TOO_LARGE:
        factors = " ".join(number(factor / 1000) for factor in scale)
        write = f'scale="{factors}"'
        if language == "sdf":
            write = f"<scale>{factors}</scale>"
        return (
            "is probably drawn in millimetres",
            f"write {write}, or export it in metres",
        )
    if 0 < size < _TOO_SMALL and max(abs(factor) for factor in scale) < 0.1:
        return "is probably in metres already", "delete the scale"
    return None
