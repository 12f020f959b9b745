"""What was given as a model: a file or text, and whether it needs xacro.

The content decides, not the file's ending (spec/real-files.md §2 number 12).
"""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from pathlib import Path

from sambot_viz.errors import Problem, RobotError, did_you_mean
from sambot_viz.robot.xml import Element
from sambot_viz.robot.xml_text import decode, mended_prolog

TEXT_LABEL = "<text>"
"""The file name in problems of a model that was given as text."""

_LFS = "version https://git-lfs"
_LARGEST = 64_000_000
_MAGIC = (
    (b"PK\x03\x04", "a zip archive", "unpack it and open the model inside"),
    (b"\x1f\x8b", "a gzip archive", "unpack it and open the model inside"),
    (b"%PDF", "a PDF document", "open the URDF or xacro file itself"),
    (b"glTF", "a glTF mesh", "open the URDF that uses it"),
    (b"\x89PNG", "a PNG picture", "open the URDF or xacro file itself"),
)
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
        RobotError: there is no such file, or it is obviously no model.
        XmlFault: the bytes are not in the encoding they claim.
    """
    if isinstance(model, str) and _looks_like_text(model):
        return _mended(TEXT_LABEL, model, None)
    label = os.fspath(model)
    path = Path(label).expanduser()
    data = _read(path, label)
    _refuse_other_kinds(data, label)
    return _mended(label, decode(data), path)


def _looks_like_text(model: str) -> bool:
    return model.lstrip("\ufeff \t\r\n").startswith("<") or "\n" in model


def _mended(label: str, text: str, path: Path | None) -> ModelSource:
    text = text.removeprefix("\ufeff")
    mended = mended_prolog(text)
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


def _refuse_other_kinds(data: bytes, label: str) -> None:
    if data.startswith(_LFS.encode()):
        raise _refusal(
            "model-lfs-pointer",
            "this is a git-LFS pointer, not the file itself",
            "run `git lfs pull` in its repository",
            label,
        )
    for magic, kind, hint in _MAGIC:
        if data.startswith(magic):
            raise _refusal("model-not-xml", f"this is {kind}, not a model", hint, label)
    utf16 = data[:2] in (b"\xff\xfe", b"\xfe\xff")
    if b"\0" in data[:4096] and not utf16:
        raise _refusal(
            "model-not-xml",
            "this is a binary file, not a model",
            "open the URDF or xacro file itself",
            label,
        )
    if not data.strip(b"\xef\xbb\xbf \t\r\n"):
        raise _refusal(
            "model-empty",
            "the file is empty",
            "check that it was saved, and that this is the right file",
            label,
        )


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


def needs_xacro(document: Element) -> bool:
    """Whether a document has to go through xacro before it is URDF.

    It does when it has xacro's own elements or attributes, or when a substitution
    stands where URDF wants a value. ``$(find …)`` in a Gazebo plugin or in a comment
    is no reason: xacro would fail there needlessly.
    """
    for element in document.iter():
        if element.tag.startswith("xacro:"):
            return True
        if any(name.startswith("xacro:") for name in element.attributes):
            return True
    robot = document if document.tag == "robot" else document.find("robot")
    if robot is None:
        return False
    return any(
        _has_substitution(element)
        for part in robot.children
        if part.tag in ("link", "joint", "material")
        for element in part.iter()
    )


def _has_substitution(element: Element) -> bool:
    return any(_SUBSTITUTION.search(value) for value in element.attributes.values())
