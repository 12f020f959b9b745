"""What a rule is, and what it may look at.

A rule is one concept in one file (or a small family in one file) and one line in
`registry.py`. It only reads: the robot, and the text of the files it came from.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property

from sambot_viz.errors import Place, Problem, Severity
from sambot_viz.robot.model import Robot
from sambot_viz.robot.xacro.diagnose.source_files import SourceSet, token_place
from sambot_viz.robot.xml.diagnose.lexer import Token
from sambot_viz.robot.xml.diagnose.source_text import SourceText


@dataclass(frozen=True)
class Finding:
    """What a rule found: the sentence, the mend, and where."""

    message: str
    hint: str
    place: Place | None = None


@dataclass(frozen=True)
class Subject:
    """What the rules look at.

    Attributes:
        main_file: the model as the user wrote it.
        robot: the robot, or None when it could not be loaded.
        files: the files it was read from, as the user would write them, the main
            file first.
    """

    main_file: str
    robot: Robot | None
    files: tuple[str, ...]

    @cached_property
    def sources(self) -> SourceSet:
        """The texts of the files."""
        return SourceSet.of((self.main_file, *self.files))

    def inside(self, place: Place | None, *path: str) -> Place | None:
        """The place of an element inside another one.

        Args:
            place: where the outer element begins.
            path: tags from the outside in, such as "geometry", "mesh".

        Returns:
            The place of the innermost that was found; `place` itself when the
            first is not there.
        """
        if place is None:
            return None
        source = self.sources.get(place.file)
        if source is None:
            return place
        at = _tag_index(source, place)
        for tag in path:
            inner = None if at is None else _child(source.tags, at, tag)
            if inner is None:
                break
            at = inner
        return place if at is None else token_place(source, place.file, source.tags[at])


def _tag_index(source: SourceText, place: Place) -> int | None:
    on_line = [
        (index, token)
        for index, token in enumerate(source.tags)
        if not token.closes and source.line(token.start) == place.line
    ]
    for index, token in on_line:
        if place.column in (None, source.column(token.start)):
            return index
    return on_line[0][0] if on_line else None


def _child(tags: list[Token], outer: int, name: str) -> int | None:
    """Index of the first tag with that name inside the element at `outer`."""
    if tags[outer].kind != "open":
        return None
    depth = 1
    for index in range(outer + 1, len(tags)):
        token = tags[index]
        if token.closes:
            depth -= 1
            if depth == 0:
                return None
            continue
        if token.name == name and depth == 1:
            return index
        depth += token.kind == "open"
    return None


@dataclass(frozen=True, slots=True)
class Rule:
    """One thing that is allowed but will bite.

    Attributes:
        code: stable identifier, the code of its problems.
        severity: of its problems.
        title: what it finds, a few words.
        why: what will happen, and what to write instead; for the page of rules.
        example: the smallest model that breaks it.
        find: looks, and yields what it found.
        needs_robot: False when the text alone is enough, also of a model that
            cannot be loaded.
        example_name: file name of the example; the ending tells its kind.
        example_files: (name, content) of further files it needs.
    """

    code: str
    severity: Severity
    title: str
    why: str
    example: str
    find: Callable[[Subject], Iterable[Finding]]
    needs_robot: bool = True
    example_name: str = "robot.urdf"
    example_files: tuple[tuple[str, str], ...] = ()

    def problems(self, subject: Subject) -> list[Problem]:
        """Everything this rule finds."""
        if self.needs_robot and subject.robot is None:
            return []
        return [self._problem(finding) for finding in self.find(subject)]

    def _problem(self, finding: Finding) -> Problem:
        place = finding.place
        return Problem(
            self.severity,
            self.code,
            finding.message,
            finding.hint,
            place.file if place else None,
            place.line if place else None,
            place.column if place else None,
        )


def listed(names: Iterable[str], most: int = 6) -> str:
    """Names as a person would list them: "a, b and c"."""
    known = list(names)
    if len(known) > most:
        return f"{', '.join(known[:most])} and {len(known) - most} more"
    if len(known) < 2:
        return "".join(known)
    return f"{', '.join(known[:-1])} and {known[-1]}"


def number(value: float) -> str:
    """A number without noise: 1.5708, -90, 0.5."""
    return f"{value:.5g}"
