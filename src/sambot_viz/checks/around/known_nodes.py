"""Whether all that a package starts is known, so that what it lacks is certain."""

from __future__ import annotations

from sambot_viz.checks.around.files.launch import NODES, LaunchFile
from sambot_viz.checks.around.files.launch_values import SHARE, keyword
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.launch_files import call_name

_PACKAGES = frozenset(
    """
    gazebo_ros joint_state_publisher joint_state_publisher_gui nav2_amcl nav2_bringup
    nav2_lifecycle_manager nav2_map_server robot_localization robot_state_publisher
    ros_gz_bridge ros_gz_sim ros_ign_bridge ros_ign_gazebo rviz2 slam_toolbox tf2_ros
    """.split()
)
_OF_WORLD = frozenset({"earth", "map", "odom", "world"})
"""Frames that programs publish, and no model."""
_VIEWERS = frozenset(
    """
    joint_state_publisher joint_state_publisher_gui robot_state_publisher ros_gz_bridge
    ros_gz_sim rviz2
    """.split()
)
_OPEN = frozenset({"ComposableNodeContainer", "LoadComposableNodes", "OpaqueFunction"})


def starts_only_known(around: Surroundings) -> bool:
    """Tell whether the launch files start Gazebo, and only nodes that are known."""
    launches = around.launches
    return any(launch.may_start for launch in launches) and all(
        _is_known(launch, around) for launch in launches
    )


def _is_known(launch: LaunchFile, around: Surroundings) -> bool:
    text = launch.values.text
    for call in launch.calls:
        name = call_name(call.func)
        if name in _OPEN:
            return False
        if name in NODES and text(keyword(call, "package")) not in _PACKAGES:
            return False
        if name == "IncludeLaunchDescription":
            source = text(keyword(call, "launch_description_source", 0)) or ""
            package = source.removeprefix(SHARE).partition("/")[0]
            if package not in around.names and package not in _PACKAGES:
                return False
    return True


def may_publish(around: Surroundings, frame: str) -> bool:
    """Tell whether a node of the packages may publish a frame that is no link."""
    if any(frame == value.strip("/") for p in around.parameters for value in p.values):
        return True
    if any(plugin.is_drive for plugin in around.plugins) and frame == "odom":
        return True
    if frame not in _OF_WORLD:
        return around.said_elsewhere(frame)
    return any(
        not _is_known(launch, around) or not _shows_only(launch)
        for launch in around.launches
    )


def _shows_only(launch: LaunchFile) -> bool:
    """True for a launch file whose nodes publish no frames but those of the model."""
    text = launch.values.text
    return all(
        text(keyword(call, "package")) in _VIEWERS
        for call in launch.calls
        if call_name(call.func) in NODES
    )
