"""Notices saved files.

One thread looks at the files when the system reports a change in their folders, and
once a second in any case. The regular look finds changes that the system does not
report (network drives, a link with a new target, a folder that was created again), and
takes over when the system cannot watch at all. Only the state of the files counts, so
it makes no difference whether an editor saves in place, by renaming or in two steps.
Errors of the file system or of a callback are logged, and the watching continues. The
thread asks for the list of files only after it may have changed, to keep a look cheap.
"""

from __future__ import annotations

import os.path
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from watchfiles import Change, watch

from sambot_viz import limits
from sambot_viz.files import Stamp, stamp
from sambot_viz.outlet import logger

QUIET = 30
"""The thread looks at changes after a pause of this length [ms] …"""
LONGEST_WAIT = 200
"""… and after this time in any case [ms]."""
LOOK_PERIOD = 1.0
"""Time between two looks without a reported change [s]."""
SETTLE = 0.3
"""Time that a missing or empty file has to come back [s]: some editors empty or remove
the old file before they write the new one."""
_RETRY = 0.02
_LONGEST_CLOSE = 5.0
_CLOCK_STEP = 10_000_000
"""Longest delay of file times behind the clock [ns]."""
_TOLD_LATE = 2_000_000_000
"""Longest time from the read of a file to the notice that it counts [ns]; the file is
drawn in between."""

_log = logger(__name__)

_Changes = set[tuple[Change, str]]
OnChange = Callable[[frozenset[Path], frozenset[Path]], None]


@dataclass(frozen=True, slots=True)
class Watched:
    """The watched files.

    Attributes:
        files: the files that count.
        package_of: a file in whose package new files are reported too.
    """

    files: frozenset[Path]
    package_of: Path | None = None


class FileWatcher:
    """Calls back when files change.

    Args:
        watched: returns the files that count; called again after `ask_again`.
        on_change: receives the changed files, and everything new in the folders; runs
            in the watcher's thread, one call at a time.
        on_trouble: called once, with the reason, when the system cannot watch.
        since: saves after this time [ns] count as changes; default now.
    """

    def __init__(
        self,
        watched: Callable[[], Watched],
        on_change: OnChange,
        on_trouble: Callable[[str], None],
        since: int | None = None,
    ) -> None:
        self._ask = watched
        self._on_change = on_change
        self._on_trouble = on_trouble
        self._stop = threading.Event()
        self._looked = time.time_ns()
        self._asked_at: int | None = None
        self._watched = watched()
        self._known: dict[Path, Stamp | None] = {}
        self._track(time.time_ns() if since is None else since)
        self._thread = threading.Thread(
            target=self._run, name="sambot-viz-watch", daemon=True
        )

    def start(self) -> None:
        """Start watching; find saves between `since` and now, too."""
        self._thread.start()

    def ask_again(self) -> None:
        """Ask again which files count, at the next look; any thread may call this.

        Call it once a file counts, not before.
        """
        if self._asked_at is None:
            self._asked_at = time.time_ns()

    def close(self) -> None:
        """Stop watching, and wait a few seconds for a running callback."""
        self._stop.set()
        if threading.current_thread() is not self._thread:
            self._thread.join(_LONGEST_CLOSE)

    @property
    def closed(self) -> bool:
        """Return whether watching has stopped."""
        return self._stop.is_set()

    def _run(self) -> None:
        system_watches, reported = True, ""
        while not self._stop.is_set():
            try:
                if system_watches:
                    self._watch(self._folders())
                elif not self._stop.wait(LOOK_PERIOD):
                    self._look(frozenset())
            except _CannotWatchError as error:
                system_watches = False
                self._on_trouble(str(error))
            except Exception as error:
                # Without this thread, the program would miss every save.
                if repr(error) != reported:
                    reported = repr(error)
                    _log.exception("error while watching the files")
                self._stop.wait(LOOK_PERIOD)

    def _watch(self, folders: Mapping[Path, int]) -> None:
        """Watch these folders until the set of folders changes."""
        self._look(frozenset())
        changes = watch(
            *folders,
            watch_filter=None,
            debounce=LONGEST_WAIT,
            step=QUIET,
            stop_event=self._stop,
            rust_timeout=int(LOOK_PERIOD * 1000),
            yield_on_timeout=True,
            raise_interrupt=False,
            recursive=False,
            ignore_permission_denied=True,
        )
        for reported in _batches(changes):
            new = (path for change, path in reported if change == Change.added)
            self._look(frozenset(map(Path, new)))
            if self._stop.is_set() or self._folders() != folders:
                return

    def _look(self, appeared: frozenset[Path]) -> None:
        """Compare the files with their previous state, and call back on a change."""
        if self._asked_at is not None:
            self._list(min(self._looked, self._asked_at - _TOLD_LATE))
        before, self._known = self._known, self._settled_stamps()
        # A save may replace an existing file with a new one; editors write that under
        # a hidden name first.
        appeared = frozenset(
            path
            for path in appeared
            if before.get(path) is None and not path.name.startswith(".")
        )
        self._looked = time.time_ns() - _CLOCK_STEP
        changed = frozenset(p for p, now in self._known.items() if before[p] != now)
        if (changed or appeared) and not self._stop.is_set():
            self._on_change(changed, appeared)
            if self._asked_at is not None:
                # All files read meanwhile were read after this look.
                self._list(self._looked)

    def _list(self, since: int) -> None:
        """Ask which files count; new ones saved since a time [ns] have changed."""
        # A later request may come too late for this answer.
        asked_at, self._asked_at = self._asked_at, None
        try:
            self._watched = self._ask()
        except BaseException:
            self._asked_at = asked_at
            raise
        self._track(since)

    def _track(self, since: int) -> None:
        before, self._known = self._known, self._stamps()
        for path, now in self._known.items():
            if path in before:
                self._known[path] = before[path]
            elif now is not None and now[0] > since:
                self._known[path] = None

    def _settled_stamps(self) -> dict[Path, Stamp | None]:
        """Look at the files, and again while one has just become empty or vanished."""
        end = time.monotonic() + SETTLE
        full = [path for path, was in self._known.items() if not _is_empty(was)]
        # Report only states that were seen: a file may become empty at any moment.
        found = self._stamps()
        while any(path in found and _is_empty(found[path]) for path in full):
            if time.monotonic() >= end or self._stop.wait(_RETRY):
                break
            found = self._stamps()
        return found

    def _stamps(self) -> dict[Path, Stamp | None]:
        return {path: stamp(path) for path in self._watched.files}

    def _folders(self) -> dict[Path, int]:
        """Return the folders to watch, with numbers that differ for new folders."""
        model = self._watched.package_of
        wanted = dict.fromkeys(() if model is None else _folders_of_package(model))
        for path in self._watched.files:
            wanted[path.parent] = None
            if os.path.islink(path):
                # Systems report a save at the file, and a new link at the link.
                wanted[Path(os.path.realpath(path)).parent] = None
        found = {folder: stamp(folder) for folder in wanted}
        return {folder: now[2] for folder, now in found.items() if now is not None}


class _CannotWatchError(Exception):
    """The system does not watch, for example because it watches too much already."""


def _batches(changes: Iterator[_Changes]) -> Iterator[_Changes]:
    """Yield watchfiles' batches; its own failures become _CannotWatchError.

    Errors of callbacks, which run between two batches, pass through.
    """
    while True:
        try:
            reported = next(changes)
        except StopIteration:
            return
        except (OSError, RuntimeError) as error:
            if "decode path" in str(error):
                # The name of a file is not text; the watching starts again.
                return
            raise _CannotWatchError(str(error)) from error
        yield reported


def _folders_of_package(file: Path) -> list[Path]:
    """Return the folders of a file's package; empty without a package."""
    for folder in Path(os.path.realpath(file)).parents:
        if os.path.isfile(folder / "package.xml"):
            return list(_folders_in(folder))
    return []


def _folders_in(folder: Path) -> Iterator[Path]:
    """Yield a folder and its subfolders, nearest first, without hidden ones."""
    pending, count = [folder], 0
    while pending and count < limits.WATCHED_FOLDERS.value:
        folder = pending.pop(0)
        yield folder
        count += 1
        try:
            inner = sorted(p for p in folder.iterdir() if p.name[:1] != ".")
            pending += [p for p in inner if p.is_dir() and not p.is_symlink()]
        except OSError:
            continue


def _is_empty(found: Stamp | None) -> bool:
    """Return whether a file is missing or empty."""
    return found is None or found[1] == 0
