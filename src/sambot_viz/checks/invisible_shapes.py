"""Shapes that are there but cannot be seen."""

from __future__ import annotations

from collections.abc import Iterator

from sambot_viz.checks.rule import Finding, Rule, Subject, number
from sambot_viz.robot.model import (
    Box,
    Capsule,
    Cylinder,
    Geometry,
    Link,
    MeshFile,
    Robot,
    Shape,
    Sphere,
)


def _shapes(robot: Robot) -> Iterator[tuple[Link, Shape]]:
    for link in robot.links.values():
        for shape in (*link.visuals, *link.collisions):
            yield link, shape


def _lengths(geometry: Geometry) -> tuple[str, tuple[float, ...]]:
    if isinstance(geometry, Box):
        return "size of the box", geometry.size
    if isinstance(geometry, Sphere):
        return "radius of the sphere", (geometry.radius,)
    if isinstance(geometry, Cylinder):
        return "radius and length of the cylinder", (geometry.radius, geometry.length)
    if isinstance(geometry, Capsule):
        return "radius and length of the capsule", (geometry.radius, geometry.length)
    return "scale of the mesh", geometry.scale


def _sizes(subject: Subject) -> Iterator[Finding]:
    if subject.robot is None:
        return
    for link, shape in _shapes(subject.robot):
        what, values = _lengths(shape.geometry)
        mirrored = isinstance(shape.geometry, MeshFile)
        wrong = [v for v in values if v == 0 or (v < 0 and not mirrored)]
        if not wrong:
            continue
        kind = "zero" if not any(wrong) else "negative"
        written = " ".join(number(v) for v in values)
        yield Finding(
            f"link {link.name}: the {what} ({written}) holds a {kind} number, so "
            "nothing sensible can be drawn",
            "give full lengths in metres, each larger than 0",
            subject.inside(shape.place, "geometry"),
        )


def _invisible(subject: Subject) -> Iterator[Finding]:
    if subject.robot is None:
        return
    told: set[str] = set()
    for link in subject.robot.links.values():
        for shape in link.visuals:
            material = shape.material
            if material is None or material.rgba is None or material.rgba[3] > 0:
                continue
            if material.name in told and material.name:
                continue
            told.add(material.name)
            named = f"the material {material.name} of " if material.name else ""
            yield Finding(
                f"{named}link {link.name} has the alpha 0: it is invisible",
                'the fourth number of rgba is the opacity: write rgba="… … … 1"',
                subject.inside(shape.place, "material"),
            )


SIZE_NOT_POSITIVE = Rule(
    code="size-not-positive",
    severity="warning",
    title="A size of zero or less",
    why="ROS's parser accepts it and RViz draws nothing, or the shape inside out.",
    example="""\
<robot name="r">
  <link name="a">
    <visual>
      <geometry><box size="1 0 1"/></geometry>
    </visual>
  </link>
</robot>
""",
    find=_sizes,
)

ALPHA_ZERO = Rule(
    code="alpha-zero",
    severity="info",
    title="An invisible material",
    why="The fourth number of rgba is the opacity. With 0 the shape is there and "
    "cannot be seen.",
    example="""\
<robot name="r">
  <link name="a">
    <visual>
      <geometry><box size="1 1 1"/></geometry>
      <material name="glass"><color rgba="1 0 0 0"/></material>
    </visual>
  </link>
</robot>
""",
    find=_invisible,
)
