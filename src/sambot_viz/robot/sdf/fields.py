"""Values of elements for the readers; a missing or wrong value gives the default.

`check_elements` has reported wrong values. This module replaces a number that cannot be
shown, with a warning.
"""

from __future__ import annotations

import math

import numpy as np

from sambot_viz.geometry import Matrix, Rgba, Vector3
from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.sdf import values
from sambot_viz.robot.sdf.values import LARGEST, BadValue, PoseText, trimmed
from sambot_viz.robot.sdf.wording import described
from sambot_viz.robot.slips.units import usual_degrees
from sambot_viz.robot.xml.element import Element


def text_in(parent: Element, tag: str) -> str:
    """Return the text of an element in another; "" if it is missing."""
    element = parent.find(tag)
    return "" if element is None else trimmed(element.text)


def number_in(parent: Element | None, tag: str, default: float) -> float:
    """Return a number in an element; it may be infinite, or not a number."""
    text = "" if parent is None else text_in(parent, tag)
    try:
        return values.read_number(text).value if text else default
    except BadValue:
        return default


def length_in(
    parent: Element, tag: str, default: float, findings: ModelFindings
) -> float:
    """Return a number that can be drawn, else the nearest one, with a warning."""
    value = number_in(parent, tag, default)
    if -LARGEST <= value <= LARGEST:
        return value
    shown = 0.0 if math.isnan(value) else math.copysign(LARGEST, value)
    findings.warn(
        "number-too-large",
        f"<{tag}>{text_in(parent, tag)}</{tag}> of {described(parent)} is nothing that "
        f"can be shown; {shown:g} is taken instead",
        "write the number in metres",
        parent.find(tag) or parent,
    )
    return shown


def vector_in(parent: Element, tag: str, default: Vector3) -> Vector3:
    """Return three numbers in an element."""
    text = text_in(parent, tag)
    try:
        x, y, z = values.read_vector(text, 3) if text else default
    except BadValue:
        return default
    return (_bounded(x), _bounded(y), _bounded(z))


def _bounded(value: float) -> float:
    return min(max(value, -LARGEST), LARGEST)


def colour_in(parent: Element, tag: str, default: Rgba) -> Rgba:
    """Return a colour in an element."""
    text = text_in(parent, tag)
    try:
        return values.read_colour(text) if text else default
    except BadValue:
        return default


def pose_of(owner: Element, findings: ModelFindings) -> Matrix:
    """Return an element's pose as written, T_base_owner (4, 4), for any base.

    A quaternion of another length than 1 is normalised, with a warning.
    """
    element = owner.find("pose")
    if element is None:
        return np.eye(4)
    degrees = trimmed(element.get("degrees") or "").lower() in ("true", "1")
    rotation_format = trimmed(element.get("rotation_format") or "") or "euler_rpy"
    try:
        pose = values.read_pose(element.text, degrees, rotation_format)
    except BadValue:
        return np.eye(4)
    _check_length(pose, element, findings)
    # Where a unit is ignored, that is the finding.
    if not pose.ignored:
        check = _check_radians if degrees else _check_degrees
        check(pose, element, findings)
    T = pose.matrix
    T[:3, 3] = [_bounded(value) for value in T[:3, 3].tolist()]
    return T


def _check_degrees(pose: PoseText, element: Element, findings: ModelFindings) -> None:
    """Report round angles of more than a turn, which are meant as degrees.

    Round angles alone give a remark; angles that are usual in degrees give a warning.
    """
    angles = pose.numbers[3:6] if len(pose.numbers) == 6 else ()
    if not any(abs(angle) > 2 * math.pi + 1e-3 for angle in angles):
        return
    if all((2 * angle).is_integer() for angle in angles):
        usual = all(map(usual_degrees, angles))
        report = findings.warn if usual else findings.remark
        report(
            "rpy-in-degrees",
            f"the angles of <pose> in {described(element)} look like degrees, but SDF "
            "uses radians",
            f"write {_with_degrees(element)}, or the angles in radians",
            element,
        )


def _check_radians(pose: PoseText, element: Element, findings: ModelFindings) -> None:
    """Warn of fractions of pi that are declared as degrees."""
    angles = pose.numbers[3:6] if len(pose.numbers) == 6 else ()
    for angle in map(math.degrees, angles):
        parts = angle / (math.pi / 4)
        if round(parts) and abs(parts - round(parts)) < 1e-3 and abs(parts) <= _PARTS:
            findings.warn(
                "rpy-in-degrees",
                f"{angle:.5g} of <pose> in {described(element)} is a part of pi, but "
                'degrees="true" makes it an angle in degrees',
                f"write {45 * round(parts)} for it, or delete degrees",
                element,
            )
            return


_PARTS = 8
"""Largest angle that is checked, in eighths of a turn."""


def _with_degrees(pose: Element) -> str:
    """Return its start tag with one attribute more."""
    others = [name for name in pose.attributes if name != "degrees"]
    if pose.call is None:
        kept = "".join(f' {name}="{pose.get(name)}"' for name in others)
        return f'<pose{kept} degrees="true">'
    if not others:
        return '<pose degrees="true">'
    # Attributes that come from a macro differ from those in the file.
    return f'degrees="true" into <pose>, beside {" and ".join(others)}'


def _check_length(pose: PoseText, element: Element, findings: ModelFindings) -> None:
    if abs(pose.length - 1.0) <= 1e-3:
        return
    findings.warn(
        "sdf-quaternion",
        f"the quaternion in <pose> of {described(element)} has the length "
        f"{pose.length:.3g}, not 1; it is made 1 here, and ROS may turn the part "
        "another way",
        "write a quaternion of length 1, such as 0 0 0 1",
        element,
    )
