"""Coordinate frames: the tree, look-ups, static transforms, and their texts."""

from sambot_viz.frames.errors import CycleRefused, LookupRefused, TransformRefused
from sambot_viz.frames.transform import Transform
from sambot_viz.frames.tree import FrameTree, Hop

__all__ = [
    "CycleRefused",
    "FrameTree",
    "Hop",
    "LookupRefused",
    "Transform",
    "TransformRefused",
]
