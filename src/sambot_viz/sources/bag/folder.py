"""The files of a folder that rosbag2 wrote; its metadata.yaml is only a hint.

It is missing when the recorder was killed, and wrong when a file was renamed.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

from sambot_viz import limits
from sambot_viz.errors import Problem
from sambot_viz.sources.bag.refusals import refused, unreadable

METADATA = "metadata.yaml"
STATE = "sambot_viz.recording"
"""The key in `custom_data` of metadata.yaml; its value is one of the next two."""
RUNNING, ENDED = "running", "ended"

_BESIDE = ("-wal", "-shm", "-journal")
ENDINGS = (".mcap", ".db3", ".bag", ".zstd", ".zst")
_GIVE_FILES = "give the recordings in it one by one, each with --source FILE"
_NAMES = re.compile(
    r"^\s*relative_file_paths:[ \t]*\n((?:[ \t]*-[^\n]*\n?)+)", re.MULTILINE
)


def files_of(folder: Path) -> tuple[list[Path], list[Problem]]:
    """Return the recordings in a folder, and the errors of its metadata.yaml.

    Args:
        folder: the folder; its subfolders are not searched.

    Raises:
        SourceError: it contains no recording.
    """
    try:
        # One more than may be: whether there are too many.
        every = list(islice(folder.iterdir(), limits.RECORDING_FILES.value + 1))
        there = sorted(_listed(every))
    except (OSError, ValueError) as error:
        raise unreadable(folder, error) from error
    files = [path for path in there if path.name.endswith(ENDINGS)]
    too_many = _too_many(folder, every)
    if too_many:
        # What was not looked at is not missing.
        code, where = "folder-too-large", str(folder)
        if not files:
            raise refused(folder, code, too_many, _GIVE_FILES)
        return files, [Problem("warning", code, too_many, _GIVE_FILES, where)]
    named = _named(folder)
    present = {path.name for path in there}
    missing = [name for name in named if name not in present]
    if not files:
        if missing:
            message = _missing(missing)
            hint = "copy that file into the folder, beside metadata.yaml"
            raise refused(folder, "file-missing", message, hint)
        message = f"the folder {folder.name} has no .mcap, .db3 or .bag file"
        hint = "give the folder that 'ros2 bag record' has made, or one of its files"
        raise refused(folder, "file-not-a-bag", message, hint)
    return files, _stale(folder, named, missing, files)


def _listed(every: list[Path]) -> Iterator[Path]:
    for path in every[: limits.RECORDING_FILES.value]:
        if not path.name.endswith(_BESIDE) and path.is_file():
            yield path


def _too_many(folder: Path, every: list[Path]) -> str:
    limit = limits.RECORDING_FILES.value
    if len(every) <= limit:
        return ""
    return (
        f"the folder {folder.name} has more than {limit:,} files; the others are not "
        "looked at"
    )


def _stale(
    folder: Path, named: list[str], missing: list[str], files: list[Path]
) -> list[Problem]:
    if not missing:
        return []
    others = [path.name for path in files if path.name not in named]
    where = str(folder / METADATA)
    if not others:
        hint = "copy that file into the folder; what is there is shown"
        return [Problem("warning", "file-missing", _missing(missing), hint, where)]
    verb = "was found and is shown" if len(others) == 1 else "were found and are shown"
    message = f"metadata.yaml names {_listing(missing)}; {_listing(others)} {verb}"
    command = f"ros2 bag reindex {shlex.quote(str(folder))}"
    hint = f"run '{command}' to write metadata.yaml again"
    return [Problem("info", "metadata-stale", message, hint, where)]


def _missing(names: list[str]) -> str:
    verb = "which is" if len(names) == 1 else "which are"
    return f"metadata.yaml names {_listing(names)}, {verb} not in the folder"


def _listing(names: list[str]) -> str:
    return ", ".join(names[:5]) + (", …" if len(names) > 5 else "")


def _named(folder: Path) -> list[str]:
    """Return the names of the files in the metadata.yaml of a folder."""
    try:
        with (folder / METADATA).open("rb") as stream:
            text = stream.read(limits.METADATA.value).decode("utf-8", "replace")
    except (OSError, ValueError):
        return []
    return names_in(text)


def names_in(text: str) -> list[str]:
    """Return the names of the files in a metadata.yaml, without the folder before."""
    found = _NAMES.search(text)
    if found is None:
        return []
    lines = (line.strip() for line in found[1].splitlines())
    names = (line[1:].strip().strip("'\"") for line in lines)
    return [re.split(r"[\\/]", name)[-1] for name in names if name]
