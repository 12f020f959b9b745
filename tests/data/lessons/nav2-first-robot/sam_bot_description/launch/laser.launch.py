from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    pose = ["0.1", "0", "0.2", "0", "0", "0"]
    return LaunchDescription(
        [
            Node(
                package="tf2_ros",
                executable="static_transform_publisher",
                arguments=[*pose, "base_link", "base_laser"],
            ),
        ]
    )
