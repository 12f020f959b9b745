"""Open a file of a recording; what it is is seen from its bytes, not from its name."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from sambot_viz.errors import Problem, SourceError
from sambot_viz.sources.bag.bag import Bag
from sambot_viz.sources.bag.block_bag import OPENING, unreadable
from sambot_viz.sources.bag.file_bytes import FileBytes
from sambot_viz.sources.bag.mcap import McapBag
from sambot_viz.sources.bag.mcap_records import MAGIC


def open_bag(path: str | os.PathLike[str]) -> Bag:
    """Open a file of a recording.

    Args:
        path: an MCAP file.

    Raises:
        SourceError: it is not there, or is no recording.
    """
    path = Path(path)
    try:
        if not stat.S_ISREG(path.stat().st_mode):
            raise _not_a_bag(path, "it is not a regular file")
        file = FileBytes(path)
    except (OSError, ValueError) as error:
        raise unreadable(path, error) from error
    try:
        return _open(file)
    except BaseException:
        file.close()
        raise


def _open(file: FileBytes) -> Bag:
    if not file.size:
        message = f"{file.path.name} is empty (0 bytes)"
        hint = "record again, or copy the file again: nothing can be read from it"
        raise _refused(file.path, "file-empty", message, hint)
    try:
        begin = file.read_at(0, 4096)
    except (OSError, ValueError) as error:
        raise unreadable(file.path, error) from error
    if not begin.startswith(MAGIC):
        raise _not_a_bag(file.path, _kind(begin))
    bag = McapBag(file)
    bag.index_more(OPENING)
    return bag


def _kind(begin: bytes) -> str:
    if all(byte >= 32 or byte in b"\t\n\r\f" for byte in begin) and begin.isascii():
        return "it is a text file"
    if not begin.strip(b"\x00"):
        return "it begins with zeros"
    return "it begins neither as MCAP, nor as sqlite3, nor as a ROS 1 bag"


def _not_a_bag(path: Path, why: str) -> SourceError:
    message = f"{path.name} is not a recording: {why}"
    hint = "give a .mcap, .db3 or .bag file, or the folder that holds it"
    return _refused(path, "file-not-a-bag", message, hint)


def _refused(path: Path, code: str, message: str, hint: str) -> SourceError:
    return SourceError([Problem("error", code, message, hint, str(path))])
