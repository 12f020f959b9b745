"""Mesh files that are there but hold no mesh; only their first bytes are read."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

from sambot_viz.checks.rule import Finding, Rule, Subject
from sambot_viz.robot.model import MeshFile

_POINTER = b"version https://git-lfs"


def _beginning(path: Path) -> bytes | None:
    try:
        with path.open("rb") as file:
            return file.read(len(_POINTER))
    except OSError:
        return None


def _meshes(
    subject: Subject, is_wrong: Callable[[bytes], bool], what: str, mend: str
) -> Iterator[Finding]:
    if subject.robot is None:
        return
    told: set[Path] = set()
    for link in subject.robot.links.values():
        for shape in (*link.visuals, *link.collisions):
            mesh = shape.geometry
            if not isinstance(mesh, MeshFile) or mesh.path is None:
                continue
            beginning = None if mesh.path in told else _beginning(mesh.path)
            if beginning is None or not is_wrong(beginning):
                continue
            told.add(mesh.path)
            place = subject.inside(shape.place, "geometry", "mesh")
            name = mesh.filename.rpartition("/")[2]
            yield Finding(f"link {link.name}: the mesh {name} {what}", mend, place)


def _pointers(subject: Subject) -> Iterator[Finding]:
    what = "is a git-LFS pointer, not the mesh itself"
    mend = "run git lfs pull in its repository"
    return _meshes(subject, lambda b: b.startswith(_POINTER), what, mend)


def _empty(subject: Subject) -> Iterator[Finding]:
    mend = "copy or export it again"
    return _meshes(subject, lambda b: not b, "is an empty file", mend)


_EXAMPLE = """\
<robot name="r">
  <link name="a">
    <visual>
      <geometry><mesh filename="part.stl"/></geometry>
    </visual>
  </link>
</robot>
"""

MESH_LFS_POINTER = Rule(
    code="mesh-lfs-pointer",
    severity="warning",
    title="A git-LFS pointer instead of a mesh",
    why="The repository was cloned without git-LFS: a text of three lines lies where "
    "the mesh should be, and nothing is drawn.",
    example=_EXAMPLE,
    find=_pointers,
    example_files=(("part.stl", "version https://git-lfs.github.com/spec/v1\n"),),
)

MESH_EMPTY = Rule(
    code="mesh-empty",
    severity="warning",
    title="An empty mesh file",
    why="The file is there, so that nothing says it is missing, and nothing is drawn.",
    example=_EXAMPLE,
    find=_empty,
    example_files=(("part.stl", ""),),
)
