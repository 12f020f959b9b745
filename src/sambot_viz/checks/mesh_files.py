"""Mesh files that cannot be drawn, or not as they were meant."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.checks.rule import Subject, listed
from sambot_viz.errors import Problem, Severity
from sambot_viz.robot.model import Link, MeshFile, Robot, Shape

if TYPE_CHECKING:
    from sambot_viz.meshes.mesh import Mesh

_LONGEST = 10.0
_LARGEST_FILE = 60_000_000


class MeshFiles:
    """Reads mesh files, each once, for at most ten seconds altogether."""

    def __init__(
        self, roots: Sequence[Path] | None = None, longest: float = _LONGEST
    ) -> None:
        """Prepare.

        Args:
            roots: the folders that files may be in; None for no limit.
            longest: files that are asked for later than this [s] are not read.
        """
        self._roots = roots
        self._read: dict[Path, Mesh | Problem | None] = {}
        self._longest = longest
        self._spent = 0.0

    def __call__(self, path: Path) -> Mesh | Problem | None:
        """The mesh, why it cannot be drawn, or None when it was not read."""
        if path not in self._read:
            start = time.perf_counter()
            self._read[path] = self._open(path)
            self._spent += time.perf_counter() - start
        return self._read[path]

    def _open(self, path: Path) -> Mesh | Problem | None:
        # Robots without meshes must not wait for these to be imported.
        from sambot_viz.meshes.mesh import MeshError
        from sambot_viz.meshes.read_mesh import read_mesh

        if self._spent > self._longest or _size(path) > _LARGEST_FILE:
            return None
        try:
            return read_mesh(path, roots=self._roots)
        except MeshError as error:
            return error.problem


def _size(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:
        return 0


def meshes_of(robot: Robot) -> Iterator[tuple[Link, Shape, MeshFile, Path]]:
    """The shapes that are meshes and whose file was found, with their links."""
    for link in robot.links.values():
        for shape in (*link.visuals, *link.collisions):
            mesh = shape.geometry
            if isinstance(mesh, MeshFile) and mesh.path is not None:
                yield link, shape, mesh, mesh.path


def unusable_meshes(subject: Subject) -> Iterator[Problem]:
    """Problems of the mesh files, each at the first shape that uses the file."""
    users: dict[Path, tuple[Link, Shape]] = {}
    for link, shape, _, path in meshes_of(subject.robot):
        users.setdefault(path, (link, shape))
    skipped: list[Path] = []
    for path, (link, shape) in users.items():
        found = subject.mesh(path)
        if found is None:
            skipped.append(path)
            continue
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
    if skipped:
        yield _not_read(skipped)


def _severity(problem: Problem) -> Severity:
    """The severity that a problem of a mesh has for the model."""
    if problem.code == "mesh-lfs-pointer":
        # The model is fine; the clone lacks its large files.
        return "warning"
    # What is not an error is drawn, as RViz draws it.
    return "error" if problem.severity == "error" else "info"


def _not_read(paths: Sequence[Path]) -> Problem:
    some = f"{len(paths)} meshes were" if len(paths) > 1 else "one mesh was"
    return Problem(
        "info",
        "mesh-not-checked",
        f"{some} not checked, because reading takes too long: "
        f"{listed(path.name for path in paths)}",
        "open the robot with sambot-viz; the Problems panel lists what cannot be drawn",
    )
