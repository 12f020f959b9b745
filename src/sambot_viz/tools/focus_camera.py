"""FocusCamera: click on a point to make the camera look at it."""

from __future__ import annotations

from sambot_viz.displays.picking.selectable import Hit
from sambot_viz.tools.tool import Click, Tool

AHEAD = 1.0
"""A click on the background makes the camera look this far along the ray [m]."""


class FocusCameraTool(Tool):
    """Looks at the clicked point, then goes back to the default tool."""

    kind = "rviz_default_plugins/FocusCamera"
    label = "Focus Camera"
    key = "C"
    help = "Click on the point that the camera should look at."
    touch = "Tap the point that the camera should look at."
    clicks = True

    def click(self, click: Click, hit: Hit) -> None:
        """Turn the camera to what was clicked on."""
        ahead = click.origin + AHEAD * click.direction
        self.context.look_at(ahead if hit.point is None else hit.point)
        self.context.finish()

    @property
    def wants_hover(self) -> bool:
        """True: the point under the mouse is shown."""
        return True

    def hover(self, click: Click, hit: Hit) -> None:
        """Show the point under the mouse [m], with three digits as in RViz."""
        if hit.point is None:
            self.context.show_status("Click to look in this direction.")
            return
        x, y, z = (f"{c:.3g}" for c in hit.point.tolist())
        self.context.show_status(f"[{x}, {y}, {z}] Click to look at this point.")
