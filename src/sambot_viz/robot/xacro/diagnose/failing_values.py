"""Values that make an expansion fail: a placeholder in a path, broken yaml."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from sambot_viz.errors import Place, Problem, nearest
from sambot_viz.robot.xacro.diagnose.failed_expansion import FailedExpansion, line_in

_NO_FILE = re.compile(r"No such file or directory: '?([^'\[\n]+)")
_YAML_PLACE = re.compile(r'in "([^"\n]+)", line (\d+), column (\d+)')
_ARGUMENT = re.compile(r"\$\(\s*arg\s+([\w.-]+)\s*\)")
_PROPERTY = re.compile(r"\$\{\s*(\w+)\s*\}")
_DEEPEST = 4


def broken_yaml(failed: FailedExpansion) -> Problem | None:
    """Point into a yaml file that cannot be read."""
    found = _YAML_PLACE.search(failed.failure.text)
    if found is None:
        return None
    said = " ".join(failed.failure.text[: found.start()].split())
    tab = "'\\t'" in said
    place = Place(found[1], int(found[2]), int(found[3]))
    return failed.pointing_at(place).error(
        "xacro-yaml-syntax",
        "a tab is at the start of a line, where yaml takes only blanks"
        if tab
        else f"this is not yaml: {said}",
        "write blanks instead of the tab"
        if tab
        else "look at this line and the one before it: a blank after each colon, lines "
        "of one list equally far from the left",
    )


def placeholder(failed: FailedExpansion) -> Problem | None:
    """Name the argument whose default is no more than a placeholder in a path."""
    missing = failed.failure.missing_package
    path = _NO_FILE.search(failed.failure.text)
    if missing is not None:
        what, part, known = f"package {missing.name}", missing.name, missing.known
    elif path is not None:
        whole = Path(path[1].strip())
        part = _first_missing(whole)
        if part is None or part == whole:
            return None
        known = tuple(sorted(p.name for p in part.parent.iterdir() if p.is_dir()))
        what, part = f"file {whole.name}", part.name
    else:
        return None
    for name, place, default in _arguments(failed):
        choices = _choices(name, part, default, known)
        if default == part or (name in _named_at(failed) and choices):
            return _give(failed, what, name, place, default, choices)
    return None


def _give(
    failed: FailedExpansion,
    what: str,
    name: str,
    place: Place,
    default: str,
    choices: list[str],
) -> Problem:
    listed = ", ".join(choices[:12])
    return failed.error(
        "xacro-argument-placeholder",
        f"the {what} was not found: its path comes from the argument {name}, which is "
        f'"{default}" unless it is given ({line_in(place, failed.at)}){failed.trail}',
        f"give it on the command line: {name}:={choices[0] if choices else '…'}"
        + (f"; there are {listed}" if len(choices) > 1 else ""),
    )


def _choices(name: str, part: str, default: str, known: tuple[str, ...]) -> list[str]:
    """Return what the argument may be: other names differ only where it is.

    Those that have words of the argument's name come first.
    """
    if default == part:
        near = nearest(part, known)
        return sorted(known, key=lambda other: other != near)
    words = set(name.split("_"))
    at = part.find(default)
    before, after = (part[:at], part[at + len(default) :]) if default else ("", part)
    end = len(after)
    fitting = [
        other[len(before) : len(other) - end]
        for other in known
        if other.startswith(before) and other.endswith(after) and len(other) > end
    ]
    return sorted(fitting, key=lambda one: -len(words.intersection(one.split("_"))))


def _first_missing(path: Path) -> Path | None:
    """Return the first folder or file of a path that does not exist."""
    for part in (*reversed(path.parents), path):
        if not part.exists():
            return part if part.parent.is_dir() else None
    return None


def _arguments(failed: FailedExpansion) -> Iterator[tuple[str, Place, str]]:
    """Yield name, place and default of each argument that has a plain default."""
    for place, token in failed.sources.calls("xacro:arg"):
        name, default = token.get("name"), token.get("default")
        if name and default is not None and "$" not in default:
            yield name, place, default


def given_in(
    failed: FailedExpansion, kind: str, attribute: str, name: str
) -> Iterator[tuple[Place, str]]:
    """Yield the places that define a name, and the values that they give it."""
    for place, token in failed.sources.calls(f"xacro:{kind}"):
        value = token.get(attribute)
        if token.get("name") == name and value is not None:
            yield place, value


def _named_at(failed: FailedExpansion) -> set[str]:
    """Return the arguments in the element that failed, through its properties."""
    source = failed.sources.get(failed.at.file)
    tags = source.tags if source is not None else ()
    texts = [
        attribute.value
        for tag in tags
        if source is not None and source.line(tag.start) == failed.at.line
        for attribute in tag.attributes
    ]
    found: set[str] = set()
    for _ in range(_DEEPEST):
        found.update(name for text in texts for name in _ARGUMENT.findall(text))
        names = [name for text in texts for name in _PROPERTY.findall(text)]
        texts = [
            value
            for name in names
            for _, value in given_in(failed, "property", "value", name)
        ]
    return found
