"""All displays this program knows: a new one is a new file and a line here."""

from __future__ import annotations

from sambot_viz.displays.axes import AxesDisplay
from sambot_viz.displays.data.camera_info_display import CameraInfoDisplay
from sambot_viz.displays.data.cloud.laser_scan import LaserScanDisplay
from sambot_viz.displays.data.cloud.measurements import (
    FluidPressureDisplay,
    IlluminanceDisplay,
    RelativeHumidityDisplay,
    TemperatureDisplay,
)
from sambot_viz.displays.data.cloud.point_clouds import (
    PointCloud2Display,
    PointCloudDisplay,
)
from sambot_viz.displays.data.depth_cloud.depth_cloud import DepthCloudDisplay
from sambot_viz.displays.data.effort.effort import EffortDisplay
from sambot_viz.displays.data.grid_cells import GridCellsDisplay
from sambot_viz.displays.data.image.camera_display import CameraDisplay
from sambot_viz.displays.data.image.image_display import ImageDisplay
from sambot_viz.displays.data.interactive_markers.interactive_display import (
    InteractiveMarkersDisplay,
)
from sambot_viz.displays.data.map import MapDisplay
from sambot_viz.displays.data.markers.marker_displays import (
    MarkerArrayDisplay,
    MarkerDisplay,
)
from sambot_viz.displays.data.path import PathDisplay
from sambot_viz.displays.data.point_stamped import PointStampedDisplay
from sambot_viz.displays.data.polygon import PolygonDisplay
from sambot_viz.displays.data.poses.odometry_display import OdometryDisplay
from sambot_viz.displays.data.poses.particle_cloud import ParticleCloudDisplay
from sambot_viz.displays.data.poses.pose import PoseDisplay, PoseWithCovarianceDisplay
from sambot_viz.displays.data.poses.pose_array import PoseArrayDisplay
from sambot_viz.displays.data.range import RangeDisplay
from sambot_viz.displays.data.vectors import (
    AccelStampedDisplay,
    TwistStampedDisplay,
    WrenchDisplay,
)
from sambot_viz.displays.display import Display
from sambot_viz.displays.grid import GridDisplay
from sambot_viz.displays.robot_model.robot_model import RobotModelDisplay
from sambot_viz.displays.tf.tf import TfDisplay


class GroupDisplay(Display):
    """Displays that are switched on and off together."""

    kind = "rviz_common/Group"
    help = "A group of displays."
    properties = ()

    def draw(self) -> None:
        """A group has no picture of its own."""

    def clear(self) -> None:
        """A group has no picture of its own."""


DISPLAYS: dict[str, type[Display]] = {
    display.kind: display
    for display in (
        AccelStampedDisplay,
        AxesDisplay,
        CameraDisplay,
        CameraInfoDisplay,
        DepthCloudDisplay,
        EffortDisplay,
        FluidPressureDisplay,
        GridCellsDisplay,
        GridDisplay,
        GroupDisplay,
        ImageDisplay,
        IlluminanceDisplay,
        InteractiveMarkersDisplay,
        LaserScanDisplay,
        MapDisplay,
        MarkerArrayDisplay,
        MarkerDisplay,
        OdometryDisplay,
        ParticleCloudDisplay,
        PathDisplay,
        PointCloud2Display,
        PointCloudDisplay,
        PointStampedDisplay,
        PolygonDisplay,
        PoseArrayDisplay,
        PoseDisplay,
        PoseWithCovarianceDisplay,
        RangeDisplay,
        RelativeHumidityDisplay,
        RobotModelDisplay,
        TemperatureDisplay,
        TfDisplay,
        TwistStampedDisplay,
        WrenchDisplay,
    )
}
