"""Displays that other packages bring to RViz: what they show, and what they need."""

from __future__ import annotations

from collections.abc import Mapping

from sambot_viz.text import text

_MOVEIT = "moveit_ros_visualization"
_JSK = "jsk_rviz_plugins"
_AUTOWARE = "Autoware"
PACKAGES: Mapping[str, str] = {
    "moveit_rviz_plugin": _MOVEIT,
    "moveit_task_constructor": "moveit_task_constructor_visualization",
    "jsk_rviz_plugin": _JSK,
    "rviz_plugins": _AUTOWARE,
    "octomap_rviz_plugin": "octomap_rviz_plugins",
    "rviz_plugin_tutorials": "the tutorials of RViz",
}
"""What class ids begin with → the name of the package, where that is another one."""

OTHERS: Mapping[str, tuple[str, str]] = {
    "autoware_mission_details_overlay_rviz_plugin/MissionDetailsDisplay": (
        "The distance and time to the goal, over the view",
        "autoware_internal_msgs/MissionRemainingDistanceTime",
    ),
    "autoware_overlay_rviz_plugin/SignalDisplay": (
        "Speed, gear and signals of a vehicle, over the view",
        "messages of autoware_vehicle_msgs",
    ),
    "autoware_perception_rviz_plugin/DetectedObjects": (
        "Objects that were detected, as boxes and polygons",
        "autoware_perception_msgs/DetectedObjects",
    ),
    "autoware_perception_rviz_plugin/PredictedObjects": (
        "Objects with the paths that they may take",
        "autoware_perception_msgs/PredictedObjects",
    ),
    "autoware_perception_rviz_plugin/TrackedObjects": (
        "Objects that are tracked, as boxes and polygons",
        "autoware_perception_msgs/TrackedObjects",
    ),
    "autoware_string_stamped_rviz_plugin/StringStampedOverlayDisplay": (
        "A text over the view",
        "autoware_internal_debug_msgs/StringStamped",
    ),
    "grid_map_rviz_plugin/GridMap": (
        "A surface with the heights and colours of a grid's layers",
        "grid_map_msgs/GridMap",
    ),
    "jsk_rviz_plugin/BoundingBoxArray": (
        "Boxes round what was recognised",
        "jsk_recognition_msgs/BoundingBoxArray",
    ),
    "jsk_rviz_plugin/LinearGauge": ("A number as a gauge", "std_msgs/Float32"),
    "jsk_rviz_plugin/NormalDisplay": (
        "The normals of a point cloud",
        "sensor_msgs/PointCloud2 with normals",
    ),
    "jsk_rviz_plugin/OverlayImage": ("An image over the view", "sensor_msgs/Image"),
    "jsk_rviz_plugin/OverlayMenu": (
        "A menu over the view",
        "jsk_rviz_plugins/OverlayMenu",
    ),
    "jsk_rviz_plugin/OverlayText": (
        "A text over the view",
        "jsk_rviz_plugins/OverlayText",
    ),
    "jsk_rviz_plugin/PeoplePositionMeasurementArray": (
        "Where people were detected",
        "people_msgs/PositionMeasurementArray",
    ),
    "jsk_rviz_plugin/PictogramArray": (
        "Pictograms in the scene",
        "jsk_rviz_plugins/PictogramArray",
    ),
    "jsk_rviz_plugin/PieChart": ("A number as a pie chart", "std_msgs/Float32"),
    "jsk_rviz_plugin/Plotter2D": ("A number as a curve over time", "std_msgs/Float32"),
    "jsk_rviz_plugin/PolygonArray": (
        "Polygons, filled or as lines",
        "jsk_recognition_msgs/PolygonArray",
    ),
    "jsk_rviz_plugin/SegmentArray": (
        "Pieces of lines",
        "jsk_recognition_msgs/SegmentArray",
    ),
    "jsk_rviz_plugin/String": ("A text over the view", "std_msgs/String"),
    "moveit_rviz_plugin/MotionPlanning": (
        "Planning with MoveIt: the start, the goal and the planned motion",
        "the robot's SRDF and the services of move_group",
    ),
    "moveit_rviz_plugin/PlanningScene": (
        "The robot and the obstacles that MoveIt plans with",
        "moveit_msgs/PlanningScene and the robot's SRDF",
    ),
    "moveit_rviz_plugin/RobotState": (
        "The robot in a state that MoveIt reports",
        "moveit_msgs/DisplayRobotState",
    ),
    "moveit_rviz_plugin/Trajectory": (
        "The motion that MoveIt has planned",
        "moveit_msgs/DisplayTrajectory",
    ),
    "moveit_task_constructor/Motion Planning Tasks": (
        "The stages of planned tasks and their solutions",
        "messages of moveit_task_constructor_msgs",
    ),
    "octomap_rviz_plugin/OccupancyGrid": (
        "The occupied cubes of an octree",
        "octomap_msgs/Octomap",
    ),
    "octomap_rviz_plugin/OccupancyMap": (
        "An octree as a map, seen from above",
        "octomap_msgs/Octomap",
    ),
    "rtabmap_rviz_plugins/Info": ("The state of RTAB-Map", "rtabmap_msgs/Info"),
    "rtabmap_rviz_plugins/MapCloud": (
        "The point clouds of RTAB-Map's map",
        "rtabmap_msgs/MapData",
    ),
    "rtabmap_rviz_plugins/MapGraph": (
        "The places of RTAB-Map's map and how they are linked",
        "rtabmap_msgs/MapGraph",
    ),
    "rviz_imu_plugin/Imu": (
        "The orientation and the acceleration of an IMU",
        "sensor_msgs/Imu",
    ),
    "rviz_plugin_tutorials/Imu": (
        "The acceleration of an IMU as an arrow",
        "sensor_msgs/Imu",
    ),
    "rviz_plugin_zed_od/ZedOdDisplay": (
        "Objects that a ZED camera has detected",
        "the messages of its driver",
    ),
    "rviz_plugins/Path": (
        "A planned path of a vehicle, with its speeds",
        "messages of autoware_planning_msgs",
    ),
    "rviz_plugins/PoseHistory": (
        "Where a pose was before, as a line",
        "geometry_msgs/PoseStamped",
    ),
    "rviz_plugins/Trajectory": (
        "A planned trajectory of a vehicle, with its speeds",
        "autoware_planning_msgs/Trajectory",
    ),
    "tier4_planning_factor_rviz_plugin/PlanningFactorRvizPlugin": (
        "Why a vehicle will stop or slow down, and where",
        "messages of autoware_internal_planning_msgs",
    ),
    "voxblox_rviz_plugin/VoxbloxMesh": (
        "The surface that Voxblox has made from depth images",
        "voxblox_msgs/Mesh",
    ),
}
"""Class id → what it shows, and what it shows that from."""

_OWN = ("rviz", "rviz_common", "rviz_default_plugins")
"""What class ids of RViz itself begin with."""


def package_of(kind: str) -> str:
    """Return the package that brings a class; empty for RViz itself, or for none."""
    prefix, _, name = kind.replace("::", "/").rpartition("/")
    if not prefix or not name or prefix in _OWN:
        return ""
    return PACKAGES.get(prefix, prefix)


def about_other(kind: str) -> str:
    """Describe a display of another package, and its requirements.

    Args:
        kind: its class id.

    Returns:
        Whole sentences; empty for a class of RViz itself.
    """
    package = text(package_of(kind), 100)
    if not package:
        return ""
    what, needs = OTHERS.get(kind.replace("::", "/"), ("", ""))
    if not what:
        return f"A display of {package}, not of RViz itself, which is not known here."
    return (
        f"{what}. A display of {package}, not of RViz itself: it would have to be "
        f"drawn here from {needs}."
    )
