"""The meanings that messages may have, and which display usually draws each."""

from __future__ import annotations

from enum import Enum


class Meaning(Enum):
    """The meaning of a message; its value names the form of such a message.

    The form is the ROS type of that name, with its fields and units. Messages of other
    schemas are converted to it, so that a display reads one form.
    """

    TRANSFORMS = "tf2_msgs/msg/TFMessage"
    TEXT = "std_msgs/msg/String"
    """A text; of topics named robot_description it is a robot."""
    JOINTS = "sensor_msgs/msg/JointState"

    CLOUD = "sensor_msgs/msg/PointCloud2"
    OLD_CLOUD = "sensor_msgs/msg/PointCloud"
    SCAN = "sensor_msgs/msg/LaserScan"
    CONE = "sensor_msgs/msg/Range"
    GRID = "nav_msgs/msg/OccupancyGrid"
    GRID_UPDATE = "map_msgs/msg/OccupancyGridUpdate"
    CELLS = "nav_msgs/msg/GridCells"

    POSE = "geometry_msgs/msg/PoseStamped"
    POSE_WITH_COVARIANCE = "geometry_msgs/msg/PoseWithCovarianceStamped"
    POSES = "geometry_msgs/msg/PoseArray"
    PARTICLES = "nav2_msgs/msg/ParticleCloud"
    PATH = "nav_msgs/msg/Path"
    ODOMETRY = "nav_msgs/msg/Odometry"
    POINT = "geometry_msgs/msg/PointStamped"
    POLYGON = "geometry_msgs/msg/PolygonStamped"
    ACCELERATION = "geometry_msgs/msg/AccelStamped"
    VELOCITY = "geometry_msgs/msg/TwistStamped"
    FORCE = "geometry_msgs/msg/WrenchStamped"

    MARKER = "visualization_msgs/msg/Marker"
    MARKERS = "visualization_msgs/msg/MarkerArray"
    INTERACTIVE_MARKERS = "visualization_msgs/msg/InteractiveMarkerInit"
    INTERACTIVE_UPDATE = "visualization_msgs/msg/InteractiveMarkerUpdate"

    IMAGE = "sensor_msgs/msg/Image"
    IMAGE_FILE = "sensor_msgs/msg/CompressedImage"
    CAMERA = "sensor_msgs/msg/CameraInfo"

    PRESSURE = "sensor_msgs/msg/FluidPressure"
    LIGHT = "sensor_msgs/msg/Illuminance"
    HUMIDITY = "sensor_msgs/msg/RelativeHumidity"
    TEMPERATURE = "sensor_msgs/msg/Temperature"

    PLACE_ON_EARTH = "sensor_msgs/msg/NavSatFix"
    LOG = "rcl_interfaces/msg/Log"
    DIAGNOSTICS = "diagnostic_msgs/msg/DiagnosticArray"
    CLOCK = "rosgraph_msgs/msg/Clock"

    @property
    def display(self) -> str | None:
        """The class of the display that usually draws it; None if there is none.

        Displays declare what they draw; this table answers without loading any, and
        decides which one comes first if several draw it.
        """
        name = _DISPLAYS.get(self)
        return name if name is None or "/" in name else f"rviz_default_plugins/{name}"

    @property
    def is_large(self) -> bool:
        """Whether it comes as a stream of large messages; the newest counts."""
        return self in _LARGE


_LARGE = frozenset(
    {
        Meaning.CLOUD,
        Meaning.OLD_CLOUD,
        Meaning.SCAN,
        Meaning.GRID,
        Meaning.GRID_UPDATE,
        Meaning.IMAGE,
        Meaning.IMAGE_FILE,
    }
)
_DISPLAYS = {
    Meaning.TRANSFORMS: "TF",
    Meaning.TEXT: "RobotModel",
    Meaning.JOINTS: "RobotModel",
    Meaning.CLOUD: "PointCloud2",
    Meaning.OLD_CLOUD: "PointCloud",
    Meaning.SCAN: "LaserScan",
    Meaning.CONE: "Range",
    Meaning.GRID: "Map",
    Meaning.GRID_UPDATE: "Map",
    Meaning.CELLS: "GridCells",
    Meaning.POSE: "Pose",
    Meaning.POSE_WITH_COVARIANCE: "PoseWithCovariance",
    Meaning.POSES: "PoseArray",
    Meaning.PARTICLES: "nav2_rviz_plugins/ParticleCloud",
    Meaning.PATH: "Path",
    Meaning.ODOMETRY: "Odometry",
    Meaning.POINT: "PointStamped",
    Meaning.POLYGON: "Polygon",
    Meaning.ACCELERATION: "AccelStamped",
    Meaning.VELOCITY: "TwistStamped",
    Meaning.FORCE: "Wrench",
    Meaning.MARKER: "Marker",
    Meaning.MARKERS: "MarkerArray",
    Meaning.INTERACTIVE_MARKERS: "InteractiveMarkers",
    Meaning.INTERACTIVE_UPDATE: "InteractiveMarkers",
    Meaning.IMAGE: "Image",
    Meaning.IMAGE_FILE: "Image",
    Meaning.CAMERA: "CameraInfo",
    Meaning.PRESSURE: "FluidPressure",
    Meaning.LIGHT: "Illuminance",
    Meaning.HUMIDITY: "RelativeHumidity",
    Meaning.TEMPERATURE: "Temperature",
}
