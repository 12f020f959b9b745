"""The Images panel of one browser: the pictures of cameras."""

from __future__ import annotations

from collections.abc import Sequence

from sambot_viz.displays.camera_pictures import ClientPictures
from sambot_viz.displays.data.topic_display import TopicDisplay
from sambot_viz.panels.command import FLAG, TEXT, command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.rows.row import Row
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.scene.scene import Scene


class ImagesPanel(Panel):
    """A row for each display that has pictures; they come beside the rows.

    Args:
        scene: has the displays.
        document: has their names.

    Attributes:
        pictures: what the browser lacks of them, for its channel.
    """

    name = "images"

    def __init__(self, scene: Scene, document: ShownDocument) -> None:
        self.remade_by = (document.replaced, document.displays, scene.statuses)
        self.pictures = ClientPictures(scene.context.pictures)
        self._scene = scene

    def rows(self) -> Sequence[Row]:
        """Return the rows, each with the faults of its pictures."""
        made = list[Row]()
        pictures = self._scene.context.pictures
        for display in self._scene.displays:
            if display.key not in pictures or not isinstance(display, TopicDisplay):
                continue
            why, key = display.unseen(), {"picture": display.key}
            row_id, name = f"images/{display.key}", display.config.name
            text = "" if why is None else why.text
            made.append(Row(row_id, "", "readonly", name, value=text, extra=key))
        return made

    def close(self) -> None:
        """Show nothing any longer."""
        self.pictures.close()

    @command("images/show", TEXT, FLAG, client_local=True)
    def _show(self, key: str, on: bool) -> None:
        """Send the pictures of a display, or do not: it is on the screen, or is not."""
        if not on or key in self._scene.context.pictures:
            self.pictures.show(key, on)
