"""Messages for tags that are misspelt, crossed or missing."""

from __future__ import annotations

from dataclasses import dataclass

from sambot_viz.errors import Problem
from sambot_viz.robot.xml.diagnose.source_text import SourceText
from sambot_viz.robot.xml.diagnose.tokens import Token


@dataclass(frozen=True, slots=True)
class StructureMessages:
    """Builds the problems of one file.

    Attributes:
        source: the text.
        file: its name, for the places.
    """

    source: SourceText
    file: str

    def _line(self, token: Token) -> int:
        return self.source.line(token.start)

    def misspelt(self, opened: Token, closed: Token) -> Problem:
        """A closing tag whose name is nearly that of the open tag."""
        return self.source.error(
            self.file,
            "xml-closing-tag-misspelt",
            closed.start,
            f"<{opened.name}> opened on line {self._line(opened)} is closed by "
            f"</{closed.name}> on line {self._line(closed)}",
            f"write </{opened.name}>",
        )

    def wrong_case(self, opened: Token, closed: Token) -> Problem:
        """A closing tag that differs from the open tag in capital letters only."""
        wrong = closed if opened.name.islower() else opened
        right = opened.name if opened.name.islower() else opened.name.lower()
        return self.source.error(
            self.file,
            "xml-tag-case",
            wrong.start,
            f"<{opened.name}> on line {self._line(opened)} is closed by "
            f"</{closed.name}> on line {self._line(closed)}: XML distinguishes "
            "capital letters from small ones",
            f"write <{right}> and </{right}>",
        )

    def crossed(self, inner: Token, closed: Token, following: Token) -> Problem:
        """Two closing tags in the wrong order: `closed` comes before `following`."""
        return self.source.error(
            self.file,
            "xml-tags-crossed",
            closed.start,
            f"</{closed.name}> on line {self._line(closed)} comes before "
            f"</{inner.name}>, although <{inner.name}> (line {self._line(inner)}) was "
            "opened last",
            f"close <{inner.name}> first: exchange the closing tags on lines "
            f"{self._line(closed)} and {self._line(following)}",
        )

    def opening_missing(self, closed: Token, orphan: Token) -> Problem:
        """A closing tag without its opening tag; `orphan` is its first child."""
        line = self._line(orphan)
        return self.source.error(
            self.file,
            "xml-opening-tag-missing",
            orphan.start,
            f"</{closed.name}> on line {self._line(closed)} closes a <{closed.name}> "
            f"that was never opened; its content begins on line {line}",
            f"write <{closed.name} …> before line {line}, or delete </{closed.name}>",
        )

    def robot_missing(self, tags: list[Token]) -> Problem:
        """A file that ends with </robot> and has no <robot>."""
        return self.source.error(
            self.file,
            "xml-opening-tag-missing",
            tags[0].start,
            f"</robot> on line {self._line(tags[-1])} closes a <robot> that was never "
            "opened",
            f'write <robot name="…"> before line {self._line(tags[0])}',
        )
