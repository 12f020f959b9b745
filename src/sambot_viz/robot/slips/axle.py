"""The axle of a wheel, from the wheel's cylinder."""

from __future__ import annotations

from sambot_viz.geometry import rotation_from_rpy
from sambot_viz.robot.xml.element import Element

_UNIT = 0.999


def axle_of(joint: Element) -> str | None:
    """Return the direction of the axis of the cylinder that a joint turns.

    Args:
        joint: a <joint> of URDF or SDF.

    Returns:
        The axis in a file's notation, such as "0 1 0"; None without a cylinder, or if
        its axis is along no axis of the joint.
    """
    child = joint.find("child")
    name = "" if child is None else child.get("link") or child.text.strip()
    siblings = joint.parent.find_all("link") if joint.parent is not None else []
    link = next((each for each in siblings if each.get("name") == name), None)
    if link is None or any(any(_angles(each)) for each in (joint, link)):
        return None
    for shape in (*link.find_all("visual"), *link.find_all("collision")):
        geometry = shape.find("geometry")
        if geometry is None or geometry.find("cylinder") is None:
            continue
        angles = _angles(shape)
        if len(angles) == 3:
            direction = [abs(row[2]) for row in rotation_from_rpy(*angles)]
            if max(direction) > _UNIT:
                return " ".join(str(round(part)) for part in direction)
    return None


def _angles(element: Element) -> list[float]:
    """Return roll, pitch and yaw of a shape, or of an element in SDF [rad]."""
    origin, pose = element.find("origin"), element.find("pose")
    text = "0 0 0"
    if pose is not None:
        text = " ".join(pose.text.split()[3:]) or text
    elif origin is not None and element.tag != "joint":
        text = origin.get("rpy") or text
    try:
        return [float(part) for part in text.split()]
    except ValueError:
        return []
