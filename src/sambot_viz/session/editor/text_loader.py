"""Shows the robot of the texts in an editor, and checks them, in a thread."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from sambot_viz.errors import RobotError
from sambot_viz.robot.model import Robot
from sambot_viz.session.background import Background
from sambot_viz.session.editor.file_text import read_file_text
from sambot_viz.session.editor.model_files import ModelFiles
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.shown_problems import Checks, Problems
from sambot_viz.session.signals import Change, Signal
from sambot_viz.unsaved import unsaved

Texts = Mapping[str, str]
"""Whole path of a file → its text."""
REST = 0.3
"""A number is moved no more when it was not for this time [s]."""


class ModelState(NamedTuple):
    """What is to be shown.

    Attributes:
        files: of the model.
        is_other: whether it is another model than the server's.
        saves: another number after other programs have saved files of such a model.
        texts: those that differ from the disk.
        arguments: of xacro, in place of those of the command line.
        typed: the files whose text a user has written.
        versions: name of a file → the version of its text.
    """

    files: ModelFiles
    is_other: bool
    saves: int
    texts: Texts
    arguments: Mapping[str, str]
    typed: frozenset[str]
    versions: Mapping[str, int]


class _Result(NamedTuple):
    robot: Robot | RobotError
    state: ModelState
    trusted: bool


class TextLoader:
    """Shows each state of the texts that loads; one with a mistake leaves the last one.

    Args:
        robot: what is shown.
        checks: look at it with these texts.
        problems: show why a text is not shown.
        show: shows the robot of a text, and whether that is unsaved.
        change: of the session.
        wanted: returns what is to be shown now; called with the session locked.
        trusts_typed: whether what users write is evaluated as the files are.
        changed: told after the problems are those of other texts.

    Attributes:
        checked: name of a file → the version of its text that the problems are of.
        suspects: the files of a text that does not load.
    """

    def __init__(
        self,
        robot: RobotState,
        checks: Checks,
        problems: Problems,
        show: Callable[[Robot, bool], None],
        change: Change,
        wanted: Callable[[], ModelState],
        trusts_typed: bool,
        changed: Sequence[Signal[None]],
    ) -> None:
        self._robot, self._checks = robot, checks
        self._problems, self._show, self._change = problems, show, change
        self._wanted, self._trusts_typed = wanted, trusts_typed
        self._changed = changed
        self.checked: Mapping[str, int] = {}
        self.suspects: tuple[Path, ...] = ()
        self._background = Background("sambot-viz-text")
        self._closed = False
        state = wanted()
        self._shown = self._of_model(state.files.model, state.texts)
        self._loaded = state._replace(texts=self._shown)
        self._result: _Result | None = None

    def close(self) -> None:
        """Show nothing more."""
        self._closed = True

    def wait(self, timeout: float) -> bool:
        """Wait until each text is shown, or its problems; False for longer [s]."""
        return self._background.wait(timeout)

    def known(
        self, model: Path, texts: Texts, trusted: bool, arguments: Texts | None = None
    ) -> Robot | RobotError | None:
        """Return what a model gives with some texts; None where that is not known.

        It is known when these texts, or the same ones in the files by now, were loaded
        last.

        Args:
            model: the whole path of its file.
            texts: as in `ModelState`; those of other files do not count.
            trusted: as for `load_robot`.
            arguments: as in `ModelState`.
        """
        result = self._result
        if result is None or (model, trusted, arguments or {}) != (
            result.state.files.model,
            result.trusted,
            result.state.arguments,
        ):
            return None
        asked, loaded = self._of_model(model, texts), result.state.texts
        # What no text is known of may have been saved by another program.
        if not loaded or not asked.keys() <= loaded.keys():
            return None
        now = (
            asked[file] if file in asked else read_file_text(Path(file)).text
            for file in loaded
        )
        return result.robot if [*now] == [*loaded.values()] else None

    def forget(self, saved: Iterable[Path] | None = None) -> None:
        """Load again what was loaded last.

        Args:
            saved: only if one of these files is of the model; None in any case.
        """
        files = self._files_of(self._loaded.files.model)
        if saved is None or not files.isdisjoint(saved):
            self._result = None

    def begin(self, *, rests: bool = True) -> None:
        """Show what is wanted now, soon; then check it.

        Args:
            rests: False while a hand moves a number: only when it rests, the checks
                follow.
        """
        self._background.do(self, self._load_newest)
        self._background.do(self._checks, self._check, after=0.0 if rests else REST)

    def _of_model(self, model: Path, texts: Texts) -> Texts:
        """Return the texts of the files that the robot is loaded from."""
        known = self._files_of(model)
        return {file: text for file, text in texts.items() if Path(file) in known}

    def _files_of(self, model: Path) -> set[Path]:
        robot = self._robot.model
        files = (() if robot is None else robot.files, self.suspects)
        return {model, *(p.absolute() for each in files for p in each)}

    def _load_newest(self) -> None:
        try:
            with self._change.lock:
                state = self._wanted()
                texts = self._of_model(state.files.model, state.texts)
                state = state._replace(texts=texts)
                if self._closed or _of_robot(state) == _of_robot(self._loaded):
                    return
            self._load(state)
        except Exception as error:
            self._problems.report_error(error)

    def _load(self, state: ModelState) -> None:
        files, texts, arguments = state.files, state.texts, state.arguments
        is_own = state.is_other or bool(texts or arguments)
        trusted = self._trusts_typed or state.typed.isdisjoint(texts)
        as_trusted = trusted and files.trusted
        robot, result = self.known(files.model, texts, as_trusted, arguments), None
        if robot is None:
            try:
                with unsaved(texts):
                    robot = files.load(files.model, trusted, texts, arguments)
            except RobotError as error:
                robot = error
            result = _Result(robot, state, as_trusted)
        with self._change():
            self._loaded, self._result = state, result or self._result
            if isinstance(robot, RobotError):
                self.suspects = robot.files
                self._problems.set_text(robot.problems if is_own else None)
                return
            if self._closed:
                return
            self._shown = texts
            self._checks.texts, self.suspects = texts, ()
            self._problems.set_text(() if is_own else None)
            self._show(robot, is_own)

    def _check(self) -> None:
        with self._change.lock:
            state = self._wanted()
            of_model = self._of_model(state.files.model, state.texts)
            if self._closed:
                return
            around = {f: t for f, t in state.texts.items() if f not in of_model}
            self._checks.texts = {**around, **self._shown}
        try:
            self._checks.run_again()
        except Exception as error:
            self._problems.report_error(error)
        with self._change(*self._changed):
            self.checked = state.versions


def _of_robot(state: ModelState) -> object:
    """Return what the robot depends on."""
    return state.files.model, state.saves, state.texts, state.arguments
