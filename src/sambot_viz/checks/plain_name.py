"""A xacro file under the name of a finished URDF."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import PurePath

from sambot_viz.checks.rule import Finding, Rule, Subject
from sambot_viz.robot.xacro_sources import token_place


def _xacro_inside(subject: Subject) -> Iterator[Finding]:
    if PurePath(subject.main_file).suffix.lower() != ".urdf":
        return
    source = subject.sources.get(subject.main_file)
    if source is None or subject.main_file not in subject.files:
        return
    first = next(
        (t for t in source.tags if t.name.startswith("xacro:") and not t.closes), None
    )
    if first is not None:
        yield Finding(
            f"this file contains xacro (<{first.name}>) though its name ends in .urdf: "
            "it is expanded first, but tools that take it for finished URDF see only a "
            "part of the robot",
            "name it .urdf.xacro",
            token_place(source, subject.main_file, first),
        )


XACRO_IN_URDF = Rule(
    code="xacro-in-urdf",
    severity="info",
    title="xacro in a file called .urdf",
    why="It is expanded here, whatever its name. check_urdf and RViz's File source "
    "take it as it is and skip every xacro element without a word.",
    example="""\
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="base" value="a"/>
  <link name="${base}"/>
</robot>
""",
    find=_xacro_inside,
)
