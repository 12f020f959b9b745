"""How images are sent: a topic for each kind, beside that of the camera infos."""

from __future__ import annotations

from sambot_viz.rviz import EditableEnumProperty

RAW, COMPRESSED, COMPRESSED_DEPTH = "raw", "compressed", "compressedDepth"
TRANSPORTS = (COMPRESSED, COMPRESSED_DEPTH, "theora")
"""Suffixes of image topics that are not plain images."""
ROS1_TOPIC, ROS1_HINT = "Image Topic", "Transport Hint"
"""What files of ROS 1 have in place of a topic with its kind."""


def hint_property() -> EditableEnumProperty:
    """Return the property of ROS 1 that says how images are sent."""
    return EditableEnumProperty(
        ROS1_HINT,
        default=RAW,
        options=(RAW, COMPRESSED),
        help="Of ROS 1: how the pictures of the topic are sent.",
        ros1_only=True,
    )


def sent_topic(topic: str, transport: object) -> str:
    """Return the topic that images are sent on.

    Args:
        topic: the topic of the plain images, or the wanted one.
        transport: the transport; unknown ones are read as plain.
    """
    is_plain = transport not in TRANSPORTS or topic.rpartition("/")[2] in TRANSPORTS
    return topic if is_plain or not topic else f"{topic}/{transport}"


def info_topic(topic: str) -> str:
    """Return the topic of the camera infos of a topic of images; "" for none."""
    base, slash, last = topic.rpartition("/")
    if slash and last in TRANSPORTS:
        base, slash, _ = base.rpartition("/")
    return f"{base}{slash}camera_info" if topic else ""
