"""Report meshes with a relative path, where the others have one of their package."""

from __future__ import annotations

import os
from collections.abc import Iterator

from sambot_viz.checks.rule import Subject
from sambot_viz.edits import write_path
from sambot_viz.errors import Problem
from sambot_viz.robot.model import shapes_of
from sambot_viz.robot.packages.package_index import package_around, package_name
from sambot_viz.robot.parts import MeshFile

_OF_PACKAGE = "package://"


def relative_meshes(subject: Subject) -> Iterator[Problem]:
    """Report relative paths in a model of ROS, whose other meshes have package://.

    RViz and Gazebo get the text of the model, and not its folder.
    """
    robot = subject.robot
    shapes = [(s, s.geometry) for s in shapes_of(robot)]
    meshes = [(s, mesh) for s, mesh in shapes if isinstance(mesh, MeshFile)]
    if not any(mesh.filename.startswith(_OF_PACKAGE) for _, mesh in meshes):
        return
    if robot.language == "sdf" or robot.file_roots is not None:
        return
    for shape, mesh in meshes:
        path, is_url = mesh.path, ":" in mesh.filename
        if path is None or is_url or os.path.isabs(mesh.filename):
            continue
        folder = package_around(path)
        name = package_name(folder) if folder is not None else None
        if folder is None or name is None:
            continue
        below = os.path.relpath(os.path.abspath(path), folder).replace(os.sep, "/")
        place = shape.geometry_place or shape.place
        yield Problem.at(
            place,
            "warning",
            "mesh-relative",
            f"the path {mesh.filename} counts from the folder of the model, which RViz "
            "and Gazebo do not know: they get its text from a topic, and do not find "
            "the mesh",
            write_path(place, mesh.filename, f"{_OF_PACKAGE}{name}/{below}"),
        )
