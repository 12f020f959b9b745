"""Open recordings; the format of a file is known by its bytes, not by its name."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable
from pathlib import Path

from sambot_viz.errors import Problem, SourceError
from sambot_viz.files import (
    is_lfs_pointer,
    is_web_address,
    is_web_folder,
    name_of_address,
)
from sambot_viz.sources.bag import db3_file, mcap_records, ros1
from sambot_viz.sources.bag.bag import Bag
from sambot_viz.sources.bag.block_bag import OPENING, BlockBag
from sambot_viz.sources.bag.db3 import Db3Bag
from sambot_viz.sources.bag.file_bytes import FileBytes
from sambot_viz.sources.bag.folder import METADATA, files_of
from sambot_viz.sources.bag.mcap import McapBag
from sambot_viz.sources.bag.recording import Recording
from sambot_viz.sources.bag.refusals import (
    lfs_pointer,
    not_a_bag,
    refused,
    unreadable,
)
from sambot_viz.sources.bag.whole_file import ZSTD, unpacked


def open_bag(path: str | os.PathLike[str]) -> Bag:
    """Open a file of a recording.

    Args:
        path: an MCAP file, rosbag2's sqlite3 file or a ROS 1 bag; or the address of
            the first or the last on a web server.

    Raises:
        SourceError: it is not there, or is not a recording.
    """
    if isinstance(path, str) and is_web_address(path):
        return _opened(_on_the_web(path))
    path = Path(path)
    try:
        if not stat.S_ISREG(path.stat().st_mode):
            raise not_a_bag(path, "it is not a regular file")
        file = FileBytes(path)
    except (OSError, ValueError) as error:
        raise unreadable(path, error) from error
    return _opened(file)


def _on_the_web(address: str) -> FileBytes:
    # It takes 0.1 s to import.
    from sambot_viz.sources.bag.web_bytes import WebBytes

    try:
        return WebBytes(address)
    except (OSError, ValueError) as error:
        raise unreadable(Path(name_of_address(address)), error) from error


def _opened(file: FileBytes) -> Bag:
    try:
        return _open(file)
    except BaseException:
        file.close()
        raise


def open_recording(
    paths: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
) -> Recording:
    """Open files and folders as one recording.

    Args:
        paths: one or several; a folder means the recordings in it.

    Raises:
        SourceError: one of them cannot be opened, or no file of a folder can.
    """
    if isinstance(paths, (str, os.PathLike)):
        paths = [paths]
    bags: list[Bag] = []
    problems: list[Problem] = []
    try:
        for path in paths:
            if isinstance(path, str) and is_web_folder(path):
                opened, found = _open_web_folder(path)
                bags += opened
                problems += found
            elif not is_web_address(path) and (path := Path(path)).is_dir():
                opened, found = _open_folder(path)
                bags += opened
                problems += found
            else:
                bags.append(open_bag(path))
    except BaseException:
        for bag in bags:
            bag.close()
        raise
    return Recording(bags, problems)


def _open_folder(folder: Path) -> tuple[list[Bag], list[Problem]]:
    """Open the recordings of a folder, without those that cannot be opened."""
    files, problems = files_of(folder)
    return _open_each(files, problems)


def _open_web_folder(address: str) -> tuple[list[Bag], list[Problem]]:
    """Open the files that the list of a folder on a web server names."""
    from sambot_viz.sources.bag.web_folder import WebFolder

    folder = WebFolder(address)
    try:
        names = folder.read_list().names
    except OSError as error:
        raise unreadable(Path(METADATA), error) from error
    finally:
        folder.close()
    if not names:
        where, message = Path(METADATA), f"{METADATA} names no file yet"
        raise refused(where, "file-not-a-bag", message, "open it in some seconds")
    return _open_each([folder.address_of(name) for name in names], [])


def _open_each(
    files: Iterable[str | Path], problems: list[Problem]
) -> tuple[list[Bag], list[Problem]]:
    bags: list[Bag] = []
    refusal: SourceError | None = None
    for file in files:
        try:
            bags.append(open_bag(file))
        except SourceError as error:
            refusal = refusal or error
            problems += error.problems
    if refusal is not None and not bags:
        raise refusal
    return bags, problems


def _open(file: FileBytes) -> Bag:
    if not file.size:
        message = f"{file.path.name} is empty (0 bytes)"
        hint = "record again, or copy the file again: nothing can be read from it"
        raise refused(file.path, "file-empty", message, hint)
    try:
        begin = file.read_at(0, 4096)
    except (OSError, ValueError) as error:
        raise unreadable(file.path, error) from error
    if begin.startswith(ZSTD) and not file.is_unpacked:
        inner = FileBytes(file.path, unpacked(file))
        try:
            return _open(inner)
        except BaseException:
            inner.close()
            raise
    bag = _of_its_format(file, begin)
    try:
        bag.index_more(OPENING)
    except BaseException:
        bag.close()
        raise
    return bag


def _of_its_format(file: FileBytes, begin: bytes) -> BlockBag:
    if begin.startswith(mcap_records.MAGIC):
        return McapBag(file)
    if begin.startswith(db3_file.MAGIC):
        return Db3Bag(file)
    if begin.startswith(ros1.MAGIC):
        return ros1.Ros1Bag(file)
    if is_lfs_pointer(begin):
        raise lfs_pointer(file.path)
    raise not_a_bag(file.path, _kind(begin))


def _kind(begin: bytes) -> str:
    if all(byte >= 32 or byte in b"\t\n\r\f" for byte in begin) and begin.isascii():
        return "it is a text file"
    if not begin.strip(b"\x00"):
        return "it begins with zeros"
    return "it begins neither as MCAP, nor as sqlite3, nor as a ROS 1 bag"
