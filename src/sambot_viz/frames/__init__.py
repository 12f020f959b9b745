"""Coordinate frames: the tree, look-ups, static transforms, and their texts."""

from sambot_viz.frames.frame_errors import (
    FrameCycleError,
    LookupRefused,
    TransformRefused,
)
from sambot_viz.frames.frame_tree import FrameTree, Hop
from sambot_viz.frames.history import FrameHistory
from sambot_viz.frames.transform import Transform

__all__ = [
    "FrameCycleError",
    "FrameHistory",
    "FrameTree",
    "Hop",
    "LookupRefused",
    "Transform",
    "TransformRefused",
]
