"""Joints as urdfdom reads them; one wrong joint rejects the model.

The rules are those of spec/ros-nodes.md §6.2 and the case tables of §6.7.
"""

from __future__ import annotations

import math
from typing import get_args

from sambot_viz.errors import did_you_mean
from sambot_viz.robot.attributes import AttributeReader, Unreadable
from sambot_viz.robot.findings import Findings
from sambot_viz.robot.model import (
    Joint,
    JointType,
    Limit,
    Mimic,
    Origin,
    SoftLimit,
    Vector3,
)
from sambot_viz.robot.xml import Element

JOINT_TYPES: tuple[JointType, ...] = get_args(JointType)
_REFUSED = "ROS refuses the model"
_LIMIT_EXAMPLE = 'lower="-1.57" upper="1.57" effort="10" velocity="1"'


def read_joint(element: Element, findings: Findings) -> Joint | None:
    """Read one <joint>; every fault in it is reported.

    Returns:
        The joint, or None when it has no name, no known type or no ends. What else
        is wrong is reported, and the joint goes on with the default for it, so that
        the checks of the tree still see it.
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


def _type(element: Element, name: str, findings: Findings) -> JointType | None:
    text = element.get("type")
    if text is None:
        findings.reject(
            "joint-without-type",
            f"joint {name} has no type; {_REFUSED}",
            f'add type="continuous" or another of {", ".join(JOINT_TYPES)}',
            element,
        )
        return None
    for kind in JOINT_TYPES:
        if kind == text:
            return kind
    plain = text.strip().lower()
    if plain in JOINT_TYPES:
        why = "ROS compares letter by letter, blanks and capitals count"
        hint = f'write type="{plain}"'
    else:
        why = did_you_mean(text, JOINT_TYPES)
        hint = f"use {', '.join(JOINT_TYPES[:-1])} or {JOINT_TYPES[-1]}"
    findings.reject(
        "joint-type-unknown",
        f"joint {name} has the unknown type '{text}' ({why}); {_REFUSED}",
        hint,
        element,
        "type",
    )
    return None


def _end(element: Element, tag: str, name: str, findings: Findings) -> str | None:
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
        self, element: Element, name: str, kind: JointType, findings: Findings
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
        self._dynamics()
        self._calibration()
        return Joint(
            self._name,
            self._kind,
            parent,
            child,
            origin,
            self._axis(),
            self._limit(),
            self._soft_limit(),
            self._mimic(),
            self._element.place,
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
            self._tell_zero_axis(element)
            return (0.0, 0.0, 0.0)
        if abs(length - 1.0) < 1e-12:
            return (x, y, z)
        return (x / length, y / length, z / length)

    def _tell_zero_axis(self, element: Element) -> None:
        if self._kind == "planar":
            return
        self._findings.error(
            "axis-zero",
            f'the axis "{element.get("xyz")}" of joint {self._name} has no '
            "direction: ROS divides by zero and the link vanishes",
            'write a direction such as xyz="0 1 0"',
            element,
            "xyz",
        )

    def _limit(self) -> Limit | None:
        element = self._element.find("limit")
        if element is None:
            if self._kind in ("revolute", "prismatic"):
                self._tell_no_limit()
            return None
        missing = [n for n in ("effort", "velocity") if element.get(n) is None]
        if missing:
            self._tell_incomplete(element, missing)
        try:
            limit = Limit(
                self._reader.optional(element, "lower", 0.0),
                self._reader.optional(element, "upper", 0.0),
                self._reader.optional(element, "effort", 0.0),
                self._reader.optional(element, "velocity", 0.0),
            )
        except Unreadable:
            return Limit()
        if self._kind in ("revolute", "prismatic"):
            self._check_range(element, limit)
        return limit

    def _tell_no_limit(self) -> None:
        unit = "radians" if self._kind == "revolute" else "metres"
        other = " or make the joint continuous" if self._kind == "revolute" else ""
        self._findings.reject(
            "limit-missing",
            f"joint {self._name} is {self._kind} and has no <limit>; {_REFUSED}",
            f"add <limit {_LIMIT_EXAMPLE}/> with lower and upper in {unit}{other}",
            self._element,
        )

    def _tell_incomplete(self, element: Element, missing: list[str]) -> None:
        names = " and ".join(missing)
        add = " ".join(f'{n}="{10 if n == "effort" else 1}"' for n in missing)
        even = (
            ""
            if self._kind in ("revolute", "prismatic")
            else (f", even on a {self._kind} joint")
        )
        self._findings.reject(
            "limit-incomplete",
            f"<limit> of joint {self._name} has no {names}; {_REFUSED}{even}",
            f"add {add}" + (", or delete <limit>" if even else ""),
            element,
        )

    def _check_range(self, element: Element, limit: Limit) -> None:
        missing = [n for n in ("lower", "upper") if element.get(n) is None]
        if missing:
            names = " and no ".join(missing)
            report = self._findings.error if len(missing) == 2 else self._findings.warn
            report(
                "limit-without-range",
                f"<limit> of joint {self._name} has no {names}: urdfdom takes 0, so "
                f"the range is {limit.lower:g} to {limit.upper:g}, and "
                "joint_state_publisher refuses the model",
                'give both, such as lower="-1.57" upper="1.57"',
                element,
            )
        elif limit.lower > limit.upper:
            self._findings.warn(
                "limit-reversed",
                f"joint {self._name} has lower ({limit.lower:g}) greater than upper "
                f"({limit.upper:g})",
                "exchange the two",
                element,
                "lower",
            )

    def _soft_limit(self) -> SoftLimit | None:
        element = self._element.find("safety_controller")
        if element is None:
            return None
        if element.get("k_velocity") is None:
            self._findings.reject(
                "safety-controller-incomplete",
                f"<safety_controller> of joint {self._name} has no k_velocity; "
                f"{_REFUSED}",
                'add k_velocity="10"',
                element,
            )
        try:
            for name in ("k_position", "k_velocity"):
                self._reader.optional(element, name, 0.0)
            return SoftLimit(
                self._soft(element, "soft_lower_limit"),
                self._soft(element, "soft_upper_limit"),
            )
        except Unreadable:
            return None

    def _soft(self, element: Element, name: str) -> float | None:
        if element.get(name) is None:
            return None
        return self._reader.number(element, name)

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

    def _dynamics(self) -> None:
        element = self._element.find("dynamics")
        if element is None:
            return
        if element.get("damping") is None and element.get("friction") is None:
            self._findings.reject(
                "dynamics-empty",
                f"<dynamics> of joint {self._name} has neither damping nor friction; "
                f"{_REFUSED}",
                "delete it, or give one of the two",
                element,
            )
        self._check_numbers(element, ("damping", "friction"))

    def _calibration(self) -> None:
        element = self._element.find("calibration")
        if element is not None:
            self._check_numbers(element, ("rising", "falling"))

    def _check_numbers(self, element: Element, names: tuple[str, ...]) -> None:
        for name in names:
            try:
                self._reader.optional(element, name, 0.0)
            except Unreadable:
                continue
