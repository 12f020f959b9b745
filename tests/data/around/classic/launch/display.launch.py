import os

import launch_ros
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import Command, LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    share = launch_ros.substitutions.FindPackageShare(package="cart_description").find(
        "cart_description"
    )
    model = os.path.join(share, "urdf/cart.urdf.xacro")
    config = os.path.join(share, "rviz/cart.rviz")
    use_sim_time = LaunchConfiguration("use_sim_time")
    description = ParameterValue(Command(["xacro ", model]), value_type=str)

    return LaunchDescription(
        [
            DeclareLaunchArgument(name="use_sim_time", default_value="True"),
            ExecuteProcess(cmd=["gazebo", "-s", "libgazebo_ros_factory.so"]),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[
                    {"robot_description": description},
                    {"use_sim_time": use_sim_time},
                ],
            ),
            Node(
                package="gazebo_ros",
                executable="spawn_entity.py",
                arguments=["-entity", "cart", "-topic", "robot_description"],
            ),
            Node(
                package="robot_localization",
                executable="ekf_node",
                name="ekf_filter_node",
                parameters=[
                    os.path.join(share, "config/ekf.yaml"),
                    {"use_sim_time": use_sim_time},
                ],
            ),
            Node(package="rviz2", executable="rviz2", arguments=["-d", config]),
        ]
    )
