"""Orbit: round a focal point, at a distance (spec/rviz-core.md §8.3)."""

from __future__ import annotations

import math

from sambot_viz.rviz import (
    BoolProperty,
    FloatProperty,
    Property,
    TfFrameProperty,
    VectorProperty,
)
from sambot_viz.views.view import Camera, Vector, View

STEEPEST = math.pi / 2 - 0.001
"""Largest pitch [rad]."""

COMMON_PROPERTIES: tuple[Property, ...] = (
    FloatProperty(
        "Near Clip Distance",
        default=0.01,
        minimum=0.001,
        maximum=10000.0,
        unit="m",
        help="What is nearer to the camera is not drawn.",
    ),
    BoolProperty("Invert Z Axis", default=False, help="Turn the picture upside down."),
    TfFrameProperty(
        "Target Frame",
        default="<Fixed Frame>",
        help="The frame that the view follows.",
    ),
)
ORBIT_PROPERTIES: tuple[Property, ...] = (
    *COMMON_PROPERTIES,
    FloatProperty(
        "Distance",
        default=10.0,
        minimum=0.001,
        unit="m",
        help="From the focal point to the camera.",
    ),
    FloatProperty(
        "Focal Shape Size",
        default=0.05,
        minimum=0.001,
        unit="m",
        help="Size of the mark at the focal point while the mouse moves the view.",
        support="none",
    ),
    BoolProperty(
        "Focal Shape Fixed Size",
        default=True,
        help="Keep the size of that mark in metres, not on the screen.",
        support="none",
    ),
    FloatProperty(
        "Yaw",
        default=math.pi / 4,
        unit="rad",
        help="Where the camera stands around the vertical through the focal point.",
    ),
    FloatProperty(
        "Pitch",
        default=math.pi / 4,
        minimum=-STEEPEST,
        maximum=STEEPEST,
        unit="rad",
        help="How high the camera stands above the focal point.",
    ),
    VectorProperty(
        "Focal Point",
        default=(0.0, 0.0, 0.0),
        unit="m",
        help="The point the camera looks at, in the target frame.",
    ),
)


class OrbitView(View):
    """Round a focal point, at a distance."""

    kind = "rviz_default_plugins/Orbit"
    help = "Moves round a focal point."
    properties = ORBIT_PROPERTIES

    def camera(self, target: Vector) -> Camera:
        """See `View.camera`: the formula of §8.3."""
        get = self.config.get
        distance, yaw, pitch = (
            float(get(name)) for name in ("Distance", "Yaw", "Pitch")
        )
        up = 1.0
        if get("Invert Z Axis"):
            yaw, pitch, up = -yaw, -pitch, -1.0
        point: Vector = get("Focal Point")
        focal = (point[0] + target[0], point[1] + target[1], point[2] + target[2])
        position = (
            focal[0] + distance * math.cos(yaw) * math.cos(pitch),
            focal[1] + distance * math.sin(yaw) * math.cos(pitch),
            focal[2] + distance * math.sin(pitch),
        )
        near = float(get("Near Clip Distance"))
        return Camera(position, focal, (0.0, 0.0, up), near=near)
