"""The properties and arguments that a model uses, with the units of their uses."""

from __future__ import annotations

import pytest

from sambot_viz.robot.xacro.named_numbers import NamedNumber, named_numbers
from sambot_viz.robot.xml.diagnose.source_text import SourceText

BOX = '<link name="l"><visual><geometry><box size="1 1 {}"/></geometry></visual></link>'
PLACE = '<origin xyz="0 0 {}"/>'


def numbers(*texts: str) -> list[NamedNumber]:
    head = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
    files = {f"{n}.xacro": f"{head}{text}\n</robot>" for n, text in enumerate(texts)}
    sources = {file: SourceText(text) for file, text in files.items()}
    found = named_numbers(sources)
    for one in found:
        start, end = one.extent
        assert files[one.file][start:end] == one.written
    return found


def written(name: str, value: str) -> str:
    return f'<xacro:property name="{name}" value="{value}"/>'


@pytest.mark.parametrize(
    ("use", "unit"),
    [
        (BOX.format("${a}"), "m"),
        (BOX.format("${2*a + 0.1}"), "m"),
        (PLACE.format("${a}"), "m"),
        ('<origin rpy="0 0 ${a}"/>', "rad"),
        ('<origin rpy="0 0 ${radians(a)}"/>', "°"),
        ('<origin rpy="0 0 ${a*pi/180}"/>', "°"),
        (PLACE.format("${sin(a)}"), "rad"),
        ('<mass value="${a}"/>', "kg"),
        ("<radius>${a}</radius>", "m"),
        ('<joint name="j" type="prismatic"><limit upper="${a}"/></joint>', "m"),
        ('<joint name="j" type="revolute"><limit lower="${a}"/></joint>', "rad"),
        # Uses that disagree, and those that say nothing.
        (f'{BOX.format("${a}")}<mass value="${{a}}"/>', ""),
        ('<inertia ixx="${a}"/>', ""),
        (f'{BOX.format("${a}")}<inertia ixx="${{a*a}}"/>', "m"),
        # Through other properties, macros and defaults.
        (f"{written('b', '${a/2}')}{BOX.format('${b}')}", "m"),
        (
            '<xacro:macro name="m" params="p"><mass value="${p}"/></xacro:macro>'
            '<xacro:m p="${a}"/>',
            "kg",
        ),
        (
            '<xacro:macro name="m" params="p:=${a}"><mass value="${p}"/></xacro:macro>'
            "<xacro:m/>",
            "kg",
        ),
    ],
)
def test_a_unit_follows_from_what_a_number_reaches(use: str, unit: str) -> None:
    (number, *_) = numbers(written("a", "0.50") + use)
    assert (number.name, number.value, number.unit) == ("a", 0.5, unit)


@pytest.mark.parametrize(
    "text",
    [
        written("a", "1"),
        # In a macro that is never called, and where a text has the same word.
        f'{written("a", "1")}<xacro:macro name="m" params="">'
        f"{BOX.format('${a}')}</xacro:macro>",
        f"{written('a', '1')}{BOX.format(chr(36) + '{b[' + repr('a') + ']}')}",
        # A parameter with the name of a property hides it.
        f'{written("a", "1")}<xacro:macro name="m" params="a">{BOX.format("${a}")}'
        '</xacro:macro><xacro:m a="2"/>',
        written("a", "left") + BOX.format("${a}"),
        written("a", "3.14159") + BOX.format("${a}"),
        written("a", "$(find x)/y") + '<mesh filename="${a}"/>',
    ],
)
def test_what_is_not_used_or_no_number_is_left_out(text: str) -> None:
    assert not numbers(text)


def test_arguments_expressions_and_names_that_are_there_twice() -> None:
    found = numbers(
        '<xacro:arg name="g" default="4"/><xacro:arg name="g" default="5"/>'
        '<mass value="$(arg g)"/><xacro:if value="${xacro.arg(\'h\') > 2}"/>\n'
        "<xacro:arg name='h' default=' 7 '/>",
        written("a", "1") + written("a", "2") + written("b", "${a/2}"),
        BOX.format("${b}"),
    )
    rows = [(n.kind, n.name, n.count, n.file, n.value, n.unit) for n in found]
    assert rows == [
        ("arg", "g", 0, "0.xacro", 4, "kg"),
        ("arg", "h", 0, "0.xacro", 7, ""),
        ("property", "a", 0, "1.xacro", 1, "m"),
        ("property", "a", 1, "1.xacro", 2, "m"),
        ("property", "b", 0, "1.xacro", None, "m"),
    ]
    assert found[1].is_whole and not found[0].is_whole
