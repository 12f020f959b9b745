"""The feedback about an interactive marker to its program, as RViz sends it."""

from __future__ import annotations

import secrets
from dataclasses import dataclass
from typing import Any, Literal

from sambot_viz.geometry import ORIGIN, Vector3, Xyzw
from sambot_viz.publishing.outbound import Outbound

FeedbackEvent = Literal[
    "POSE_UPDATE", "MENU_SELECT", "BUTTON_CLICK", "MOUSE_DOWN", "MOUSE_UP"
]
_EVENTS: dict[FeedbackEvent, int] = {
    "POSE_UPDATE": 1,
    "MENU_SELECT": 2,
    "BUTTON_CLICK": 3,
    "MOUSE_DOWN": 4,
    "MOUSE_UP": 5,
}
"""The numbers of visualization_msgs/InteractiveMarkerFeedback."""
_CLIENT_ID = f"sambot-viz {secrets.token_hex(4)}"
"""One for all pages: a program refuses another one for a second after the last word."""


@dataclass(frozen=True, slots=True)
class MarkerFeedback(Outbound):
    """What was done with a marker, and its pose.

    Attributes:
        event: what was done.
        marker: the name of the interactive marker.
        control: that of the control.
        stamp_ns: the time of the pose [ns]; 0 for the latest.
        position: of the marker in the frame [m].
        xyzw: its rotation.
        menu_entry: the id of the entry that was chosen; 0 for none.
        mouse_point: what the pointer is on, in the frame [m]; None for nothing.
    """

    kind = "markers"
    type_name = "visualization_msgs/msg/InteractiveMarkerFeedback"
    noun = "pose of a marker"
    event: FeedbackEvent
    marker: str
    control: str
    stamp_ns: int
    position: Vector3
    xyzw: Xyzw
    menu_entry: int = 0
    mouse_point: Vector3 | None = None

    @property
    def numbers(self) -> tuple[float, ...]:
        """The position [m], the rotation as x, y, z, w, and what was done."""
        return *self.position, *self.xyzw, _EVENTS[self.event], self.menu_entry

    @property
    def told(self) -> dict[str, Any]:
        """What was done, with which handle, and where the marker is."""
        x, y, z = (round(value, 6) for value in self.position)
        qx, qy, qz, qw = (round(value, 6) for value in self.xyzw)
        said: dict[str, Any] = {"marker": self.marker, "control": self.control}
        said |= {"event": self.event, "position": (x, y, z)}
        said |= {"orientation": (qx, qy, qz, qw)}
        return said | ({"entry": self.menu_entry} if self.menu_entry else {})

    def fields(self, stamp: object) -> dict[str, Any]:
        """Return the fields of the message, with the time of its pose."""
        del stamp
        sec, nanosec = divmod(self.stamp_ns, 10**9)
        # Zero-argument super does not work in a class with slots that is made again.
        return Outbound.fields(self, {"sec": sec, "nanosec": nanosec})

    def content(self) -> dict[str, Any]:
        """Return the fields after the header."""
        place = dict(zip("xyz", self.position, strict=True))
        turn = dict(zip("xyzw", self.xyzw, strict=True))
        point = dict(zip("xyz", self.mouse_point or ORIGIN, strict=True))
        return {
            "client_id": _CLIENT_ID,
            "marker_name": self.marker,
            "control_name": self.control,
            "event_type": _EVENTS[self.event],
            "pose": {"position": place, "orientation": turn},
            "menu_entry_id": self.menu_entry,
            "mouse_point": point,
            "mouse_point_valid": self.mouse_point is not None,
        }

    @property
    def words(self) -> str:
        """The text for the log; empty for events that come many times a second."""
        done = {
            "MENU_SELECT": f"entry {self.menu_entry} of its menu",
            "BUTTON_CLICK": f"a click on {self.control}",
            "MOUSE_DOWN": f"takes {self.control}",
            "MOUSE_UP": f"leaves {self.control}",
        }.get(self.event)
        return f"Interactive marker {self.marker}: {done}" if done else ""
