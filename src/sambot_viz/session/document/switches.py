"""What of a document is on or off, each with a name that another program knows too.

These are the boxes of displays, of links and of frames, and properties. A name is that
of the display and of the property, such as "TF/Show Names"; of two displays with the
same name, the second one is "TF*2".
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from sambot_viz.displays.display import Display
from sambot_viz.displays.entries import EntryList
from sambot_viz.rviz import BoolProperty, DisplayConfig, RvizConfig

if TYPE_CHECKING:
    from sambot_viz.session import Session

_BOX = "Value"
_ENABLED = "Enabled"


@dataclass(frozen=True, slots=True)
class Switch:
    """One of them.

    Attributes:
        on: whether it is on.
        first: whether it was at first.
        set: turns it on or off, as an edit.
    """

    on: bool
    first: bool
    set: Callable[[bool], object]


def first_switches(config: RvizConfig) -> dict[str, bool]:
    """How the switches of a document are, those of links and frames left out."""
    return {
        f"{name}/{path}": on
        for name, item in _named(config.displays)
        for path, on in _own(item)
    }


def switches(session: Session) -> dict[str, Switch]:
    """The switches of all displays of a session, by name."""
    first = session.first_switches
    found: dict[str, Switch] = {}
    for name, item in _named(session.config.displays):
        display = session.display_of(item)
        for path, on in _own(item):
            key = f"{name}/{path}"
            default = path == _ENABLED or _default(item, path)
            found[key] = Switch(
                on, first.get(key, default), _setter(session, item, path)
            )
        if display is not None:
            for path, switch in _of_entries(session, display):
                found[f"{name}/{path}"] = switch
    return found


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


def _setter(
    session: Session, item: DisplayConfig, path: str
) -> Callable[[bool], object]:
    if path == _ENABLED:
        return partial(session.set_enabled, item)

    def change(on: bool) -> None:
        display = session.display_of(item)
        if display is not None:
            session.set_property(display, path, on)

    return change


def _of_entries(session: Session, display: Display) -> Iterator[tuple[str, Switch]]:
    """The boxes of links and frames; at first they are as all of them are."""
    for entries in display.entries():
        if entries.singular == "joint":
            # Its box is that of its link.
            continue
        every = _every(display.config, entries)
        for name in entries.names:
            item = entries.item(name)
            shown = entries.rows(name) if entries.rows else tuple(item.declared)
            if _BOX in shown and _BOX in item.declared:
                change = partial(session.set_entry, display, entries.title, name, _BOX)
                path = f"{entries.title}/={_escaped(name)}"
                yield path, Switch(bool(item.get(_BOX)), every, change)


def _every(config: DisplayConfig, entries: EntryList) -> bool:
    """The switch for all of a list, such as "Links/All Links Enabled"."""
    for path, declared in config.declared.items():
        if path.startswith(f"{entries.title}/All "):
            if isinstance(declared.property, BoolProperty):
                return bool(config.get(path))
    return True


def _escaped(name: str) -> str:
    for sign, code in (("%", "%25"), ("/", "%2F"), ("*", "%2A")):
        name = name.replace(sign, code)
    return name
