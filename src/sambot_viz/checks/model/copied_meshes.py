"""Report a link that shows the mesh of another link, while its own one is unused."""

from __future__ import annotations

from collections.abc import Iterator

from sambot_viz.checks.rule import Subject
from sambot_viz.edits import write_path
from sambot_viz.errors import Problem
from sambot_viz.robot.model import shapes_of
from sambot_viz.robot.parts import Link, MeshFile, Shape
from sambot_viz.robot.slips.twin_names import swap, swapped


def copied_meshes(subject: Subject) -> Iterator[Problem]:
    """Report meshes named as another link that has them too.

    The file with the name of the link must be there, and in no shape of the robot.
    """
    shapes = [(s, s.geometry) for s in shapes_of(subject.robot)]
    meshes = [(s, mesh) for s, mesh in shapes if isinstance(mesh, MeshFile)]
    used = {mesh.path for _, mesh in meshes}
    owners: dict[str, list[Link]] = {}
    for link, shape in subject.shapes():
        if isinstance(shape.geometry, MeshFile):
            owners.setdefault(shape.geometry.filename, []).append(link)
    for link, shape in subject.shapes():
        mesh = shape.geometry
        if not isinstance(mesh, MeshFile) or mesh.path is None:
            continue
        for other in owners[mesh.filename]:
            pair = swap(other.name, link.name) if other is not link else None
            # The link of the file has the word of its name too.
            right = swapped(mesh.path.name, pair) if pair else mesh.path.name
            own = mesh.path.with_name(right)
            if pair is None or own == mesh.path or own in used or not own.is_file():
                continue
            yield _problem(link, shape, mesh, other, right)
            break


def _problem(
    link: Link, shape: Shape, mesh: MeshFile, other: Link, right: str
) -> Problem:
    folder = mesh.filename.rpartition("/")[0]
    place = shape.geometry_place or shape.place
    name = mesh.filename.rpartition("/")[2]
    return Problem.at(
        place,
        "warning",
        "mesh-copied",
        f"{link.name} shows {name}, as {other.name} does, and nothing shows {right}, "
        "which lies beside it",
        write_path(place, mesh.filename, f"{folder}/{right}" if folder else right),
    )
