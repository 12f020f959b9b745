"""The rows of the tables."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Measure:
    """A row of a table.

    Attributes:
        key: of the values.
        title: what it is, with its unit.
        scale: values times this are in that unit.
        digits: after the point.
    """

    key: str
    title: str
    scale: float = 1.0
    digits: int = 1

    def text(self, value: float | None) -> str:
        """A value in the unit of the title."""
        return "–" if value is None else f"{value * self.scale:,.{self.digits}f}"


VIEWER_MEASURES = (
    Measure("page", "command → page opens [s]", digits=2),
    Measure("pixels", "command → first pixels of the robot [s]"),
    Measure("loaded", "reading the model [ms]", 1e3, 0),
    Measure("poses", "poses of all links [µs]", 1e6, 0),
    Measure("delay1", "a step → 1 client [ms]", 1e3),
    Measure("delay5", "a step → all of 5 clients [ms]", 1e3),
    Measure("delay30", "a step → all of 30 clients [ms]", 1e3),
    Measure("step_pixels", "a step → changed pixel [ms]", 1e3, 0),
    Measure("cpu_one", "computing of a step of one joint [ms]", digits=2),
    Measure("cpu_all", "computing of a step of all joints [ms]", digits=2),
    Measure("bytes_one", "bytes of a step of one joint", digits=0),
    Measure("bytes_all", "bytes of a step of all joints", digits=0),
    Measure("rest", "computing at rest [% of a core]"),
    Measure("rest_messages", "messages at rest [1/s]"),
    Measure("memory", "memory of the server [MB]", digits=0),
    Measure("memory_per_client", "memory per further client [MB]", digits=2),
    Measure("size", "what the page brings [MB]"),
)
INSTALLED = Measure("installed", "installed [MB]", digits=0)
RECORDING_MEASURES = (
    Measure("opening", "opening [ms]", 1e3),
    Measure("jump", "jump: last message of five topics [ms]", 1e3),
    Measure("peak", "most memory of both [MB]", digits=0),
    Measure("page", "command → address of the page [s]", digits=2),
    Measure("memory", "memory of the program [MB]", digits=0),
)
SHORT = ("page", "pixels", "delay30", "cpu_one", "bytes_one", "rest", "memory")
"""What the README has room for, of `VIEWER_MEASURES`."""
