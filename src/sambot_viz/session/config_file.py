"""The .rviz file of a session: where it is, what may be beside it, and saving it.

A client may overwrite the config that was opened, and open and write other files
beside it; nothing else, because whoever can open the page can press the buttons. A link
that leads elsewhere is not beside it.
"""

from __future__ import annotations

import os
import re
from pathlib import Path

from sambot_viz import bundled, limits
from sambot_viz.errors import ConfigError, UsageError
from sambot_viz.files import is_below
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.listed_files import ListedFiles
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.room import require_room
from sambot_viz.session.scene.scene import Scene
from sambot_viz.text import text

ENDING = ".rviz"
UNNAMED = f"sambot_viz{ENDING}"
"""The name of a downloaded config that has no file."""
_FORBIDDEN = '<>:"|?*'
_RESERVED = re.compile(
    r"(con|prn|aux|nul|conin\$|conout\$|(com|lpt)[0-9¹²³])(\.|$)", re.IGNORECASE
)
"""Names that Windows keeps for devices, with any ending."""


class ConfigFile:
    """The file of a session's document.

    Args:
        document: the document to save.
        robot: a config without a file is saved beside its model.
        scene: knows the config that the command line opened.
    """

    def __init__(
        self, document: ShownDocument, robot: RobotState, scene: Scene
    ) -> None:
        self._document = document
        self._robot = robot
        self._context = scene.context

    @property
    def name(self) -> str:
        """The file's name; empty when the document was never in a file."""
        file = self._document.config.file
        return "" if file is None else Path(file).name

    @property
    def target(self) -> Path | None:
        """The file that saving writes; None when it needs another name first."""
        file = self._document.config.file
        return None if file is None or _is_bundled(Path(file)) else Path(file)

    @property
    def origin(self) -> str:
        """Where the document comes from, in words: a folder, or the program."""
        return "the program" if self.target is None else str(self.target.parent)

    @property
    def folder(self) -> Path:
        """Where files are saved and opened: beside the config, else the model."""
        opened, robot = self.target or self._opened, self._robot.model
        if opened is not None:
            return opened.absolute().parent
        if robot is not None and robot.files:
            beside = robot.files[0].absolute().parent
            if not _is_bundled(beside / "any") and os.access(beside, os.W_OK):
                return beside
        return Path.cwd()

    @property
    def _opened(self) -> Path | None:
        """The config of the command line; another one may be shown meanwhile."""
        file = self._context.config_file
        return None if file is None or _is_bundled(file) else file

    @property
    def _files(self) -> ListedFiles:
        opened = self._opened
        # Builds of ROS workspaces consist of links to the sources.
        beside = () if opened is None else (Path(os.path.realpath(opened)).parent,)
        most, shown = limits.CONFIG_NAMES.value, (self.target, opened)
        return ListedFiles(self.folder, _is_config, most, shown, beside)

    def names(self) -> list[str]:
        """The .rviz files in the folder, by name, and the one of the program.

        Raises:
            UsageError: the folder cannot be read.
        """
        return [*self._files.names(), *_of_the_program()]

    def listed(self, name: str) -> Path:
        """Return the file that is listed under a name.

        Raises:
            UsageError: there is no such file.
        """
        if name in _of_the_program():
            return bundled.config_path()
        for found in self.names():
            if text(found) == name:
                return self.folder / found
        raise UsageError(f"there is no file '{name}' in {self.folder}")

    def path(self, name: str) -> Path:
        """The file that a name means, which may not exist yet.

        Args:
            name: as a user types it; ".rviz" is added.

        Raises:
            UsageError: no file can, or should, have this name.
        """
        name = name.strip()
        if name.casefold().endswith(ENDING):
            name = name[: -len(ENDING)]
        refusal = _refusal(name)
        if refusal is not None:
            raise UsageError(f"{refusal}; the file goes into {self.folder}")
        path = self.folder / f"{name}{ENDING}"
        if self._files.leads_elsewhere(path):
            raise UsageError(
                f"{path.name} is a link to another folder; the file goes into "
                f"{self.folder}"
            )
        return path

    def is_taken(self, path: Path) -> bool:
        """Whether a path is another file, or a folder, that exists already."""
        return path != self.target and os.path.lexists(path)

    def save(self, path: Path | None = None) -> Path:
        """Write the document.

        Args:
            path: the file, from `path`; None writes its own one.

        Returns:
            The file that was written.

        Raises:
            UsageError: there is no file to write, or it cannot be written; the old
                content is kept.
        """
        target = path or self.target
        if target is None:
            raise UsageError(
                "this config has no file of its own yet: save it under a name"
            )
        if not os.path.lexists(target):
            what = f"configs in {target.absolute().parent}"
            require_room(len(self.names()), limits.CONFIG_NAMES.value, what)
        try:
            self._document.save(target)
        except ConfigError as error:
            raise UsageError(
                f"{target.name} in {target.absolute().parent}: "
                f"{error.problems[0].message}. Nothing is lost: save it under "
                "another name, or download it"
            ) from error
        return target


def _is_config(entry: os.DirEntry[str]) -> bool:
    return entry.name.endswith(ENDING) and entry.is_file()


def _of_the_program() -> list[str]:
    try:
        return [f"{bundled.config_path().name} (comes with the program)"]
    except UsageError:
        return []


def _refusal(name: str) -> str | None:
    """Why a name without its ending is not taken."""
    if not name:
        return "enter a name, such as my_robot"
    if "/" in name or "\\" in name:
        return "enter a name without a folder"
    if name.startswith("."):
        return "a name that begins with a dot would be hidden"
    bad = [
        letter for letter in name if letter in _FORBIDDEN or not letter.isprintable()
    ]
    if bad:
        return f"a file name cannot contain {text(bad[0])}"
    if name.endswith((".", " ")):
        return "a name cannot end with a dot"
    if _RESERVED.match(name):
        return f"Windows keeps the name {name} for a device"
    if len(f"{name}{ENDING}".encode(errors="replace")) > limits.CONFIG_NAME.value:
        return f"the name is too long ({limits.CONFIG_NAME.value} bytes at most)"
    return None


def _is_bundled(path: Path) -> bool:
    try:
        folders = [bundled.configs_folder(), bundled.assets_folder()]
    except UsageError:
        return False
    return is_below(path, [folder.resolve() for folder in folders])
