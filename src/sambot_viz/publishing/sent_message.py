"""What was sent to a robot, and the file in which it is kept."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sambot_viz.errors import PublishError


@dataclass(frozen=True, slots=True)
class SentMessage:
    """A message that was sent.

    Attributes:
        time: when, since 1970 [s].
        who: the user, or "Python".
        topic: where.
        type_name: of the message.
        frame: in which its place is given; "" for none.
        values: its numbers in the order in which they are given; of a message of a
            program, its fields.
    """

    time: float
    who: str
    topic: str
    type_name: str
    frame: str
    values: Sequence[float] | dict[str, Any]


class PublishLog:
    """A file with a line of JSON for each message that was sent.

    Args:
        path: it is appended to.

    Raises:
        PublishError: it cannot be written.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._append("")

    def add(self, sent: SentMessage) -> None:
        """Write what was sent.

        Raises:
            PublishError: it cannot be written.
        """
        told = {
            "time": round(sent.time, 3),
            "who": sent.who,
            "topic": sent.topic,
            "type": sent.type_name,
            "frame": sent.frame,
            "values": sent.values,
        }
        self._append(f"{json.dumps(told, allow_nan=False)}\n")

    def _append(self, line: str) -> None:
        try:
            with self._path.open("a", encoding="utf-8") as file:
                file.write(line)
        except OSError as error:
            why = error.strerror or str(error)
            raise PublishError(f"{self._path} cannot be written: {why}") from error
