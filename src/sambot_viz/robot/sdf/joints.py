"""Read joints as sdformat_urdf does, and report the parts that ROS drops."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from sambot_viz.edits import write_attribute
from sambot_viz.errors import Fix, did_you_mean, nearest
from sambot_viz.geometry import Vector3
from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.parts import Dynamics, JointType, Limit
from sambot_viz.robot.sdf.fields import number_in, text_in, vector_in
from sambot_viz.robot.sdf.loose_text import loose_text
from sambot_viz.robot.sdf.old_versions import Version
from sambot_viz.robot.sdf.scopes import Frame
from sambot_viz.robot.sdf.sdf_frames import FramePoses
from sambot_viz.robot.sdf.values import trimmed
from sambot_viz.robot.sdf.wording import REFUSED, and_list
from sambot_viz.robot.slips.axle import axle_of
from sambot_viz.robot.slips.exchanged_words import exchanged
from sambot_viz.robot.urdf.joints import meant_type
from sambot_viz.robot.xml.element import Element

TYPES: dict[str, JointType] = {
    "fixed": "fixed",
    "continuous": "continuous",
    "revolute": "revolute",
    "prismatic": "prismatic",
    "ball": "floating",
    "universal": "floating",
    "revolute2": "floating",
    "gearbox": "floating",
    "screw": "floating",
}
"""Joint type of SDF → ROS's type for it."""

_LOST = ("spring_reference", "spring_stiffness", "dissipation", "stiffness")
_Z: Vector3 = (0.0, 0.0, 1.0)


@dataclass(frozen=True, slots=True)
class JointMotion:
    """The motion of a joint.

    Attributes:
        type: type of the joint in ROS.
        axis: unit vector in the joint frame.
        limit: None for joints without limits.
        dynamics: None for joints that do not move.
    """

    type: JointType
    axis: Vector3 = (1.0, 0.0, 0.0)
    limit: Limit | None = None
    dynamics: Dynamics | None = None


class MotionReader:
    """Reads the type, axis and limits of joints."""

    def __init__(
        self, frames: FramePoses, version: Version, findings: ModelFindings
    ) -> None:
        self._frames = frames
        self._version = version
        self._findings = findings
        self._joints = {f.name: f.element for f in frames.scope.of_kind("joint")}

    def read(self, joint: Frame) -> JointMotion:
        """Read one joint, and report its faults and lost parts."""
        element = joint.element
        kind = self._type(joint)
        axes = {
            axis.tag: self._axis(axis, joint)
            for axis in map(element.find, ("axis", "axis2"))
            if axis is not None
        }
        self._report_lost(joint, kind)
        if kind == "floating":
            self._report_floating(joint)
        if kind in ("fixed", "floating"):
            return JointMotion(kind)
        axis = element.find("axis")
        if axis is None:
            self._findings.reject(
                "sdf-joint-without-axis",
                f"joint {joint.name} is {kind} and has no <axis>; {REFUSED}",
                "write <axis><xyz>0 1 0</xyz></axis> into it",
                element,
            )
            return JointMotion(kind)
        limit = None if kind == "continuous" else self._limit(axis, joint, kind)
        return JointMotion(kind, axes["axis"], limit, _dynamics(axis))

    def _type(self, joint: Frame) -> JointType:
        written = trimmed(joint.element.get("type") or "")
        kind = TYPES.get(written.lower())
        if kind is not None:
            return kind
        if written:
            known = written.lower() in ("floating", "planar")
            meant = meant_type(joint.element, written, TYPES)
            near = did_you_mean(meant or written.lower(), TYPES)
            why = "a type of URDF that SDF does not have" if known else near
            self._findings.reject(
                "joint-type-unknown",
                f"joint {joint.name} has the unknown type '{written}' ({why}); "
                f"{REFUSED}",
                exchanged(joint.element, "type", TYPES)
                or (f'write type="{meant}"' if meant else f"use {', '.join(TYPES)}"),
                joint.element,
                "type",
            )
        return "fixed"

    def _axis(self, axis: Element, joint: Frame) -> Vector3:
        """Return the direction of an axis in the joint frame, as a unit vector."""
        direction = np.array(vector_in(axis, "xyz", _Z))
        length = math.hypot(*direction)
        if length == 0.0:
            axle = axle_of(joint.element)
            self._findings.reject(
                "axis-zero",
                f"the axis 0 0 0 of joint {joint.name} has no direction; {REFUSED}",
                f"write <xyz>{axle}</xyz>"
                if axle
                else "write a direction such as <xyz>0 1 0</xyz>",
                axis.find("xyz") or axis,
            )
            return _Z
        name = self._version.expressed_in(axis)
        at = axis.find("xyz") or axis
        if at is axis and name:
            # The conversion to a newer version creates an empty <xyz> for the frame.
            self._findings.reject(
                "sdf-value",
                f"<axis> of joint {joint.name} has no <xyz>, which a file of this "
                f"version needs; {REFUSED}",
                "write <xyz>0 0 1</xyz> into it",
                axis,
            )
        frame = self._frames.named(name, at, "expressed_in") if name else None
        turn = np.eye(3)
        if frame is not None:
            turn = self._frames.between(joint, frame)[:3, :3]
        x, y, z = (turn @ (direction / length)).tolist()
        return (x, y, z)

    def _limit(self, axis: Element, joint: Frame, kind: JointType) -> Limit:
        element = axis.find("limit")
        effort, velocity = (
            number_in(element, tag, math.inf) for tag in ("effort", "velocity")
        )
        limit = Limit(
            number_in(element, "lower", -math.inf),
            number_in(element, "upper", math.inf),
            math.inf if effort < 0 else effort,
            math.inf if velocity < 0 else velocity,
            (element or axis).place,
        )
        if None in limit.ends:
            self._report_endless(joint, limit, kind, element or axis)
        elif limit.lower > limit.upper:
            self._findings.warn(
                "limit-reversed",
                f"joint {joint.name} has lower ({limit.lower:g}) greater than upper "
                f"({limit.upper:g})",
                "exchange the two",
                (element or axis).find("lower") or axis,
            )
        return limit

    def _report_endless(
        self, joint: Frame, limit: Limit, kind: JointType, at: Element
    ) -> None:
        as_text = at.tag == "limit" and loose_text(at) and not at.children
        if as_text or at.attributes or joint.element.find("limit") is not None:
            # Another finding gives the notation of the intended limits.
            return
        no_end = limit.ends == (None, None)
        given = [e for e in map(at.find, ("lower", "upper")) if e is not None]
        publisher = (
            "joint_state_publisher_gui ends with an error at a limit that is not finite"
            if len(given) == 2
            else "joint_state_publisher ends with an error at a joint without limits"
        )
        ends = "−π to π" if kind == "revolute" else "−1 m to 1 m"
        self._findings.warn(
            "sdf-limit-not-finite",
            f"joint {joint.name} has no end: {publisher}, and then "
            f"its link has no transform; the slider here runs from {ends}"
            if no_end
            else f"joint {joint.name} has only one finite limit: {publisher}, and then "
            "its link has no transform",
            'write type="continuous", without <limit>'
            if kind == "revolute" and no_end
            else "write <limit><lower>…</lower><upper>…</upper></limit> into <axis>, "
            "with finite numbers",
            given[0] if given else at,
        )

    def _report_floating(self, joint: Frame) -> None:
        child = text_in(joint.element, "child")
        kind = trimmed(joint.element.get("type") or "").lower()
        self._findings.warn(
            "sdf-joint-floating",
            f"joint {joint.name} is of type {kind}, which ROS makes a floating joint: "
            "robot_state_publisher leaves it out, so RViz has no transform for "
            f"{child} and all links behind it; here it does not move",
            "use fixed, continuous, revolute or prismatic joints for ROS",
            joint.element,
            "type",
        )

    def _report_lost(self, joint: Frame, kind: JointType) -> None:
        """Report parts of a joint that ROS ignores; it refuses a wrong mimic."""
        lost: dict[str, Element] = {}
        axes = [joint.element.find("axis"), joint.element.find("axis2")]
        for axis in (axis for axis in axes if axis is not None):
            if axis.tag == "axis2":
                lost["axis2"] = axis
            mimic = axis.find("mimic")
            if mimic is not None:
                self._check_mimic(mimic, axis, joint)
                lost.setdefault("mimic", mimic)
            for parent in (axis.find("dynamics"), axis.find("limit")):
                lost |= {
                    element.tag: element
                    for element in (parent.children if parent is not None else ())
                    if element.tag in _LOST and number_in(parent, element.tag, 0.0)
                }
        if lost and kind != "floating":
            free = ", so the joint is free" if "mimic" in lost else ""
            self._findings.warn(
                "sdf-joint-part",
                f"ROS does not read {and_list(f'<{tag}>' for tag in lost)} of joint "
                f"{joint.name}{free}",
                "nothing has to be done for Gazebo; in ROS write a URDF for it"
                if free
                else "delete it, or keep it for Gazebo",
                next(iter(lost.values())),
            )

    def _check_mimic(self, mimic: Element, axis: Element, joint: Frame) -> None:
        leader = trimmed(mimic.get("joint") or "")
        leading = trimmed(mimic.get("axis") or "") or "axis"
        other = self._joints.get(leader)
        near = did_you_mean(leader, self._joints)
        why = ""
        hint: str | Fix = ""
        if leader and other is None:
            why, hint = f"which does not exist ({near})", "correct the name"
            right = nearest(leader, [n for n in self._joints if n != joint.name])
            if right is not None:
                hint = write_attribute(mimic.place, "joint", leader, right)
        elif leader == joint.name and leading == axis.tag:
            why, hint = "which is itself", "name another joint"
        elif other is not None and other.find(leading) is None:
            why, hint = f"which has no <{leading}>", 'write axis="axis"'
        if why:
            self._findings.reject(
                "mimic-joint-unknown",
                f"joint {joint.name} mimics '{leader}', {why}; {REFUSED}",
                hint,
                mimic,
                "joint",
                cause=f"joint {leader}",
            )


def _dynamics(axis: Element) -> Dynamics:
    element = axis.find("dynamics")
    return Dynamics(
        number_in(element, "damping", 0.0), number_in(element, "friction", 0.0)
    )
