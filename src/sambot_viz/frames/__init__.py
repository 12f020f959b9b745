"""Coordinate frames: the tree, look-ups, static transforms, and their texts."""

from sambot_viz.frames.frame_tree import FrameTree, Hop
from sambot_viz.frames.refusals import CycleRefused, LookupRefused, TransformRefused
from sambot_viz.frames.transform import Transform

__all__ = [
    "CycleRefused",
    "FrameTree",
    "Hop",
    "LookupRefused",
    "Transform",
    "TransformRefused",
]
