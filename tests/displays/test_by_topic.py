"""Which displays show a topic: each says so itself."""

from __future__ import annotations

import pytest

from sambot_viz.displays.by_topic import displays_of_topic
from sambot_viz.displays.data.topic_display import TopicDisplay
from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.displays.robot_display import WantedQos
from sambot_viz.meanings import Meaning

QOS = WantedQos("Best Effort", "Volatile")


def names(topic: str, type_name: str) -> list[str]:
    return [d.kind.rpartition("/")[2] for d in displays_of_topic(topic, type_name)]


def test_every_type_that_a_display_draws_has_a_usual_display_that_draws_it() -> None:
    drawn = {
        meaning
        for display in DISPLAYS.values()
        if issubclass(display, TopicDisplay)
        for meaning in display.meanings
    }
    missing = {one for one in drawn if one.display is None}
    assert not missing, "a new display has a line for what it draws in Meaning"
    for meaning in Meaning:
        if meaning.display is not None:
            shown = displays_of_topic("/robot_description", meaning.value)
            assert shown[0].kind == meaning.display


@pytest.mark.parametrize(
    ("topic", "type_name", "shown"),
    [
        ("/scan", "sensor_msgs/msg/LaserScan", ["LaserScan"]),
        ("/tf_static", "tf2_msgs/msg/TFMessage", ["TF"]),
        ("/left/robot_description", "std_msgs/msg/String", ["RobotModel"]),
        ("/chatter", "std_msgs/msg/String", []),
        ("/imu", "sensor_msgs/msg/Imu", []),
        ("/untyped", "", []),
    ],
)
def test_a_topic_is_shown_by_the_displays_of_its_type(
    topic: str, type_name: str, shown: list[str]
) -> None:
    assert names(topic, type_name) == shown


@pytest.mark.parametrize(
    ("name", "topic", "type_name", "values"),
    [
        (
            "LaserScan",
            "/scan",
            "sensor_msgs/msg/LaserScan",
            {
                "Topic": "/scan",
                "Topic/Reliability Policy": "Best Effort",
                "Topic/Durability Policy": "Volatile",
            },
        ),
        (
            "RobotModel",
            "/robot_description",
            "std_msgs/msg/String",
            {
                "Description Topic": "/robot_description",
                "Description Topic/Reliability Policy": "Best Effort",
                "Description Topic/Durability Policy": "Volatile",
            },
        ),
        (
            "Map",
            "/map",
            "nav_msgs/msg/OccupancyGrid",
            {
                "Topic": "/map",
                "Topic/Reliability Policy": "Best Effort",
                "Topic/Durability Policy": "Volatile",
                "Update Topic": "/map_updates",
            },
        ),
        (
            "Map",
            "/map_updates",
            "map_msgs/msg/OccupancyGridUpdate",
            {"Topic": "/map", "Update Topic": "/map_updates"},
        ),
        # Its quality of service is not below the topic.
        (
            "DepthCloud",
            "/depth",
            "sensor_msgs/msg/Image",
            {"Depth Map Topic": "/depth"},
        ),
        # It is moved by them, and describes nothing.
        ("RobotModel", "/joint_states", "sensor_msgs/msg/JointState", {}),
        ("TF", "/tf", "tf2_msgs/msg/TFMessage", {}),
        ("Grid", "/scan", "sensor_msgs/msg/LaserScan", None),
    ],
)
def test_a_display_says_with_which_values_it_shows_a_topic(
    name: str, topic: str, type_name: str, values: dict[str, str] | None
) -> None:
    display = DISPLAYS[f"rviz_default_plugins/{name}"]
    assert display.topic_values(topic, type_name, QOS) == values
