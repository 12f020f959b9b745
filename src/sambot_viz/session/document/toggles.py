"""Toggles: what of a document is on or off, by names that a permalink carries.

These are the boxes of displays, of links and of frames, and properties. A name is that
of the display and of the property, such as "TF/Show Names"; of two displays with the
same name, the second one is "TF*2".
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

from sambot_viz.displays.display import Display, EntryList
from sambot_viz.rviz import BoolProperty, DisplayConfig
from sambot_viz.session.document.display_edits import DisplayEdits
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import connect

_BOX = "Value"
_ENABLED = "Enabled"


@dataclass(frozen=True, slots=True)
class Toggle:
    """An on/off setting of a display, link or frame.

    Attributes:
        on: whether it is on.
        first: whether it was at first.
        set: turns it on or off, as an edit.
    """

    on: bool
    first: bool
    set: Callable[[bool], object]


class Toggles:
    """Finds the toggles of all displays of a session.

    Args:
        edits: sets a toggle, as an edit.
    """

    def __init__(
        self, document: ShownDocument, scene: Scene, edits: DisplayEdits
    ) -> None:
        self._document = document
        self._scene = scene
        self._edits = edits
        self._first: dict[str, bool] = {}
        self._note_first()
        connect([document.replaced], self._note_first)

    def all(self) -> dict[str, Toggle]:
        """Return the toggles by name."""
        found: dict[str, Toggle] = {}
        for name, item in _named(self._document.config.displays):
            display = self._scene.display_of(item)
            for path, on in _own(item):
                key = f"{name}/{path}"
                default = path == _ENABLED or _default(item, path)
                setter = self._setter(item, display, path)
                found[key] = Toggle(on, self._first.get(key, default), setter)
            if display is not None:
                for path, toggle in self._of_entries(display):
                    found[f"{name}/{path}"] = toggle
        return found

    def _note_first(self) -> None:
        """Note how the toggles are before any edit, without those of links."""
        self._first = {
            f"{name}/{path}": on
            for name, item in _named(self._document.config.displays)
            for path, on in _own(item)
        }

    def _setter(
        self, item: DisplayConfig, display: Display | None, path: str
    ) -> Callable[[bool], object]:
        if path == _ENABLED:
            return partial(self._edits.set_enabled, item)
        if display is None:
            return lambda on: None
        return partial(self._edits.set_property, display, path)

    def _of_entries(self, display: Display) -> Iterator[tuple[str, Toggle]]:
        """Yield the boxes of links and frames; at first they are as all of them are."""
        for entries in display.entries():
            if entries.singular == "joint":
                # Its box is that of its link.
                continue
            every = _every(display.config, entries)
            for name in entries.names:
                item = entries.item(name)
                shown = entries.rows(name) if entries.rows else tuple(item.declared)
                if _BOX in shown and _BOX in item.declared:
                    change = partial(
                        self._edits.set_entry, display, entries.title, name, _BOX
                    )
                    path = f"{entries.title}/={_escaped(name)}"
                    yield path, Toggle(bool(item.get(_BOX)), every, change)


def _named(
    items: Sequence[DisplayConfig], above: str = ""
) -> Iterator[tuple[str, DisplayConfig]]:
    """All displays with their names, which are those above too."""
    seen: Counter[str] = Counter()
    for item in items:
        name = f"{above}{_escaped(item.name)}"
        seen[name] += 1
        if seen[name] > 1:
            name = f"{name}*{seen[name]}"
        yield name, item
        yield from _named(item.displays, f"{name}/")


def _own(item: DisplayConfig) -> Iterator[tuple[str, bool]]:
    yield _ENABLED, item.enabled
    for path, declared in item.declared.items():
        if isinstance(declared.property, BoolProperty):
            yield path, bool(item.get(path))


def _default(item: DisplayConfig, path: str) -> bool:
    return bool(item.declared[path].property.default)


def _every(config: DisplayConfig, entries: EntryList) -> bool:
    """Return the toggle for all of a list, such as "Links/All Links Enabled"."""
    for path, declared in config.declared.items():
        if path.startswith(f"{entries.title}/All "):
            if isinstance(declared.property, BoolProperty):
                return bool(config.get(path))
    return True


def _escaped(name: str) -> str:
    for sign, code in (("%", "%25"), ("/", "%2F"), ("*", "%2A")):
        name = name.replace(sign, code)
    return name
