"""Read joints as urdfdom 3 and 5 do: one invalid joint rejects the model."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import get_args

from sambot_viz.edits import write_attribute
from sambot_viz.errors import Fix, did_you_mean, nearest
from sambot_viz.geometry import Vector3
from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.parts import Joint, JointType, Mimic, Origin, mimic_chain
from sambot_viz.robot.slips.axle import axle_of
from sambot_viz.robot.slips.exchanged_words import exchanged
from sambot_viz.robot.urdf.attributes import AttributeReader, Unreadable
from sambot_viz.robot.urdf.joint_limits import LimitReader
from sambot_viz.robot.xml.element import Element

JOINT_TYPES: tuple[JointType, ...] = get_args(JointType)
_REFUSED = "ROS refuses the model"
_MEANT: dict[str, JointType] = {
    "static": "fixed",
    "rigid": "fixed",
    "hinge": "revolute",
    "rotary": "revolute",
    "rotational": "revolute",
    "rotation": "revolute",
    "wheel": "continuous",
    "linear": "prismatic",
    "slider": "prismatic",
    "sliding": "prismatic",
    "translational": "prismatic",
    "free": "floating",
}
"""Common name of a type → the type."""


def read_joint(element: Element, findings: ModelFindings) -> Joint | None:
    """Read one <joint> and report every error in it.

    Returns:
        The joint, or None when it has no name, no known type or no ends. Other
        invalid parts are reported and replaced by their defaults, so that the tree
        is still checked.
    """
    name = element.get("name")
    if name is None:
        findings.reject(
            "joint-without-name",
            f"this <joint> has no name; {_REFUSED}",
            'write <joint name="…" type="…">',
            element,
        )
    shown = name or f"on line {element.place.line}"
    kind = _type(element, shown, findings)
    parent = _end(element, "parent", shown, findings)
    child = _end(element, "child", shown, findings)
    if name is None or kind is None or parent is None or child is None:
        return None
    return _JointReader(element, name, kind, findings).read(parent, child)


def _type(element: Element, name: str, findings: ModelFindings) -> JointType | None:
    text = element.get("type")
    if text is None:
        findings.reject(
            "joint-without-type",
            f"joint {name} has no type; {_REFUSED}",
            f'add type="{_usual(element)}" or another of {", ".join(JOINT_TYPES)}',
            element,
        )
        return None
    for kind in JOINT_TYPES:
        if kind == text:
            return kind
    plain = text.strip().lower()
    if plain in JOINT_TYPES:
        why = "ROS compares letter by letter, blanks and capitals count"
        hint: str | Fix = write_attribute(element.place, "type", text, plain)
    else:
        near = meant_type(element, text, JOINT_TYPES)
        why = did_you_mean(near or text, JOINT_TYPES)
        hint = f"use {', '.join(JOINT_TYPES[:-1])} or {JOINT_TYPES[-1]}"
        if near is not None:
            hint = write_attribute(element.place, "type", text, near)
        hint = exchanged(element, "type", JOINT_TYPES) or hint
    findings.reject(
        "joint-type-unknown",
        f"joint {name} has the unknown type '{text}' ({why}); {_REFUSED}",
        hint,
        element,
        "type",
    )
    return None


def meant_type(element: Element, text: str, types: Iterable[str]) -> str | None:
    """Return the intended type for a word that is not a type, or None."""
    known = list(types)
    near = _MEANT.get(text.strip().lower()) or nearest(text.lower(), known)
    if near == "revolute" and not any(each.tag == "limit" for each in element.iter()):
        near = "continuous"
    return near if near in known else None


def _usual(element: Element) -> JointType:
    """Return the usual type of a joint with these elements."""
    if element.find("axis") is None:
        return "fixed"
    return "continuous" if element.find("limit") is None else "revolute"


def _end(element: Element, tag: str, name: str, findings: ModelFindings) -> str | None:
    end = element.find(tag)
    if end is None:
        findings.reject(
            f"joint-without-{tag}",
            f"joint {name} has no <{tag}>; {_REFUSED}",
            f'write <{tag} link="…"/> into it',
            element,
        )
        return None
    link = end.get("link")
    if link is not None:
        return link
    text = end.text.strip()
    if text:
        message = f"<{tag}> of joint {name} has the link as text, as in SDF"
        hint = f'write <{tag} link="{text}"/>'
    else:
        message = f"<{tag}> of joint {name} names no link"
        hint = f'write <{tag} link="…"/>'
    findings.reject(f"joint-{tag}-without-link", f"{message}; {_REFUSED}", hint, end)
    return None


class _JointReader:
    def __init__(
        self, element: Element, name: str, kind: JointType, findings: ModelFindings
    ) -> None:
        self._element = element
        self._name = name
        self._kind: JointType = kind
        self._findings = findings
        self._reader = AttributeReader(
            findings, findings.reject, f"joint {name}", _REFUSED
        )

    def read(self, parent: str, child: str) -> Joint:
        origin = Origin()
        try:
            origin = self._reader.origin(self._element)
        except Unreadable:
            pass
        limits = LimitReader(
            self._element, self._name, self._kind, self._reader, self._findings
        )
        dynamics = limits.dynamics()
        limits.check_calibration()
        return Joint(
            self._name,
            self._kind,
            parent,
            child,
            origin,
            self._axis(),
            limits.limit(),
            limits.soft_limit(),
            self._mimic(),
            self._element.place,
            dynamics,
        )

    def _axis(self) -> Vector3:
        element = self._element.find("axis")
        if element is None or self._kind in ("fixed", "floating"):
            return (1.0, 0.0, 0.0)
        if element.get("xyz") is None:
            wrong = next(iter(element.attributes), None)
            have = f" but {wrong}" if wrong else ""
            self._findings.error(
                "axis-without-xyz",
                f"<axis> of joint {self._name} has no xyz{have}: ROS reads it as "
                "0 0 0, which has no direction",
                'write <axis xyz="0 1 0"/>, or delete <axis> for the default 1 0 0',
                element,
            )
            return (0.0, 0.0, 0.0)
        try:
            x, y, z = self._reader.vector(element, "xyz", (0.0, 0.0, 0.0))
        except Unreadable:
            return (1.0, 0.0, 0.0)
        length = math.sqrt(x * x + y * y + z * z)
        if length == 0.0:
            self._report_zero_axis(element)
            return (0.0, 0.0, 0.0)
        if abs(length - 1.0) < 1e-12:
            return (x, y, z)
        return (x / length, y / length, z / length)

    def _report_zero_axis(self, element: Element) -> None:
        if self._kind == "planar":
            return
        axle = axle_of(self._element)
        self._findings.error(
            "axis-zero",
            f'the axis "{element.get("xyz")}" of joint {self._name} has no '
            "direction: ROS divides by zero and the link vanishes",
            f'write xyz="{axle}"' if axle else 'write a direction such as xyz="0 1 0"',
            element,
            "xyz",
        )

    def _mimic(self) -> Mimic | None:
        element = self._element.find("mimic")
        if element is None:
            return None
        joint = element.get("joint")
        if joint is None:
            self._findings.reject(
                "mimic-without-joint",
                f"<mimic> of joint {self._name} names no joint; {_REFUSED}",
                'write <mimic joint="…"/>',
                element,
            )
            return None
        try:
            return Mimic(
                joint,
                self._reader.optional(element, "multiplier", 1.0),
                self._reader.optional(element, "offset", 0.0),
            )
        except Unreadable:
            return None


def check_mimics(
    joints: Mapping[str, Joint],
    elements: Mapping[str, Element],
    findings: ModelFindings,
) -> None:
    """Report unknown, immovable and circular mimic joints, which urdfdom accepts.

    joint_state_publisher looks only at the <mimic> of joints that move.
    """
    reported: set[str] = set()
    for name, joint in joints.items():
        if joint.mimic is None or name in reported or not joint.movable:
            continue
        element = elements[name].find("mimic") or elements[name]
        leader = joints.get(joint.mimic.joint)
        if leader is None:
            others = [name for name, one in joints.items() if one.movable]
            others = [other for other in others if other != name]
            near = did_you_mean(joint.mimic.joint, others)
            one = nearest(joint.mimic.joint, others)
            findings.error(
                "mimic-joint-unknown",
                f"joint {name} mimics '{joint.mimic.joint}', which does not exist "
                f"({near}); joint_state_publisher would crash",
                f'write joint="{one}", or delete <mimic>'
                if one
                else "correct the name, or delete <mimic>",
                element,
                "joint",
                cause=f"joint {joint.mimic.joint}",
            )
        elif not leader.movable:
            findings.warn(
                "mimic-joint-immovable",
                f"joint {name} mimics {leader.name}, which is {leader.type} and has "
                "no position; joint_state_publisher would crash",
                "mimic a revolute, continuous or prismatic joint",
                element,
                "joint",
            )
        else:
            reported |= _report_ring(joint, joints, element, findings)


def _report_ring(
    joint: Joint, joints: Mapping[str, Joint], element: Element, findings: ModelFindings
) -> set[str]:
    """Report the ring that a joint's mimic chain runs into, if the joint is in it."""
    ring = mimic_chain(joint, joints).ring
    if not ring or ring[0] is not joint:
        return set()
    chain = [member.name for member in ring]
    names = " → ".join([*chain, joint.name])
    what = (
        f"joint {joint.name} mimics itself"
        if len(chain) == 1
        else f"these joints mimic each other in a ring: {names}"
    )
    leader = _only_leader(joint, joints) if len(chain) == 1 else None
    findings.error(
        "mimic-ring",
        f"{what}; joint_state_publisher would stop",
        f'write joint="{leader.name}"'
        if leader
        else "delete the <mimic> of one of them",
        element,
        "joint",
    )
    return set(chain)


def _only_leader(joint: Joint, joints: Mapping[str, Joint]) -> Joint | None:
    """Return the only joint that is made like one, on the same link, and is free."""
    found = [
        other
        for other in joints.values()
        if other is not joint
        and other.mimic is None
        and (other.type, other.parent) == (joint.type, joint.parent)
    ]
    return found[0] if len(found) == 1 else None
