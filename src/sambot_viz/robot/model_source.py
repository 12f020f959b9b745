"""Reads the text of a model as XML."""

from __future__ import annotations

import os
import stat
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

from sambot_viz import limits
from sambot_viz.errors import Problem, RobotError, did_you_mean
from sambot_viz.files import FileTooLargeError, read_limited
from sambot_viz.robot.xml.decode import XmlFault, decode, repaired_prolog
from sambot_viz.robot.xml.element import Element, parse_xml

PathLike = str | os.PathLike[str]

TEXT_LABEL = "<text>"
"""File name in problems of a model without a file."""


@dataclass(frozen=True, slots=True)
class ModelSource:
    """A model as text.

    Attributes:
        label: file as the user wrote it, or `TEXT_LABEL`.
        text: content.
        path: the file, or None for text.
        problems: peculiarities of the file itself.
        is_published: whether it came over a topic, where the text is expanded.
    """

    label: str
    text: str
    path: Path | None
    problems: tuple[Problem, ...] = ()
    is_published: bool = False

    @property
    def folder(self) -> Path | None:
        """The folder of the file, or None for text."""
        return None if self.path is None else self.path.absolute().parent


class OpenedModel(NamedTuple):
    """A model that is well-formed XML; xacro and URDF's rules come later.

    Attributes:
        source: text and file.
        document: root element.
    """

    source: ModelSource
    document: Element


def open_model(model: PathLike, edited: Mapping[str, str] | None = None) -> OpenedModel:
    """Read the text of a model as XML, for `load_robot`.

    Args:
        model: file, or XML text.
        edited: as for `load_robot`.

    Raises:
        RobotError: the model cannot be read, or is not well-formed.
    """
    label = os.fspath(model)
    text = edited.get(os.path.abspath(label)) if edited else None
    if text is not None:
        # The file on disk may have a mistake, or may be missing.
        return _parsed(_with_good_prolog(label, text, Path(label)))
    try:
        return _parsed(read_source(model))
    except XmlFault as fault:
        raise _explained(fault, os.fspath(model)) from None


def edited_model(opened: OpenedModel, texts: Mapping[str, str]) -> OpenedModel:
    """Return a model with another text for its file, if `texts` has one.

    Args:
        opened: the model.
        texts: absolute path of a file → its text.

    Raises:
        RobotError: the text is not well-formed.
    """
    path = opened.source.path
    text = None if path is None else texts.get(os.path.abspath(path))
    if text is None:
        return opened
    return _parsed(replace(opened.source, text=repaired_prolog(text)))


def open_text(text: str, label: str) -> OpenedModel:
    """Read the text of a topic as XML; it is never a file name.

    Args:
        text: the model.
        label: name of the model in problems.

    Raises:
        RobotError: the text is not well-formed.
    """
    source = _with_good_prolog(TEXT_LABEL, text, None)
    return _parsed(replace(source, label=label, is_published=True))


def _parsed(source: ModelSource) -> OpenedModel:
    try:
        return OpenedModel(source, parse_xml(source.text, source.label))
    except XmlFault as fault:
        raise _explained(fault, source.label) from None


def _explained(fault: XmlFault, label: str) -> RobotError:
    """Explain why a text is not XML."""
    # Only a model that is not XML needs the rules that explain the cause.
    from sambot_viz.robot.xml.diagnose.explain_xml import explain_xml

    return RobotError(explain_xml(fault.text, label, fault))


def read_source(model: PathLike) -> ModelSource:
    """Read a model from a path, or take it as text when it looks like XML.

    Raises:
        RobotError: the file does not exist, or cannot be read.
        XmlFault: the bytes do not match the declared encoding.
    """
    if isinstance(model, str) and looks_like_text(model):
        return _with_good_prolog(TEXT_LABEL, model, None)
    label = os.fspath(model)
    path = _path(label)
    return _with_good_prolog(label, decode(_read(path, label)), path)


def looks_like_text(model: str) -> bool:
    """Return whether a model is XML text, not a file name."""
    return model.lstrip("\ufeff \t\r\n").startswith("<") or "\n" in model


def _path(label: str) -> Path:
    try:
        return Path(label).expanduser()
    except RuntimeError:
        raise _refusal(
            "model-not-found", "there is no such user", "write the whole path", label
        ) from None


def _with_good_prolog(label: str, text: str, path: Path | None) -> ModelSource:
    text = text.removeprefix("\ufeff")
    repaired = repaired_prolog(text)
    if repaired == text:
        return ModelSource(label, text, path)
    problem = Problem(
        "warning",
        "xml-declaration-odd",
        "the XML declaration has no version; ROS 2 reads it, other programs refuse "
        "the file",
        'write <?xml version="1.0"?>',
        label,
        1,
        1,
    )
    return ModelSource(label, repaired, path, (problem,))


def _read(path: Path, label: str) -> bytes:
    try:
        mode = path.stat().st_mode
        if stat.S_ISDIR(mode):
            raise _refusal(
                "model-is-folder",
                "this is a folder, not a model file",
                _models_in(path),
                label,
            )
        if stat.S_ISCHR(mode) or stat.S_ISBLK(mode) or stat.S_ISSOCK(mode):
            raise _refusal(
                "model-unreadable",
                "this is a device or a socket, not a file",
                "give the URDF, SDF or xacro file",
                label,
            )
        return read_limited(path, limits.MODEL.value, pipe=True)
    except FileTooLargeError:
        raise _refusal(
            "model-too-large",
            f"the file has more than {limits.MODEL.value:,} bytes, too many for a "
            "robot description",
            "open the model file itself",
            label,
        ) from None
    except FileNotFoundError:
        raise _refusal(
            "model-not-found", "there is no such file", _nearest(path), label
        ) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise _refusal(
            "model-unreadable",
            f"the file cannot be read: {reason}",
            "check its permissions",
            label,
        ) from None


def _refusal(code: str, message: str, hint: str, label: str) -> RobotError:
    return RobotError([Problem("error", code, message, hint, label)])


def _models_in(folder: Path) -> str:
    found = sorted(
        str(path.relative_to(folder))
        for ending in ("urdf", "xacro", "sdf")
        for pattern in (f"*.{ending}", f"*/*.{ending}")
        for path in folder.glob(pattern)
    )
    if not found:
        return "give the model file itself"
    return f"give one of its files: {', '.join(found[:5])}"


def _nearest(path: Path) -> str:
    try:
        names = sorted(os.listdir(path.parent))
    except OSError:
        return f"the folder {path.parent} does not exist either"
    models = [n for n in names if n.endswith((".urdf", ".xacro", ".xml", ".sdf"))]
    return f"in {path.parent}: {did_you_mean(path.name, models)}"
