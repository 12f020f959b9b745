"""ThirdPersonFollower: XYOrbit that turns with its target frame."""

from __future__ import annotations

from sambot_viz.views.xy_orbit import XYOrbitView


class ThirdPersonFollowerView(XYOrbitView):
    """Follows position and yaw of the target frame, not its roll and pitch."""

    kind = "rviz_default_plugins/ThirdPersonFollower"
    help = "Follows the target frame and turns with it."
    follows_yaw = True
