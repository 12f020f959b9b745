"""Names that will be mixed up or cannot be typed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from sambot_viz.checks.rule import Finding, Rule, Subject
from sambot_viz.robot.model import Joint, Link


def _case(subject: Subject) -> Iterator[Finding]:
    if subject.robot is None:
        return
    yield from _case_among("link", subject.robot.links.values())
    yield from _case_among("joint", subject.robot.joints.values())


def _case_among(kind: str, things: Iterable[Link | Joint]) -> Iterator[Finding]:
    seen: dict[str, Link | Joint] = {}
    for thing in things:
        other = seen.setdefault(thing.name.lower(), thing)
        if other is not thing:
            where = f" (line {other.place.line})" if other.place else ""
            yield Finding(
                f"the {kind} names {other.name}{where} and {thing.name} differ only "
                "in capital letters: they are two different things to ROS",
                "rename one of them, or join them if one is a typing error",
                thing.place,
            )


def _blanks(subject: Subject) -> Iterator[Finding]:
    if subject.robot is None:
        return
    things = (*subject.robot.links.values(), *subject.robot.joints.values())
    for thing in things:
        if any(c.isspace() for c in thing.name):
            kind = "link" if isinstance(thing, Link) else "joint"
            yield Finding(
                f'the {kind} name "{thing.name}" contains a blank: it works, but '
                "commands and launch files split it in two",
                f'write "{"_".join(thing.name.split())}"',
                thing.place,
            )


NAMES_DIFFER_IN_CASE = Rule(
    code="names-differ-in-case",
    severity="warning",
    title="Names that differ only in capital letters",
    why="base_link and Base_Link are two links to ROS. Usually one is a typing error.",
    example="""\
<robot name="r">
  <link name="arm"/>
  <link name="Arm"/>
  <joint name="j" type="fixed">
    <parent link="arm"/>
    <child link="Arm"/>
  </joint>
</robot>
""",
    find=_case,
)

NAME_WITH_BLANK = Rule(
    code="name-with-blank",
    severity="info",
    title="A blank in a name",
    why="ROS accepts it, but every command line and launch file splits it in two.",
    example='<robot name="r">\n  <link name="left wheel"/>\n</robot>\n',
    find=_blanks,
)
