"""FocusCamera: click on a point to make the camera look at it."""

from __future__ import annotations

from sambot_viz.tools.picking.hit import Hit
from sambot_viz.tools.tool import Click, Tool

AHEAD = 1.0
"""A click on the background makes the camera look this far along the ray [m]."""


class FocusCameraTool(Tool):
    """Looks at the clicked point, then goes back to the default tool."""

    kind = "rviz_default_plugins/FocusCamera"
    label = "Focus Camera"
    key = "C"
    help = "Click on the point that the camera should look at."
    clicks = True

    def click(self, click: Click, hit: Hit) -> None:
        """Turn the camera to what was clicked on."""
        ahead = click.origin + AHEAD * click.direction
        self.context.look_at(ahead if hit.point is None else hit.point)
        self.context.finish()
