"""The files that a server shows, and how they are read."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from sambot_viz.robot.model import Robot
from sambot_viz.server.documents import Documents


@dataclass(frozen=True, slots=True)
class Sources:
    """The files of a server, and how they are read and shown.

    Attributes:
        model: the model file; None follows that of the robot that is shown.
        load: reads a model from its file.
        show: shows a robot in all sessions.
        documents: where sessions take their document from, and which file it is in.
        opened: when the files were opened first [ns].
    """

    model: Path | None
    load: Callable[[Path], Robot]
    show: Callable[[Robot], None]
    documents: Documents
    opened: int
