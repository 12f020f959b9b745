"""Read the shape of a visual or collision; ROS takes four of SDF's."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from sambot_viz.errors import did_you_mean
from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.parts import Box, Cylinder, Geometry, MeshFile, Sphere
from sambot_viz.robot.sdf.fields import length_in, text_in, vector_in
from sambot_viz.robot.sdf.loose_text import text_not_read
from sambot_viz.robot.sdf.wording import REFUSED, described
from sambot_viz.robot.xml.element import Element

FindMesh = Callable[[str, Element], "Path | None"]
"""Mesh file name as written and its element → the file, or None."""

_TAKEN = ("box", "cylinder", "sphere", "mesh")
_ORDER = (
    "box",
    "capsule",
    "cone",
    "cylinder",
    "ellipsoid",
    "plane",
    "sphere",
    "mesh",
    "heightmap",
    "polyline",
    "image",
    "empty",
)
"""All shapes of SDF; of several in one place the first of this list counts."""


class ShapeReader:
    """Reads the <geometry> of one element after the other."""

    def __init__(self, findings: ModelFindings, find_mesh: FindMesh) -> None:
        self._findings = findings
        self._find_mesh = find_mesh

    def read(self, shape: Element) -> Geometry | None:
        """Read the shape of a <visual> or <collision>; None when ROS refuses it."""
        geometry = shape.find("geometry")
        inside = geometry.children if geometry is not None else []
        solids = {child.tag: child for child in reversed(inside)}
        known = [solids[tag] for tag in _ORDER if tag in solids]
        if not known or known[0].tag not in _TAKEN:
            self._refuse(shape, geometry, known[0] if known else None)
            return None
        if len(known) > 1:
            self._findings.warn(
                "geometry-more-than-one",
                f"{described(shape)} has more than one shape in <geometry>; only "
                f"<{known[0].tag}> counts",
                "give each shape its own element",
                known[1],
            )
        return self._solid(known[0])

    def _solid(self, element: Element) -> Geometry:
        findings = self._findings
        match element.tag:
            case "box":
                return Box(vector_in(element, "size", (1.0, 1.0, 1.0)))
            case "cylinder":
                radius = length_in(element, "radius", 1.0, findings)
                return Cylinder(radius, length_in(element, "length", 1.0, findings))
            case "sphere":
                return Sphere(length_in(element, "radius", 1.0, findings))
            case _:
                return self._mesh(element)

    def _mesh(self, element: Element) -> MeshFile:
        submesh = element.find("submesh")
        if submesh is not None:
            self._check_submesh(submesh)
        uri = text_in(element, "uri") or "__default__"
        scale = vector_in(element, "scale", (1.0, 1.0, 1.0))
        # A mesh without a name is reported, and ROS looks for no such file.
        at = element.find("uri")
        return MeshFile(uri, scale, self._find_mesh(uri, at) if at else None)

    def _check_submesh(self, submesh: Element) -> None:
        if not text_in(submesh, "name"):
            self._findings.reject(
                "sdf-submesh-name",
                f"<submesh> of {described(submesh)} has no <name>; {REFUSED}",
                "delete <submesh>: ROS draws the whole file",
                submesh,
            )
            return
        self._findings.warn(
            "sdf-submesh",
            f"ROS does not read <submesh> of {described(submesh)}: it draws the whole "
            "mesh file",
            "put this part into a file of its own",
            submesh,
        )

    def _refuse(
        self, shape: Element, geometry: Element | None, solid: Element | None
    ) -> None:
        unknown = geometry.children[0] if geometry and geometry.children else None
        if solid is not None:
            message = f"{described(shape)} is a {solid.tag}, which ROS does not know"
            if solid.tag == "empty":
                message = f"{described(shape)} has an empty shape"
        elif unknown is not None:
            near = did_you_mean(unknown.tag, _TAKEN)
            message = (
                f"{described(shape)} has the shape <{unknown.tag}>, which is not known "
                f"({near})"
            )
        else:
            message = f"{described(shape)} has no shape"
        if geometry is not None and not geometry.children:
            habit = text_not_read(geometry)
            if habit is not None:
                message = f"{habit.message}; {REFUSED}"
                self._findings.reject("sdf-geometry", message, habit.hint, geometry)
                return
        self._findings.reject(
            "sdf-geometry",
            f"{message}; {REFUSED}",
            f"use <box>, <cylinder>, <sphere> or <mesh>, or delete this <{shape.tag}>",
            solid or unknown or geometry or shape,
        )
