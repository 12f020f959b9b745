"""What ``--source`` was given: the name of a source, and where it is."""

from __future__ import annotations

import os.path
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from sambot_viz.errors import UsageError
from sambot_viz.files import (
    RECORDING_ENDINGS,
    is_web_address,
    is_web_folder,
    name_of_address,
)
from sambot_viz.sources.prefix import NO_NAMES
from sambot_viz.sources.registry import KNOWN, live_address
from sambot_viz.text import text

_RECORDING = "bag:"
_NAMED = re.compile(r"([A-Za-z][\w-]*)=(.*)", re.DOTALL)
_WORD = re.compile(r"[A-Za-z_]\w*(/[A-Za-z_]\w*)*")
_PLACE = re.compile(r"(\[[0-9a-fA-F:]+\]|[\w.-]+):\d+(/.*)?")
"""A host with a port, and no kind of source before it."""


@dataclass(frozen=True, slots=True)
class GivenSource:
    """A source that a user has named, not opened yet.

    Attributes:
        uri: the address of a live robot, or bag:PATH.
        name: the user's name for it; "" without one.
        prefix: prefix of its topics and frames; "" without one.
        remaps: topics with other names at the source: name here → name there.
    """

    uri: str
    name: str = ""
    prefix: str = ""
    remaps: Mapping[str, str] = field(default_factory=dict[str, str], compare=False)

    @property
    def is_renamed(self) -> bool:
        """Whether topics have other names here than at the source."""
        return bool(self.prefix or self.remaps)

    @property
    def is_live(self) -> bool:
        """Whether it is a robot on the network, and not a recording."""
        return not self.uri.startswith(_RECORDING)

    @property
    def path(self) -> Path | str:
        """The file or folder of a recording; its address on a web server."""
        place = self.uri.removeprefix(_RECORDING)
        on_the_web = is_web_address(place) or is_web_folder(place)
        return place if on_the_web else Path(place)

    @property
    def label(self) -> str:
        """The name of a recording without one."""
        place = self.path
        return name_of_address(place) if isinstance(place, str) else place.name


def given_source(words: str) -> GivenSource:
    """Read ``URI`` or ``NAME=URI``; a file or folder needs no ``bag:`` before it.

    Raises:
        UsageError: it is neither a file nor the address of a live robot.
    """
    named = None if os.path.exists(words) else _NAMED.fullmatch(words)
    name, uri = (named[1], named[2]) if named else ("", words)
    if uri.startswith(_RECORDING):
        return GivenSource(uri, name)
    if is_web_folder(uri):
        live_address(uri)
        return GivenSource(uri, name)
    if is_web_address(uri):
        return GivenSource(f"{_RECORDING}{uri}", name)
    # A missing recording is reported where it is opened.
    is_named_so = ":" not in uri and uri.lower().endswith(RECORDING_ENDINGS)
    if uri and (is_named_so or os.path.exists(uri)):
        return GivenSource(f"{_RECORDING}{uri}", name)
    if _PLACE.fullmatch(uri):
        raise UsageError(
            f"{text(uri)}: say what is spoken there: foxglove://{text(uri)} of a "
            f"foxglove_bridge, rosbridge://{text(uri)} of a rosbridge_server, or "
            f"zenoh://{text(uri)} of a router of rmw_zenoh"
        )
    if ":" not in uri:
        raise UsageError(f"{text(uri)}: no such file or folder; known: {KNOWN}")
    live_address(uri)
    return GivenSource(uri, name)


def given_sources(
    words: Iterable[str],
    prefixes: Mapping[str, str],
    remaps: Mapping[str, str] = NO_NAMES,
) -> tuple[GivenSource, ...]:
    """Read all sources of a command line.

    Args:
        words: as for `given_source`.
        prefixes: name → prefix of the topics and frames of that source.
        remaps: topics with other names at all sources: name here → name there.

    Raises:
        UsageError: as `given_source`; a prefix names no source or is invalid; or a
            robot has the name of another source.
    """
    found = [given_source(one) for one in words]
    names = [one.name for one in found if one.name]
    for name, prefix in prefixes.items():
        if name not in names:
            listed = f"known: {', '.join(names)}"
            if not names:
                listed = "none has a name: write --source NAME=URI"
            raise UsageError(f"--source-prefix {name}: no such source; {listed}")
        if not _WORD.fullmatch(prefix):
            raise UsageError(
                f"--source-prefix {name}={text(prefix)}: a prefix has letters, digits "
                "and _, as in robot1"
            )
    for one in found:
        if one.is_live and names.count(one.name) > 1:
            raise UsageError(f"two sources are called {one.name}: name them otherwise")
    return tuple(
        replace(one, prefix=prefixes.get(one.name, ""), remaps=remaps) for one in found
    )
