"""Replaces the shown recordings, for the page or a program."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from itertools import chain
from pathlib import Path
from weakref import WeakKeyDictionary

from sambot_viz.errors import SambotVizError, ServerError, UsageError
from sambot_viz.files import Stamp, stamp
from sambot_viz.inputs import Inputs, named_descriptions
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import RvizConfig
from sambot_viz.server.config_store import ConfigStore
from sambot_viz.server.sessions import Sessions
from sambot_viz.session import Session
from sambot_viz.session.own_config import is_own_config
from sambot_viz.session.recording_files import (
    Given,
    RecordingFiles,
    parts_of,
    replaced,
)
from sambot_viz.topics.source_robot import Lease, SourceRobot

FirstConfig = Callable[[SourceRobot, Robot | None], RvizConfig]
"""Adapts the bundled config to sources and a robot."""
_Opened = tuple[object, SourceRobot, Robot | None]
"""The request, the sources, and the robot that they move."""
Done = Callable[[SambotVizError | None], object]


class Recordings:
    """Opens recordings, one after the other; a failure changes nothing.

    Args:
        inputs: the opened inputs.
        configs: config of new sessions.
        first_config: makes a config where no user has one.
    """

    def __init__(
        self, inputs: Inputs, configs: ConfigStore, first_config: FirstConfig
    ) -> None:
        self.files = RecordingFiles(inputs.options.sources)
        self._inputs = inputs
        self._configs = configs
        self._first_config = first_config
        self._turn = threading.Lock()
        # Many private sessions may show the same recording.
        self._known: WeakKeyDictionary[Lease, _Opened] = WeakKeyDictionary()

    def of(self, sessions: Sessions, session: Session) -> SessionRecordings:
        """Return the recordings that a session of the server may open."""
        return SessionRecordings(self, sessions, session)

    def replaces_config(self, session: Session) -> bool:
        """Return whether another recording brings another config."""
        return self._replaces(session.document.config)

    def _replaces(self, config: RvizConfig) -> bool:
        return self._inputs.takes_bundled_config and is_own_config(config)

    def show(
        self, sessions: Sessions, given: Given, session: Session | None = None
    ) -> None:
        """Open recordings, and show them.

        Args:
            sessions: sessions of the server.
            given: the recordings.
            session: session that shows them; None for all present and future sessions
                except copies.

        Raises:
            SourceError: a recording cannot be opened; the shown ones stay.
        """
        with self._turn:
            shown = (
                self._configs.current if session is None else session.document.config
            )
            replaces = self._replaces(shown)
            # A session has a config later.
            lease = self._opened(given, None if replaces else shown)
            _, moved_by, described = self._known[lease]
            robot = described or sessions.robot
            document = self._first_config(moved_by, robot) if replaces else None
            for_all = session is None or session is sessions.shared
            if for_all:
                self._inputs.take(moved_by)
            sessions.show_sources(session, moved_by, described, document)
            if for_all and document is not None:
                self._configs.begin_again(shown, document)
            del lease

    def _opened(self, given: Given, config: RvizConfig | None) -> Lease:
        """Open recordings, unless a session shows the same, unchanged files."""
        named = named_descriptions(config)
        wanted = (tuple(given), named, _stamps(given))
        for lease, opened in list(self._known.items()):
            if opened[0] == wanted:
                return lease
        moved_by, robot = self._inputs.open_recordings(given, named)
        lease = moved_by.lease()
        self._known[lease] = wanted, moved_by, robot
        return lease

    def open(self, sessions: Sessions, path: Path, part: str | None = None) -> None:
        """Open a file or folder for a program.

        Args:
            sessions: sessions of the server.
            path: path of the recording.
            part: recording to replace; None where there is only one.

        Raises:
            SourceError: the recording cannot be opened; the shown one stays.
            UsageError: there are several recordings to replace, or none of this name.
        """
        moved_by = self._inputs.moved_by
        given = () if moved_by is None else moved_by.given
        parts = parts_of(given)
        if part is None and len(parts) > 1:
            raise UsageError(f"say which one it replaces: source={_listed(parts)}")
        if part is not None and part not in parts:
            raise UsageError(f"no recording is called '{part}': {_listed(parts)}")
        others = replaced(given, parts[part or next(iter(parts))], [path])
        self.show(sessions, others)
        self.files.add(others)


def _stamps(given: Given) -> tuple[Stamp | None, ...]:
    """Return stamps that differ after a file was written."""
    # A recording on a web server detects its own changes.
    paths = [one.path for one in given if isinstance(one.path, Path)]
    inside = (sorted(path.iterdir()) for path in paths if path.is_dir())
    return tuple(stamp(path) for path in (*paths, *chain.from_iterable(inside)))


def _listed(parts: Iterable[str]) -> str:
    return " or ".join(f"'{part}'" for part in parts)


class SessionRecordings:
    """Recordings that pages of one session may open; `panels` defines the interface.

    Args:
        recordings: opens them.
        sessions: all sessions of the server.
        session: session that shows them.
    """

    def __init__(
        self, recordings: Recordings, sessions: Sessions, session: Session
    ) -> None:
        self._recordings = recordings
        self._sessions = sessions
        self._session = session
        self._opening = ""

    @property
    def parts(self) -> Sequence[str]:
        """The shown recordings, each of which can be replaced."""
        return list(parts_of(self._given))

    @property
    def replaces_config(self) -> bool:
        """Return whether another recording brings another config."""
        return self._recordings.replaces_config(self._session)

    @property
    def _given(self) -> Given:
        data = self._session.data
        return () if data is None else data.moved_by.given

    def names(self) -> Sequence[str]:
        """Return the names of the recordings that a user can open.

        Raises:
            UsageError: a folder cannot be read.
        """
        return self._recordings.files.names()

    def open(self, part: str, name: str, done: Done) -> None:
        """Show another recording, which a thread opens.

        Raises:
            UsageError: there is no such part or name, or another one is opening.
        """
        if self._opening:
            raise UsageError(f"{self._opening} is still being opened")
        given = self._recordings.files.instead(self._given, part, name)
        self._opening = name
        run = partial(self._open, given, done)
        threading.Thread(target=run, name="sambot-viz-open", daemon=True).start()

    def _open(self, given: Given, done: Done) -> None:
        error: SambotVizError | None = None
        try:
            self._recordings.show(self._sessions, given, self._session)
        except SambotVizError as refused:
            error = refused
        except Exception as fault:
            self._session.worker.report(fault)
            error = ServerError("internal error; please report it")
        with self._session.lock:
            self._opening = ""
            done(error)
