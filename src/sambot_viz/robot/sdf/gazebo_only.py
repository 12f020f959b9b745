"""Notes, one for each kind, on the parts of a model that only Gazebo uses."""

from __future__ import annotations

from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.sdf.wording import and_list
from sambot_viz.robot.xml.element import Element

_KINDS = {
    "sensor": "sensors",
    "plugin": "plugins",
    "light": "lights",
    "gripper": "grippers",
    "projector": "projectors",
    "particle_emitter": "particle emitters",
    "battery": "batteries",
    "audio_source": "sounds",
    "audio_sink": "microphones",
    "ros2_control": "parts of ros2_control",
}
"""Tag → plural for messages."""

_SETTINGS = frozenset(
    "static self_collide allow_auto_disable enable_wind gravity kinematic "
    "must_be_base_link velocity_decay surface physics laser_retro max_contacts "
    "cast_shadows visibility_flags meta fluid_added_mass "
    "transparency lighting".split()
)
"""Elements that only control how Gazebo simulates or draws."""

_MOST_NAMES = 4
_NOTHING_TO_DO = "nothing has to be done"


def is_for_gazebo(element: Element) -> bool:
    """Return whether ROS ignores an element with all its content."""
    return is_tag_for_gazebo(element.tag)


def is_tag_for_gazebo(tag: str) -> bool:
    """Return whether ROS ignores elements with that tag."""
    return tag in _KINDS or tag in ("surface", "physics")


def note_gazebo_only(model: Element, findings: ModelFindings) -> None:
    """Note elements without effect on the picture.

    Args:
        model: the <model>.
        findings: receives the notes.
    """
    found: dict[str, list[Element]] = {}
    settings: dict[str, Element] = {}
    stack = [model]
    while stack:
        element = stack.pop()
        if element.tag == "sensor" and element.parent is model:
            # That is a separate problem.
            continue
        if element.tag in _KINDS:
            found.setdefault(element.tag, []).append(element)
            continue
        if element.tag in _SETTINGS:
            settings.setdefault(element.tag, element)
            continue
        stack.extend(reversed(element.children))
    for tag, elements in found.items():
        _note_kind(tag, elements, findings)
    if settings:
        tags = and_list(f"<{tag}>" for tag in settings)
        findings.add(
            "info",
            "sdf-gazebo-only",
            f"{tags} {'is' if len(settings) == 1 else 'are'} for Gazebo: ROS and this "
            "picture leave such settings out",
            _NOTHING_TO_DO,
            next(iter(settings.values())).place,
        )


def _note_kind(tag: str, elements: list[Element], findings: ModelFindings) -> None:
    names = [element.get("name") or f"<{tag}>" for element in elements]
    shown = ", ".join(names[:_MOST_NAMES])
    shown += f" and {len(names) - _MOST_NAMES} more" if len(names) > _MOST_NAMES else ""
    one = len(elements) == 1
    what = tag.replace("_", " ") if one else _KINDS[tag]
    counted = f"1 {what}" if one else f"{len(elements)} {what}"
    links = "; its link is shown" if one else "; their links are shown"
    findings.add(
        "info",
        "sdf-gazebo-only",
        f"{counted} ({shown}) {'is' if one else 'are'} for Gazebo and not for ROS"
        + (links if tag == "sensor" else ""),
        _NOTHING_TO_DO,
        elements[0].place,
    )
