"""Macros that the model defines and never calls."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sambot_viz.checks.rule import Finding, Rule, Subject
from sambot_viz.robot.xacro.diagnose.source_files import named_things


def _unused(subject: Subject) -> Iterator[Finding]:
    """Only the main file is judged: a library may hold more than one needs."""
    source = subject.sources.get(subject.main_file)
    if source is None or "macro" not in source.text:
        return
    called = set(_called(subject))
    for thing in named_things(source, subject.main_file):
        if thing.kind != "macro" or not thing.prefixed or not thing.name:
            continue
        if thing.name.removeprefix("xacro:") not in called:
            yield Finding(
                f"the macro {thing.name} is defined but never called, so nothing of "
                "it is in the robot",
                f"call it with <xacro:{thing.name} …/>, or delete it",
                thing.place,
            )


def _called(subject: Subject) -> Iterator[str]:
    """Names that are called anywhere, whatever namespace they are called through."""
    for _, source in subject.sources.sources():
        for token in source.tags:
            prefix, _, name = token.name.rpartition(":")
            if prefix == "xacro" and name == "call":
                # A name that is put together cannot be known: any letters fit.
                wanted = token.get("macro") or ""
                yield from _fitting(subject, wanted)
            elif prefix == "xacro" and name != "macro":
                yield name.rpartition(".")[2]
            elif not prefix:
                # A call without its prefix is told by the xacro reader.
                yield token.name


def _fitting(subject: Subject, wanted: str) -> Iterator[str]:
    pattern = ".*".join(re.escape(part) for part in re.split(r"\$\{[^}]*\}", wanted))
    for _, source in subject.sources.sources():
        for thing in named_things(source, ""):
            if thing.kind == "macro" and re.fullmatch(pattern, thing.name):
                yield thing.name


UNUSED_MACRO = Rule(
    code="unused-macro",
    severity="warning",
    title="A macro that is never called",
    why="xacro only remembers a macro until it is called. A forgotten call leaves its "
    "links and joints out without a word.",
    example="""\
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="a"/>
  <xacro:macro name="wheel" params="side">
    <link name="${side}_wheel"/>
  </xacro:macro>
</robot>
""",
    find=_unused,
    example_name="robot.urdf.xacro",
)
