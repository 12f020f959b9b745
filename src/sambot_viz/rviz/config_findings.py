"""What is doubtful in an .rviz file, with its place."""

from __future__ import annotations

from sambot_viz.errors import Findings, Problem
from sambot_viz.rviz.yaml.nodes import Node


class ConfigFindings(Findings):
    """Collects the warnings of one file.

    Args:
        file: its path as the user wrote it.
    """

    def __init__(self, file: str | None) -> None:
        super().__init__()
        self._file = file

    def warn(self, code: str, node: Node, message: str, hint: str = "") -> None:
        """Add a warning at a node; copies are reported at their originals."""
        if node.span is not None:
            line, column = node.span.line, node.span.column
            self.note(Problem("warning", code, message, hint, self._file, line, column))
