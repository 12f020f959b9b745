"""The properties of a RobotModel, of its links and of its joints, in RViz's order."""

from __future__ import annotations

from sambot_viz.displays.robot_model.robot_source import FILE, TOPIC
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

STYLES = (
    "Links in Alphabetic Order",
    "Joints in Alphabetic Order",
    "Tree of links",
    "Tree of links and joints",
)
STYLE = "Links/Link Tree Style"
ALL_ENABLED = "Links/All Links Enabled"
COLLISIONS = "Collision Enabled"
MASS_PROPERTIES = "Mass Properties"
BALANCE = f"{MASS_PROPERTIES}/Balance"
ALL_LINKS_ENABLED = BoolProperty(
    "All Links Enabled", default=True, help="Show or hide all links."
)

LINK_TREE_PROPERTIES: tuple[Property, ...] = (
    GroupProperty(
        "Links",
        help="The links of the robot, each with its own settings.",
        open_keys=True,
        children=(
            EnumProperty(
                "Link Tree Style",
                default=STYLES[0],
                options=STYLES,
                help="How RViz lists the links; here the list is always alphabetic.",
                support="approximate",
            ),
            BoolProperty(
                "Expand Tree",
                default=False,
                help="Kept for RViz: its tree of links is not drawn here.",
                support="approximate",
            ),
            BoolProperty(
                "Expand Link Details",
                default=False,
                help="Kept for RViz: its tree of links is not drawn here.",
                support="approximate",
            ),
            BoolProperty(
                "Expand Joint Details",
                default=False,
                help="Kept for RViz: its tree of links is not drawn here.",
                support="approximate",
            ),
            ALL_LINKS_ENABLED,
        ),
    ),
    GroupProperty("Joints", help="The joints.", open_keys=True, read_only=True),
    GroupProperty(
        "Link Tree", help="The links as a tree.", open_keys=True, read_only=True
    ),
    GroupProperty(
        "Link/Joint Tree",
        help="The links and joints as a tree.",
        open_keys=True,
        read_only=True,
    ),
)
LINK_PROPERTIES: tuple[Property, ...] = (
    BoolProperty("Value", default=True, help="Show the link."),
    FloatProperty(
        "Alpha",
        default=1.0,
        minimum=0.0,
        maximum=1.0,
        help="How opaque the link is, on top of the robot's own Alpha.",
    ),
    BoolProperty("Show Trail", default=False, help="Draw the path of the link."),
    BoolProperty("Show Axes", default=False, help="Draw the axes of the link."),
)
JOINT_PROPERTIES: tuple[Property, ...] = (
    BoolProperty("Value", default=True, help="Show the links that the joint carries."),
    BoolProperty("Show Axes", default=False, help="Draw the axes of the joint."),
    BoolProperty(
        "Show Joint Axis", default=False, help="Draw the axis the joint moves about."
    ),
)


ROBOT_MODEL_PROPERTIES: tuple[Property, ...] = (
    BoolProperty(
        "Visual Enabled", default=True, help="Show the visual shapes of the links."
    ),
    BoolProperty(
        COLLISIONS, default=False, help="Show the collision shapes of the links."
    ),
    GroupProperty(
        MASS_PROPERTIES,
        help="What the <inertial> elements say, one by one and all together.",
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
            BoolProperty(
                "Balance",
                default=False,
                help="Show the robot's centre of mass, the point below it, and what "
                "the robot stands on; RViz does not have it, and ignores it.",
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
        help="The robot of a topic, or of a model file.",
    ),
    FileProperty(
        FILE,
        default="",
        help="The model file to show.",
        hidden_unless=("Description Source", "File"),
    ),
    TopicProperty(
        TOPIC,
        default="",
        help="Where the robot is described, with a recording or a live robot; the "
        "robot that was opened when this is empty.",
        hidden_unless=("Description Source", "Topic"),
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
