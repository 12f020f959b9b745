"""Shows the robot of an editor's texts, and checks them, in a thread."""

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
"""Absolute path of a file → its text."""
REST = 0.3
"""A moved number is at rest after this time without a move [s]."""


class ModelState(NamedTuple):
    """The state to show.

    Attributes:
        files: files of the model.
        is_other: whether the model differs from the server's.
        saves: number that changes when other programs save files of such a model.
        texts: texts that differ from the disk.
        arguments: arguments of xacro, in place of those of the command line.
        typed: files with text that a user has written.
        versions: name of a file → version of its text.
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
    """Shows each state that loads; after a mistake, the last good state stays.

    Args:
        robot: the shown robot.
        checks: checks that read these texts.
        problems: report why a text is not shown.
        show: shows the robot of a text; its second argument is True for unsaved text.
        change: change signal of the session.
        wanted: returns the state to show now; called with the session's lock held.
        trusts_typed: whether text of users is evaluated with the trust of the files.
        changed: called once the problems refer to other texts.

    Attributes:
        checked: name of a file → version of the text that the problems refer to.
        suspects: files of a text that does not load.
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
        self._tried = state
        self._result: _Result | None = None
        self._forgotten = 0

    def close(self) -> None:
        """Stop showing texts."""
        self._closed = True

    def wait(self, timeout: float) -> bool:
        """Wait until all texts or their problems are shown; False on a timeout [s]."""
        return self._background.wait(timeout)

    def known(
        self, model: Path, texts: Texts, trusted: bool, arguments: Texts | None = None
    ) -> Robot | RobotError | None:
        """Return the result of loading a model with some texts; None if not known.

        It is known if the last load used the same texts, unsaved or saved by now.

        Args:
            model: absolute path of the model file.
            texts: as in `ModelState`; texts of other files are ignored.
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
        # Another program may have saved a file whose text is not loaded here.
        if not loaded or not asked.keys() <= loaded.keys():
            return None
        now = (
            asked[file] if file in asked else read_file_text(Path(file)).text
            for file in loaded
        )
        return result.robot if [*now] == [*loaded.values()] else None

    def forget(self, saved: Iterable[Path] | None = None) -> None:
        """Forget the result of the last load, and of one that is running.

        Args:
            saved: forget it only if one of these files belongs to the model; None to
                forget it in any case.
        """
        files = self._files_of(self._loaded.files.model)
        if saved is None or not files.isdisjoint(saved):
            self._result = None
            self._forgotten += 1

    def begin(self, *, rests: bool = True) -> None:
        """Show the wanted state soon, then check it.

        Args:
            rests: False while a user drags a number: the checks wait until it rests.
        """
        self._background.do(self, self._load_newest)
        self._background.do(self._checks, self._check, after=0.0 if rests else REST)

    def _of_model(self, model: Path, texts: Texts) -> Texts:
        """Return the texts of the files that make up the robot."""
        known = self._files_of(model)
        return {file: text for file, text in texts.items() if Path(file) in known}

    def _files_of(self, model: Path) -> set[Path]:
        robot = self._robot.model
        files = (() if robot is None else robot.files, self.suspects)
        return {model, *(p.absolute() for each in files for p in each)}

    def _load_newest(self) -> None:
        try:
            with self._change.lock:
                self._tried = state = self._wanted()
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
        as_trusted, forgotten = trusted and files.trusted, self._forgotten
        robot, result = self.known(files.model, texts, as_trusted, arguments), None
        if robot is None:
            try:
                with unsaved(texts):
                    robot = files.load(files.model, trusted, texts, arguments)
            except RobotError as error:
                robot = error
            result = _Result(robot, state, as_trusted)
        with self._change():
            self._loaded = state
            if result is not None and forgotten == self._forgotten:
                self._result = result
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
            # A text that came after the load is checked after its own.
            if self._closed or _of_robot(state) != _of_robot(self._tried):
                return
            of_model = self._of_model(state.files.model, state.texts)
            around = {f: t for f, t in state.texts.items() if f not in of_model}
            self._checks.texts = {**around, **self._shown}
        try:
            self._checks.run_again()
        except Exception as error:
            self._problems.report_error(error)
        with self._change(*self._changed):
            self.checked = state.versions


def _of_robot(state: ModelState) -> object:
    """Return the parts of a state that determine the robot."""
    return state.files.model, state.saves, state.texts, state.arguments
