"""The .rviz file: its name, whether it is saved, and the buttons for that.

A browser may overwrite the config that was opened, and write new files beside it;
nothing else, because whoever can open the page can press the buttons.
"""

from __future__ import annotations

import os
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any

import viser

from sambot_viz import bundled
from sambot_viz.errors import ConfigError, UsageError
from sambot_viz.panels.widgets import add_buttons, add_text, on_press
from sambot_viz.session import Event, Session
from sambot_viz.text import html_text

ENDING = ".rviz"
LONGEST_NAME = 200
"""Most file systems take 255 bytes; a temporary name beside the file is longer."""
DOWNLOADED = "sambot_viz.rviz"
SAVE, SAVE_AS, DOWNLOAD = "Save", "Save as …", "Download"


class ConfigFile:
    """The rows of the file, in the current container.

    Args:
        session: whose document it is.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        gui = session.audience.gui
        self._shown = ""
        self._said = ""
        self._level = "ok"
        self._title = gui.add_html("")
        # Private sessions belong to anonymous visitors: they may download the file, not
        # write to the server's disk.
        private = isinstance(session.audience, viser.ClientHandle)
        buttons = (DOWNLOAD,) if private else (SAVE, SAVE_AS, DOWNLOAD)
        add_buttons(self._session, buttons, self._press)
        self._name = add_text(
            self._session,
            "File name",
            "",
            self._take_name,
            hint="Name of the new file.",
        )
        self._confirm = gui.add_button("Save under this name")
        on_press(self._session, self._confirm, lambda client: self._save_as())
        self._ask(False)
        session.listeners.append(self._hear)
        self._write()

    def close(self) -> None:
        """Stop following the session."""
        self._session.listeners.remove(self._hear)

    def _hear(self, event: Event) -> None:
        if event in ("config", "edits"):
            self._write()

    @property
    def target(self) -> Path | None:
        """The file that "Save" writes; None when only another name will do."""
        file = self._session.config.file
        if file is None or _is_bundled(Path(file)):
            return None
        return Path(file)

    def _press(self, button: str, client: viser.ClientHandle | None) -> None:
        with self._session.change():
            self._said = ""
            if button == SAVE:
                self._save()
            elif button == SAVE_AS:
                self._ask(not self._name.visible)
            elif client is not None:
                self._download(client)
            self._write()

    def _save(self) -> None:
        target = self.target
        if target is None:
            self._say("ok", "This config has no file of its own yet: give it a name.")
            self._ask(True)
        else:
            self._write_file(target)

    def _save_as(self) -> None:
        with self._session.change():
            try:
                path = self._path(str(self._name.value))
            except UsageError as error:
                self._say("error", str(error))
            else:
                self._write_file(path)
            self._write()

    def _write_file(self, path: Path) -> None:
        try:
            self._store_view()
            self._session.config.save(path)
            self._session.edits.saved()
        except ConfigError as error:
            self._say("error", error.problems[0].message)
        else:
            self._ask(False)
            self._say("ok", f"Saved {path.name}.")

    def _path(self, name: str) -> Path:
        """The new file that a name means: beside the opened config.

        Raises:
            UsageError: a path, no name at all, one that is too long, or that of a file
                that exists already.
        """
        name = name.strip()
        if not name.endswith(ENDING):
            name += ENDING
        pure = PurePosixPath(name).name == name == PureWindowsPath(name).name
        if not pure or name.startswith(".") or not name.isprintable():
            raise UsageError("give a file name without folders, such as my_robot.rviz")
        if len(name.encode()) > LONGEST_NAME:
            raise UsageError(f"give a name of at most {LONGEST_NAME} bytes")
        target = self.target
        path = (Path.cwd() if target is None else target.parent) / name
        if path != target and os.path.exists(path):
            raise UsageError(f"{name} exists already; choose another name")
        return path

    def _take_name(self, name: Any) -> None:
        """The name is read when the button is pressed."""

    def _store_view(self) -> None:
        # The panels of one browser are rows of its own soon; until then, the first.
        for browser in tuple(self._session.browsers.values())[:1]:
            browser.view.store()

    def _download(self, client: viser.ClientHandle) -> None:
        self._store_view()
        target = self.target
        name = DOWNLOADED if target is None else target.name
        client.send_file_download(name, self._session.config.to_yaml().encode())

    def _ask(self, name: bool) -> None:
        self._name.visible = self._confirm.visible = name

    def _say(self, level: str, sentence: str) -> None:
        self._level, self._said = level, sentence

    def _write(self) -> None:
        config, target = self._session.config, self.target
        star = " *" if self._session.edits.modified else ""
        name = "no file yet" if target is None else target.name
        if target is None and config.file is not None:
            name = f"{Path(config.file).name} (bundled)"
        hint = "unsaved changes" if star else "saved"
        lines = f'<div class="sambot-file" title="{hint}">{html_text(name)}{star}</div>'
        if self._said:
            lines += (
                f'<div class="sambot-status sambot-{self._level}">'
                f"{html_text(self._said)}</div>"
            )
        if lines != self._shown:
            self._shown = lines
            self._title.content = lines


def _is_bundled(path: Path) -> bool:
    try:
        return path.resolve().is_relative_to(bundled.configs_folder().resolve())
    except UsageError:
        return False
