"""The text of the model's files in one session, as its users edit it.

The session shows each text that loads. After a mistake it keeps the last robot that
worked and reports the problem beside it. Only `save` writes to the disk.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from sambot_viz import limits
from sambot_viz.edits import Extent, SourceFile, apply_edits, by_file
from sambot_viz.errors import Edit, Place, RobotError, SambotVizError, UsageError
from sambot_viz.files import reason_of
from sambot_viz.fixes import EditRefused
from sambot_viz.outlet import logger
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Link
from sambot_viz.robot.xacro.diagnose.source_files import read_source
from sambot_viz.session.editor.buffer import Buffer, Replacement
from sambot_viz.session.editor.drafts import (
    draft_path,
    forget_draft,
    keep_draft,
    take_draft,
)
from sambot_viz.session.editor.file_text import to_units
from sambot_viz.session.editor.model_files import ModelFiles
from sambot_viz.session.editor.model_numbers import (
    ModelNumbers,
    ModelSources,
    arguments_of,
    laid_over,
)
from sambot_viz.session.editor.text_loader import ModelState, TextLoader, Texts
from sambot_viz.session.editor.words import OfferedElement, offered
from sambot_viz.session.model_edits import ModelEdits
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.shown_problems import Checks, Problems
from sambot_viz.session.signals import Change, Signal, connect
from sambot_viz.unsaved import unsaved

_log = logger(__name__)


class TextPlace(NamedTuple):
    """A place in a file: the file's name, a line, and an offset [UTF-16 units]."""

    file: str
    line: int
    extent: Extent


class ModelText:
    """The texts of the model in one session.

    Args:
        files: files of the model.
        robot: the shown robot.
        checks: checks that read these texts.
        problems: report why a text is not shown.
        saved: signals saves by other programs.
        show: shows the robot of a text; its second argument is True for unsaved text.
        change: change signal of the session.
        edits: saves the texts; None where browsers may not. Text that may not be saved
            is evaluated as text of unknown origin.

    Attributes:
        changed: signal after a change of the files, or of one of their texts.
        followed: signal after the texts were loaded and checked.
        numbers: properties and arguments of the model.
    """

    def __init__(
        self,
        files: ModelFiles,
        robot: RobotState,
        checks: Checks,
        problems: Problems,
        saved: Signal[frozenset[Path]],
        show: Callable[[Robot, bool], None],
        change: Change,
        edits: ModelEdits | None = None,
    ) -> None:
        self._robot, self._checks, self._problems = robot, checks, problems
        self._saved = saved
        self._files = self._of_server = files
        self._edits, self._saves, self._was_other = edits, 0, False
        self._paths: dict[str, Path] = {}
        self._buffers: dict[str, Buffer] = {}
        self._words: tuple[Robot | None, tuple[OfferedElement, ...]] | None = None
        self.changed, self.followed = Signal(change, None), Signal(change, None)
        # A copy of a session starts with the unsaved texts of the original.
        self.numbers = ModelNumbers(
            files.arguments, self._sources, change, checks.moved
        )
        for path, text in checks.texts.items():
            for name, whole in files.named([Path(path)]):
                self._paths[name] = whole
                self.buffer(name).take(text)
        self._loader = TextLoader(
            robot,
            checks,
            problems,
            show,
            change,
            self._wanted,
            self.can_save,
            (self.changed, self.followed),
        )
        facts = (robot.changed, checks.files, problems.saves)
        self._ends = (
            connect(facts, self._find),
            connect([saved], self._look),
            connect([self.numbers.moved], self._move),
        )
        self._find()

    def close(self) -> None:
        """Stop following the session."""
        self._loader.close()
        for end in self._ends:
            end()

    def wait(self, timeout: float) -> bool:
        """Wait until all texts or their problems are shown; False on a timeout [s]."""
        return self._loader.wait(timeout)

    def known(
        self, model: Path, texts: Texts, trusted: bool
    ) -> Robot | RobotError | None:
        """Return the result of loading a model; None where it is not known.

        Args:
            model: the model file.
            texts: texts that differ from the disk.
            trusted: as for `load_robot`.
        """
        return self._loader.known(model.absolute(), texts, trusted)

    def forget(self) -> None:
        """Forget the last load: a file that the model needs has come or gone."""
        self._loader.forget()

    @property
    def checked(self) -> Mapping[str, int]:
        """Name of a file → version of the text that the shown problems refer to."""
        return self._loader.checked

    @property
    def can_save(self) -> bool:
        """Return whether users may write the files."""
        return self._edits is not None

    @property
    def names(self) -> tuple[str, ...]:
        """The files, the model first."""
        return tuple(self._paths)

    @property
    def unsaved(self) -> tuple[Buffer, ...]:
        """The files whose text differs from the disk."""
        return tuple(b for b in self._buffers.values() if b.is_changed)

    @property
    def texts(self) -> Texts:
        """The unsaved texts."""
        return {str(buffer.path): buffer.text for buffer in self.unsaved}

    def holds(self, edits: Sequence[Edit]) -> bool:
        """Return whether all edits are in files of the model, one of them unsaved."""
        unsaved = {buffer.name for buffer in self.unsaved}
        names = {self.name_of(edit.file) for edit in edits}
        return "" not in names and not unsaved.isdisjoint(names)

    def name_of(self, file: str | None) -> str:
        """Return the name of a file; "" if the model does not use it."""
        if file is None:
            return ""
        whole = Path(os.path.abspath(file))
        return next((name for name, path in self._paths.items() if path == whole), "")

    @property
    def expanded(self) -> str:
        """The output of xacro for the last text that loaded; "" without xacro."""
        robot = self._robot.model
        source = None if robot is None else self._sources().texts
        return robot.description if robot is not None and source else ""

    def opened(self, name: str) -> Buffer | None:
        """Return an open file; None for others."""
        return self._buffers.get(name)

    def buffer(self, name: str) -> Buffer:
        """Return a file, and read it at the first call.

        Raises:
            UsageError: no file has this name.
        """
        path = self._paths.get(name)
        if path is None:
            raise UsageError("this file is no longer there")
        if name not in self._buffers:
            opened = self._buffers[name] = Buffer.opened(path, name)
            if self.can_save and take_draft(opened):
                _log.warning(
                    f"{name} has text that was not saved when the program ended: it "
                    "is in the editor"
                )
        return self._buffers[name]

    def link(self, name: str) -> Link | None:
        """Return a link of the robot."""
        robot = self._robot.model
        return None if robot is None else robot.links.get(name)

    def element_at(self, place: Place | None) -> TextPlace | None:
        """Locate an element in a file of the model; None for other places."""
        name = "" if place is None else self.name_of(place.file)
        if place is None or not name:
            return None
        source = SourceFile(self.buffer(name).text, "utf-8")
        start = min(source.offset(place), len(source.text))
        if place.column is None:
            # A macro call is known by its line only.
            line = source.text[start:].partition("\n")[0]
            start += len(line) - len(line.lstrip())
        tag = source.tag(start)
        end = start if tag is None else source.end_of(tag) or tag.end
        units = (to_units(source.text, at) for at in (start, end))
        return TextPlace(name, place.line, Extent(*units))

    def words(self) -> tuple[OfferedElement, ...]:
        """Return the elements that an editor offers; computed once for each robot."""
        robot = self._robot.model
        if self._words is None or self._words[0] is not robot:
            files = () if robot is None else map(str, robot.files)
            with unsaved(self.texts):
                self._words = robot, tuple(offered(robot, files))
        return self._words[1]

    def keys(self, buffer: Buffer) -> Mapping[str, Mapping[str, tuple[str, ...]]]:
        """Return the keys that an editor offers in a parameter file."""
        # Imported late so that the first page does not wait for the rules.
        from sambot_viz.session.editor.keys import offered_keys

        return offered_keys(self._robot.model, buffer.text)

    # Actions of users; the caller holds the session's lock.

    def replace(
        self, name: str, version: int, start: int, end: int, new: str, *, more: bool
    ) -> None:
        """Replace a part of a text, and show it unless more changes follow at once.

        The other arguments are those of `Buffer.replace`.

        Raises:
            UsageError: the text is too long.
        """
        buffer = self.buffer(name)
        before = buffer.text
        if buffer.replace(version, start, end, new):
            self._note_applied(buffer, before)
            self._tell(loads=not more)

    def _note_applied(self, buffer: Buffer, before: str) -> None:
        """Record a fix that the page's editor has applied to a text."""
        for problem in self._problems.shown.value.listed:
            edits = problem.edits
            is_of_text = edits and all(
                edit.seen == hash(before) and self.name_of(edit.file) == buffer.name
                for edit in edits
            )
            if is_of_text and apply_edits(edits, before) == buffer.text:
                self._problems.note_applied(edits)

    def apply(self, edits: Iterable[Edit]) -> None:
        """Apply the edits of a problem to the texts.

        Raises:
            UsageError: a text has changed since it was checked.
        """
        made: list[tuple[Buffer, str]] = []
        edits = tuple(edits)
        for file, own in by_file(edits).items():
            buffer = self.buffer(self.name_of(file))
            if any(edit.seen != hash(buffer.text) for edit in own):
                raise UsageError(f"{buffer.name} has changed since it was checked")
            made.append((buffer, apply_edits(own, buffer.text)))
        for buffer, text in made:
            buffer.take(text)
        self._problems.note_applied(edits)
        self._tell()

    def follow(self, model: Path) -> None:
        """Show another model of the folder in this session, or that of the server.

        Args:
            model: the model file, which need not exist.
        """
        model = model.absolute()
        if model == self._files.model:
            return
        own = self._of_server
        self._files = own if model == own.model else replace(own, model=model)
        self._was_other = True
        self._find()
        self._tell()

    def revert(self, name: str) -> list[Replacement]:
        """Return the changes that restore the text on disk; see `Buffer.revert`."""
        changes = self.buffer(name).revert()
        self._tell()
        return changes

    def put_back(
        self, name: str, now: str, before: str, moved: Mapping[str, float]
    ) -> None:
        """Undo or redo a change of the editor.

        Args:
            name: name of the file.
            now: its current text.
            before: the text that replaces it.
            moved: moved numbers after the call.

        Raises:
            UsageError: the text has changed meanwhile.
        """
        buffer = self.buffer(name)
        if buffer.text != now:
            raise UsageError("the text has changed since; Ctrl+Z in the text undoes it")
        buffer.take(before)
        self._tell()
        self.numbers.restore(moved)

    def keep(self, name: str, place: int | None = None) -> None:
        """Allow a save to overwrite another program's changes; see `Buffer.keep`."""
        self.buffer(name).keep(place)
        self._tell()

    def save_all(self) -> list[str]:
        """Save each unsaved text; return a reason for each that cannot be saved."""
        refused: list[str] = []
        for buffer in self.unsaved:
            try:
                self.save(buffer.name)
            except SambotVizError as error:
                refused.append(str(error))
        return refused

    def keep_drafts(self) -> list[str]:
        """Keep unsaved texts for the next program; return what cannot be kept."""
        refused: list[str] = []
        for buffer in self._buffers.values() if self.can_save else ():
            try:
                if buffer.is_changed:
                    keep_draft(buffer)
                else:
                    forget_draft(buffer.path)
            except OSError as error:
                refused.append(f"{buffer.name}: {reason_of(error)}")
        return refused

    def save(self, name: str) -> None:
        """Write a text into its file.

        Raises:
            UsageError: users may not write it, or another program has saved the file.
            EditRefused: the file cannot be written.
        """
        buffer = self.buffer(name)
        if self._edits is None:
            raise UsageError("this program writes no files; start it with --edit")
        if buffer.look():
            self._tell()
        if buffer.theirs is not None:
            raise UsageError(f"{name} was saved by another program meanwhile")
        try:
            data = buffer.disk.encoded(buffer.text)
        except UnicodeEncodeError as error:
            sign = error.object[error.start]
            raise UsageError(
                f"{name} is in {buffer.disk.encoding}, which has no '{sign}'"
            ) from error
        try:
            self._edits.save(buffer.path, buffer.disk.data, data)
        except EditRefused as error:
            if error.is_old and buffer.look():
                self._tell()
            raise
        buffer.saved(data)
        forget_draft(buffer.path)
        self._tell()

    @property
    def can_create(self) -> bool:
        """Return whether users may add files."""
        return self._edits is not None and self._edits.can_create

    def create(self, name: str) -> None:
        """Write an empty file, and open it.

        Args:
            name: as for `ModelEdits.create`.

        Raises:
            UsageError: users may not write it, or there are too many files.
            EditRefused: the file cannot be written.
        """
        if self._edits is None or len(self._paths) >= limits.EDITED_FILES.value:
            raise UsageError("no file can be added here")
        self._paths[name] = self._edits.create(name)
        self.buffer(name)
        self._find()
        # The model may include a file that was missing.
        self._saves += 1
        self._tell()

    # Consequences of edits

    def _tell(self, *, loads: bool = True) -> None:
        self.changed.touch()
        self.numbers.forget()
        if loads:
            self._loader.begin()

    def _move(self) -> None:
        """Show the moved numbers; run the checks once they rest."""
        self._checks.moved = self.numbers.moved.value
        self._loader.begin(rests=False)

    def _sources(self) -> ModelSources:
        robot = self._robot.model
        of_robot = () if robot is None else robot.files
        found = (self._files.model, *(path.absolute() for path in of_robot))
        names = {str(path): name for name, path in self._paths.items()}
        texts: dict[str, str] = {}
        for file in dict.fromkeys(map(str, found)):
            if file in names:
                text = self.buffer(names[file]).text
            else:
                source = read_source(file)
                text = "" if source is None else source.text
            if "xacro:" in text:
                texts[file] = text
        return ModelSources(texts, names)

    def _wanted(self) -> ModelState:
        """Return the state to show now."""
        typed, versions = self.texts, {n: b.version for n, b in self._buffers.items()}
        texts = dict(typed)
        numbers = self.numbers.listed() if self.numbers.moved.value else []
        for name in {n.file for n in numbers if n.moved is not None}:
            buffer = self.buffer(name)
            text = laid_over(buffer.text, (n for n in numbers if n.file == name))
            if text != buffer.text:
                texts[str(buffer.path)] = text
        files, is_other = self._files, self._files is not self._of_server
        return ModelState(
            files,
            is_other,
            self._saves,
            texts,
            arguments_of(numbers),
            frozenset(typed),
            versions,
        )

    def _find(self) -> None:
        """Look for the files of the model, after new ones may have appeared."""
        robot = self._robot.model
        found: list[Path] = [self._files.model, *self._loader.suspects]
        found += () if robot is None else robot.files
        found += sorted(self._checks.files.value)
        found += self._files.others()
        for problem in self._problems.of_newest:
            found += () if problem.file is None else (Path(problem.file),)
        named = self._files.named(dict.fromkeys(found))
        paths = {n: path for n, path in named if n in self._buffers or path.is_file()}
        paths = dict([*paths.items()][: limits.EDITED_FILES.value])
        for name, buffer in self._buffers.items():
            paths.setdefault(name, buffer.path)
        if [*paths.items()] != [*self._paths.items()]:
            self._paths = paths
            self.changed.touch()
            drafts = [
                name
                for name, path in paths.items()
                if name not in self._buffers and draft_path(path).exists()
            ]
            if self.can_save and any([self.buffer(n).is_changed for n in drafts]):
                self._tell()

    def _look(self) -> None:
        """Compare the files with the disk, after other programs may have saved them."""
        self._find()
        looked = [buffer.look() for buffer in self._buffers.values()]
        # This session has already loaded what it has saved.
        own = {b.path for b in self._buffers.values() if b.theirs is None}
        self._loader.forget(None if any(looked) else self._saved.value - own)
        if self._was_other:
            # The server follows only its own model.
            self._saves += 1
        if any(looked) or self._was_other:
            self._tell()
