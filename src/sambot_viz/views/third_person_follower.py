"""ThirdPersonFollower: XYOrbit that turns with its target (§1.6)."""

from __future__ import annotations

from sambot_viz.views.xy_orbit import XYOrbitView


class ThirdPersonFollowerView(XYOrbitView):
    """Behind a robot, and turning with it; its roll and pitch do not count."""

    kind = "rviz_default_plugins/ThirdPersonFollower"
    help = "Follows the target frame and turns with it."
    follows_yaw = True
