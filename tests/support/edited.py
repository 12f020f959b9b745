"""What edits make of files, which stay as they are."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from sambot_viz.errors import Edit
from sambot_viz.fixes import changes


def edited_files(edits: Iterable[Edit]) -> dict[str, bytes]:
    """Return each file with its content after the edits."""
    return {change.file: change.after for change in changes(edits, [Path("/")])}
