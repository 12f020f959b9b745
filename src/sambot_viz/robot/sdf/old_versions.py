"""Differences in files of older versions of SDF.

libsdformat converts a file to the newest version before it reads it. For a robot, a few
rules suffice: the attribute ``frame`` of a pose (until 1.6), axes in the frame of the
model (always until 1.4, by <use_parent_model_frame> in 1.5 and 1.6), repeated names
(until 1.6) and ``::`` in a name (until 1.7).
"""

from __future__ import annotations

from dataclasses import dataclass

from sambot_viz.robot.sdf.values import trimmed
from sambot_viz.robot.xml.element import Element

OLDEST, NEWEST = 2, 12
"""The versions 1.2 to 1.12; ROS 2 Jazzy reads up to 1.11."""


@dataclass(frozen=True, slots=True)
class Version:
    """The version of a file, 1.`minor`."""

    minor: int

    @property
    def may_rename(self) -> bool:
        """Return whether a repeated name gets an ending instead of a refusal."""
        return self.minor < 7

    @property
    def may_have_colons(self) -> bool:
        """Return whether a name may contain ``::``."""
        return self.minor < 8

    def relative_to(self, pose: Element) -> str:
        """Return the frame that a <pose> is relative to; "" for the default."""
        frame = pose.get("frame") if self.minor < 7 else None
        return trimmed(frame or pose.get("relative_to") or "")

    def expressed_in(self, axis: Element) -> str:
        """Return the name of the frame of an <axis>; "" for that of its joint."""
        if self.minor < 5:
            return "__model__"
        in_model = axis.find("use_parent_model_frame") if self.minor < 7 else None
        if in_model is not None and trimmed(in_model.text).lower() in ("true", "1"):
            return "__model__"
        xyz = axis.find("xyz")
        return trimmed(xyz.get("expressed_in") or "") if xyz is not None else ""

    def knows(self, element: Element, attribute: str) -> bool:
        """Return whether this version has an attribute that the newest one lacks."""
        return self.minor < 7 and element.tag == "pose" and attribute == "frame"

    def knows_element(self, element: Element) -> bool:
        """Return whether this version has an element that the newest one lacks."""
        return self.minor < 7 and element.tag == "use_parent_model_frame"


def version_of(text: str) -> Version | None:
    """Return the version of an attribute ``version``, or None for an unknown one."""
    known = {f"1.{minor}": minor for minor in range(OLDEST, NEWEST + 1)}
    return Version(known[text]) if text in known else None
