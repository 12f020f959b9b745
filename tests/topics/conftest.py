"""Recordings that tests write."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import made_recording
import pytest

Told = Sequence[tuple[float, Mapping[str, str]]]
"""Log time [s], and the child of each parent."""
TOPICS = {"/tf": "tf2_msgs/msg/TFMessage", "/robot_description": "std_msgs/msg/String"}


@pytest.fixture
def write_recording(tmp_path: Path) -> Callable[..., Path]:
    """Write an mcap file of /tf, and of /robot_description: its path."""

    def write(told: Told, description: str | None = None) -> Path:
        texts = {} if description is None else {"/robot_description": description}
        moves = [
            ("/tf", seconds, {child: parent for parent, child in frames.items()})
            for seconds, frames in told
        ]
        path = tmp_path / "written.mcap"
        return made_recording.write_recording(path, texts, moves, TOPICS)

    return write
