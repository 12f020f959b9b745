"""The text of an .rviz file with its nodes: reading it, changing it, saving it."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import yaml

from sambot_viz import limits
from sambot_viz.edits import write
from sambot_viz.errors import ConfigError, Findings, Fix, Place, Problem
from sambot_viz.files import is_recording, read_limited, write_atomically
from sambot_viz.rviz.yaml.explain_yaml import explain_yaml, other_format
from sambot_viz.rviz.yaml.parser import ParseFault, parse
from sambot_viz.rviz.yaml.yaml_nodes import Entry, Map, Node, Scalar, copied, same

_SECTIONS = ("Visualization Manager", "Panels", "Window Geometry")


class ConfigFindings(Findings):
    """Collects the warnings of one file.

    Args:
        file: its path as the user wrote it.
    """

    def __init__(self, file: str | None) -> None:
        super().__init__()
        self._file = file

    def warn(
        self, code: str, node: Node, message: str, hint: str = "", right: str = ""
    ) -> None:
        """Add a warning at a node; copies are reported at their originals.

        Args:
            code: code of the problem.
            node: its place.
            message: the fault.
            hint: the remedy.
            right: the replacement of the node's text; empty for no edit.
        """
        if node.span is not None:
            line, column = node.span.line, node.span.column
            where: Place | str | None = self._file
            fix: Fix | str = hint
            if self._file is not None:
                where = Place(self._file, line, column)
                if right and isinstance(node, Scalar):
                    fix = write(where, node.text, right, hint=hint)
            problem = Problem.at(where, "warning", code, message, fix)
            self.note(replace(problem, line=line, column=column))

    def warn_without_dash(self, entry: Entry) -> None:
        """Add a warning at the first key of an item whose dash is missing."""
        value, key = entry.value, entry.key or ""
        if value.span is None:
            return
        line = _line_of_key(value)
        hint = f'write "- " before {key} (line {line}) in place of two blanks'
        fix: Fix | str = hint
        where: Place | str | None = self._file
        if self._file is not None:
            where = Place(self._file, line)
            fix = write(where, f"  {key}:", f"- {key}:", hint=hint)
        message = "two items of a list are one here, and the first is lost"
        problem = Problem.at(where, "warning", "config-duplicate-key", message, fix)
        self.note(replace(problem, line=line))

    def warn_key(self, entry: Entry, message: str, right: str) -> None:
        """Add a warning at a key that was meant to be another.

        Args:
            entry: the entry with the key.
            message: the fault.
            right: the intended key.
        """
        value, key = entry.value, entry.key or ""
        if value.span is None:
            return
        line = _line_of_key(value)
        fix: Fix | str = f"write {right}"
        where: Place | str | None = self._file
        if self._file is not None:
            where = Place(self._file, line)
            fix = write(where, key, right)
        problem = Problem.at(where, "warning", "config-property", message, fix)
        self.note(replace(problem, line=line))


def _line_of_key(value: Node) -> int:
    """Return the line of the key of a value that is in a file."""
    if value.span is None:
        raise ValueError("the value is in no file")
    # What a map or a list has begins in the line below its key.
    return value.span.line - (not isinstance(value, Scalar) and not value.flow)


class Document:
    """One .rviz file.

    Attributes:
        root: the top-level map; change its nodes to change the file.
        file: the path as the user wrote it, for messages.
        problems: what was found on reading.
    """

    def __init__(self, text: str, file: str | None = None):
        """Read a text.

        Args:
            text: the file, with its own line breaks.
            file: its path as the user wrote it.

        Raises:
            ConfigError: it is not YAML, or is YAML of something else.
        """
        self.file = file
        self.problems: list[Problem] = []
        self._bom = "\ufeff" if text.startswith("\ufeff") else ""
        self._text = text.removeprefix("\ufeff")
        self._newline = "\r\n" if "\r\n" in self._text else "\n"
        self.root = self._read()
        self._saved: Node | None = None

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Document:
        """Read a file.

        Raises:
            ConfigError: the file cannot be read, or is not a .rviz document.
        """
        name = os.fspath(path)
        try:
            data = read_limited(Path(path), limits.CONFIG.value, pipe=True)
        except (OSError, ValueError) as error:
            _refuse_recording(name)
            why = getattr(error, "strerror", None) or str(error)
            hint = "check the path"
            raise _error(
                "config-unreadable", f"cannot read it: {why}", hint, name
            ) from error
        try:
            return cls(data.decode("utf-8"), name)
        except UnicodeDecodeError as error:
            _refuse_recording(name)
            line = data[: error.start].count(b"\n") + 1
            raise _error(
                "config-encoding",
                "this line is not UTF-8",
                "save it as UTF-8",
                name,
                line,
            ) from None

    def _read(self) -> Map:
        strange = other_format(self._text, self.file)
        if strange is not None:
            raise ConfigError([strange])
        try:
            root = parse(self._text)
        except (yaml.YAMLError, ParseFault) as error:
            raise ConfigError([explain_yaml(self._text, error, self.file)]) from error
        if root is None or (isinstance(root, Scalar) and root.null):
            self._warn_of_emptiness("the file is empty: it gives no displays")
            return Map()
        if not isinstance(root, Map):
            raise _not_rviz(self.file)
        if root.entries and not any(root.entry(name) for name in _SECTIONS):
            raise _not_rviz(self.file)
        if not isinstance(root.get(_SECTIONS[0]), Map):
            self._warn_of_emptiness(
                f"'{_SECTIONS[0]}' is missing: there are no displays"
            )
        return root

    def _warn_of_emptiness(self, message: str) -> None:
        hint = "add displays and save, or give another file"
        self.problems.append(
            Problem("warning", "config-empty", message, hint, self.file)
        )

    def to_yaml(self) -> str:
        """Return the text of the file as it would be saved.

        Returns:
            The text that was read, with only the changes in it. If that does not read
            back as the present values, the whole document is written as RViz does.
        """
        if not self.root.changed and self.root.span is not None:
            return self._bom + self._text
        for text in (self._patched(), self._written("")):
            if _reads_as(text, self.root):
                return self._bom + text
        raise AssertionError("the plain writer writes what the parser reads")

    def _patched(self) -> str:
        if self.root.span is None:
            # The file had comments only, or nothing.
            kept = self._text if self._text.strip() else ""
            return kept + self._written("")
        return self._written(self._text)

    def _written(self, text: str) -> str:
        # The import is late: most configs are only read.
        from sambot_viz.rviz.yaml.writer import Writer

        return Writer(text, self._newline).document(self.root)

    @property
    def modified(self) -> bool:
        """Return whether the file differs from what was read or saved last."""
        if self._saved is None:
            return self.root.changed if self.root.span else bool(self.root.entries)
        return not same(self.root, self._saved)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the file; readers see the old one or the new one, never half of it.

        Args:
            path: where to; a symbolic link stays one.

        Raises:
            ConfigError: it cannot be written; the old file is untouched.
        """
        text = self.to_yaml()
        try:
            write_atomically(Path(path), text.encode("utf-8"))
        except OSError as error:
            why = error.strerror or str(error)
            raise _error(
                "config-unwritable",
                f"cannot write it: {why}",
                "choose another place",
                os.fspath(path),
            ) from error
        self._saved = copied(self.root)
        self.file = os.fspath(path)


def _reads_as(text: str, root: Node) -> bool:
    try:
        read = parse(text)
    except (yaml.YAMLError, ParseFault):
        return False
    return same(root, read if read is not None else Map())


def _refuse_recording(name: str) -> None:
    """Raise ConfigError for a file that cannot be read because it is a recording."""
    if is_recording(name):
        hint = f"show it with --source {name}, and give an .rviz file as the config"
        message = "this is a recording, not a display config"
        raise _error("config-not-rviz", message, hint, name) from None


def _not_rviz(file: str | None) -> ConfigError:
    return _error(
        "config-not-rviz",
        "this YAML is not a .rviz document: 'Visualization Manager' is missing",
        "give a file that RViz has saved, or one with the same structure",
        file,
        1,
    )


def _error(
    code: str, message: str, hint: str, file: str | None, line: int | None = None
) -> ConfigError:
    return ConfigError([Problem("error", code, message, hint, file, line)])
