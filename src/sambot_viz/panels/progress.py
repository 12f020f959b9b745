"""The line that shows how many mesh files are still being read."""

from __future__ import annotations

from sambot_viz.session import Event, Session


class ProgressLine:
    """How many mesh files and textures of how many have been read.

    It is in the current container of the session's GUI, and is only there while
    something is still being read.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._line = session.audience.gui.add_html("", visible=False)
        self._shown: tuple[int, int] | None = None
        session.listeners.append(self._hear)
        self._write()

    def close(self) -> None:
        """Follow the session no longer."""
        self._session.listeners.remove(self._hear)

    def _hear(self, event: Event) -> None:
        if event in ("status", "robot"):
            self._write()

    def _write(self) -> None:
        progress = self._session.context.assets.progress
        if progress == self._shown:
            return
        self._shown = progress
        if progress is not None:
            self._line.content = progress_html(*progress)
        self._line.visible = progress is not None


def progress_html(read: int, total: int) -> str:
    """The line and its bar as HTML."""
    percent = 100 * read // max(1, total)
    return (
        '<div class="sambot-progress" role="status">'
        f"Reading meshes and textures: {read} of {total}"
        f'<div><div style="width: {percent}%"></div></div></div>'
    )
