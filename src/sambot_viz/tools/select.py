"""Select: click on a link, a frame or data, or drag a rectangle over several."""

from __future__ import annotations

from sambot_viz.displays.picking.selectable import Hit, Selection
from sambot_viz.tools.tool import Click, Tool


class SelectTool(Tool):
    """Replaces the selection; with Shift it adds to it, with Ctrl it removes."""

    kind = "rviz_default_plugins/Select"
    label = "Select"
    key = "S"
    help = "Click, or drag a rectangle. Shift: add. Ctrl: remove. Alt: camera."
    touch = "Tap, or draw a rectangle."
    clicks = True
    rectangles = True

    def click(self, click: Click, hit: Hit) -> None:
        """Selects the item under the cursor; nothing on the grid and the background."""
        self.context.select(hit.selection, click.modifier)

    def rectangle(self, items: Selection, modifier: str | None) -> None:
        """Select all that is visible in the rectangle."""
        self.context.select(items, modifier)
