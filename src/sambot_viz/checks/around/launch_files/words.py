"""Report unknown words in launch files: arguments, elements and attributes."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator, Sequence
from functools import partial

from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.place import key_place
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.words import WordKind, WrittenWord, misspelt
from sambot_viz.checks.around.workspace import Package
from sambot_viz.checks.rule import listed
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import (
    delete_attribute,
    rename_attribute,
    rename_element,
    together,
    write,
    write_between,
)
from sambot_viz.errors import Fix, Place, Problem, nearest
from sambot_viz.robot.xml.element import Element

_STOPS = "ros2 launch stops with it"
_ARGUMENT = WordKind(
    "launch_calls",
    "launch-code",
    f"{{owner}} has no argument {{wrong}}, but {{right}}: {_STOPS}",
)
_ATTRIBUTE = WordKind(
    "launch_elements",
    "launch-code",
    f"<{{owner}}> has no attribute {{wrong}}, but {{right}}: {_STOPS}",
)
_ELEMENT = WordKind(
    "launch_elements",
    "launch-code",
    f"there is no <{{wrong}}> in <{{owner}}>, but <{{right}}>: {_STOPS}",
)
_SUBSTITUTION = WordKind(
    "launch_elements",
    "launch-code",
    f"there is no substitution $({{wrong}} …), but $({{right}} …): {_STOPS}",
)
_COMMAND = WordKind(
    "ros2_commands",
    "launch-code",
    "{owner} has no command {wrong}, but {right}: it stops with an error",
)
_DOLLAR = re.compile(r"\$\(\s*([\w-]+)")
_OF_FILE = ("from", "allow_substs")
"""The attributes of a <param> that reads a file."""
_OLD = frozenset({"type", "rosparam", "$find", "$arg"})
_NEW = frozenset({"exec", "let", "$var", "$find-pkg-share", "composable_node"})
"""Words that exist only in launch files of ROS 1, or only in those of ROS 2."""


def unknown_keywords(around: Surroundings) -> Iterator[Problem]:
    """Report misspelt arguments of an action."""
    for launch in around.launches:
        yield from misspelt(_arguments(launch), _ARGUMENT)


def _arguments(launch: LaunchFile) -> Iterator[WrittenWord]:
    for call in launch.calls:
        given = {k.arg for k in call.node.keywords if k.arg}
        for each in call.node.keywords:
            if each.arg:
                place = Place(launch.shown, each.lineno, each.col_offset + 1)
                fix = partial(_replaced, place, each.arg)
                yield WrittenWord(call.name, each.arg, given, place, fix)


def _replaced(place: Place, wrong: str, right: str) -> Fix:
    end = Place(place.file, place.line, (place.column or 1) + len(wrong))
    return write_between(place, end, right, f"write {right}")


def unknown_commands(around: Surroundings) -> Iterator[Problem]:
    """Report misspelt commands of ros2."""
    for launch in around.launches:
        for call in launch.called("ExecuteProcess", "ExecuteLocal"):
            owner = ""
            for item, node in call.listing("cmd").items:
                for word in (launch.values.said(item) or "$").split():
                    fix = partial(write, launch.place(node), word)
                    shown = owner.replace("_", " ")
                    place = launch.place(node)
                    written = WrittenWord(owner, word, (), place, fix, shown)
                    yield from misspelt([written], _COMMAND)
                    owner = f"{owner}_{word}".strip("_")


def of_ros1(package: Package) -> list[Element]:
    """Return the launch files with words that only ROS 1 has."""
    found: list[Element] = []
    for root in package.frontends:
        used = {word for element in root.iter() for word in _used(element)}
        if _OLD & used and not _NEW & used:
            found.append(root)
    return found


def _of_ros1(roots: Sequence[Element]) -> Problem:
    """Report all of a package at once: it comes from ROS 1 as a whole."""
    names = [root.place.file.rpartition("/")[2] for root in roots]
    one = len(roots) == 1
    which = "this launch file is" if one else f"{listed(names, 3)} are launch files"
    them = "it" if one else "them"
    return Problem.at(
        roots[0].place,
        "info",
        "launch-code",
        f"{which} written for ROS 1, which has other elements and attributes: ros2 "
        f"launch stops with {them}",
        f"write {them} for ROS 2, or delete {them}",
    )


def unknown_elements_of_launch(around: Surroundings) -> Iterator[Problem]:
    """Report words of XML and YAML launch files that launch does not know."""
    for package in around.packages:
        old = of_ros1(package)
        if old:
            yield _of_ros1(old)
        for root in package.frontends:
            if root in old:
                continue
            is_xml = not root.place.file.endswith((".yaml", ".yml"))
            for element in root.iter():
                attribute, inner = (
                    _in(kind, is_xml) for kind in (_ATTRIBUTE, _ELEMENT)
                )
                yield from misspelt(_attributes(element, is_xml), attribute)
                yield from _beside_file(element, is_xml)
                yield from misspelt(_substitutions(element), _SUBSTITUTION)
                yield from misspelt(_children(element, is_xml), inner)


def _in(kind: WordKind, is_xml: bool) -> WordKind:
    """Return a kind of words with a message for XML, or for YAML without brackets."""
    plain = kind.message.replace("<", "").replace(">", "")
    return kind if is_xml else kind._replace(message=plain)


def _used(element: Element) -> Iterator[str]:
    yield element.tag
    if element.tag != "param":
        yield from element.attributes
    for value in element.attributes.values():
        yield from (f"${name}" for name in _DOLLAR.findall(value))


def _attributes(element: Element, is_xml: bool) -> Iterator[WrittenWord]:
    given, place = element.attributes, element.place
    owner = element.tag
    if element.parent is not None and element.parent.tag == "include":
        owner = "keep"
    for name, value in given.items():
        there = place if is_xml else key_place(place, name)

        def renamed(
            right: str, name: str = name, value: str = value, there: Place = there
        ) -> Fix:
            hint = f"write {right}"
            if is_xml:
                return rename_attribute(place, name, right, value, f'{hint}="{value}"')
            return write(there, name, right, hint=hint)

        yield WrittenWord(owner, name, given, there, renamed)


def _substitutions(element: Element) -> Iterator[WrittenWord]:
    for value in element.attributes.values():
        for name in dict.fromkeys(_DOLLAR.findall(value)):

            def renamed(right: str, name: str = name) -> Fix:
                hint = f"write $({right} …)"
                return write(element.place, f"$({name}", f"$({right}", hint=hint)

            yield WrittenWord("$", name, (), element.place, renamed)


def _beside_file(element: Element, is_xml: bool) -> Iterator[Problem]:
    """Report attributes of a <param> that reads a file, which has no others."""
    for name in _unread(element.tag, element.attributes):
        if nearest(name, _OF_FILE, 0.75) is not None:
            continue
        place = element.place
        other = {"name", "value"} <= element.attributes.keys()
        fix = Fix("write two <param>") if other else Fix(f"delete {name}")
        if is_xml and not other:
            fix = Fix(fix.hint, delete_attribute(place, name))
        yield Problem.at(
            place if is_xml else key_place(place, name),
            "error",
            "launch-code",
            f"a <param> with from reads a file, and has no {name} beside it: {_STOPS}",
            fix,
        )


def _unread(tag: str, given: Collection[str]) -> list[str]:
    """Return the attributes that a <param> with a file does not have."""
    reads = tag == "param" and "from" in given
    return [name for name in given if name not in _OF_FILE] if reads else []


def _children(element: Element, is_xml: bool) -> Iterator[WrittenWord]:
    for child in element.children:
        place, tag = child.place, child.tag
        if not is_xml:
            place = key_place(element.place, tag)
        fix: Callable[[str], Fix] = partial(write, place, tag)
        if is_xml:
            fix = partial(_renamed, child)
        yield WrittenWord(f"{element.tag}/", tag, (), place, fix, element.tag)


def _renamed(element: Element, right: str) -> Fix:
    """Return the fix that gives an element another name, and its attributes theirs."""
    place, tag = element.place, element.tag
    row = vocabulary("launch_elements").get(right, ())
    others = dict(word.split("=") for word in row if "=" in word)
    values = {others.get(n, n): value for n, value in element.attributes.items()}
    gone = _unread(right, values)
    shown = " ".join(f'{n}="{v}"' for n, v in values.items() if n not in gone)
    if tag != "rosparam":
        return rename_element(place, tag, right, f"write <{right}>")
    if "from" not in values:
        return Fix('write <param name="…" value="…"/> for each of its parameters')
    hint = f"write <{right} {shown}/>"
    return together(
        hint,
        rename_element(place, tag, right, hint),
        *(
            rename_attribute(place, name, others[name], value, hint)
            for name, value in element.attributes.items()
            if name in others
        ),
        *(Fix(hint, delete_attribute(place, name)) for name in gone),
    )
