"""Read links as sdformat_urdf does: shapes, colours and inertia in the link's frame."""

from __future__ import annotations

import math

import numpy as np

from sambot_viz.errors import Place
from sambot_viz.geometry import Matrix, Rgba, rpy_from_matrix
from sambot_viz.matrices import inverse_matrix
from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.parts import Inertial, Link, Material, MeshFile, Origin, Shape
from sambot_viz.robot.sdf.fields import colour_in, number_in, pose_of, text_in
from sambot_viz.robot.sdf.loose_text import loose_text
from sambot_viz.robot.sdf.scopes import Frame
from sambot_viz.robot.sdf.script_colours import SCRIPT_COLOURS
from sambot_viz.robot.sdf.sdf_frames import FramePoses
from sambot_viz.robot.sdf.shapes import FindMesh, ShapeReader
from sambot_viz.robot.sdf.values import trimmed
from sambot_viz.robot.sdf.wording import REFUSED
from sambot_viz.robot.xml.element import Element

_BLACK: Rgba = (0.0, 0.0, 0.0, 1.0)
_WITHOUT_COLORS = (".stl", ".stlb")
"""Endings of mesh files without materials."""
_MOMENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


class SdfLinkReader:
    """Reads <link> elements one by one."""

    def __init__(
        self, frames: FramePoses, findings: ModelFindings, find_mesh: FindMesh
    ) -> None:
        self._frames = frames
        self._findings = findings
        self._shapes = ShapeReader(findings, find_mesh)

    def read(self, link: Frame, holder: Frame) -> Link:
        """Read a link and report what is wrong in it.

        Args:
            link: the link.
            holder: the frame that has its name in ROS: its joint, or for the root
                the link itself.
        """
        T_holder_model = inverse_matrix(self._frames.T_model_frame(holder))
        inertial = self._inertial(link, T_holder_model)
        visuals, collisions = (
            tuple(
                shape
                for element in link.element.find_all(tag)
                if (shape := self._shape(element, link, T_holder_model)) is not None
            )
            for tag in ("visual", "collision")
        )
        places = link.element.place, link.element.call
        return Link(link.name, visuals, collisions, inertial, *places)

    def _shape(
        self, element: Element, link: Frame, T_holder_model: Matrix
    ) -> Shape | None:
        T = T_holder_model @ self._frames.of(element, link)
        geometry = self._shapes.read(element)
        name = trimmed(element.get("name") or "")
        material = None
        if element.tag == "visual":
            # The file's own materials win, in RViz and here.
            has_colors = isinstance(
                geometry, MeshFile
            ) and not geometry.filename.lower().endswith(_WITHOUT_COLORS)
            material = self._material(element, f"{link.name}{name}", has_colors)
        if geometry is None:
            return None
        inner = element.find("geometry")
        solid = inner.children[0].place if inner and inner.children else None
        pose = element.find("pose")
        origin = origin_of(T, pose.place if pose else None)
        return Shape(geometry, origin, material, name, element.place, solid)

    def _material(
        self, visual: Element, name: str, has_colors: bool
    ) -> Material | None:
        """Return the material as ROS mixes it; None is RViz's red.

        Args:
            visual: the visual with the <material>.
            name: name of the material.
            has_colors: whether the shape is a mesh that may have colours in its file.
        """
        element = visual.find("material")
        if element is None:
            return None
        script = element.find("script")
        if script is not None:
            self._check_script(script)
        ambient = colour_in(element, "ambient", _BLACK)
        diffuse = colour_in(element, "diffuse", _BLACK)
        r, g, b, a = (
            min(0.4 * dim + 0.8 * bright, 1.0)
            for dim, bright in zip(ambient, diffuse, strict=True)
        )
        if not has_colors:
            self._check_black(element, script)
        return Material(name, (r, g, b, a))

    def _check_script(self, script: Element) -> None:
        missing = [tag for tag in ("uri", "name") if not text_in(script, tag)]
        if not missing:
            return
        words = (text_in(script, "name") or trimmed(script.text)).lower()
        rgba = next((c for w, c in SCRIPT_COLOURS.items() if w in words), None)
        rgba = rgba or "0.5 0.5 0.5 1"
        self._findings.reject(
            "sdf-script",
            f"a <script> needs a <{' and a <'.join(f'{tag}>' for tag in missing)}, and "
            f"{REFUSED} without; and ROS and the new Gazebo show no script, the part "
            "would be black",
            f"replace <script> by <ambient>{rgba}</ambient><diffuse>{rgba}</diffuse>",
            script,
        )

    def _check_black(self, material: Element, script: Element | None) -> None:
        """Warn of a material without a colour that ROS shows."""
        if any(material.find(tag) for tag in ("ambient", "diffuse", "color")):
            return
        what = next((c.tag for c in material.children), None)
        if script is not None and not text_in(script, "uri"):
            return
        if loose_text(material):
            # The finding about the text gives the remedy.
            return
        self._findings.warn(
            "material-without-colour",
            "ROS shows this <material> black: it has neither <ambient> nor <diffuse>"
            + (f", and ROS knows no <{what}>" if what else ""),
            "write <ambient>0.5 0.5 0.5 1</ambient><diffuse>0.5 0.5 0.5 1</diffuse> "
            "into it",
            material,
        )

    def _inertial(self, link: Frame, T_holder_model: Matrix) -> Inertial:
        """Read the inertia; every SDF link has one, by default of 1 kg."""
        T_model_link = self._frames.T_model_frame(link)
        element = link.element.find("inertial")
        if element is None:
            origin = origin_of(T_holder_model @ T_model_link)
            return Inertial(1.0, origin, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0)
        inertia = element.find("inertia")
        defaults = (1.0, 0.0, 0.0, 1.0, 0.0, 1.0)
        moments = [
            number_in(inertia, tag, default)
            for tag, default in zip(_MOMENTS, defaults, strict=True)
        ]
        mass = number_in(element, "mass", 1.0)
        self._check_inertia(link, element, mass, moments)
        T = T_holder_model @ T_model_link @ pose_of(element, self._findings)
        return Inertial(
            mass, origin_of(T), *moments, place=element.place, call=element.call
        )

    def _check_inertia(
        self, link: Frame, element: Element, mass: float, moments: list[float]
    ) -> None:
        why = _why_invalid(mass, moments)
        if why:
            self._findings.reject(
                "sdf-inertia",
                f"<inertial> of link {link.name}: {why}; {REFUSED}",
                "take mass and inertia from the shape: a box of size x y z has "
                "ixx = m (y² + z²) / 12",
                element,
            )


def _why_invalid(mass: float, moments: list[float]) -> str:
    """Explain why libsdformat refuses this mass and inertia; "" if it does not."""
    if math.isnan(mass) or any(math.isnan(moment) for moment in moments):
        return 'it contains "nan"'
    if mass < 0:
        return f"the mass {mass:g} is negative"
    if not all(map(math.isfinite, moments[1:])):
        return "a moment of inertia is infinite"
    if math.isinf(moments[0]):
        # libsdformat's sums only notice the others.
        return ""
    ixx, ixy, ixz, iyy, iyz, izz = moments
    tensor = np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
    low, middle, high = (float(v) for v in np.linalg.eigvalsh(tensor))
    slack = 4e-15 * max(abs(low), abs(middle), abs(high))
    if low < -slack:
        return "a moment of inertia is negative"
    if high > low + middle + slack:
        return "one moment of inertia is larger than the sum of the other two"
    return ""


def origin_of(T: Matrix, place: Place | None = None) -> Origin:
    """Return a transform (4, 4) as URDF writes it."""
    x, y, z = T[:3, 3].tolist()
    return Origin((x, y, z), rpy_from_matrix(T), place)
