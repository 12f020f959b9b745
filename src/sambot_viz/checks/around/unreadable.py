"""Report unreadable parameter files and launch files, which stop their users."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any, cast

import yaml

from sambot_viz.checks.around.files.parameters import YamlFile, pairs, place_of
from sambot_viz.checks.around.place import line_fix, where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.workspace import Package
from sambot_viz.edits import source_of, write, write_between
from sambot_viz.errors import Fix, Place, Problem, nearest
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.element import parse_xml

_KNOWN = re.compile(
    r"(.*/)?(ekf|ukf|nav2|amcl|slam|navsat|.*bridge|.*params|.*controllers?)"
    r"[^/]*\.ya?ml"
)
_TEMPLATE = re.compile(r"\{\{|\{%|<%")
_ROOT = "launch"
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_TAG = re.compile(r"<(/?)([\w:.-]+)(?:[^<>\"']|\"[^\"]*\"|'[^']*')*?(/?)>")
_KEY, _LIKENESS = "ros__parameters", 0.84


def unreadable_yaml(around: Surroundings) -> Iterator[Problem]:
    """Report parameter files that are not YAML."""
    read = {file.shown for file in around.yaml_files}
    for package, path, user in parameter_files(around):
        shown = package.shown(path)
        text = package.text(path) if shown not in read else None
        is_launch = path.endswith((".launch.yaml", ".launch.yml"))
        if text is None or is_launch or _TEMPLATE.search(text):
            continue
        # Import late, as below: most files are readable.
        from sambot_viz.checks.around.files.yaml_repair import fault_in

        fault = fault_in(text)
        if fault is not None:
            place = Place(shown, fault.line)
            named = f" ({where(user, place)})" if user else ""
            yield Problem.at(
                place,
                "error",
                "parameters-yaml",
                f"this file is not YAML: {fault.cause}; the node that it is for{named} "
                "does not start",
                line_fix(fault, place, text),
            )


def joined_entries(around: Surroundings) -> Iterator[Problem]:
    """Report topics of a bridge that a missing "- " joins into one entry."""
    for file in around.yaml_files:
        if not isinstance(file.root, yaml.SequenceNode):
            continue
        for entry in file.root.value:
            seen: set[str] = set()
            for key, _ in pairs(entry):
                if key.value in seen and key.value.endswith("topic_name"):
                    yield Problem.at(
                        Place(file.shown, key.start_mark.line + 1),
                        "error",
                        "parameters-yaml",
                        f"{key.value} is twice in one entry of the list: two topics "
                        'are one, because the "- " before the second is missing',
                        f'write "- " in place of the last 2 blanks before {key.value}',
                    )
                    seen.clear()
                seen.add(key.value)


def misspelt_key(around: Surroundings) -> Iterator[Problem]:
    """Report misspelt ros__parameters."""
    users = {p.shown(path): user for p, path, user in parameter_files(around)}
    for file in around.yaml_files:
        for key, place in _above_parameters(file):
            user = users.get(file.shown)
            named = f" ({where(user, place)})" if user else ""
            yield Problem.at(
                place,
                "error",
                "parameters-key",
                f"the key {key} is no {_KEY}, with two underscores: the node that the "
                f"file is for{named} finds no parameters and stops",
                write(place, key, _KEY),
            )


def missing_key(around: Surroundings) -> Iterator[Problem]:
    """Report files of nodes with values outside ros__parameters."""
    files = {file.shown: file for file in around.yaml_files}
    users = {
        given.shown: (node, given)
        for node in reversed(around.running.started)
        for given in node.files
    }
    for shown, (node, given) in users.items():
        file = files.get(shown)
        for key, block in pairs(file.root) if file and not file.nodes else ():
            below = list(pairs(block))
            has_values = any(isinstance(v, yaml.ScalarNode) for _, v in below)
            if not has_values or any(_is_like_key(k.value) for k, _ in below):
                continue
            place = Place(shown, key.start_mark.line + 1)
            yield Problem.at(
                place,
                "error",
                "parameters-key",
                f"the values of {key.value} are not below {_KEY}: {node.name}, "
                f"which is given this file ({where(given.place, place)}), stops",
                _put_below(key, block, shown),
            )


def _is_like_key(written: str) -> bool:
    return nearest(written, [_KEY], _LIKENESS) is not None


def _put_below(key: yaml.Node, block: yaml.Node, shown: str) -> Fix:
    """Return the fix that writes the key above a block, and moves it if needed."""
    source = source_of(shown)
    above, first = (place_of(node, shown).column or 1 for node in (key, block))
    hint = f"write {_KEY}: above them, and move them to the right"
    begin = cast("Any", block).start_mark.line
    if source is None or begin == cast("Any", key).start_mark.line:
        # In {a: 1, b: 2}, after the key, no line can move.
        return Fix(hint)
    lines = source.text.split("\n")[begin : cast("Any", block).end_mark.line + 1]
    # The end mark is at the beginning of the next block, or of the text above it.
    while len(lines) > 1 and not lines[-1][: first - 1].isspace():
        lines.pop()
    move = max(0, above + 4 - first)
    own = [f"{' ' * move}{line}" if line[:1].isspace() else line for line in lines]
    text = "\n".join([" " * ((above + first + move) // 2 - 1) + f"{_KEY}:", *own])
    end = Place(shown, begin + len(lines), len(lines[-1]) + 1)
    return write_between(Place(shown, begin + 1, 1), end, text, hint)


def _above_parameters(file: YamlFile) -> Iterator[tuple[str, Place]]:
    """Yield the keys like ros__parameters below the names of nodes."""
    level = [file.root]
    for _ in range(4):
        below = [pair for node in level for pair in pairs(node)][:1000]
        for key, _value in below:
            if key.value != _KEY and _is_like_key(key.value):
                yield key.value, Place(file.shown, key.start_mark.line + 1)
        level = [value for key, value in below if key.value != _KEY]


def parameter_files(
    around: Surroundings,
) -> Iterator[tuple[Package, str, Place | None]]:
    """Yield the parameter files: those that launch files name, and usual names."""
    named = {
        around.named(fact.value): fact.place
        for launch in reversed(around.launches)
        for fact in reversed(launch.paths)
    }
    for package in around.packages:
        for path in package.ending(".yaml", ".yml"):
            user = named.get((package, path))
            if user is not None or _KNOWN.fullmatch(path):
                yield package, path, user


def unreadable_python(around: Surroundings) -> Iterator[Problem]:
    """Report launch files, and a setup.py, that are not Python."""
    for package in around.packages:
        read = {launch.path for launch in package.launches}
        paths = [p for p in package.ending("launch.py") if p not in read]
        for path in paths if package.setup is not None else (*paths, "setup.py"):
            text = package.text(path)
            if not text:
                continue
            from sambot_viz.checks.around.files.python_repair import fault_in_python

            fault = fault_in_python(text)
            if fault is not None:
                place = Place(package.shown(path), fault.line)
                stops = "colcon build" if path == "setup.py" else "ros2 launch"
                yield Problem.at(
                    place,
                    "error",
                    "python-syntax",
                    f"this file is not Python: {fault.cause}; {stops} stops with it",
                    line_fix(fault, place, text),
                )


def unreadable_launch_files(around: Surroundings) -> Iterator[Problem]:
    """Report launch files that are not XML."""
    for package in around.packages:
        for path in package.ending(".launch.xml"):
            text, shown = package.text(path) or "", package.shown(path)
            try:
                parse_xml(text, shown)
            except XmlFault as fault:
                open_ = _not_closed(text)
                # Import late: most launch files are right.
                from sambot_viz.robot.xml.diagnose.explain_xml import explain_xml

                yield from (
                    explain_xml(text, shown, fault)
                    if open_ is None
                    else [_unclosed(shown, *open_)]
                )


def unreadable_yaml_launches(around: Surroundings) -> Iterator[Problem]:
    """Report YAML launch files that are not YAML, or have no launch at the top."""
    for package in around.packages:
        for path in package.ending(".launch.yaml", ".launch.yml"):
            text, shown = package.text(path) or "", package.shown(path)
            file = next((f for f in package.yaml_files if f.path == path), None)
            if file is not None:
                keys = [key for key, _ in pairs(file.root)]
                if keys and all(key.value != _ROOT for key in keys):
                    place, wrong = place_of(keys[0], shown), keys[0].value
                    near = nearest(wrong, [_ROOT], 0.7) is not None
                    yield Problem.at(
                        place,
                        "error",
                        "launch-code",
                        f"the first key of a launch file is {_ROOT}, and this is "
                        f"{wrong}: ros2 launch stops with it",
                        write(place, wrong, _ROOT) if near else f"write {_ROOT}: above",
                    )
                continue
            # Import late, as above.
            from sambot_viz.checks.around.files.yaml_repair import fault_in

            fault = fault_in(text) if text else None
            if fault is not None:
                place = Place(shown, fault.line)
                yield Problem.at(
                    place,
                    "error",
                    "launch-code",
                    f"this file is not YAML: {fault.cause}; ros2 launch stops with it",
                    line_fix(fault, place, text),
                )


def _not_closed(text: str) -> tuple[str, int, str] | None:
    """Return the first element without an end, its line, and what ends before it."""
    text = _COMMENT.sub(lambda found: "\n" * found[0].count("\n"), text)
    waiting: list[tuple[str, int]] = []
    for found in _TAG.finditer(text):
        closes, name, is_empty = found.groups()
        if not closes and not is_empty:
            waiting.append((name, text.count("\n", 0, found.start()) + 1))
        elif closes and waiting and waiting[-1][0] == name:
            waiting.pop()
        elif closes:
            ends = any(name == tag for tag, _ in waiting)
            return (*waiting[-1], f"</{name}>") if ends else None
    return (*waiting[0], "the end of the file") if waiting else None


def _unclosed(shown: str, tag: str, line: int, before: str) -> Problem:
    return Problem.at(
        Place(shown, line),
        "error",
        "launch-code",
        f"<{tag}> begins here, and {before} comes before its </{tag}>: ros2 launch "
        "stops with it",
        f"write </{tag}> at its end, or /> in place of > if it has nothing inside",
    )


def unreadable_models(around: Surroundings) -> Iterator[Problem]:
    """Report models and their parts that are not XML, including unused ones."""
    for package in around.packages:
        for path in package.ending(".xacro", ".urdf"):
            text, shown = package.text(path), package.shown(path)
            try:
                parse_xml(text or "<robot/>", shown)
            except XmlFault as fault:
                from sambot_viz.robot.xml.diagnose.explain_xml import explain_xml

                yield from explain_xml(text or "", shown, fault)
