"""Class ids of ROS 1 and ROS 2: what an .rviz file calls its displays, views, tools.

Files of ROS 1 say ``rviz/Grid``, files of ROS 2 ``rviz_default_plugins/Grid``.
Here every class goes by its ROS 2 id, its kind; what was
written is written back.
"""

from __future__ import annotations

GROUP = "rviz_common/Group"
NO_CLASS = "(no class name found)"
"""What RViz calls a display without a class."""

_ROS1 = "rviz/"
_ROS2 = "rviz_default_plugins/"
_RENAMED = {"rviz/Group": GROUP, "rviz/WrenchStamped": f"{_ROS2}Wrench"}
_RENAMED_BACK = {new: old for old, new in _RENAMED.items()}


def is_ros1(class_id: str) -> bool:
    """Return whether a class id is one of ROS 1's own."""
    return class_id.startswith(_ROS1)


def kind_of(class_id: str) -> str:
    """Return the ROS 2 id of a class; foreign ids stay as they are."""
    if class_id in _RENAMED:
        return _RENAMED[class_id]
    return _ROS2 + class_id[len(_ROS1) :] if is_ros1(class_id) else class_id


def written_in_ros1(kind: str) -> str:
    """Return the ROS 1 id of a class; foreign ids stay as they are."""
    if kind in _RENAMED_BACK:
        return _RENAMED_BACK[kind]
    return _ROS1 + kind[len(_ROS2) :] if kind.startswith(_ROS2) else kind


def short_name(kind: str) -> str:
    """Return the part behind the slash, such as "Grid"."""
    return kind.rpartition("/")[2]


def row_text(kind: str) -> str:
    """Return RViz's label of a view type, such as "Orbit (rviz_default_plugins)"."""
    package, _, name = kind.rpartition("/")
    return f"{name} ({package})" if package else name
