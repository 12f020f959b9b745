from launch import LaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare("sam_bot_odometry")
    bridged = PathJoinSubstitution([share, "config", "bridge_config.yaml"])
    filtered = PathJoinSubstitution([share, "config", "ekf.yaml"])
    return LaunchDescription(
        [
            Node(
                package="ros_gz_bridge",
                executable="parameter_bridge",
                parameters=[{"config_file": bridged}],
            ),
            Node(
                package="robot_localization",
                executable="ekf_node",
                name="ekf_filter_node",
                parameters=[filtered],
            ),
        ]
    )
