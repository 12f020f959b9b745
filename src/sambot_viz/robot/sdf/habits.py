"""URDF's notation in SDF files: values as attributes.

ROS ignores it without a message. Each problem gives the full notation of SDF.
"""

from __future__ import annotations

from dataclasses import dataclass

from sambot_viz.robot.sdf.wording import REFUSED, and_list, described
from sambot_viz.robot.slips.three_lengths import size_of_three
from sambot_viz.robot.xml.element import Element


@dataclass(frozen=True, slots=True)
class Habit:
    """The effect in ROS, and the remedy.

    Attributes:
        message: cause and effect.
        hint: SDF's notation of the same.
        refused: whether ROS refuses the model for it.
    """

    message: str
    hint: str
    refused: bool = False


_VALUES = {
    "box": (("size",), "the box gets the default size of 1 1 1, one metre"),
    "cylinder": (("radius", "length"), "radius and length become 1 metre"),
    "capsule": (("radius", "length"), "radius and length become 1 metre"),
    "sphere": (("radius",), "the radius becomes 1 metre"),
    "mesh": (("filename", "scale"), "no file is found"),
    "axis": (("xyz",), "the axis becomes 0 0 1"),
    "limit": (("lower", "upper", "effort", "velocity"), "the joint has no limits"),
    "dynamics": (("damping", "friction"), "they become 0"),
    "mass": (("value",), "the mass becomes 1 kg"),
    "inertia": (("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), "they become 1 or 0"),
    "mimic": (("multiplier", "offset"), "they become 1 and 0"),
}
"""Element of URDF → its attributes, and SDF's notation."""


def effect_of_default(tag: str) -> str:
    """Return the effect of an element without values, or ""."""
    if tag == "material":
        return "ROS shows it black"
    return _VALUES.get({"inertial": "mass", "axis2": "axis"}.get(tag, tag), ("", ""))[1]


def says_more_inside(element: Element) -> bool:
    """Return whether the finding about an inner element also covers this one."""
    return element.tag == "material" and element.find("color") is not None


def attributes_of_urdf(element: Element, names: list[str]) -> Habit | None:
    """Explain the URDF meaning of an element's attributes, or return None.

    Args:
        element: an element of SDF.
        names: its attributes that SDF does not know.
    """
    if element.tag in ("parent", "child") and names == ["link"]:
        link = element.get("link")
        return Habit(
            f"in SDF the link is text inside <{element.tag}>; the attribute link is "
            f"ignored and <{element.tag}> of {described(element)} is empty; {REFUSED}",
            f"write <{element.tag}>{link}</{element.tag}>",
            refused=not element.text.strip(),
        )
    if element.tag == "material":
        return _unnamed_material(element)
    if element.tag == "pose":
        return _pose(element, names)
    size = size_of_three(element) if element.tag == "box" else None
    if size is not None:
        return Habit(
            f"<box> of {described(element)} has its lengths as attributes, which SDF "
            "does not know; the box gets the default size of 1 1 1, one metre",
            f"write <box><size>{size}</size></box>",
        )
    known, effect = _VALUES.get(element.tag, ((), ""))
    if not known or any(name not in known for name in names):
        return None
    what = "the attribute" if len(names) == 1 else "the attributes"
    return Habit(
        f"SDF does not know {what} {and_list(names)} of <{element.tag}> in "
        f"{described(element)}; {effect}",
        f"write {_as_sdf(element, names)}",
    )


_PLACES = (("x", "y", "z"), ("roll", "pitch", "yaw"))


def _pose(element: Element, names: list[str]) -> Habit | None:
    """Explain a <pose> with its numbers in attributes, or return None."""
    triples = [
        element.get(whole) or " ".join(element.get(name) or "0" for name in parts)
        for whole, parts in zip(("xyz", "rpy"), _PLACES, strict=True)
    ]
    if not {"xyz", "rpy", *_PLACES[0], *_PLACES[1]}.issuperset(names):
        return None
    message = (
        f"in SDF the numbers are text inside <pose>; ROS ignores {and_list(names)} of "
        f"the <pose> of {described(element)}"
    )
    if element.text.strip():
        return Habit(message, f"delete {and_list(names)}: the numbers inside count")
    kept = "".join(
        f' {name}="{value}"'
        for name, value in element.attributes.items()
        if name not in names
    )
    return Habit(message, f"write <pose{kept}>{' '.join(triples)}</pose>")


def _as_sdf(element: Element, names: list[str]) -> str:
    """Write attributes of URDF as SDF's elements."""
    renamed = {"filename": "uri"}
    if element.tag == "mass":
        return f"<mass>{element.get('value')}</mass>"
    own = ""
    if element.tag == "mimic" and element.get("joint"):
        own = f' joint="{element.get("joint")}"'
        names = [name for name in names if name != "joint"]
    inner = "".join(
        f"<{renamed.get(name, name)}>{element.get(name)}</{renamed.get(name, name)}>"
        for name in names
    )
    return f"<{element.tag}{own}>{inner}</{element.tag}>"


def _unnamed_material(element: Element) -> Habit:
    return Habit(
        f"<material> of {described(element)} has no name in SDF: a material of another "
        "place cannot be used, each visual has its own colour",
        "write <material><ambient>…</ambient><diffuse>…</diffuse></material>"
        if not element.children
        else "delete the name",
    )


def element_of_urdf(element: Element) -> Habit | None:
    """Explain the URDF meaning of an element unknown to SDF, or return None."""
    parent = element.parent
    if parent is None:
        return None
    match parent.tag, element.tag:
        case _, "origin":
            return _origin(element, parent)
        case "material", "color":
            rgba = element.get("rgba") or "0.5 0.5 0.5 1"
            return Habit(
                f"SDF has no <color>; the <material> of {described(element)} without "
                "<ambient> and <diffuse> is black",
                f"write <ambient>{rgba}</ambient> and <diffuse>{rgba}</diffuse>",
            )
        case "material", "texture":
            return Habit(
                "SDF has no <texture> here, and ROS shows no textures of SDF",
                "put the texture into the mesh file",
            )
        case "joint", "limit" | "dynamics" | "mimic" if not element.children:
            names = list(element.attributes)
            inner = _as_sdf(element, names)
            return Habit(
                f"in SDF <{element.tag}> is inside <axis>; here ROS ignores it, so "
                f"{described(element)} has none",
                f"write {inner} inside <axis>",
            )
        case "cylinder", "height" if parent.find("length") is None:
            return Habit(
                f"SDF calls the height of <cylinder> length; the length of "
                f"{described(element)} becomes 1 metre",
                f"write <length>{element.text.strip()}</length>",
            )
        case "cylinder" | "sphere", "diameter" if parent.find("radius") is None:
            return Habit(
                f"SDF wants the radius of <{parent.tag}>, not the diameter; the radius "
                f"of {described(element)} becomes 1 metre",
                f"write <radius>{_half(element.text)}</radius>",
            )
        case "joint", "safety_controller" | "calibration":
            return Habit(f"SDF has no <{element.tag}>; ROS ignores it", "delete it")
        case _, "gazebo" | "transmission":
            return Habit(
                f"<{element.tag}> belongs to URDF; in SDF ROS and Gazebo ignore it",
                "delete it; what it says to Gazebo goes into the <model> itself",
            )
        case _:
            return None


def _half(text: str) -> str:
    try:
        return f"{float(text) / 2:g}"
    except ValueError:
        return "…"


def _origin(element: Element, parent: Element) -> Habit:
    xyz = element.get("xyz") or "0 0 0"
    rpy = element.get("rpy") or "0 0 0"
    pose = f"{xyz} {rpy}"
    if parent.tag != "joint":
        return Habit(
            f"SDF has no <origin>; ROS ignores it, so {described(element)} stays where "
            "its frame is",
            f"write <pose>{pose}</pose>",
        )
    links = [end.text.strip() for end in map(parent.find, ("parent", "child")) if end]
    above, child = links if len(links) == 2 else ("parent_link", "the child")
    name = parent.get("name")
    if _counts_from(parent, child):
        return Habit(
            f"SDF has no <origin>: without <pose> joint {name} counts from its child "
            f"link {child}, and {child}'s pose counts from {name}; {REFUSED}",
            f'write <pose relative_to="{above}">{pose}</pose>',
            refused=True,
        )
    return Habit(
        f"SDF has no <origin>; ROS ignores it, so the link {child} stays in the middle "
        f"of {above}",
        f'write <pose relative_to="{above}">{pose}</pose>, and '
        f'<pose relative_to="{name}"/> in the link {child}',
    )


def origin_in_place_of_pose(joint: Element) -> bool:
    """Return whether the finding about the <origin> of a joint says where it is."""
    return joint.find("pose") is None and joint.find("origin") is not None


def _counts_from(joint: Element, child: str) -> bool:
    """Return whether a joint without <pose> has a child link that counts from it."""
    model = joint.parent
    if model is None or not origin_in_place_of_pose(joint):
        return False
    poses = (
        link.find("pose")
        for link in model.find_all("link")
        if link.get("name") == child
    )
    return any(p and p.get("relative_to") == joint.get("name") for p in poses)
