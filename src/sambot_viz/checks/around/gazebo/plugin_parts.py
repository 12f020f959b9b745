"""Report plugins in the wrong part of a model, and links and remappings in them."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz.checks.around.files.gazebo import plugins
from sambot_viz.checks.around.gazebo.classic_plugins import OF_MODELS
from sambot_viz.edits import delete_attribute, write
from sambot_viz.errors import Fix, Problem, nearest
from sambot_viz.robot.model import Robot
from sambot_viz.robot.slips.vocabulary import is_one_slip

_CODE = "gazebo-plugin"
_LINKS = ("bodyName", "body_name", "link_name", "linkName")
"""Elements in which plugins of Gazebo name a link."""
_SCOPED = ("::", "/", "$")
_REMAPPING = re.compile(r"(\S+?)\s*(?:=:|:|=|->|\s)\s*(\S+)")
_CLASSIC = ("libgazebo_ros_", "libgazebo_ros2_control.so")
"""Beginnings of the plugins that come with Gazebo Classic for ROS 2."""
_MORE_OF_MODELS = re.compile(
    r"(?:lib)?(?:gz-sim\d*|ignition-gazebo\d*)-(?:ackermann-steering|diff-drive|"
    r"joint-controller|joint-position-controller|joint-state-publisher|"
    r"joint-trajectory-controller|mecanum-drive|odometry-publisher|pose-publisher|"
    r"tracked-vehicle|velocity-control)-system(?:\.so)?"
    r"|(?:lib)?(?:gz|ign)_ros2_control-system(?:\.so)?"
    r"|libgazebo_ros_joint_pose_trajectory\.so"
)
"""Other plugins that Gazebo loads only for a whole model."""


def plugins_of_links(robot: Robot) -> Iterator[Problem]:
    """Report a plugin of a model in a <gazebo> that refers to a link."""
    for part in robot.gazebo if robot.language == "urdf" else ():
        name = part.get("reference") or ""
        for plugin in part.find_all("plugin") if name in robot.links else ():
            file = plugin.get("filename") or ""
            if not _is_of_model(file):
                continue
            alone = all(child.tag == "plugin" for child in part.children)
            hint = f'write <gazebo> without reference="{name}"'
            edits = delete_attribute(part.place, "reference")
            if not alone:
                hint, edits = "move <plugin> into a <gazebo> without reference", ()
            yield Problem.at(
                part.place,
                "warning",
                _CODE,
                f"{file} is a plugin of the whole model, and with the reference here "
                f"it is in the link {name}: Gazebo does not load it",
                Fix(hint, edits),
            )


def _is_of_model(file: str) -> bool:
    is_classic = file.startswith(_CLASSIC) and file.endswith(OF_MODELS)
    return is_classic or _MORE_OF_MODELS.fullmatch(file) is not None


def words_in_plugins(robot: Robot) -> Iterator[Problem]:
    """Report links that a plugin names and the model lacks, and broken remappings."""
    for plugin in plugins(robot.gazebo):
        for fact in plugin.all(*_LINKS):
            known = [*robot.links]
            if fact.value in known or any(mark in fact.value for mark in _SCOPED):
                continue
            ends = (f"{fact.value}_link", fact.value.removesuffix("_link"))
            slips = [link for link in known if is_one_slip(fact.value, link)]
            near = next((each for each in (*ends, *slips) if each in known), None)
            near = near or nearest(fact.value, known, 0.8)
            if near is not None:
                yield Problem.at(
                    fact.place,
                    "warning",
                    _CODE,
                    f"the plugin {plugin.filename} is for the link {fact.value}, which "
                    f"does not exist: the model has {near}; Gazebo does not load it",
                    write(fact.place, fact.value, near),
                )
        for ros in plugin.element.find_all("ros"):
            for child in ros.find_all("remapping"):
                said = child.text.strip()
                parts = None if ":=" in said else _REMAPPING.fullmatch(said)
                if said and ":=" not in said and "$" not in said:
                    right = parts and f"{parts[1]}:={parts[2]}"
                    yield Problem.at(
                        child.place,
                        "warning",
                        _CODE,
                        f"<remapping>{said}</remapping> of {plugin.filename} is not "
                        "from:=to: the plugin keeps its own topic",
                        write(child.place, said, right)
                        if right
                        else "write from:=to, such as ~/out:=imu/data",
                    )
