"""Report elements and words that Gazebo does not know.

ROS does not read them, and Gazebo leaves out what it does not know.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache

from sambot_viz.checks.rule import Subject
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import move_before, rename_element, write
from sambot_viz.errors import Fix, Problem
from sambot_viz.robot.findings import tag_text
from sambot_viz.robot.sdf.check_elements import value_fault
from sambot_viz.robot.sdf.elements import ElementType, Values, model_type
from sambot_viz.robot.slips.vocabulary import is_one_slip
from sambot_viz.robot.xml.element import Element

_SYNONYMS = {
    "topicname": "topic",
    "rate": "update_rate",
    "frequency": "update_rate",
    "framename": "gz_frame_id",
    "frameid": "gz_frame_id",
}
_ANGLES = ("horizontal_fov",)
"""Angles, whose values above a full turn another rule reports."""
_LOWER = {"far": "near", "max": "min"}
"""Limit → the lower one beside it."""
_BELOW_ZERO = re.compile(r"-(?=.*[1-9])[\d.]+")
_BESIDE = frozenset({"gz_frame_id", "ignition_frame_id"})
"""Elements that Gazebo reads in a sensor, and that the table of SDF lacks."""


_OF_SENSOR = _BESIDE | {"always_on", "update_rate", "visualize"}
"""Elements of a sensor that no link or model has."""


@cache
def _in_gazebo() -> ElementType:
    """Return the possible elements in a <gazebo> of URDF."""
    words = vocabulary("gazebo_elements")
    inside = {word: ElementType(word, Values(), {}) for word in words}
    return ElementType("gazebo", Values(), {}, inside)


def gazebo_words(subject: Subject) -> Iterator[Problem]:
    """Report misspelt elements of <gazebo>."""
    for part in subject.robot.gazebo if subject.robot.language == "urdf" else ():
        if part.tag == "gazebo":
            yield from _misspelt(part, _in_gazebo(), part)
            yield from _colours(part)


def sensor_words(subject: Subject) -> Iterator[Problem]:
    """Report misspelt elements of sensors, and words that are not a valid choice."""
    known = model_type().children["link"].children["sensor"]
    for part in subject.robot.gazebo:
        for sensor in part.find_all("sensor"):
            stack = [(sensor, known, part)]
            while stack:
                element, kind, above = stack.pop()
                yield from _misspelt(element, kind, sensor)
                if element is not sensor:
                    yield from _displaced(element, kind, sensor)
                if subject.robot.language == "urdf" and not _is_exchanged(
                    element, above
                ):
                    # ROS itself refuses such a word in SDF.
                    yield from _unfit_text(element, kind, sensor)
                yield from _negative(element, kind, sensor)
                stack += [
                    (child, kind.children[child.tag], element)
                    for child in element.children
                    if child.tag in kind.children
                ]


def beside_sensors(subject: Subject) -> Iterator[Problem]:
    """Report what Gazebo reads only in a sensor, and that stands behind it."""
    for part in subject.robot.gazebo if subject.robot.language == "urdf" else ():
        for child in part.children if part.tag == "gazebo" else ():
            if child.tag not in _OF_SENSOR:
                continue
            sensors = [s for s in part.find_all("sensor") if s.find(child.tag) is None]
            if len(sensors) == 1 and sensors[0].place.file == child.place.file:
                (sensor,) = sensors
                name = sensor.get("name")
                named = "" if name is None else f' name="{name}"'
                yield Problem.at(
                    child.place,
                    "warning",
                    "element-misplaced",
                    f"<{child.tag}> stands outside of {tag_text(sensor)} (line "
                    f"{sensor.place.line}), and is read only in it: Gazebo ignores it",
                    f"move <{child.tag}> into <sensor{named}> (line "
                    f"{sensor.place.line})",
                )


def _colours(part: Element) -> Iterator[Problem]:
    """Report a misspelt colour of Gazebo Classic."""
    known = [f"Gazebo/{colour}" for colour in vocabulary("gazebo_materials")]
    for material in part.find_all("material"):
        said = material.text.strip()
        near = [colour for colour in known if is_one_slip(said, colour)]
        if said not in known and len(near) == 1:
            yield Problem.at(
                material.place,
                "warning",
                "sdf-value",
                f"Gazebo Classic has no material {said}: the link has no colour there",
                write(material.place, said, near[0]),
            )


def _plain(name: str) -> str:
    return re.sub("[_-]", "", name).lower()


def _misspelt(
    element: Element, kind: ElementType, sensor: Element
) -> Iterator[Problem]:
    present = {child.tag for child in element.children}
    tags = {_plain(tag): tag for tag in (*kind.children, *_BESIDE)}
    for child in element.children if not kind.open else ():
        if child.tag in kind.children or child.tag in _BESIDE or ":" in child.tag:
            continue
        plain = _plain(child.tag)
        near = [
            tag
            for other, tag in tags.items()
            if is_one_slip(plain, other) and len(plain) > 2
        ]
        right = tags.get(plain) or (near[0] if len(near) == 1 else None)
        if element is sensor:
            right = right or _SYNONYMS.get(_plain(child.tag))
        if right is None or right in present:
            continue
        yield Problem.at(
            child.place,
            "warning",
            "element-misspelt",
            f"<{child.tag}> of {tag_text(sensor)} is not known; did you mean "
            f"<{right}>? Gazebo ignores it",
            rename_element(child.place, child.tag, right, f"write <{right}>"),
        )


def _displaced(
    element: Element, kind: ElementType, sensor: Element
) -> Iterator[Problem]:
    """Report children that only the sensor around knows, and does not have."""
    of_sensor = {*model_type().children["link"].children["sensor"].children, *_BESIDE}
    of_sensor -= {"frame_id"}  # Gazebo reads it nowhere, and gz_frame_id instead.
    for child in element.children if not kind.open else ():
        is_its_own = child.tag in kind.children
        if (
            is_its_own
            or child.tag not in of_sensor
            or sensor.find(child.tag) is not None
        ):
            continue
        is_next = element in sensor.children
        yield Problem.at(
            child.place,
            "warning",
            "element-misplaced",
            f"<{child.tag}> means nothing in <{element.tag}>: it belongs directly in "
            f"{tag_text(sensor)}, and Gazebo ignores it here",
            Fix(
                f"move <{child.tag}> out of <{element.tag}>, directly into "
                f"{tag_text(sensor)}",
                move_before(child.place, element.place) if is_next else (),
            ),
        )


def _negative(
    element: Element, kind: ElementType, sensor: Element
) -> Iterator[Problem]:
    """Report a standard deviation below zero, where SDF itself has no lower limit."""
    text = element.text.strip()
    if not element.tag.endswith("stddev") or not _BELOW_ZERO.fullmatch(text):
        return
    if value_fault(element, kind.text) is None:
        yield Problem.at(
            element.place,
            "warning",
            "sdf-value",
            f"<{element.tag}>{text}</{element.tag}> of {tag_text(sensor)} is less than "
            "0: a standard deviation is 0 or more",
            write(element.place, text, text[1:]),
        )


def _is_exchanged(element: Element, above: Element) -> bool:
    """Return whether a limit is less than the lower one, which another rule reports."""
    lower = [e for e in above.children if e.tag == _LOWER.get(element.tag)]
    try:
        return any(float(element.text) < float(each.text) for each in lower)
    except ValueError:
        return False


def _unfit_text(
    element: Element, kind: ElementType, sensor: Element
) -> Iterator[Problem]:
    """Report a text that Gazebo cannot read as the number or word that it needs."""
    fault = value_fault(element, kind.text)
    if fault is None or (element.tag in _ANGLES and "more than" in fault.reason):
        return
    text = element.text.strip()
    yield Problem.at(
        element.place,
        "warning",
        "sdf-value",
        f"<{element.tag}>{text}</{element.tag}> of {tag_text(sensor)} {fault.reason}: "
        "Gazebo does not read it as it is meant",
        write(element.place, text, fault.right) if fault.right else fault.hint,
    )
