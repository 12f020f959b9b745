"""The displays of the config, as a program reads, sets, adds and removes them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from types import MappingProxyType
from typing import Any, cast

import numpy as np

from sambot_viz.displays.display import Display
from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.errors import ServerError, UsageError, did_you_mean
from sambot_viz.rviz import DisplayConfig, FileProperty
from sambot_viz.rviz.declarations import kind_of, short_name
from sambot_viz.server.sessions import Sessions
from sambot_viz.session import Session, walk


class DisplayControl:
    """One display: ``viz.displays["TF"].set("Show Names", False)``.

    It is looked up by its name at each use, in the sessions of all browsers. Reading
    returns the value of the first session. Private copies are not changed.

    Every method raises UsageError if no display has the name, and ServerError while
    there is no session: with private sessions, before the first page is open.
    """

    def __init__(self, sessions: Sessions, name: str, number: int = 0) -> None:
        self._sessions = sessions
        self._name = name
        # Which one of those with the same name.
        self._number = number

    @property
    def name(self) -> str:
        """Its name in the Displays panel."""
        return self._name

    @property
    def kind(self) -> str:
        """Its type, such as "rviz_default_plugins/TF"."""
        return self._read(lambda config: config.kind)

    @property
    def enabled(self) -> bool:
        """Its box; set it to show or hide the display."""
        return self._read(lambda config: config.enabled)

    @enabled.setter
    def enabled(self, enabled: bool) -> None:
        def change(session: Session) -> None:
            found = self.config_in(session)
            session.display_edits.set_enabled(found, bool(enabled))

        for_all(self._sessions, change)

    @property
    def values(self) -> Mapping[str, Any]:
        """Every value by its path, such as "Line Style/Line Width"; a copy."""
        return self._read(lambda config: MappingProxyType(dict(config.properties)))

    def get(self, path: str) -> Any:
        """Return a value: bool, int, float, str or a tuple of numbers.

        Args:
            path: its row in the panel, such as "Show Names", with those above it, such
                as "Line Style/Line Width".

        Raises:
            UsageError: it has no such value.
        """
        return self._read(lambda config: config.get(path))

    def set(self, path: str, value: object) -> None:
        """Set a value; the panel shows it. Users cannot undo it.

        Args:
            path: its row in the panel, as for `get`; of a link, joint or frame
                "Links/base_link/Alpha", and "Frames/base_link/Value" for its box.
            value: of the type of the row; numbers and colours of numpy too. A number
                outside its limits is set to the limit, as in the page.

        Raises:
            UsageError: it has no such value, or the value cannot be that.
        """
        for_all(
            self._sessions,
            lambda session: self.set_in(session, path, plain_value(value)),
        )

    def __repr__(self) -> str:
        return f"<display '{self._name}'>"

    def set_in(self, session: Session, path: str, value: object) -> None:
        """Set a value in one session."""
        config = self.config_in(session)
        display = session.scene.display_of(config)
        if display is None:
            raise UsageError(f"'{self._name}' ({config.kind}) has no values here")
        declared = config.declared.get(path)
        if declared is None and (entry := _entry(display, path)) is not None:
            session.display_edits.set_entry(display, *entry, value)
            return
        if declared is not None and isinstance(declared.property, FileProperty):
            # A program may read any file, and not only those that were opened.
            session.scene.context.trusted_files |= {str(value)}
        session.display_edits.set_property(display, path, value)

    def config_in(self, session: Session) -> DisplayConfig:
        """Return the display in the document of a session."""
        displays = [*walk(session.document.config.displays)]
        found = [config for config in displays if config.name == self._name]
        if self._number >= len(found):
            names = [config.name for config in displays]
            near = did_you_mean(self._name, names)
            raise UsageError(f"there is no display '{self._name}'; {near}")
        return found[self._number]

    def _read(self, read: Callable[[DisplayConfig], Any]) -> Any:
        session = first(self._sessions)
        with session.lock:
            return read(self.config_in(session))


class Displays:
    """The displays in the order of the panel, those in groups too.

    ::

        for display in viz.displays:
            print(display.name, display.kind, display.enabled)
        viz.displays["TF"].set("Show Names", False)
        viz.displays.add("Axes", "tool", {"Reference Frame": "tool0", "Length": 0.1})
        viz.displays.remove("tool")

    They are those of the sessions of all browsers; private copies keep theirs. Private
    sessions that are opened later begin with the config.
    """

    def __init__(self, sessions: Sessions) -> None:
        self._sessions = sessions

    def __getitem__(self, name: str) -> DisplayControl:
        """Return the first display of a name.

        Raises:
            UsageError: there is none.
        """
        found = DisplayControl(self._sessions, name)
        session = first(self._sessions)
        with session.lock:
            found.config_in(session)
        return found

    def __iter__(self) -> Iterator[DisplayControl]:
        seen: dict[str, int] = {}
        for name in self._names():
            yield DisplayControl(self._sessions, name, seen.get(name, 0))
            seen[name] = seen.get(name, 0) + 1

    def __len__(self) -> int:
        return len(self._names())

    def __contains__(self, name: object) -> bool:
        return name in self._names()

    def add(
        self,
        kind: str,
        name: str | None = None,
        values: Mapping[str, object] | None = None,
    ) -> DisplayControl:
        """Add a display at the end, switched on.

        Args:
            kind: its type, such as "Grid" or "rviz_default_plugins/Grid".
            name: its name; by default its type, with a number if that is taken.
            values: what to set, as for `DisplayControl.set`.

        Raises:
            UsageError: an unknown type, a value that it cannot have, or too many
                displays; nothing is added then.
        """
        kinds = {short_name(known): known for known in DISPLAYS}
        known = kinds.get(kind, kind_of(kind))
        if known not in DISPLAYS:
            near = did_you_mean(kind, kinds)
            raise UsageError(f"there is no display type '{kind}'; {near}")
        made: list[DisplayControl] = []

        def add(session: Session) -> None:
            config = session.display_edits.add_display(known, name=name)
            displays = walk(session.document.config.displays)
            same = [one for one in displays if one.name == config.name]
            made.append(DisplayControl(self._sessions, config.name, same.index(config)))
            try:
                for path, value in (values or {}).items():
                    made[-1].set_in(session, path, plain_value(value))
            except UsageError:
                session.display_edits.remove_display(config)
                raise

        for_all(self._sessions, add)
        return made[0]

    def remove(self, name: str) -> None:
        """Remove the first display of a name; a group with all its members.

        Raises:
            UsageError: there is none.
        """
        gone = self[name]
        for_all(
            self._sessions,
            lambda session: session.display_edits.remove_display(
                gone.config_in(session)
            ),
        )

    def __repr__(self) -> str:
        return f"<displays {', '.join(self._names())}>"

    def _names(self) -> list[str]:
        session = first(self._sessions)
        with session.lock:
            return [one.name for one in walk(session.document.config.displays)]


def for_all(sessions: Sessions, change: Callable[[Session], object]) -> None:
    """Change every session except private copies, each in one step.

    Raises:
        ServerError: there is none, or the server was stopped.
    """
    sessions.require_open()
    first(sessions)

    def change_one(session: Session) -> None:
        with session.change():
            change(session)

    sessions.for_each(change_one, copies=False)


def first(sessions: Sessions) -> Session:
    """Return the session of all browsers, or that of the one that came first.

    Raises:
        ServerError: no browser has opened a private session yet.
    """
    found = sessions.all(copies=False)
    if not found:
        raise ServerError("no browser has opened a private session yet")
    return found[0]


def plain_value(value: object) -> object:
    """Return numbers and arrays of numpy as numbers and tuples of Python."""
    if isinstance(value, np.ndarray):
        value = cast("Any", value).tolist()
    if isinstance(value, np.generic):
        return cast("Any", value).item()
    if isinstance(value, list | tuple):
        return tuple(plain_value(part) for part in cast("list[object]", value))
    return value


def _entry(display: Display, path: str) -> tuple[str, str, str] | None:
    """Return the list, the name and the value that "Links/base_link/Alpha" means."""
    title, _, rest = path.partition("/")
    name, _, prop = rest.rpartition("/")
    titles = {entries.title for entries in display.entries()}
    return (title, name, prop) if name and title in titles else None
