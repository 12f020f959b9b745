"""All displays this program knows: a new one is a new file and a row here.

Their modules are imported when they are asked for: a robot needs three of them, and the
others take as long to import as the rest of the program.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from importlib import import_module
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from sambot_viz.displays.display import Display
    from sambot_viz.rviz import Property


class _DisplayRow(NamedTuple):
    """A display: its module in this package, its class, a sentence about it."""

    module: str
    name: str
    help: str


_ROWS: dict[str, _DisplayRow] = {
    "rviz_default_plugins/AccelStamped": _DisplayRow(
        "data.vectors", "AccelStampedDisplay", "An acceleration as arrows."
    ),
    "rviz_default_plugins/Axes": _DisplayRow(
        "axes", "AxesDisplay", "The axes of a frame."
    ),
    "rviz_default_plugins/Camera": _DisplayRow(
        "data.image.camera_display",
        "CameraDisplay",
        "The pictures of a camera with the scene over them, in the panel Images.",
    ),
    "rviz_default_plugins/CameraInfo": _DisplayRow(
        "data.camera_info_display",
        "CameraInfoDisplay",
        "What a camera sees, as a pyramid.",
    ),
    "rviz_default_plugins/DepthCloud": _DisplayRow(
        "data.depth_cloud.depth_cloud",
        "DepthCloudDisplay",
        "The points of a depth image.",
    ),
    "rviz_default_plugins/Effort": _DisplayRow(
        "data.effort.effort",
        "EffortDisplay",
        "Torque of each revolute joint, as a circle.",
    ),
    "rviz_default_plugins/FluidPressure": _DisplayRow(
        "data.cloud.measurements",
        "FluidPressureDisplay",
        "Pressures as coloured points.",
    ),
    "rviz_default_plugins/GridCells": _DisplayRow(
        "data.grid_cells", "GridCellsDisplay", "Cells of a grid, such as obstacles."
    ),
    "rviz_default_plugins/Grid": _DisplayRow(
        "grid", "GridDisplay", "A grid in a plane through the origin of a frame."
    ),
    "rviz_common/Group": _DisplayRow("group", "GroupDisplay", "A group of displays."),
    "rviz_default_plugins/Illuminance": _DisplayRow(
        "data.cloud.measurements",
        "IlluminanceDisplay",
        "Brightnesses as coloured points.",
    ),
    "rviz_default_plugins/Image": _DisplayRow(
        "data.image.image_display",
        "ImageDisplay",
        "The pictures of a camera, in the panel Images.",
    ),
    "rviz_default_plugins/InteractiveMarkers": _DisplayRow(
        "data.interactive_markers.interactive_display",
        "InteractiveMarkersDisplay",
        "Markers with handles of a program, which are moved by hand.",
    ),
    "rviz_default_plugins/LaserScan": _DisplayRow(
        "data.cloud.laser_scan",
        "LaserScanDisplay",
        "The points that a laser scanner measures.",
    ),
    "rviz_default_plugins/Map": _DisplayRow(
        "data.map", "MapDisplay", "An occupancy grid, such as a map or a costmap."
    ),
    "rviz_default_plugins/MarkerArray": _DisplayRow(
        "data.markers.marker_displays",
        "MarkerArrayDisplay",
        "Many shapes and texts that a program draws.",
    ),
    "rviz_default_plugins/Marker": _DisplayRow(
        "data.markers.marker_displays",
        "MarkerDisplay",
        "Shapes and texts that a program draws.",
    ),
    "rviz_default_plugins/Odometry": _DisplayRow(
        "data.poses.odometry_display",
        "OdometryDisplay",
        "Current and past robot poses, as arrows or axes.",
    ),
    "nav2_rviz_plugins/ParticleCloud": _DisplayRow(
        "data.poses.particle_cloud",
        "ParticleCloudDisplay",
        "The particles of Nav2's localisation; those with more weight are longer.",
    ),
    "rviz_default_plugins/Path": _DisplayRow(
        "data.path", "PathDisplay", "The path that a robot is to follow."
    ),
    "rviz_default_plugins/PointCloud2": _DisplayRow(
        "data.cloud.point_clouds",
        "PointCloud2Display",
        "Points, such as those of a 3D scanner.",
    ),
    "rviz_default_plugins/PointCloud": _DisplayRow(
        "data.cloud.point_clouds",
        "PointCloudDisplay",
        "Points, in the older kind of message.",
    ),
    "rviz_default_plugins/PointStamped": _DisplayRow(
        "data.point_stamped", "PointStampedDisplay", "A single point."
    ),
    "rviz_default_plugins/Polygon": _DisplayRow(
        "data.polygon",
        "PolygonDisplay",
        "The outline of a polygon, such as a footprint.",
    ),
    "rviz_default_plugins/PoseArray": _DisplayRow(
        "data.poses.pose_array",
        "PoseArrayDisplay",
        "Many poses, such as the particles of a localisation.",
    ),
    "rviz_default_plugins/Pose": _DisplayRow(
        "data.poses.pose", "PoseDisplay", "A pose as an arrow or as axes."
    ),
    "rviz_default_plugins/PoseWithCovariance": _DisplayRow(
        "data.poses.pose", "PoseWithCovarianceDisplay", "A pose with its uncertainty."
    ),
    "rviz_default_plugins/Range": _DisplayRow(
        "data.range",
        "RangeDisplay",
        "What an ultrasonic or infrared sensor measures, as a cone.",
    ),
    "rviz_default_plugins/RelativeHumidity": _DisplayRow(
        "data.cloud.measurements",
        "RelativeHumidityDisplay",
        "Humidities as coloured points.",
    ),
    "rviz_default_plugins/RobotModel": _DisplayRow(
        "robot_model.robot_model", "RobotModelDisplay", "A robot, posed by its joints."
    ),
    "rviz_default_plugins/Temperature": _DisplayRow(
        "data.cloud.measurements",
        "TemperatureDisplay",
        "Temperatures as coloured points.",
    ),
    "rviz_default_plugins/TF": _DisplayRow(
        "tf.tf", "TfDisplay", "The frames and their tree."
    ),
    "rviz_default_plugins/TwistStamped": _DisplayRow(
        "data.vectors", "TwistStampedDisplay", "A velocity as arrows."
    ),
    "rviz_default_plugins/Wrench": _DisplayRow(
        "data.vectors", "WrenchDisplay", "A force and a torque as arrows."
    ),
}


class DisplayClasses(Mapping[str, "type[Display]"]):
    """Display classes by their names in a `.rviz` file."""

    def __getitem__(self, kind: str) -> type[Display]:
        """Import a display class.

        Raises:
            KeyError: there is none of that kind.
        """
        row = _ROWS[kind]
        module = import_module(f"sambot_viz.displays.{row.module}")
        found: type[Display] = getattr(module, row.name)
        return found

    def __contains__(self, kind: object) -> bool:
        """Look for a kind, without its module."""
        return kind in _ROWS

    def __iter__(self) -> Iterator[str]:
        """Go over the kinds."""
        return iter(_ROWS)

    def __len__(self) -> int:
        """Count them."""
        return len(_ROWS)

    def help_of(self, kind: str) -> str:
        """Return the help of a display, in a sentence."""
        return _ROWS[kind].help


class _DeclaredProperties(Mapping[str, "Sequence[Property]"]):
    """The properties that each display declares."""

    def __getitem__(self, kind: str) -> Sequence[Property]:
        return DISPLAYS[kind].properties

    def __iter__(self) -> Iterator[str]:
        return iter(DISPLAYS)

    def __len__(self) -> int:
        return len(DISPLAYS)


DISPLAYS = DisplayClasses()
PROPERTIES: Mapping[str, Sequence[Property]] = _DeclaredProperties()
