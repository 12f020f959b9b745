"""The joints, frames, topics and sizes in the Gazebo plugins of a model."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from typing import Literal, NamedTuple

from sambot_viz.errors import Place
from sambot_viz.robot.xml.element import Element

Generation = Literal["gz", "classic"]
"""Gazebo since Fortress (gz-sim, Ignition), and Gazebo Classic."""

_GZ = re.compile(r"(lib)?(gz-sim|ignition-gazebo|gz_|ign_)")
_DRIVES = ("diff-drive-system", "diff_drive.so", "skid_steer_drive.so")
SENSOR_FRAMES = ("gz_frame_id", "ignition_frame_id", "frame_name", "frameName")
"""Elements in which a sensor, or its plugin, names its frame."""
_OPEN = re.compile(r"\$\(|\$\{")


class Fact(NamedTuple):
    """A name or a number in a file, with its place.

    Attributes:
        value: the text, without blanks around it.
        place: its line.
    """

    value: str
    place: Place

    @property
    def number(self) -> float | None:
        """The value as a finite number, or None."""
        try:
            number = float(self.value)
        except ValueError:
            return None
        return number if math.isfinite(number) else None


class Plugin(NamedTuple):
    """A <plugin> of a model.

    Attributes:
        filename: as written.
        element: the <plugin>.
        link: the link it belongs to; empty for the whole model.
        sensor: the <sensor> around it, or None.
    """

    filename: str
    element: Element
    link: str
    sensor: Element | None

    @property
    def generation(self) -> Generation | None:
        """The Gazebo that it belongs to; None when its name does not show that."""
        if "libgazebo_" in self.filename:
            return "classic"
        if _GZ.match(self.filename):
            return "gz"
        return None

    @property
    def is_drive(self) -> bool:
        """True for a differential drive."""
        return any(name in self.filename for name in _DRIVES)

    def all(self, *tags: str) -> list[Fact]:
        """Return the texts of the elements with these tags, except those with $( … ).

        Args:
            tags: different names of the same element.
        """
        return facts(self.element, *tags)

    def one(self, *tags: str) -> Fact | None:
        """Return the text of the first element with one of these tags, or None."""
        return next(iter(self.all(*tags)), None)


def facts(element: Element, *tags: str) -> list[Fact]:
    """Return the texts of the child elements with these tags, in document order."""
    return [
        Fact(child.text.strip(), child.place)
        for child in element.children
        if child.tag in tags and child.text.strip() and not _OPEN.search(child.text)
    ]


def plugins(parts: Sequence[Element]) -> Iterator[Plugin]:
    """Yield all plugins of a model.

    Args:
        parts: `Robot.gazebo`.
    """
    for part in parts:
        link = part.get("reference") or ""
        for child in part.children:
            if child.tag == "plugin":
                yield Plugin(child.get("filename") or "", child, link, None)
            elif child.tag == "sensor":
                for inner in child.find_all("plugin"):
                    yield Plugin(inner.get("filename") or "", inner, link, child)


def sensors(parts: Sequence[Element]) -> Iterator[tuple[str, Element]]:
    """Yield all sensors of a model, each with the name of its link.

    Args:
        parts: `Robot.gazebo`.
    """
    for part in parts:
        for sensor in part.find_all("sensor"):
            yield part.get("reference") or "", sensor
