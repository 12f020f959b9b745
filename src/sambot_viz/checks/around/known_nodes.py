"""Whether all that a package starts is known, so that what it lacks is certain."""

from __future__ import annotations

from sambot_viz.checks.around.files.launch import NODES, LaunchFile
from sambot_viz.checks.around.files.launch_values import SHARE, keyword
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.launch_files import call_name

PACKAGES = frozenset(
    """
    gazebo_ros joint_state_publisher joint_state_publisher_gui nav2_amcl nav2_bringup
    nav2_lifecycle_manager nav2_map_server robot_localization robot_state_publisher
    ros_gz_bridge ros_gz_sim ros_ign_bridge ros_ign_gazebo rviz2 slam_toolbox tf2_ros
    """.split()
)
"""Packages whose nodes are known."""
_OPEN = frozenset({"ComposableNodeContainer", "LoadComposableNodes", "OpaqueFunction"})


def starts_only_known(around: Surroundings) -> bool:
    """Tell whether the launch files start Gazebo, and only nodes that are known."""
    launches = around.launches
    return any(launch.may_start for launch in launches) and all(
        is_known(launch, around) for launch in launches
    )


def is_known(launch: LaunchFile, around: Surroundings) -> bool:
    """Tell whether a launch file starts only nodes that are known."""
    text = launch.values.text
    for call in launch.calls:
        name = call_name(call.func)
        if name in _OPEN:
            return False
        if name in NODES and text(keyword(call, "package")) not in PACKAGES:
            return False
        if name == "IncludeLaunchDescription":
            source = text(keyword(call, "launch_description_source", 0)) or ""
            package = source.removeprefix(SHARE).partition("/")[0]
            if package not in around.names and package not in PACKAGES:
                return False
    return True
