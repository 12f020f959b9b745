"""The parts of a model for Gazebo and ros2_control, which ROS does not draw.

Rules compare the names in them with the robot's links and joints.
"""

from __future__ import annotations

from sambot_viz import limits
from sambot_viz.robot.xml.element import Element

_OUTER = frozenset({"robot", "model", "world"})


def gazebo_parts(document: Element, depth: int = 0) -> tuple[Element, ...]:
    """Copy the <gazebo>, <ros2_control> and <transmission> elements of a model.

    Plugins and sensors of an SDF model get the form that they have in URDF: a <gazebo>
    around each, whose `reference` names the link or the joint of a sensor.

    Args:
        document: root element, expanded by xacro.
        depth: depth of that element in another document.

    Returns:
        Elements without parents, so that the rest of the document can be released.
    """
    found: list[Element] = []
    for child in document.children:
        if child.tag in ("gazebo", "ros2_control", "transmission"):
            found.append(_copy(child))
        elif child.tag == "plugin":
            found.append(_wrapped(child))
        elif child.tag in _OUTER and depth < limits.NESTED_MODELS.value:
            found += gazebo_parts(child, depth + 1)
        elif child.tag in ("link", "joint"):
            found += (_wrapped(s, child) for s in child.find_all("sensor"))
    return tuple(found)


def _wrapped(element: Element, carrier: Element | None = None) -> Element:
    """Wrap a part of an SDF model in the <gazebo> that URDF puts around it."""
    attributes = {} if carrier is None else {"reference": carrier.get("name") or ""}
    return Element("gazebo", attributes, element.place, [_copy(element)])


def _copy(element: Element, depth: int = 0) -> Element:
    children = element.children if depth < limits.NESTED_MODELS.value else []
    copied = [_copy(child, depth + 1) for child in children]
    return Element(
        element.tag,
        dict(element.attributes),
        element.place,
        copied,
        element.text.strip(),
        call=element.call,
    )
