"""The properties of a RobotModel, in RViz's order."""

from __future__ import annotations

from sambot_viz.displays.robot_model.link_settings import LINK_TREE_PROPERTIES
from sambot_viz.displays.robot_model.robot_source import FILE
from sambot_viz.rviz import (
    BoolProperty,
    EnumProperty,
    FileProperty,
    FloatProperty,
    GroupProperty,
    KeptProperty,
    Property,
    StringProperty,
    TopicProperty,
)

ROBOT_MODEL_PROPERTIES: tuple[Property, ...] = (
    BoolProperty(
        "Visual Enabled", default=True, help="Show the visual shapes of the links."
    ),
    BoolProperty(
        "Collision Enabled",
        default=False,
        help="Show the collision shapes of the links.",
    ),
    GroupProperty(
        "Mass Properties",
        help="What the <inertial> elements say.",
        children=(
            BoolProperty(
                "Mass",
                default=False,
                help="Show each mass as a ball of lead of that mass.",
            ),
            BoolProperty(
                "Inertia",
                default=False,
                help="Show each inertia as the box that has it.",
            ),
        ),
    ),
    FloatProperty(
        "Update Interval",
        default=0.0,
        minimum=0.0,
        unit="s",
        help="Seconds between updates; joints move at once here, whatever it says.",
        support="approximate",
    ),
    FloatProperty(
        "Alpha",
        default=1.0,
        minimum=0.0,
        maximum=1.0,
        help="How opaque the links are: 0 is invisible, 1 opaque.",
    ),
    EnumProperty(
        "Description Source",
        default="Topic",
        options=("Topic", "File"),
        help="The robot that was opened, or a model file of its own.",
    ),
    FileProperty(
        FILE,
        default="",
        help="The model file to show.",
        hidden_unless=("Description Source", "File"),
    ),
    TopicProperty(
        "Description Topic",
        default="",
        help="Kept for RViz; here the robot that was opened takes its place.",
        hidden_unless=("Description Source", "Topic"),
        support="approximate",
    ),
    StringProperty(
        "TF Prefix",
        default="",
        help="The frame of a link is <prefix>/<link> when this is not empty.",
    ),
    KeptProperty(
        "Robot Description",
        support="approximate",
        note="the parameter of ROS 1; the opened robot takes its place",
    ),
    *LINK_TREE_PROPERTIES,
)
