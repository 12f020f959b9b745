"""Select: click on a link or a frame, or draw a rectangle (§2.6)."""

from __future__ import annotations

from sambot_viz.tools.tool import Ray, Rays, Thing, Tool


class SelectTool(Tool):
    """Replaces the selection; with Shift adds to it, with Ctrl takes away."""

    kind = "rviz_default_plugins/Select"
    label = "Select"
    key = "S"
    help = "Click, or drag a rectangle. Shift: add. Ctrl: remove. Alt: camera."
    clicks = True
    rectangles = True

    def click(self, ray: Ray) -> None:
        """See `Tool`."""
        hit = self.desk.pick(ray)
        found: set[Thing] = set()
        if hit is not None and hit.thing is not None:
            found.add(hit.thing)
        self.desk.select(found, ray.modifier)

    def rectangle(self, rays: Rays) -> None:
        """See `Tool`."""
        self.desk.select(self.desk.things_met(rays), rays.modifier)
