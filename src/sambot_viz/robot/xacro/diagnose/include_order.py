"""Which file of a model includes which, in which order, and with which namespace."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from sambot_viz import limits
from sambot_viz.errors import Place
from sambot_viz.files import relative_path
from sambot_viz.robot.xacro.diagnose.source_files import (
    NamedElement,
    SourceSet,
    token_place,
)

_TAIL = re.compile(r"(?:^|[)}])/?([^${}()]+)$")


@dataclass(frozen=True, slots=True)
class Include:
    """An <xacro:include>.

    Attributes:
        place: where it is.
        file: the file that it includes, as the user would write it.
        ns: the namespace that it gives, or "".
    """

    place: Place
    file: str
    ns: str


@dataclass(frozen=True, slots=True)
class IncludeOrder:
    """The includes of a model, those too that xacro did not reach.

    Attributes:
        includes: in the order in which the files were found.
        sources: all files.
    """

    includes: Sequence[Include]
    sources: SourceSet

    @classmethod
    def of(cls, sources: SourceSet) -> IncludeOrder:
        """Read the includes of the files, and of the files that they include."""
        found: list[Include] = []
        files = list(sources.files)
        for file in files:
            if len(files) > limits.XACRO_NEIGHBOURS.value:
                break
            found += _includes_in(file, SourceSet.of([file]), files)
            new = dict.fromkeys(include.file for include in found)
            files += [each for each in new if each not in files]
        return cls(found, SourceSet.of(files))

    def meeting(self, use: Place, definition: Place) -> tuple[Place, Place] | None:
        """Return where one file has a use and a definition, or their includes."""
        defined = {place.file: place for place, _ in self._way(definition)}
        for place, _ in self._way(use):
            if place.file in defined:
                return place, defined[place.file]
        return None

    def known_as(self, thing: NamedElement, use: Place) -> str:
        """Return the name that a definition has where it is used: "wheel.radius"."""
        meeting = self.meeting(use, thing.place)
        names: list[str] = []
        for place, ns in self._way(thing.place):
            names += [ns] if ns else []
            if meeting is None or place == meeting[1]:
                break
        return ".".join([*reversed(names), thing.name])

    def later(self, kind: str, name: str, use: Place) -> NamedElement | None:
        """Return a definition of a file that is included after its use."""
        for thing in self.sources.named(kind):
            meeting = self.meeting(use, thing.place)
            if thing.name == name and thing.prefixed and meeting is not None:
                if _at(meeting[0]) < _at(meeting[1]):
                    return thing
        return None

    def _way(self, place: Place) -> Iterator[tuple[Place, str]]:
        """Yield a place and the includes that lead to it, with their namespaces."""
        yield place, ""
        seen: set[str] = set()
        while place.file not in seen:
            seen.add(place.file)
            around = next((i for i in self.includes if i.file == place.file), None)
            if around is None:
                return
            place = around.place
            yield place, around.ns


def _at(place: Place) -> tuple[int, int]:
    return place.line or 0, place.column or 0


def _includes_in(file: str, source: SourceSet, known: list[str]) -> Iterator[Include]:
    text = source.get(file)
    for token in text.tags if text is not None else ():
        filename = token.get("filename") or ""
        tail = _TAIL.search(filename)
        if text is None or token.name != "xacro:include" or tail is None:
            continue
        target = _target(file, tail[1], known)
        if target is not None and target != file:
            place = token_place(text, file, token)
            yield Include(place, target, token.get("ns") or "")


def _target(file: str, tail: str, known: Sequence[str]) -> str | None:
    """Return the file that a file includes by this end of its path."""
    folder = Path(file).parent
    for around in (folder, *folder.absolute().parents):
        path = os.path.abspath(around / tail)
        same = (each for each in known if os.path.abspath(each) == path)
        if (found := next(same, None)) is not None:
            return found
        if os.path.isfile(path):
            return path if Path(file).is_absolute() else relative_path(path)
        if (around / "package.xml").is_file():
            break
    ending = f"/{os.path.normpath(tail)}"
    return next((each for each in known if each.endswith(ending)), None)
