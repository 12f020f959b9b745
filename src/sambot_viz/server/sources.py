"""The files that a server shows, and how they are read."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from sambot_viz.robot.model import Robot
from sambot_viz.rviz import RvizConfig


class Documents:
    """The .rviz document of the server: one for all browsers, or a copy for each.

    Args:
        document: as it was read, with the options of the command line applied.
        copy: makes a copy for a private session; None shares the document itself.
    """

    def __init__(
        self, document: RvizConfig, copy: Callable[[RvizConfig], RvizConfig] | None
    ) -> None:
        self.current = document
        self._copy = copy

    def __call__(self) -> RvizConfig:
        """The document for one more session."""
        return self.current if self._copy is None else self._copy(self.current)


@dataclass(frozen=True, slots=True)
class Sources:
    """The files of a server, and how they are read and shown.

    Attributes:
        model: the model file; None follows that of the robot that is shown.
        load: reads a model from its file.
        show: shows a robot in all sessions.
        config: the .rviz file, or None when there is none to follow.
        documents: where sessions take their document from.
        prepare: applies the options of the command line to a document that was read.
        opened: when the files were opened first [ns].
    """

    model: Path | None
    load: Callable[[Path], Robot]
    show: Callable[[Robot], None]
    config: Path | None
    documents: Documents
    prepare: Callable[[RvizConfig], None]
    opened: int
