"""Shows the robot of the texts in an editor, and checks them, in a thread."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from sambot_viz.errors import RobotError
from sambot_viz.robot.model import Robot
from sambot_viz.robot.xacro.expansion import SpareChild
from sambot_viz.session.background import Background
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
        texts: those that differ from the disk.
        arguments: of xacro, in place of those of the command line.
        typed: the files whose text a user has written.
        versions: name of a file → the version of its text.
    """

    texts: Texts
    arguments: Mapping[str, str]
    typed: frozenset[str]
    versions: Mapping[str, int]


class TextLoader:
    """Shows each state of the texts that loads; one with a mistake leaves the last one.

    Args:
        files: those of the model.
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
        files: ModelFiles,
        robot: RobotState,
        checks: Checks,
        problems: Problems,
        show: Callable[[Robot, bool], None],
        change: Change,
        wanted: Callable[[], ModelState],
        trusts_typed: bool,
        changed: Sequence[Signal[None]],
    ) -> None:
        self._files, self._robot, self._checks = files, robot, checks
        self._problems, self._show, self._change = problems, show, change
        self._wanted, self._trusts_typed = wanted, trusts_typed
        self._changed = changed
        self.checked: Mapping[str, int] = {}
        self.suspects: tuple[Path, ...] = ()
        self._background = Background("sambot-viz-text")
        self._spare, self._closed = SpareChild(), False
        arguments = wanted().arguments
        self._loaded = self._shown = (self.of_model(checks.texts), arguments)

    def close(self) -> None:
        """Show nothing more."""
        self._closed = True
        self._spare.end()

    def wait(self, timeout: float) -> bool:
        """Wait until each text is shown, or its problems; False for longer [s]."""
        return self._background.wait(timeout)

    def begin(self, *, rests: bool = True) -> None:
        """Show what is wanted now, soon; then check it.

        Args:
            rests: False while a hand moves a number: only when it rests, the checks
                follow.
        """
        self._background.do(self, self._load_newest)
        self._background.do(self._checks, self._check, after=0.0 if rests else REST)

    def of_model(self, texts: Texts) -> Texts:
        """Return those of the files that the robot is loaded from."""
        robot = self._robot.model
        files = (() if robot is None else robot.files, self.suspects)
        known = {self._files.model, *(p.absolute() for each in files for p in each)}
        return {file: text for file, text in texts.items() if Path(file) in known}

    def _load_newest(self) -> None:
        try:
            with self._change.lock:
                wanted = self._wanted()
                texts = self.of_model(wanted.texts)
                if self._closed or (texts, wanted.arguments) == self._loaded:
                    return
            trusted = self._trusts_typed or wanted.typed.isdisjoint(texts)
            self._load(texts, wanted.arguments, trusted)
        except Exception as error:
            self._problems.report_error(error)
        finally:
            if self._closed:
                self._spare.end()

    def _load(self, texts: Texts, arguments: Mapping[str, str], trusted: bool) -> None:
        loaded, is_own = (texts, arguments), bool(texts or arguments)
        try:
            with unsaved(texts), self._spare.used():
                robot = self._files.load(trusted, texts, arguments)
        except RobotError as error:
            with self._change():
                self._loaded, self.suspects = loaded, error.files
                self._problems.set_text(error.problems if is_own else None)
            return
        with self._change():
            if self._closed:
                return
            self._loaded = self._shown = loaded
            self._checks.texts, self.suspects = texts, ()
            self._problems.set_text(() if is_own else None)
            self._show(robot, is_own)

    def _check(self) -> None:
        with self._change.lock:
            wanted = self._wanted()
            texts, of_model = wanted.texts, self.of_model(wanted.texts)
            if self._closed:
                return
            around = {f: t for f, t in texts.items() if f not in of_model}
            self._checks.texts = {**around, **self._shown[0]}
        try:
            self._checks.run_again()
        except Exception as error:
            self._problems.report_error(error)
        with self._change(*self._changed):
            self.checked = wanted.versions
