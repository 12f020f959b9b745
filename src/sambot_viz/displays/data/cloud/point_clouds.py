"""PointCloud2 and PointCloud: points of depth cameras, lidars and stereo vision."""

from __future__ import annotations

from sambot_viz.displays.data.cloud.cloud import cloud_of_cloud, cloud_of_cloud2
from sambot_viz.displays.data.cloud.cloud_display import CloudDisplay
from sambot_viz.meanings import Meaning


class PointCloud2Display(CloudDisplay):
    """The points of sensor_msgs/PointCloud2."""

    kind = "rviz_default_plugins/PointCloud2"
    differs = (
        "Squares turn with the y axis of their cloud, as in RViz where it has no "
        "geometry shaders; else RViz keeps them upright on the screen. Of points that "
        "overlap in a plane the later one is in front, but for one of 64, which "
        "rounding decides. So it is in all displays of points."
    )
    meanings = frozenset({Meaning.CLOUD})
    points_of = cloud_of_cloud2


class PointCloudDisplay(CloudDisplay):
    """The points of sensor_msgs/PointCloud."""

    kind = "rviz_default_plugins/PointCloud"
    meanings = frozenset({Meaning.OLD_CLOUD})
    points_of = cloud_of_cloud
