"""FocusCamera: click on what the camera shall look at (§2.7)."""

from __future__ import annotations

from sambot_viz.tools.tool import Ray, Tool

AHEAD = 1.0
"""Over the background, the camera looks at the point so far along the ray [m]."""


class FocusCameraTool(Tool):
    """One click, then the default tool again."""

    kind = "rviz_default_plugins/FocusCamera"
    label = "Focus Camera"
    key = "C"
    help = "Click on what the camera shall look at."
    clicks = True

    def click(self, ray: Ray) -> None:
        """See `Tool`."""
        hit = self.desk.pick(ray)
        point = ray.at(AHEAD) if hit is None else hit.point
        self.desk.look_at(point, ray.client_id)
        self.desk.finish()
