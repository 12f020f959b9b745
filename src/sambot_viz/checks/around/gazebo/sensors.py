"""Report sensors that Gazebo leaves out, or that do not measure as intended."""

from __future__ import annotations

import math
from collections.abc import Container, Iterator

from sambot_viz.checks.around.files.gazebo import (
    SENSOR_FRAMES,
    Fact,
    facts,
    plugins,
    sensors,
)
from sambot_viz.checks.around.place import where
from sambot_viz.checks.clues import guess
from sambot_viz.checks.rule import number
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import (
    exchange,
    rename_attribute,
    rename_element,
    write,
    write_attribute,
)
from sambot_viz.errors import Fix, Problem, nearest
from sambot_viz.robot.model import Robot
from sambot_viz.robot.slips.exchanged_words import exchanged
from sambot_viz.robot.slips.units import usual_degrees
from sambot_viz.robot.slips.vocabulary import is_one_slip
from sambot_viz.robot.xml.element import Element

_SIMULATORS = ("Gazebo", "Gazebo Classic")
_OF_GZ = {"ray": "gpu_lidar", "lidar": "gpu_lidar"}
_OF_CLASSIC = {"lidar": "ray", "gpu_lidar": "gpu_ray"}
"""Type of a lidar that a simulator does not have → its replacement there."""
_OF_JOINTS = ("force_torque",)
_ANGLES = ("min_angle", "max_angle", "horizontal_fov")
_FRAMES = ("frame_id", "frame", "sensor_frame", "optical_frame_id", "link_frame")
_LIKENESS = 0.75
_TURN = 360.0
_FULL_TURN = 2 * math.pi + 0.01
_NEAR, _FAR = 1.0, 5.0
"""Limits are exchanged up to this minimum [m] or from this ratio; else one is wrong."""
_LIMITS = (("range", "min", "max"), ("clip", "near", "far"))


def sensors_without_link(robot: Robot) -> Iterator[Problem]:
    """Report sensors that belong to no link, or to a joint."""
    in_sdf = robot.language == "sdf"
    for part in robot.gazebo:
        if part.tag != "gazebo":
            # <ros2_control> has a separate kind of sensor.
            continue
        name = part.get("reference")
        joint = robot.joints.get(name or "")
        for sensor in part.find_all("sensor"):
            if name is None and not in_sdf:
                link = _frame_of(robot, sensor)
                yield _without_link(part, sensor, link)
            elif (
                joint is not None
                and (in_sdf or name not in robot.links)
                and sensor.get("type") not in _OF_JOINTS
            ):
                place = sensor.place if in_sdf else part.place
                yield Problem.at(
                    place,
                    "warning",
                    "gazebo-sensor",
                    f"{name} is a joint ({where(joint.place, place)}), and a joint has "
                    f"no sensor {_named(sensor)}: Gazebo leaves it out",
                    f'move the whole <sensor> into <link name="{joint.child}">'
                    if in_sdf
                    else f'write reference="{joint.child}", the link of that joint',
                )


def _without_link(part: Element, sensor: Element, link: str | None) -> Problem:
    name = link or "LINK"
    more = "" if link else ", with the name of the link that it is on"
    return Problem.at(
        part.place,
        "warning",
        "gazebo-sensor",
        f"the sensor {_named(sensor)} ({where(sensor.place, part.place)}) belongs to "
        "no link, because <gazebo> has no reference: Gazebo leaves it out",
        f'write <gazebo reference="{name}">{more}',
    )


def _named(sensor: Element) -> str:
    return sensor.get("name") or "without a name"


def _frame_of(robot: Robot, sensor: Element) -> str | None:
    """Return the link that a sensor names as its frame."""
    named = facts(sensor, *SENSOR_FRAMES)
    return next((fact.value for fact in named if fact.value in robot.links), None)


def lidars_of_the_other(robot: Robot) -> Iterator[Problem]:
    """Report lidars of a type that only the other Gazebo simulates."""
    known = [each for each in plugins(robot.gazebo) if each.generation is not None]
    made_for = {plugin.generation: plugin for plugin in known}
    is_classic = "classic" in made_for
    # A single one of Classic may itself be the fault.
    if len(made_for) != 1 or (is_classic and len(known) == 1):
        return
    plugin = made_for["classic" if is_classic else "gz"]
    for _, sensor in sensors(robot.gazebo):
        kind, place = sensor.get("type") or "", sensor.place
        right = (_OF_CLASSIC if is_classic else _OF_GZ).get(kind)
        if right is not None:
            other, own = _SIMULATORS if is_classic else _SIMULATORS[::-1]
            yield Problem.at(
                place,
                "warning",
                "gazebo-sensor",
                f'a lidar of type "{kind}" is for {other}: with {plugin.filename} '
                f"({where(plugin.element.place, place)}) the robot is for {own}, whose "
                f"lidars are of type {right}",
                write_attribute(place, "type", kind, right),
            )


def unknown_types(robot: Robot) -> Iterator[Problem]:
    """Report misspelt types of sensors."""
    known = vocabulary("sensor_types")
    parts = (part for part in robot.gazebo if part.tag == "gazebo")
    # A sensor of <ros2_control> has no type.
    in_gazebo = [sensor for part in parts for sensor in part.find_all("sensor")]
    for _, sensor in sensors(robot.gazebo):
        kind = (sensor.get("type") or "").strip()
        if sensor.get("type") is None:
            if any(part is sensor for part in in_gazebo):
                yield _typeless(sensor, known)
            continue
        bare = kind.lower().removesuffix("_sensor")
        same = (each for each in known if _words(each) == _words(bare))
        near = next(same, None) or nearest(bare, known, _LIKENESS)
        near = None if kind in known else near
        # A sensor of another program may have any type, and "lidar" as its name.
        is_first = next(iter(sensor.attributes), "") == "type"
        unread = kind not in known and near is None and is_first
        swapped = exchanged(sensor, "type", known) if unread else None
        if near is not None or swapped is not None:
            yield Problem.at(
                sensor.place,
                "warning",
                "gazebo-sensor",
                f'Gazebo has no sensors of type "{kind}": it leaves {_named(sensor)} '
                "out",
                swapped
                or write_attribute(
                    sensor.place, "type", sensor.get("type") or "", near or ""
                ),
            )


def sensors_twice(robot: Robot) -> Iterator[Problem]:
    """Report a second sensor of a link with the same name."""
    first: dict[tuple[str, str], Element] = {}
    for part in robot.gazebo:
        for sensor in part.find_all("sensor") if part.tag == "gazebo" else ():
            key = (part.get("reference") or "", sensor.get("name") or "")
            other = first.setdefault(key, sensor)
            if other is not sensor and other.place != sensor.place and all(key):
                yield Problem.at(
                    sensor.place,
                    "warning",
                    "gazebo-sensor",
                    f"{key[0]} has the sensor {key[1]} twice "
                    f"({where(other.place, sensor.place)}): Gazebo makes only one",
                    "delete one of the two, or give it another name",
                )


def _typeless(sensor: Element, known: Container[str]) -> Problem:
    """Report a sensor without a type, or with a misspelt type attribute."""
    hint: str | Fix = 'add type="…" with the kind of sensor, such as gpu_lidar'
    for name, value in sensor.attributes.items():
        if value in known and name != "name":
            said = f'write type="{value}"'
            hint = rename_attribute(sensor.place, name, "type", value, said)
    return Problem.at(
        sensor.place,
        "warning",
        "gazebo-sensor",
        f"the sensor {_named(sensor)} has no type: Gazebo leaves it out",
        hint,
    )


def _words(kind: str) -> list[str]:
    return sorted(kind.replace("-", "_").split("_"))


def sensor_values(robot: Robot) -> Iterator[Problem]:
    """Report angles of sensors in degrees, and exchanged limits."""
    for _, sensor in sensors(robot.gazebo):
        for element in sensor.iter():
            for fact in facts(element, *_ANGLES):
                angle = abs(fact.number or 0.0)
                if _FULL_TURN < angle <= _TURN:
                    yield _in_degrees(sensor, fact, fact.number or 0.0)
                elif angle > _TURN and element.tag in ("horizontal", "vertical"):
                    yield Problem.at(
                        fact.place,
                        "warning",
                        "gazebo-sensor",
                        f"{fact.value} is more than a full turn for the sensor "
                        f"{_named(sensor)} ({where(sensor.place, fact.place)}): Gazebo "
                        "reads radians",
                        "write the angle in radians, at most 3.1416 to each side",
                    )
            yield from _exchanged(sensor, element)
        for fact in facts(sensor, "update_rate"):
            if fact.number is not None and fact.number < 0:
                yield Problem.at(
                    fact.place,
                    "warning",
                    "gazebo-sensor",
                    f"the sensor {_named(sensor)} is to be updated {fact.value} times "
                    "in a second, which is less than never",
                    write(fact.place, fact.value, fact.value.lstrip("-")),
                )


def _in_degrees(sensor: Element, fact: Fact, degrees: float) -> Problem:
    clues = {"size", "usual degrees"} if usual_degrees(degrees) else {"size"}
    return guess(
        fact.place,
        "gazebo-sensor",
        f"{fact.value} is more than a full turn for the sensor {_named(sensor)} "
        f"({where(sensor.place, fact.place)}): it looks like degrees, but Gazebo "
        "reads radians",
        write(fact.place, fact.value, number(math.radians(degrees))),
        clues,
    )


def _exchanged(sensor: Element, element: Element) -> Iterator[Problem]:
    for tag, low, high in _LIMITS:
        least, most = facts(element, low), facts(element, high)
        if element.tag != tag or not least or not most:
            continue
        one, other = least[0].number, most[0].number
        if one is not None and other is not None and one > other:
            fix = Fix(f"write less than {number(other)} for <{low}>")
            if other <= _NEAR or one >= _FAR * other:
                fix = exchange(
                    f"exchange {number(one)} and {number(other)}",
                    (least[0].place, least[0].value),
                    (most[0].place, most[0].value),
                )
            yield Problem.at(
                least[0].place,
                "warning",
                "gazebo-sensor",
                f"<{low}> of the sensor {_named(sensor)} is {number(one)} m, and "
                f"<{high}> ({where(most[0].place, least[0].place)}) is less: nothing "
                "is in its range",
                fix,
            )


def misspelt_frames(robot: Robot) -> Iterator[Problem]:
    """Report a misspelt frame, and a frame in an element that Gazebo does not read."""
    for _, sensor in sensors(robot.gazebo):
        for fact in facts(sensor, *SENSOR_FRAMES):
            near = [link for link in robot.links if is_one_slip(fact.value, link)]
            if fact.value not in robot.links and len(near) == 1:
                yield Problem.at(
                    fact.place,
                    "warning",
                    "frame-unknown",
                    f"the sensor {_named(sensor)} uses the frame {fact.value}, which "
                    f"is not a link of the model: it has {near[0]} "
                    f"({where(robot.links[near[0]].place, fact.place)})",
                    write(fact.place, fact.value, near[0]),
                )
        if facts(sensor, *SENSOR_FRAMES) or sensor.find("plugin") is not None:
            continue
        for fact in facts(sensor, *_FRAMES):
            if fact.value not in robot.links:
                continue
            tag = next(c.tag for c in sensor.children if c.place == fact.place)
            yield Problem.at(
                fact.place,
                "warning",
                "gazebo-element-unknown",
                f"Gazebo does not read <{tag}> of the sensor {_named(sensor)} "
                f"({where(sensor.place, fact.place)}): its frame is then a long name "
                "that no transform has",
                rename_element(fact.place, tag, "gz_frame_id", "write <gz_frame_id>"),
            )


def frames_of_sensors(robot: Robot) -> Iterator[Problem]:
    """Report a sensor whose frame is the link of another sensor."""
    carriers = {link: sensor for link, sensor in sensors(robot.gazebo)}
    parents = {joint.child: joint.parent for joint in robot.joints.values()}
    for link, sensor in sensors(robot.gazebo):
        for fact in facts(sensor, *SENSOR_FRAMES)[:1]:
            other = carriers.get(fact.value)
            if other is None or fact.value == link or link not in robot.links:
                continue
            if _related(parents, link, fact.value):
                continue
            yield Problem.at(
                fact.place,
                "warning",
                "gazebo-sensor",
                f"the sensor {_named(sensor)} is on {link}, and its frame here is "
                f"{fact.value}, which carries {_named(other)} "
                f"({where(other.place, fact.place)}): what it sees is drawn in the "
                "wrong place",
                write(fact.place, fact.value, link),
            )


def _related(parents: dict[str, str], one: str, other: str) -> bool:
    """Return whether one of two links hangs below the other one."""
    return other in _above(parents, one) or one in _above(parents, other)


def _above(parents: dict[str, str], link: str) -> Iterator[str]:
    # A model here has no cycles.
    while link in parents:
        link = parents[link]
        yield link
