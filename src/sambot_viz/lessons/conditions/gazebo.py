"""Conditions about sensors and plugins of Gazebo."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from sambot_viz.checks.around.files.gazebo import SENSOR_FRAMES, plugins, sensors
from sambot_viz.errors import Place
from sambot_viz.lessons.conditions.condition import Unmet
from sambot_viz.lessons.reading.records import given
from sambot_viz.lessons.reading.values import TEXT, TEXTS, VALUES
from sambot_viz.lessons.work import Work
from sambot_viz.robot.xml.element import Element

_SAME = 1e-6
"""Numbers are the same when they differ by no more, of the larger one."""
_SENSOR_WORDS: Mapping[str, tuple[str, ...]] = {
    "rate": ("update_rate",),
    "topic": ("topic",),
    "frame": SENSOR_FRAMES,
}


def same(text: str, wanted: str) -> bool:
    """Return whether two values are equal, as numbers or as names of topics."""
    try:
        one, other = float(text), float(wanted)
    except ValueError:
        return text.strip().strip("/") == wanted.strip().strip("/")
    return abs(one - other) <= _SAME * max(abs(one), abs(other), _SAME)


def compared(
    what: str, said: str | None, wanted: tuple[str, ...], place: Place | None
) -> Iterator[Unmet]:
    """Say what a value is that is none of those that fit; None for one not there."""
    if said is None or not any(same(said, one) for one in wanted):
        found = f"{what} is {said}" if said is not None else f"{what} is not given"
        yield Unmet(found, " or ".join(wanted), place)


def _inner(element: Element, path: str) -> Element | None:
    """Return an element inside another one; "*" stands for any tag."""
    found = [element]
    for tag in path.split("/"):
        found = [c for e in found for c in e.children if tag in ("*", c.tag)]
    return next(iter(found), None)


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorCondition:
    """A link has a sensor; values are elements in it, such as camera/image/width."""

    link: str = given(TEXT)
    type: tuple[str, ...] = given(TEXTS)
    rate: tuple[str, ...] = given(TEXTS, ())
    topic: tuple[str, ...] = given(TEXTS, ())
    frame: tuple[str, ...] = given(TEXTS, ())
    values: tuple[tuple[str, tuple[str, ...]], ...] = given(VALUES, ())

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Compare the sensors of the link with what is given."""
        found = [one for one in sensors(work.robot.gazebo) if one[0] == self.link]
        fitting = [one for _, one in found if one.get("type") in self.type]
        expected = f"a sensor of type {' or '.join(self.type)} at {self.link}"
        if not fitting:
            types = ", ".join(one.get("type") or "without a type" for _, one in found)
            said = f"only {types}" if types else "none"
            yield Unmet(f"{self.link} has no such sensor, {said}", expected)
            return
        faults = [list(self._faults(sensor)) for sensor in fitting]
        yield from min(faults, key=len)

    def _faults(self, sensor: Element) -> Iterator[Unmet]:
        what = f"of the sensor {sensor.get('name') or ''}"
        for word, tags in _SENSOR_WORDS.items():
            wanted: tuple[str, ...] = getattr(self, word)
            texts = (_said(sensor, tag) for tag in tags)
            said = next((text for text in texts if text is not None), None)
            if word == "frame" and said is None:
                said = self.link
            if wanted:
                yield from compared(f"the {word} {what}", said, wanted, sensor.place)
        for path, wanted in self.values:
            said = _said(sensor, path)
            yield from compared(f"<{path}> {what}", said, wanted, sensor.place)


def _said(element: Element, path: str) -> str | None:
    inner = _inner(element, path)
    return None if inner is None else inner.text.strip()


@dataclass(frozen=True, slots=True, kw_only=True)
class PluginCondition:
    """The model has a plugin of Gazebo; values are elements in it."""

    name: tuple[str, ...] = given(TEXTS)
    values: tuple[tuple[str, tuple[str, ...]], ...] = given(VALUES, ())

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Look for a plugin whose file or class has one of these words in its name."""
        found = [*plugins(work.robot.gazebo)]
        fitting = [
            one
            for one in found
            for word in self.name
            if word in one.filename or word in (one.element.get("name") or "")
        ]
        if not fitting:
            names = ", ".join(one.filename for one in found) or "none"
            expected = f"one called {' or '.join(self.name)}"
            yield Unmet(f"the plugins of the model are: {names}", expected)
            return
        element = fitting[0].element
        for path, wanted in self.values:
            what = f"<{path}> of the plugin {fitting[0].filename}"
            yield from compared(what, _said(element, path), wanted, element.place)
