"""Finds the one <model> of an SDF file, and reports other content."""

from __future__ import annotations

import numpy as np

from sambot_viz.robot.findings import ModelFindings, tag_text
from sambot_viz.robot.sdf.fields import pose_of
from sambot_viz.robot.sdf.loose_text import loose_text
from sambot_viz.robot.sdf.old_versions import NEWEST, OLDEST, Version, version_of
from sambot_viz.robot.sdf.wording import REFUSED, and_list
from sambot_viz.robot.xml.element import Element

_MOST_MODELS = 5
_ENTITIES = ("model", "light", "actor")


def find_model(
    document: Element, findings: ModelFindings
) -> tuple[Element, Version] | None:
    """Return the model of a document and its version.

    Returns:
        None when there is no such model; the findings say so.
    """
    version = _version(document, findings)
    models = document.find_all("model")
    world = document.find("world")
    if world is not None:
        _refuse_world(world, findings)
        return None
    if not models:
        _refuse_without_model(document, findings)
        return None
    others = [e for e in document.children if e.tag in _ENTITIES and e is not models[0]]
    if others:
        names = and_list(f"<{e.tag}> {e.get('name')}" for e in [models[0], *others])
        findings.reject(
            "sdf-not-one-model",
            f"ROS reads an SDF file with one <model> only, here are {names}; {REFUSED}",
            _without_others(document, _robot_in(document)),
            others[0],
        )
    _check_rest(document, findings)
    model = _robot_in(document) or models[0]
    _check_pose(model, version, findings)
    return model, version


def _robot_in(parent: Element) -> Element | None:
    """Return the only model with joints; None where there is none or several."""
    models = [m for m in parent.find_all("model") if m.find("joint") is not None]
    return models[0] if len(models) == 1 else None


def _without_others(document: Element, robot: Element | None) -> str:
    """Advise on the models, lights and actors beside a robot."""
    if robot is None:
        return "put each into a file of its own"
    others = [e for e in document.children if e.tag in _ENTITIES and e is not robot]
    return "delete " + and_list(
        f"<{e.tag}> {e.get('name')} (line {e.place.line})" for e in others
    )


def _version(document: Element, findings: ModelFindings) -> Version:
    text = document.get("version")
    version = version_of(text or "")
    if version is not None:
        return version
    newest = Version(NEWEST)
    findings.reject(
        "sdf-version",
        f'ROS does not read the version "{text}" of SDF, only 1.{OLDEST} to '
        f"1.{NEWEST}; it refuses the model"
        if text is not None
        else f"<sdf> has no version; {REFUSED}",
        'write <sdf version="1.8">',
        document,
        "version",
    )
    return newest


def _refuse_world(world: Element, findings: ModelFindings) -> None:
    robot = _robot_in(world)
    models = [m.get("name") or "?" for m in world.find_all("model")]
    shown = ", ".join(models[:_MOST_MODELS])
    more = f" with the models {shown}" if len(models) > 1 else ""
    more = f" with the model {shown}" if len(models) == 1 else more
    findings.reject(
        "sdf-world",
        f"this is a world for Gazebo{more}; ROS reads an SDF file with one <model> "
        "directly in <sdf>",
        "open the file of the robot"
        if robot is None
        else f"delete {tag_text(world)} and </world>, and all between them but the "
        f"<model> {robot.get('name')} (line {robot.place.line}); or open the file of "
        "the robot",
        world,
    )


def _refuse_without_model(document: Element, findings: ModelFindings) -> None:
    if document.find("robot") is not None:
        message = "<robot> of URDF is inside <sdf>"
        hint = "delete <sdf> and </sdf>: then it is a URDF file"
    elif document.find("include") is not None:
        message = "this file only includes a model, which ROS does not find"
        hint = "open the file of that model"
    else:
        message = "there is no <model> directly in <sdf>"
        hint = 'put the links and joints into <model name="my_robot">'
    findings.reject("sdf-not-one-model", f"{message}; {REFUSED}", hint, document)


def _check_rest(document: Element, findings: ModelFindings) -> None:
    """Report content beside the model, which ROS ignores."""
    text = loose_text(document)
    if text:
        findings.warn(
            "sdf-text-not-read",
            f"the text {text} directly in <sdf> is not read",
            "delete it",
            document,
        )
    for element in document.children:
        if element.tag == "include":
            findings.reject(
                "sdf-include",
                f"<include> beside the model: ROS does not find such models; {REFUSED}",
                "delete it",
                element,
            )
        elif element.tag not in _ENTITIES and ":" not in element.tag:
            findings.warn(
                "sdf-element-unknown",
                f"<{element.tag}> is beside the <model>, where ROS ignores it",
                "move it into the <model>",
                element,
            )


def _check_pose(model: Element, version: Version, findings: ModelFindings) -> None:
    pose = model.find("pose")
    if pose is None:
        return
    moved = not np.array_equal(pose_of(model, findings), np.eye(4))
    if moved or version.relative_to(pose):
        findings.reject(
            "sdf-model-pose",
            "robot_state_publisher refuses a <pose> of the <model>: where the robot "
            "stands belongs to the world, not to the robot",
            "delete the line; Gazebo gets the height from the launch file (spawn "
            "argument z)",
            pose,
        )
