"""Finds the model that a student hands in, and its track of a lesson."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from sambot_viz.errors import UsageError
from sambot_viz.lessons.lesson import Lesson, LessonStep
from sambot_viz.robot.packages.package_index import package_around

_BEGIN = 4096
"""Number of first bytes in which an SDF model reveals its language."""
BUILT = frozenset({"build", "install", "log"})
"""Folders of a workspace that hold build results, not a student's files."""


@dataclass(frozen=True, slots=True)
class HandedIn:
    """Files that a student hands in.

    Attributes:
        folder: folder with all files; None for the folder of the model.
        track: track of the lesson.
        model: model file of the track, which need not exist.
        is_file: whether the student has handed in one file, not a folder.
    """

    folder: Path | None
    track: str
    model: Path
    is_file: bool

    def model_of(self, step: LessonStep) -> Path:
        """Return the model file of a step."""
        if not step.model or (self.is_file and self.model.name == step.model):
            return self.model
        return self.model.parent / step.model

    def folder_of(self, step: LessonStep) -> Path | None:
        """Return the folder with the files of a step; None for that of its model."""
        if not step.model or self.folder is None:
            return self.folder
        return folder_of(self.model_of(step), self.folder)


def handed_in(lesson: Lesson, path: Path) -> HandedIn:
    """Match a file or a folder with a lesson.

    Args:
        lesson: the lesson.
        path: a model, or a folder with one.

    Raises:
        UsageError: the file does not exist.
    """
    if not path.exists():
        raise UsageError(f"'{path}' does not exist; name a model file or a folder")
    tracks = lesson.tracks
    if path.is_dir():
        for name, track in tracks.items():
            for file in _models(path, track.model):
                return HandedIn(folder_of(file, path), name, file, False)
        name, track = next(iter(tracks.items()))
        return HandedIn(path, name, path / track.model, False)
    for name, track in tracks.items():
        if path.name == Path(track.model).name:
            return HandedIn(None, name, path, True)
    return HandedIn(None, _track_by_content(lesson, path), path, True)


def _track_by_content(lesson: Lesson, path: Path) -> str:
    with path.open("rb") as stream:
        begin = stream.read(_BEGIN)
    is_sdf = b"<sdf" in begin or path.suffix == ".sdf"
    for name, track in lesson.tracks.items():
        if track.model.endswith(".sdf") == is_sdf:
            return name
    return next(iter(lesson.tracks))


def _models(folder: Path, name: str) -> Iterator[Path]:
    """Yield the files with a name at and below a folder, without build results."""
    if (folder / name).is_file():
        yield folder / name
    for file in sorted(folder.glob(f"*/**/{name}")):
        if file.is_file() and BUILT.isdisjoint(file.relative_to(folder).parts):
            yield file


def folder_of(model: Path, folder: Path) -> Path:
    """Return the package of a model if it is below a folder, else the folder."""
    package = package_around(model)
    inside = package is not None and package.resolve().is_relative_to(folder.resolve())
    return package if package is not None and inside else folder
