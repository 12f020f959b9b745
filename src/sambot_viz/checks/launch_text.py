"""Text in a model that stops ``ros2 launch`` (spec/ros-nodes.md §7.3).

A launch file that passes Command([…]) straight as robot_description has the whole
URDF read as YAML. xacro keeps comments, so a harmless "TODO: …" is enough.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from sambot_viz.checks.rule import Finding, Rule, Subject
from sambot_viz.errors import Place
from sambot_viz.robot.xml.diagnose.source_text import SourceText

_TRAP = re.compile(r":(?=[ \t\n]|$)|(?<=[ \t\n])#|(?<=\n)\t", re.MULTILINE)
_SAYING = {":": '": "', "#": '" #"', "\t": "a tab at the start of a line"}


@dataclass(frozen=True, slots=True)
class _Trap:
    place: Place
    what: str
    mark: str


def _traps(subject: Subject) -> Iterator[Finding]:
    traps = [
        trap
        for number, (file, source) in enumerate(subject.sources.sources())
        for trap in _traps_in(source, file, is_main=number == 0)
        if _survives(subject, source, trap)
    ]
    if not traps:
        return
    first = traps[0]
    lines = [
        str(t.place.line)
        for t in traps[1:]
        if t.place.file == first.place.file and t.place.line != first.place.line
    ]
    lines = list(dict.fromkeys(lines))
    also = f" (the same on lines {', '.join(lines[:5])})" if lines else ""
    also = also.replace("lines", "line") if len(lines) == 1 else also
    also = also.replace(")", f" and {len(lines) - 5} more)") if len(lines) > 5 else also
    yield Finding(
        f"{first.what} contains {_SAYING[first.mark]}{also}: the model is fine, but a "
        "launch file that gives the text to robot_state_publisher as it is has it "
        "read as YAML, and nothing starts",
        "in the launch file write ParameterValue(Command([…]), value_type=str), or "
        "change the text here",
        first.place,
    )


def _survives(subject: Subject, source: SourceText, trap: _Trap) -> bool:
    """Whether these words are still there after xacro."""
    if subject.robot is None:
        return False
    line = source.line_text(trap.place.line)
    at = trap.place.column - 1 if trap.place.column else 0
    inside = line.rfind("${", 0, at) > line.rfind("}", 0, at)
    words = re.split(r"\$[{(]|[})]|<!--|-->", line)
    reached = 0
    for word in words:
        reached = line.find(word, reached) + len(word)
        if reached > at:
            return not inside and word.strip() in subject.robot.urdf
    return not inside


def _traps_in(source: SourceText, file: str, *, is_main: bool) -> Iterator[_Trap]:
    tokens = source.tokens
    root = source.first("robot")
    for index, token in enumerate(tokens):
        outside = root is None or token.start < root.start
        if outside and not is_main:
            continue
        if token.kind == "comment":
            if not _before_xacro(source, index):
                what = "the comment"
                yield from _found(source, file, token.start + 4, token.end - 3, what)
        elif token.kind == "text":
            if source.text[token.start : token.end].strip():
                yield from _found(source, file, token.start, token.end, "the text")
        elif token.name and not token.name.startswith("xacro:"):
            for attribute in token.attributes:
                start = source.text.find(attribute.value, attribute.offset)
                end = start + len(attribute.value)
                if start >= 0 and attribute.value:
                    what = f"the attribute {attribute.name}"
                    yield from _found(source, file, start, end, what)


def _before_xacro(source: SourceText, index: int) -> bool:
    """Whether xacro drops this comment: it stands directly before its own tag."""
    for token in source.tokens[index + 1 :]:
        if token.kind == "comment":
            continue
        if token.kind == "text" and not source.text[token.start : token.end].strip():
            continue
        return token.name.startswith("xacro:") and not token.closes
    return False


def _found(
    source: SourceText, file: str, start: int, end: int, what: str
) -> Iterator[_Trap]:
    for match in _TRAP.finditer(source.text, start, end):
        mark = match[0]
        if what.startswith("the attribute") and mark == "\t":
            # XML turns a tab in a value into a blank.
            continue
        at = match.start()
        yield _Trap(Place(file, source.line(at), source.column(at)), what, mark)


LAUNCH_TEXT_AS_YAML = Rule(
    code="launch-text-as-yaml",
    severity="warning",
    title="Text that stops ros2 launch",
    why="A launch file that passes Command([…]) straight as robot_description has the "
    "URDF read as YAML; a colon with a blank, a # after a blank or a tab at the start "
    "of a line is then an error, and nothing starts. "
    "ParameterValue(…, value_type=str) around it avoids that for good.",
    example="""\
<robot name="r">
  <!-- TODO: measure the arm -->
  <link name="a"/>
</robot>
""",
    find=_traps,
)
