"""The one outlet to the terminal and the log: nothing else writes there.

What comes from a file or from the network may hold escape codes that a terminal obeys,
or line breaks that make one line look like two; so may names of files. Each line passes
`text.line`, and gets its colors after that. What others write (argparse, viser,
logging, warnings, tracebacks) is cleaned in the process of a command, see `guarded`.
"""

from __future__ import annotations

import contextlib
import io
import logging
import os
import re
import sys
import traceback
from collections.abc import Generator, Sequence
from datetime import datetime, timezone
from typing import Any, Literal, NamedTuple, TextIO, TypeAlias, cast

from sambot_viz.text import json_text, line, lines, xml_text

Style = Literal["error", "warning", "info", "bold", "dim", "added", "removed"]

_CODES: dict[Style, str] = {
    "error": "\033[1;31m",
    "warning": "\033[1;33m",
    "info": "\033[1;36m",
    "bold": "\033[1m",
    "dim": "\033[2m",
    "added": "\033[32m",
    "removed": "\033[31m",
}
_END = "\033[0m"
_SAID = re.compile(r"\b(error|warning|note): ")
_LEVELS = {"note": "info"}


class Painted(NamedTuple):
    """A part of a line that is written in a color, on a terminal that has colors."""

    words: str
    style: Style


Line: TypeAlias = "str | Sequence[str | Painted]"
"""Text for a single line; a line break in it is written as a blank."""


def write_err(*written: Line) -> None:
    """Write lines to standard error; as JSON they are one record."""
    if _FORMAT.records:
        _write_record(_level(written), [_words(each, False) for each in written])
    else:
        _write(sys.stderr, *written)


def write_out(*written: Line) -> None:
    """Write lines to standard output."""
    _write(sys.stdout, *written)


def write_json(value: Any) -> None:
    """Write a value as JSON to standard output; escape invisible characters."""
    _write_raw(sys.stdout, f"{json_text(value)}\n")


def write_xml(document: str) -> None:
    """Write an XML document to standard output; see `text.xml_text`."""
    _write_raw(sys.stdout, xml_text(document))


def write_lines(document: str) -> None:
    """Write a text whose line breaks are its own to standard output."""
    _write_raw(sys.stdout, lines(document))


def write_code(url: str) -> None:
    """Draw an address for the camera of a phone, where standard error is a terminal."""
    stream = _own(sys.stderr)
    if stream is not None and stream.isatty():
        import segno

        segno.make(url, error="l").terminal(stream, compact=True, border=2)


def can_ask() -> bool:
    """Tell if a question is seen, and can be answered: both are on a terminal."""
    streams = (_own(sys.stdout), sys.stdin)
    return all(stream is not None and stream.isatty() for stream in streams)


def ask(question: str) -> str | None:
    """Write a question, and return the line of the answer; None at its end."""
    _write_raw(sys.stdout, f"{line(question)} ")
    answer = sys.stdin.readline()
    return answer.strip() if answer else None


def write_records(wanted: bool) -> None:
    """Write what goes to standard error as JSON from now on, a record in each line.

    A record has time (UTC, as ISO 8601), level (error, warning or info), message, and
    of the log of a module the name of its logger.

    Args:
        wanted: whether to; else lines are written as they are.
    """
    _FORMAT.records = wanted


@contextlib.contextmanager
def guarded() -> Generator[None]:
    """Let everything that this process writes pass the outlet.

    For the process of a command; its readers may leave before the end (`2>&1 | head`).
    """
    out, err, last = sys.stdout, sys.stderr, logging.lastResort
    _speak_utf8(out, err)
    sys.stdout = cast(TextIO, _Guard(out))
    sys.stderr = cast(TextIO, _Guard(err, may_leave=True))
    take_log()
    try:
        yield
    finally:
        sys.stdout, sys.stderr, logging.lastResort = out, err, last
        write_records(False)


def take_log() -> None:
    """Write the log of a program that has not said where to, here and not raw."""
    logging.lastResort = _Log(logging.WARNING)


def logger(name: str) -> logging.Logger:
    """Return the logger of a module, whose records are clean for any handler."""
    made = logging.getLogger(name)
    made.addFilter(_clean_record)  # it is added only once
    return made


def drop_output() -> None:
    """Write standard output to nowhere from now on: nothing reads it any longer."""
    if (stream := _own(sys.stdout)) is not None:
        _write_to_nowhere(stream)


class _Format:
    """How standard error is written, in all threads."""

    records = False


_FORMAT = _Format()


class _Guard:
    """Replaces a stream of the process; text written to it is cleaned.

    Args:
        stream: the stream; None if the program was started with it closed.
        may_leave: whether output without a reader is dropped, in place of
            BrokenPipeError.
    """

    def __init__(self, stream: TextIO | None, may_leave: bool = False) -> None:
        self.stream = stream or open(os.devnull, "w", encoding="utf-8")
        self._may_leave = may_leave

    def __getattr__(self, name: str) -> Any:
        return getattr(self.stream, name)

    def isatty(self) -> bool:
        """Say no: escape codes of others would be written as signs."""
        return False

    def write(self, words: str) -> int:
        """Write lines of others."""
        if self._may_leave and _FORMAT.records:
            if words.strip():
                _write_record("info", words.rstrip("\n").split("\n"))
        else:
            self.write_raw(lines(words))
        return len(words)

    def writelines(self, several: Sequence[str]) -> None:
        """Write lines of others."""
        for each in several:
            self.write(each)

    def write_raw(self, words: str) -> None:
        """Write cleaned text, as far as the encoding of the stream allows."""
        try:
            _write_encoded(self.stream, words)
        except BrokenPipeError:
            if not self._may_leave:
                raise
            _write_to_nowhere(self.stream)

    def flush(self) -> None:
        """Flush the buffer."""
        try:
            self.stream.flush()
        except BrokenPipeError:
            if not self._may_leave:
                raise
            _write_to_nowhere(self.stream)


class _Log(logging.Handler):
    """Writes records to standard error: a line, and an indented traceback."""

    def emit(self, record: logging.LogRecord) -> None:
        """Write a record."""
        try:
            written = [record.getMessage()]
            if record.exc_info and record.exc_info[0] is not None:
                written += _traceback(*record.exc_info)
            if _FORMAT.records:
                level = "error" if record.levelno >= logging.ERROR else "warning"
                _write_record(level, written, logger=record.name)
            else:
                write_err(*written)
        except Exception:
            self.handleError(record)


def write_traceback(error: BaseException) -> None:
    """Write where an error was raised to standard error."""
    write_err(*_traceback(type(error), error, error.__traceback__))


def _traceback(*raised: Any) -> list[str]:
    """Return the lines of a traceback, such that none can be taken for one of ours."""
    written = "".join(traceback.format_exception(*raised)).rstrip("\n").split("\n")
    return [f"  {each}" for each in written]


def _clean_record(record: logging.LogRecord) -> bool:
    record.msg, record.args = line(record.getMessage()), None
    return True


def _write(stream: TextIO | None, *written: Line) -> None:
    own = _own(stream)
    colors = own is not None and own.isatty() and "NO_COLOR" not in os.environ
    _write_raw(stream, "".join(f"{_words(each, colors)}\n" for each in written))


def _write_record(level: str, written: Sequence[str], **more: str) -> None:
    now = datetime.now(timezone.utc).isoformat(timespec="milliseconds")
    message = "\n".join(written)
    record = {"time": now, "level": level, **more, "message": message}
    _write_raw(sys.stderr, f"{json_text(record, indent=None)}\n")


def _level(written: Sequence[Line]) -> str:
    """Return how grave lines are: as they are painted, or as they say."""
    for each in written:
        for part in () if isinstance(each, str) else each:
            if isinstance(part, Painted) and part.style in ("error", "warning"):
                return part.style
    said = _SAID.search(_words(written[0], False)) if written else None
    return "info" if said is None else _LEVELS.get(said[1], said[1])


def _words(written: Line, colors: bool) -> str:
    parts = (written,) if isinstance(written, str) else written
    return "".join(_part(part, colors) for part in parts)


def _part(part: str | Painted, colors: bool) -> str:
    if isinstance(part, str):
        return line(part)
    words = line(part.words)
    return f"{_CODES[part.style]}{words}{_END}" if colors else words


def _write_raw(stream: TextIO | None, words: str) -> None:
    if isinstance(stream, _Guard):
        stream.write_raw(words)
    elif stream is not None:
        _write_encoded(stream, words)
    else:
        return
    stream.flush()


def _write_encoded(stream: TextIO, words: str) -> None:
    try:
        stream.write(words)
    except UnicodeEncodeError:
        encoding = stream.encoding or "ascii"
        stream.write(words.encode(encoding, "replace").decode(encoding))


def _speak_utf8(*streams: TextIO | None) -> None:
    """Let files and pipes get UTF-8 on Windows too, where they get its code page."""
    for stream in streams:
        if isinstance(stream, io.TextIOWrapper) and not stream.isatty():
            if sys.platform == "win32":
                stream.reconfigure(encoding="utf-8")


def _own(stream: TextIO | None) -> TextIO | None:
    """Return the stream itself, which knows whether it is a terminal."""
    return stream.stream if isinstance(stream, _Guard) else stream


def _write_to_nowhere(stream: TextIO) -> None:
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, stream.fileno())
    os.close(nowhere)
