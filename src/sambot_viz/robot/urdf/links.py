"""Links with their shapes and inertia, in urdfdom's reading order.

urdfdom reads the inertia first, then all visuals, then all collisions. The first
unreadable part ends the link; earlier parts stay.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path

from sambot_viz.edits import rename_attribute, together, write_attribute
from sambot_viz.errors import Fix, did_you_mean
from sambot_viz.geometry import Vector3
from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.parts import (
    Box,
    Capsule,
    Cylinder,
    Geometry,
    Inertial,
    Link,
    Material,
    MeshFile,
    Origin,
    Shape,
    Sphere,
)
from sambot_viz.robot.slips.three_lengths import size_of_three
from sambot_viz.robot.urdf.attributes import (
    AttributeReader,
    BadNumber,
    Unreadable,
    read_number,
)
from sambot_viz.robot.urdf.material_table import MaterialTable
from sambot_viz.robot.xml.element import Element

FindMesh = Callable[[str, Element], "Path | None"]
"""Mesh file name as written and its element → the file, or None."""

_INERTIA = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


class LinkReader:
    """Reads <link> elements one by one, sharing the material table."""

    def __init__(
        self, findings: ModelFindings, materials: MaterialTable, find_mesh: FindMesh
    ) -> None:
        self._findings = findings
        self._materials = materials
        self._find_mesh = find_mesh

    def read(self, element: Element, name: str) -> Link:
        """Read the link as ROS would keep it, and report its faults."""
        inertial, complete = self._inertial(element, name)
        visuals, complete = self._shapes(element, name, "visual", complete)
        current = next((v.material for v in reversed(visuals) if v.material), None)
        collisions, _ = self._shapes(element, name, "collision", complete, current)
        shapes = tuple(visuals), tuple(collisions)
        return Link(name, *shapes, inertial, element.place, element.call)

    def _inertial(self, link: Element, name: str) -> tuple[Inertial | None, bool]:
        element = link.find("inertial")
        if element is None:
            return None, True
        reader = AttributeReader(
            self._findings,
            self._findings.warn,
            f"the inertial of link {name}",
            f"ROS then drops all shapes of {name}"
            if _has_shapes(link)
            else "ROS leaves it out",
        )
        try:
            return self._read_inertial(element, reader), True
        except Unreadable:
            return None, False

    def _read_inertial(self, element: Element, reader: AttributeReader) -> Inertial:
        origin = reader.origin(element)
        mass = self._child(element, "mass", '<mass value="1.0"/>', reader)
        value = reader.number(mass, "value")
        inertia = self._child(
            element, "inertia", '<inertia ixx="0.01" ixy="0" …/>', reader
        )
        missing = [key for key in _INERTIA if inertia.get(key) is None]
        if missing:
            raise reader.fail(
                "inertia-incomplete",
                f"<inertia> of {reader.owner} lacks {', '.join(missing)}",
                f"add {_moments_to_add(inertia, missing)}",
                inertia,
            )
        moments = (reader.number(inertia, key) for key in _INERTIA)
        return Inertial(value, origin, *moments, place=element.place, call=element.call)

    def _child(
        self, parent: Element, tag: str, example: str, reader: AttributeReader
    ) -> Element:
        child = parent.find(tag)
        if child is None:
            raise reader.fail(
                f"inertial-without-{tag}",
                f"{reader.owner} has no <{tag}>",
                f"write {example}",
                parent,
            )
        return child

    def _shapes(
        self,
        link: Element,
        name: str,
        tag: str,
        complete: bool,
        current: Material | None = None,
    ) -> tuple[list[Shape], bool]:
        """Read all visuals or collisions; only check those after a wrong one.

        Each has the last material before it, or the `current` one.
        """
        shapes: list[Shape] = []
        elements = link.find_all(tag)
        bodies = len(link.find_all("collision")) if tag == "visual" else 0
        for number, element in enumerate(elements, 1):
            loss = _loss(name, tag, len(elements) - number, bodies)
            try:
                geometry, origin = self._solid(element, f"a {tag} of link {name}", loss)
                if tag == "visual":
                    current = self._material(element, name, loss) or current
            except Unreadable:
                complete = False
                continue
            if complete:
                shapes.append(_shape(element, geometry, origin, current))
        return shapes, complete

    def _material(self, visual: Element, link: str, loss: str) -> Material | None:
        element = visual.find("material")
        if element is None:
            return None
        if element.get("name") is None:
            self._findings.error(
                "material-without-name",
                f"<material> in a visual of link {link} has no name; {loss}",
                'write <material name="…">',
                element,
            )
            raise Unreadable("material without name")
        return self._materials.of_visual(element)

    def _solid(
        self, element: Element, owner: str, loss: str
    ) -> tuple[Geometry, Origin]:
        reader = AttributeReader(self._findings, self._findings.error, owner, loss)
        origin = reader.origin(element)
        return self._geometry(element, owner, loss, reader), origin

    def _geometry(
        self, shape: Element, owner: str, loss: str, reader: AttributeReader
    ) -> Geometry:
        element = shape.find("geometry")
        if element is None or not element.children:
            what = "no <geometry>" if element is None else "an empty <geometry>"
            self._findings.warn(
                "geometry-empty",
                f"{owner} has {what}; {loss}",
                "put a box, cylinder, sphere or mesh into it, or delete the element",
                element or shape,
            )
            raise Unreadable(what)
        if len(element.children) > 1:
            self._findings.warn(
                "geometry-more-than-one",
                f"{owner} has more than one shape in <geometry>; only the first, "
                f"<{element.children[0].tag}>, counts",
                "give each shape its own element",
                element.children[1],
            )
        return self._geometry_of(element.children[0], owner, reader)

    def _geometry_of(
        self, element: Element, owner: str, reader: AttributeReader
    ) -> Geometry:
        match element.tag:
            case "box":
                return Box(self._size(element, reader))
            case "sphere":
                return Sphere(self._length(element, "radius", owner, reader))
            case "cylinder":
                return Cylinder(*self._radius_and_length(element, owner, reader))
            case "capsule":
                self._findings.warn(
                    "geometry-capsule",
                    f"{owner} is a capsule, which is not a standard URDF shape; it is "
                    "drawn here, but ROS loads the robot without it",
                    "use box, cylinder, sphere or mesh",
                    element,
                )
                return Capsule(*self._radius_and_length(element, owner, reader))
            case "mesh":
                return self._mesh(element, reader)
            case _:
                raise self._unknown(element, owner, reader)

    def _unknown(
        self, element: Element, owner: str, reader: AttributeReader
    ) -> Unreadable:
        names = ("box", "cylinder", "sphere", "mesh")
        self._findings.warn(
            "geometry-unknown",
            f"{owner} has the shape <{element.tag}>, which is not known "
            f"({did_you_mean(element.tag, names)}); {reader.loss}",
            "use box, cylinder, sphere or mesh",
            element,
        )
        return Unreadable(element.tag)

    def _size(self, element: Element, reader: AttributeReader) -> Vector3:
        if element.get("size") is None:
            reader.required(element, "size", size_of_three(element) or "1 1 1")
        return reader.vector(element, "size", (0.0, 0.0, 0.0))

    def _radius_and_length(
        self, element: Element, owner: str, reader: AttributeReader
    ) -> tuple[float, float]:
        if element.get("length") is None and element.get("height") is not None:
            raise reader.fail(
                "cylinder-height",
                f"<{element.tag}> of {owner} has a height; the attribute is called "
                "length",
                rename_attribute(
                    element.place,
                    "height",
                    "length",
                    element.get("height") or "",
                    f'write length="{element.get("height")}"',
                ),
                element,
                "height",
            )
        radius = self._length(element, "radius", owner, reader)
        return radius, self._length(element, "length", owner, reader)

    def _length(
        self, element: Element, name: str, owner: str, reader: AttributeReader
    ) -> float:
        if element.get(name) is None and name == "radius" and element.get("diameter"):
            raise reader.fail(
                "sphere-diameter",
                f"<{element.tag}> of {owner} has a diameter; URDF wants the radius",
                _half(element),
                element,
                "diameter",
            )
        return reader.number(element, name, _as_beside(element, name) or "0.1")

    def _mesh(self, element: Element, reader: AttributeReader) -> MeshFile:
        filename = reader.required(element, "filename", "package://…/meshes/….stl")
        scale = reader.vector(element, "scale", (1.0, 1.0, 1.0))
        return MeshFile(filename, scale, self._find_mesh(filename, element))


def _as_beside(element: Element, name: str) -> str | None:
    """Return an attribute of the same solid in another shape of the link."""
    link = element.parent
    while link is not None and link.tag != "link":
        link = link.parent
    solids = link.iter() if link is not None else iter(())
    said = {e.get(name) for e in solids if e.tag == element.tag and e is not element}
    said.discard(None)
    return said.pop() if len(said) == 1 else None


def _half(element: Element) -> Fix:
    """Write the radius for a diameter."""
    place, diameter = element.place, element.get("diameter") or ""
    try:
        radius = f"{float(diameter) / 2:.6g}"
    except ValueError:
        return Fix('write radius="…" with half of it')
    hint = f'write radius="{radius}"'
    return together(
        hint,
        rename_attribute(place, "diameter", "radius", diameter, hint),
        write_attribute(place, "diameter", diameter, radius),
    )


def _moments_to_add(inertia: Element, missing: list[str]) -> str:
    """Write the missing values: a moment like the others, a product as 0."""
    numbers: dict[str, float] = {}
    for text in filter(None, map(inertia.get, ("ixx", "iyy", "izz"))):
        with contextlib.suppress(BadNumber):
            numbers[text] = read_number(text)
    # The largest one fits any two: no moment exceeds the sum of the others.
    like = max(numbers, key=numbers.__getitem__, default="0.01")
    values = {key: like if key[1] == key[2] else "0" for key in missing}
    return " ".join(f'{key}="{value}"' for key, value in values.items())


def _has_shapes(link: Element) -> bool:
    return any(child.tag in ("visual", "collision") for child in link.children)


def _shape(
    element: Element, geometry: Geometry, origin: Origin, material: Material | None
) -> Shape:
    inner = element.find("geometry")
    solid = inner.children[0].place if inner and inner.children else None
    name = element.get("name") or ""
    return Shape(geometry, origin, material, name, element.place, solid)


def _loss(name: str, tag: str, later: int, bodies: int) -> str:
    """Describe what urdfdom loses with a shape.

    Args:
        name: name of the link.
        tag: tag of the shape.
        later: number of later shapes with the same tag.
        bodies: number of collisions after all of these.
    """
    parts = [
        f"{count} {word}{'' if count == 1 else 's'}"
        for count, word in ((later, tag), (bodies, "collision"))
        if count
    ]
    if not parts:
        return f"ROS loads {name} without this shape"
    return f"ROS loads {name} without this shape and the {' and '.join(parts)} after it"
