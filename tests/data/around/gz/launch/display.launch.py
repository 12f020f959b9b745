import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import (
    DeclareLaunchArgument,
    ExecuteProcess,
    IncludeLaunchDescription,
)
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import Command, LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from ros_gz_bridge.actions import RosGzBridge
from ros_gz_sim.actions import GzServer


def generate_launch_description():
    share = get_package_share_directory("cart_description")
    gz_share = get_package_share_directory("ros_gz_sim")
    model = os.path.join(share, "urdf", "cart.urdf.xacro")
    config = os.path.join(share, "rviz", "cart.rviz")
    world = os.path.join(share, "world", "room.sdf")
    use_sim_time = LaunchConfiguration("use_sim_time")
    description = ParameterValue(Command(["xacro ", model]), value_type=str)

    robot_state_publisher = Node(
        package="robot_state_publisher",
        executable="robot_state_publisher",
        parameters=[
            {"robot_description": description},
            {"use_sim_time": use_sim_time},
        ],
    )
    robot_localization = Node(
        package="robot_localization",
        executable="ekf_node",
        name="ekf_filter_node",
        parameters=[
            os.path.join(share, "config/ekf.yaml"),
            {"use_sim_time": use_sim_time},
        ],
    )
    rviz = Node(package="rviz2", executable="rviz2", arguments=["-d", config])
    bridge = RosGzBridge(
        bridge_name="ros_gz_bridge",
        config_file=os.path.join(share, "config", "bridge_config.yaml"),
    )
    spawn = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(
            os.path.join(gz_share, "launch", "gz_spawn_model.launch.py")
        ),
        launch_arguments={
            "world": "room",
            "topic": "/robot_description",
            "entity_name": "cart",
        }.items(),
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument("use_sim_time", default_value="True"),
            ExecuteProcess(cmd=["gz", "sim", "-g"]),
            GzServer(world_sdf_file=world),
            bridge,
            robot_state_publisher,
            robot_localization,
            rviz,
            spawn,
        ]
    )
