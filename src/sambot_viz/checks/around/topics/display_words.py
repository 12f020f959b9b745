"""Report names in RViz configs that RViz does not know, and robots it cannot show."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.topics.display_settings import (
    OWN_PACKAGES,
    Settings,
    settings,
)
from sambot_viz.checks.around.words import meant_word
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import exchange, write, write_between
from sambot_viz.errors import Fix, Place, Problem, nearest
from sambot_viz.robot.slips.vocabulary import is_one_slip

_CLASS = re.compile(r"[A-Za-z][\w: /-]*")
_OF_ALL = ("Class", "Enabled", "Name", "Topic")
"""Properties that displays of other packages also have."""
_ON = ("Enabled", "Value")
"""Keys that switch a display on."""
_LIKE_PROPERTY, _LIKE_CLASS = 0.8, 0.87
_FRAMES, _FIXED = ("Target Frame", "Reference Frame"), "<Fixed Frame>"
"""Properties that name a frame, and the text that means the fixed frame."""


def unknown_frames_of_views(around: Surroundings) -> Iterator[Problem]:
    """Report a misspelt <Fixed Frame>, and misspelt links in its place."""
    for one in settings(around):
        for key in _FRAMES:
            said = one.values.get(key)
            if said is None or said.value == _FIXED:
                continue
            if is_one_slip(said.value, _FIXED):
                yield Problem.at(
                    said.place,
                    "warning",
                    "frame-unknown",
                    f"{key} is {said.value}, which is no frame: RViz knows only "
                    f"{_FIXED} for that of the whole view",
                    write(said.place, said.value, _FIXED),
                )
                continue
            near = [link for link in around.links if is_one_slip(said.value, link)]
            if said.value in around.links or len(near) != 1:
                continue
            if not around.said_elsewhere(said.value):
                yield Problem.at(
                    said.place,
                    "warning",
                    "frame-unknown",
                    f"{key} is {said.value}, which no link has: the model has "
                    f"{near[0]}",
                    write(said.place, said.value, near[0]),
                )


def unknown_settings(around: Surroundings) -> Iterator[Problem]:
    """Report misspelt classes and properties of RViz."""
    table = vocabulary("rviz_classes")
    classes = [
        f"{package}/{name.replace('_', ' ')}"
        for package in OWN_PACKAGES
        for name in table[package]
    ]
    for one in settings(around):
        package, _, name = one.owner.rpartition("/")
        kind = one.values.get("Class")
        near = nearest(one.owner, classes, _LIKE_CLASS) if kind else None
        if near is not None and kind is not None and one.owner not in classes:
            what = "display " if "Enabled" in one.keys else ""
            yield Problem.at(
                kind.place,
                "warning",
                "config-class",
                f"RViz has no {what}{one.owner}: it shows an error in its place",
                write(kind.place, one.owner, near),
            )
        elif kind is not None and not _CLASS.fullmatch(one.owner):
            yield _no_class(kind, one, classes)
        known = table["properties"]
        for key in one.keys.values():
            word = key.value.replace(" ", "_")
            if package in OWN_PACKAGES:
                right = meant_word(known, word, _LIKE_PROPERTY)
            else:
                slips = (each for each in _OF_ALL if is_one_slip(word, each))
                right = None if word in known else next(slips, None)
            right = (right or "").replace("_", " ")
            if right and right not in one.keys:
                follows = "which it needs: RViz leaves it out"
                if right != "Class":
                    follows = "whose default is used"
                yield Problem.at(
                    key.place,
                    "warning",
                    "config-property",
                    f"{name} has no property {key.value}, but {right}, {follows}",
                    write(key.place, key.value, right),
                )


def _no_class(kind: Fact, one: Settings, classes: list[str]) -> Problem:
    """Report a Class without a package; another key may have the class."""
    other = next((each for each in one.values.values() if each.value in classes), None)
    fix = Fix("write a class such as rviz_default_plugins/Grid")
    if other is not None:
        fix = exchange(
            f"write {other.value}, and {kind.value} there",
            (kind.place, kind.value),
            (other.place, other.value),
        )
    return Problem.at(
        kind.place,
        "warning",
        "config-class",
        f"RViz has no class {kind.value}: it shows an error in its place",
        fix,
    )


def switched_off(around: Surroundings) -> Iterator[Problem]:
    """Report displays without Enabled, which RViz leaves off."""
    for one in settings(around):
        kind = one.values.get("Class")
        given = any(is_one_slip(key, on) for key in one.keys for on in _ON)
        if one.above == "Displays" and kind is not None and not given:
            key = one.keys["Class"].place
            below, blanks = Place(key.file, key.line + 1, 1), (key.column or 1) - 1
            line = f"{' ' * blanks}Enabled: true\n"
            yield Problem.at(
                kind.place,
                "warning",
                "config-property",
                f"the display {kind.value.rpartition('/')[2]} has no Enabled: RViz "
                "leaves it switched off",
                write_between(below, below, line, "add Enabled: true"),
            )


def robots_without_source(around: Surroundings) -> Iterator[Problem]:
    """Report displays of a robot that name no file, or a prefix that no frame has."""
    for one in settings(around):
        if not one.above or one.owner.rpartition("/")[2] != "RobotModel":
            continue
        source, file = (one.values.get(f"Description {n}") for n in ("Source", "File"))
        if source is not None and source.value == "File" and not (file and file.value):
            yield Problem.at(
                source.place,
                "warning",
                "setup-description-topic",
                "the display RobotModel reads the robot from a file, and names none: "
                "it shows nothing",
                write(source.place, "File", "Topic"),
            )
        prefix = one.values.get("TF Prefix")
        name = prefix.value.strip("/") if prefix is not None else ""
        if prefix is None or not name or not around.links:
            continue
        if any(link.startswith(f"{name}/") for link in around.links):
            continue
        if any(e.kind == "Pose_V" and e.scoped for e in around.bridged):
            # A bridge carries the frames of Gazebo, which begin with the model's name.
            continue
        given = _frame_prefixes(around)
        unsure = given is None and (
            around.namespaced
            or any(node.parameter("frame_prefix") for node in around.running.started)
            or around.said_elsewhere(name)
        )
        if not unsure and name not in (given or ()):
            (right,) = given if given and len(given) == 1 else ("",)
            text = right or '""'
            yield Problem.at(
                prefix.place,
                "warning",
                "frame-unknown",
                f"the display RobotModel looks for frames that begin with {name}/, and "
                "no launch file gives them this prefix: each link has an error",
                write(
                    prefix.place,
                    prefix.value,
                    text,
                    hint=f"write TF Prefix: {text}",
                ),
            )


def _frame_prefixes(around: Surroundings) -> set[str] | None:
    """Return the prefixes that launch files give the frames; None when uncertain."""
    found = set[str]()
    for node in around.running.started:
        if node.executable == "robot_state_publisher":
            given = node.parameter("frame_prefix")
            is_known = (
                node.parameters_known if given is None else given.value is not None
            )
            if not is_known:
                return None
            found.add((given.value or "" if given is not None else "").strip("/"))
    return found if found and around.running.is_whole else None
