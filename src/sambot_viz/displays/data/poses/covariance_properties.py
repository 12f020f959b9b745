"""The Covariance of Odometry and PoseWithCovariance: its properties and its look."""

from __future__ import annotations

from typing import Any

from sambot_viz.displays.data.properties import alpha_property
from sambot_viz.displays.scene.covariance import CovarianceLook
from sambot_viz.rviz import (
    BoolProperty,
    ColorProperty,
    ConfigItem,
    EnumProperty,
    FloatProperty,
)


def _least(name: str, help: str, unit: str = "") -> FloatProperty:
    return FloatProperty(name, default=1.0, minimum=0.0, unit=unit, help=help)


COVARIANCE = BoolProperty(
    "Covariance",
    default=True,
    help="Show how uncertain poses are.",
    children=(
        BoolProperty(
            "Position",
            default=True,
            help="Show the uncertainty of the position as an ellipsoid.",
            children=(
                ColorProperty(
                    "Color", default=(204, 51, 204), help="Of the ellipsoid."
                ),
                alpha_property(0.3),
                _least("Scale", "Its semi-axes in standard deviations."),
            ),
        ),
        BoolProperty(
            "Orientation",
            default=True,
            help="Show the uncertainty of the orientation, as a wedge in the plane, or "
            "as three discs.",
            children=(
                EnumProperty(
                    "Frame",
                    default="Local",
                    options=("Local", "Fixed"),
                    help="Whether it turns with the pose, or stays with its frame.",
                ),
                EnumProperty(
                    "Color Style",
                    default="Unique",
                    options=("Unique", "RGB"),
                    help="One colour for all, or those of the axes.",
                ),
                ColorProperty(
                    "Color",
                    default=(255, 255, 127),
                    help="Of all.",
                    hidden_unless=("Covariance/Orientation/Color Style", "Unique"),
                ),
                alpha_property(0.5),
                _least("Offset", "How far they are from the pose.", "m"),
                _least("Scale", "Their angles in standard deviations."),
            ),
        ),
    ),
)


def covariance_look(config: ConfigItem) -> CovarianceLook:
    """Return what of a covariance a display draws, and how."""

    def get(path: str) -> Any:
        return config.get(f"Covariance/{path}")

    is_on = bool(config.get("Covariance"))
    return CovarianceLook(
        has_position=is_on and bool(get("Position")),
        position_color=get("Position/Color"),
        position_alpha=float(get("Position/Alpha")),
        position_scale=float(get("Position/Scale")),
        has_orientation=is_on and bool(get("Orientation")),
        is_local=get("Orientation/Frame") != "Fixed",
        is_rgb=get("Orientation/Color Style") == "RGB",
        orientation_color=get("Orientation/Color"),
        orientation_alpha=float(get("Orientation/Alpha")),
        offset=float(get("Orientation/Offset")),
        orientation_scale=float(get("Orientation/Scale")),
    )
