"""Problems in a lesson's file, collected up to its end."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import yaml

from sambot_viz.checks.around.files.parameters import place_of
from sambot_viz.errors import Findings, Place, did_you_mean


class LessonReport:
    """Collects the problems of one file.

    Args:
        file: file as the user wrote it.

    Attributes:
        folder: folder of the file.
        findings: the problems.
    """

    def __init__(self, file: Path) -> None:
        self.file = str(file)
        self.folder = file.parent
        self.findings = Findings()

    def place(self, node: yaml.Node) -> Place:
        """Return the start of a value."""
        return place_of(node, self.file)

    def wrong_value(self, node: yaml.Node, message: str, hint: str) -> None:
        """Report a value of another kind or outside its range."""
        self.findings.add("error", "lesson-value", message, hint, self.place(node))

    def unknown(
        self, node: yaml.ScalarNode, what: str, of: str, known: Iterable[str]
    ) -> None:
        """Report a name that is not in a list.

        Args:
            node: the name.
            what: kind of name, such as "key".
            of: owner of the names, such as "a step".
            known: the valid names.
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
        """Report a required key that is missing."""
        self.findings.add(
            "error",
            "lesson-key",
            f"{of} has no '{key}'",
            f"add {key}: with {kind}",
            self.place(node),
        )
