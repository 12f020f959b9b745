"""What is wrong with a lesson's file, collected while it is read to the end."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import yaml

from sambot_viz.checks.around.files.parameters import place_of
from sambot_viz.errors import Findings, Place, did_you_mean


class LessonReport:
    """Collects the problems of one file.

    Args:
        file: the file as the user wrote it.

    Attributes:
        folder: the folder of the file.
        findings: the problems.
    """

    def __init__(self, file: Path) -> None:
        self.file = str(file)
        self.folder = file.parent
        self.findings = Findings()

    def place(self, node: yaml.Node) -> Place:
        """Return where a value begins."""
        return place_of(node, self.file)

    def wrong_value(self, node: yaml.Node, message: str, hint: str) -> None:
        """Add a value of another kind or outside its range."""
        self.findings.add("error", "lesson-value", message, hint, self.place(node))

    def unknown(
        self, node: yaml.ScalarNode, what: str, of: str, known: Iterable[str]
    ) -> None:
        """Add a name that is not in a list.

        Args:
            node: the name.
            what: what it is, such as "key".
            of: what has those names, such as "a step".
            known: the names that there are.
        """
        names = list(known)
        self.findings.add(
            "error",
            "lesson-key",
            f"{of} has no {what} '{node.value}'",
            did_you_mean(node.value, names),
            self.place(node),
        )

    def missing(self, node: yaml.Node, key: str, of: str, kind: str) -> None:
        """Add a key that is needed and not there."""
        self.findings.add(
            "error",
            "lesson-key",
            f"{of} has no '{key}'",
            f"add {key}: with {kind}",
            self.place(node),
        )
