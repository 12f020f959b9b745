"""A student's files, read once for all conditions of all steps."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.cached import cached_property
from sambot_viz.checks import check_robot
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.workspace import Package, Workspace
from sambot_viz.errors import Problem, RobotError, SourceError
from sambot_viz.files import RECORDING_ENDINGS, is_below
from sambot_viz.robot.model import Robot, load_robot
from sambot_viz.robot.packages.package_index import package_around

if TYPE_CHECKING:
    from sambot_viz.lessons.recorded import StudentRecording


class Work:
    """A model and its folder.

    Args:
        model: model file, which need not exist.
        folder: the student's folder; default the package of the model, or its folder.
        trusted: as for `load_robot`.
        loaded: the robot, or the reason why there is none, if already known.
        problems: findings of `check`, if already known.
        edited: as for `load_robot`.

    Attributes:
        model: the model file.
        folder: the student's folder.
    """

    def __init__(
        self,
        model: Path,
        folder: Path | None = None,
        *,
        trusted: bool = True,
        loaded: Robot | RobotError | None = None,
        problems: Iterable[Problem] | None = None,
        edited: Mapping[str, str] | None = None,
    ) -> None:
        self.model = model
        self.folder = folder or package_around(model) or model.parent
        self._trusted = trusted
        self._known = loaded
        self._given = problems
        self._edited = edited

    @cached_property
    def _loaded(self) -> Robot | RobotError:
        if self._known is not None:
            return self._known
        try:
            return load_robot(self.model, trusted=self._trusted, edited=self._edited)
        except RobotError as error:
            return error

    @property
    def refusal(self) -> RobotError | None:
        """The reason why there is no robot; None when there is one."""
        loaded = self._loaded
        return loaded if isinstance(loaded, RobotError) else None

    @property
    def robot(self) -> Robot:
        """The robot.

        Raises:
            RobotError: the model cannot be read.
        """
        loaded = self._loaded
        if isinstance(loaded, RobotError):
            raise loaded
        return loaded

    @cached_property
    def problems(self) -> tuple[Problem, ...]:
        """The findings of `check` in the model and its package."""
        if self._given is not None:
            return tuple(self._given)
        if self.refusal is not None:
            return self.refusal.problems
        return tuple(check_robot(self.robot, self.model))

    @cached_property
    def files(self) -> Package:
        """The files of the folder, which need not be a ROS package."""
        found = Workspace(self.folder, trusted=self._trusted).at(self.folder)
        if found is not None:
            return found
        folder = self.folder.absolute()
        relative = not self.folder.is_absolute()
        return Package(folder, folder.name, relative, self._trusted, set())

    @cached_property
    def around(self) -> Surroundings:
        """The robot, if there is one, and the facts from all files of the folder."""
        robot = None if self.refusal is not None else self.robot
        return Surroundings(robot, (self.files,))

    @cached_property
    def launches(self) -> frozenset[str]:
        """The launch files, as the user would write them."""
        return frozenset(self.files.shown(path) for path in self.files.launch_paths)

    @cached_property
    def recording(self) -> StudentRecording:
        """The recordings of the folder, as one.

        Raises:
            SourceError: there is no recording, or one cannot be opened.
        """
        # Imported late: it needs numpy and the decoders of messages.
        from sambot_viz.lessons.recorded import StudentRecording

        paths = [self.files.folder / each for each in self._recordings()]
        if not paths:
            raise SourceError("the folder has no recording (.mcap, .db3 or .bag)")
        return StudentRecording(paths)

    def _recordings(self) -> list[str]:
        """Return the recordings; for an untrusted folder, without links."""
        root = [self.files.folder.resolve()]
        paths = self.files.ending(*RECORDING_ENDINGS)
        folder = self.files.folder
        return [p for p in paths if self._trusted or is_below(folder / p, root)]

    def sources(self) -> Iterator[tuple[str, str]]:
        """Yield the files of the model that are in the folder, each with its text."""
        found = [] if self.refusal is not None else [*self.robot.files]
        for file in dict.fromkeys([self.model.absolute(), *found]):
            if file.is_relative_to(self.files.folder):
                path = file.relative_to(self.files.folder).as_posix()
                yield self.files.shown(path), self.files.text(path) or ""
