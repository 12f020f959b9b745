"""Find meshes at paths that only the installed package has."""

from __future__ import annotations

from collections.abc import Sequence

from sambot_viz.checks.around.package_files.installed import installed_by_build
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.rule import Subject
from sambot_viz.errors import Place, Problem
from sambot_viz.robot.parts import MeshFile

_CODES = ("file-other-layout", "file-by-path-only")


def without_installed(problems: Sequence[Problem], subject: Subject) -> list[Problem]:
    """Leave out files that the build installs where the model looks for them."""
    if all(problem.code not in _CODES for problem in problems):
        return list(problems)
    right = _installed_places(subject)
    return [
        p
        for p in problems
        if p.code not in _CODES
        or Place(p.file or "", p.line or 1, p.column) not in right
    ]


def _installed_places(subject: Subject) -> set[Place | None]:
    found: set[Place | None] = set()
    for package in subject.packages:
        start = f"package://{package.name}/"
        build = installed_by_build(Surroundings(subject.robot, (package,)))
        if build is None:
            continue
        for _, shape in subject.shapes():
            mesh = shape.geometry
            name = mesh.filename if isinstance(mesh, MeshFile) else ""
            if name.startswith(start) and build.has(name.removeprefix(start)):
                found.add(shape.geometry_place)
    return found
