"""Which topics are shown at first, where no config says it, and in which order."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from sambot_viz import limits
from sambot_viz.meanings import Meaning, meaning_of
from sambot_viz.topics.reasons import display_of

IMAGE = "rviz_default_plugins/Image"
_NEEDED = (
    "rviz_default_plugins/Map",
    "rviz_default_plugins/PointCloud2",
    "rviz_default_plugins/PointCloud",
    "rviz_default_plugins/LaserScan",
    "rviz_default_plugins/Path",
    "rviz_default_plugins/Odometry",
    "rviz_default_plugins/Polygon",
    "nav2_rviz_plugins/ParticleCloud",
    "rviz_default_plugins/PoseArray",
    "rviz_default_plugins/Pose",
    "rviz_default_plugins/PoseWithCovariance",
    "rviz_default_plugins/MarkerArray",
    "rviz_default_plugins/Marker",
    "rviz_default_plugins/InteractiveMarkers",
    "rviz_default_plugins/GridCells",
    "rviz_default_plugins/Range",
    "rviz_default_plugins/PointStamped",
    IMAGE,
)
"""The order of drawing: large displays that lie below others come first."""
_RANK = {kind: rank for rank, kind in enumerate(_NEEDED)}


def shown_at_first(types: Mapping[str, str]) -> list[tuple[str, str]]:
    """Choose the first displays for some topics: topic and class of display.

    Args:
        types: topic → type of its messages.
    """
    return list(_needed(types))[: limits.FIRST_SIGHT.value]


def is_costmap(topic: str) -> bool:
    """Return whether a map is one of costs, which lies over the others, by its name."""
    return "costmap" in topic


def _needed(types: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    found = sorted(
        (_RANK[kind], is_costmap(name), name, kind)
        for name, type_name in types.items()
        # An update is drawn by the display of its map.
        if meaning_of(type_name) is not Meaning.GRID_UPDATE
        and (kind := display_of(name, type_name) or "") in _RANK
    )
    pictures = 0
    for _, _, name, kind in found:
        pictures += kind == IMAGE
        if kind != IMAGE or pictures <= limits.FIRST_PICTURES.value:
            yield name, kind
