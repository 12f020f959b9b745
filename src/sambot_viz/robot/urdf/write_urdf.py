"""Write a robot as URDF text, like robot_state_publisher for an SDF file."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from xml.etree import ElementTree

from sambot_viz.robot.parts import (
    Box,
    Capsule,
    Cylinder,
    Geometry,
    Inertial,
    Joint,
    Link,
    Material,
    MeshFile,
    Origin,
    Shape,
    Sphere,
)

_NO_LIMIT = 1e16
"""URDF has no infinite numbers; Gazebo writes this one for "no limit"."""


def write_urdf(
    name: str, links: Mapping[str, Link], joints: Mapping[str, Joint]
) -> str:
    """Return a robot as URDF.

    Args:
        name: of the robot.
        links: link name → link.
        joints: joint name → joint.

    Returns:
        Text that reads as the same robot: numbers have 12 digits, and limits without
        an end are ±1e16.
    """
    robot = ElementTree.Element("robot", name=name)
    for link in links.values():
        robot.append(_link(link))
    for joint in joints.values():
        robot.append(_joint(joint))
    ElementTree.indent(robot)
    return f'<?xml version="1.0"?>\n{ElementTree.tostring(robot, "unicode")}\n'


def _link(link: Link) -> ElementTree.Element:
    element = ElementTree.Element("link", name=link.name)
    if link.inertial is not None:
        element.append(_inertial(link.inertial))
    for tag, shapes in (("visual", link.visuals), ("collision", link.collisions)):
        element.extend(_shape(tag, shape) for shape in shapes)
    return element


def _inertial(inertial: Inertial) -> ElementTree.Element:
    element = ElementTree.Element("inertial")
    element.append(_origin(inertial.origin))
    ElementTree.SubElement(element, "mass", value=_number(inertial.mass))
    moments = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    values = {moment: _number(getattr(inertial, moment)) for moment in moments}
    ElementTree.SubElement(element, "inertia", values)
    return element


def _shape(tag: str, shape: Shape) -> ElementTree.Element:
    element = ElementTree.Element(tag)
    if shape.name:
        element.set("name", shape.name)
    element.append(_origin(shape.origin))
    solid, values = _solid(shape.geometry)
    ElementTree.SubElement(ElementTree.SubElement(element, "geometry"), solid, values)
    if shape.material is not None and tag == "visual":
        element.append(_material(shape.material))
    return element


def _solid(geometry: Geometry) -> tuple[str, dict[str, str]]:
    match geometry:
        case Box(size):
            return "box", {"size": _numbers(size)}
        case Cylinder(radius, length):
            return "cylinder", {"radius": _number(radius), "length": _number(length)}
        case Sphere(radius):
            return "sphere", {"radius": _number(radius)}
        case Capsule(radius, length):
            return "capsule", {"radius": _number(radius), "length": _number(length)}
        case MeshFile(filename, scale):
            return "mesh", {"filename": filename, "scale": _numbers(scale)}


def _material(material: Material) -> ElementTree.Element:
    element = ElementTree.Element("material", name=material.name)
    if material.rgba is not None:
        ElementTree.SubElement(element, "color", rgba=_numbers(material.rgba))
    if material.texture is not None:
        ElementTree.SubElement(element, "texture", filename=material.texture)
    return element


def _joint(joint: Joint) -> ElementTree.Element:
    element = ElementTree.Element("joint", name=joint.name, type=joint.type)
    element.append(_origin(joint.origin))
    ElementTree.SubElement(element, "parent", link=joint.parent)
    ElementTree.SubElement(element, "child", link=joint.child)
    if joint.type not in ("fixed", "floating"):
        ElementTree.SubElement(element, "axis", xyz=_numbers(joint.axis))
    if joint.dynamics is not None:
        braked = joint.dynamics
        ElementTree.SubElement(
            element,
            "dynamics",
            damping=_number(braked.damping),
            friction=_number(braked.friction),
        )
    if joint.limit is not None:
        names = ("lower", "upper", "effort", "velocity")
        limits = {name: _number(getattr(joint.limit, name)) for name in names}
        ElementTree.SubElement(element, "limit", limits)
    return element


def _origin(origin: Origin) -> ElementTree.Element:
    return ElementTree.Element(
        "origin", xyz=_numbers(origin.xyz), rpy=_numbers(origin.rpy)
    )


def _numbers(values: Iterable[float]) -> str:
    return " ".join(map(_number, values))


def _number(value: float) -> str:
    """Write a number with 12 digits; one without an end as that of Gazebo."""
    if not math.isfinite(value):
        value = 0.0 if math.isnan(value) else math.copysign(_NO_LIMIT, value)
    # Adding 0 makes -0.0 into 0.0.
    return f"{round(value, 15) + 0.0:.12g}"
