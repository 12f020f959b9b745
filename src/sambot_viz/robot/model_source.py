"""What was given as a model: a file or text, and whether it needs xacro.

The content decides, not the file's ending (spec/real-files.md §2 number 12).
"""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from pathlib import Path

from sambot_viz.errors import Problem, RobotError, did_you_mean
from sambot_viz.robot.xml.decode import decode, repaired_prolog
from sambot_viz.robot.xml.parse import Element

TEXT_LABEL = "<text>"
"""The file name in problems of a model that was given as text."""

_LARGEST = 64_000_000
_SUBSTITUTION = re.compile(r"\$[{(]")


@dataclass(frozen=True, slots=True)
class ModelSource:
    """A model as text.

    Attributes:
        label: the file as the user wrote it, or `TEXT_LABEL`.
        text: the content.
        path: the file, or None for text.
        problems: what was odd about the file itself.
    """

    label: str
    text: str
    path: Path | None
    problems: tuple[Problem, ...] = ()


def read_source(model: str | os.PathLike[str]) -> ModelSource:
    """Take a model as a path, or as text when it looks like XML.

    Raises:
        RobotError: there is no such file, or it cannot be read.
        XmlFault: the bytes are not in the encoding they claim.
    """
    if isinstance(model, str) and _looks_like_text(model):
        return _mended(TEXT_LABEL, model, None)
    label = os.fspath(model)
    path = Path(label).expanduser()
    return _mended(label, decode(_read(path, label)), path)


def _looks_like_text(model: str) -> bool:
    return model.lstrip("\ufeff \t\r\n").startswith("<") or "\n" in model


def _mended(label: str, text: str, path: Path | None) -> ModelSource:
    text = text.removeprefix("\ufeff")
    mended = repaired_prolog(text)
    if mended == text:
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
    return ModelSource(label, mended, path, (problem,))


def _read(path: Path, label: str) -> bytes:
    try:
        if path.is_dir():
            raise _refusal(
                "model-is-folder",
                "this is a folder, not a model file",
                _models_in(path),
                label,
            )
        if path.stat().st_size > _LARGEST:
            raise _refusal(
                "model-too-large",
                "the file is larger than 64 MB, which no robot description is",
                "open the URDF or xacro file itself",
                label,
            )
        return path.read_bytes()
    except FileNotFoundError:
        raise _refusal(
            "model-not-found", "there is no such file", _nearest(path), label
        ) from None
    except OSError as error:
        reason = error.strerror or str(error)
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
        for pattern in ("*.urdf", "*.xacro", "*/*.urdf", "*/*.xacro")
        for path in folder.glob(pattern)
    )
    if not found:
        return "give the URDF or xacro file itself"
    return f"give one of its files: {', '.join(found[:5])}"


def _nearest(path: Path) -> str:
    try:
        names = os.listdir(path.parent)
    except OSError:
        return f"the folder {path.parent} does not exist either"
    models = [n for n in names if n.endswith((".urdf", ".xacro", ".xml", ".sdf"))]
    return f"in {path.parent}: {did_you_mean(path.name, models)}"


def first_xacro(document: Element) -> Element | None:
    """The first element for which a document has to go through xacro, or None.

    It has to when it has xacro's own elements or attributes, or when a substitution
    stands where URDF wants a value. ``$(find …)`` in a Gazebo plugin or in a comment
    is no reason: xacro would fail there needlessly.
    """
    for element in document.iter():
        if element.tag.startswith("xacro:"):
            return element
        if any(name.startswith("xacro:") for name in element.attributes):
            return element
    robot = document if document.tag == "robot" else document.find("robot")
    parts = robot.children if robot is not None else []
    return next(
        (
            element
            for part in parts
            if part.tag in ("link", "joint", "material")
            for element in part.iter()
            if _has_substitution(element)
        ),
        None,
    )


def _has_substitution(element: Element) -> bool:
    return any(_SUBSTITUTION.search(value) for value in element.attributes.values())
