"""Check values in launch files for which launch accepts only a few words."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import NamedTuple

from sambot_viz.checks.around.files.parameters import flag
from sambot_viz.checks.around.launching.launch_file import NODES
from sambot_viz.checks.around.parameters.slips import WORDS
from sambot_viz.checks.around.place import rewritten, where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.rule import listed
from sambot_viz.edits import write, write_attribute
from sambot_viz.errors import Fix, Place, Problem, nearest
from sambot_viz.robot.slips.vocabulary import is_one_slip

_OUTPUT = ("screen", "log", "both", "own_log", "full")
_PROGRAMS = NODES | {"ComposableNodeContainer", "ExecuteLocal", "ExecuteProcess"}
_TRUTH = ("true", "false")
_LIKENESS = 0.5
_STOPS = "ros2 launch stops with it"


class _Choice(NamedTuple):
    """A value that must be one of a few words.

    Attributes:
        name: the argument or key that has it.
        value: the value.
        words: the words.
        place: of the value.
        fix: the fix for each of the words, by the word.
    """

    name: str
    value: str
    words: tuple[str, ...]
    place: Place
    fix: dict[str, Fix]


def other_words(around: Surroundings) -> Iterator[Problem]:
    """Report an output, a default and a condition with an unknown word."""
    for one in (*_in_python(around), *_in_elements(around)):
        if one.value not in one.words:
            near = nearest(one.value, one.words, _LIKENESS)
            yield Problem.at(
                one.place,
                "error",
                "launch-code",
                f"{one.name} is {one.value}, and takes only {listed(one.words)}: "
                f"{_STOPS}",
                one.fix[near] if near else f"write {' or '.join(one.words)}",
            )
    for (name, value, place), condition in around.running.unclear.items():
        meant, near = flag(value), nearest(value.lower(), _TRUTH, _LIKENESS)
        right = near if meant is None else str(meant).lower()
        yield Problem.at(
            place,
            "error",
            "launch-code",
            f"the launch argument {name} is {value}, neither true nor false, but a "
            f"condition ({where(condition, place)}): {_STOPS}",
            write(place, value, right) if right else f"write {' or '.join(_TRUTH)}",
        )


def misspelt_truths(around: Surroundings) -> Iterator[Problem]:
    """Report texts that are almost true or false; conditions have their own rule."""
    told = {place for _, _, place in around.running.unclear}
    for text, place in _texts(around):
        near = next((word for word in _TRUTH if is_one_slip(text.lower(), word)), None)
        if near is None or text.lower() in (*_TRUTH, *WORDS) or place in told:
            continue
        right = near.title() if text[:1].isupper() else near
        yield Problem.at(
            place,
            "warning",
            "launch-code",
            f"the text {text} is neither true nor false, but probably {right} is meant",
            write(place, text, right),
        )


def _texts(around: Surroundings) -> Iterator[tuple[str, Place]]:
    """Yield the values of arguments and keys in launch files."""
    for launch in around.launches:
        for node in ast.walk(launch.tree):
            values: list[ast.expr] = []
            if isinstance(node, ast.Call):
                values = [*node.args, *(keyword.value for keyword in node.keywords)]
            elif isinstance(node, ast.Dict):
                values = node.values
            elif isinstance(node, ast.Tuple):
                values = node.elts[1:]
            for value in values:
                if isinstance(value, ast.Constant) and isinstance(value.value, str):
                    yield value.value, launch.place(value)
    for root in (root for package in around.packages for root in package.frontends):
        for element in root.iter():
            for name in ("value", "default"):
                yield element.get(name) or "", element.place


def _in_python(around: Surroundings) -> Iterator[_Choice]:
    for launch in around.launches:
        for call in launch.called(*_PROGRAMS, "DeclareLaunchArgument"):
            is_program = call.name in _PROGRAMS
            given = (
                call.given("output") if is_program else call.given("default_value", 1)
            )
            texts = launch.values.listed(call.value("choices")).known
            words = _OUTPUT if is_program else tuple(sorted(texts or ()))
            if (
                isinstance(given, ast.Constant)
                and isinstance(given.value, str)
                and words
            ):
                fix = {w: rewritten(given, launch.shown, f"'{w}'") for w in words}
                name = "output" if is_program else "default_value"
                yield _Choice(name, given.value, words, launch.place(given), fix)


def _in_elements(around: Surroundings) -> Iterator[_Choice]:
    for element in (e for p in around.packages for r in p.frontends for e in r.iter()):
        name = "output" if element.tag in ("node", "executable") else "default"
        choices = tuple(c.get("value") or "" for c in element.find_all("choice"))
        words, value = _OUTPUT if name == "output" else choices, element.get(name)
        if value is not None and words and "$" not in value:
            place = element.place
            is_yaml = place.file.endswith((".yaml", ".yml"))
            fix = {
                w: write(place, value, w)
                if is_yaml
                else write_attribute(place, name, value, w)
                for w in words
            }
            yield _Choice(name, value, words, place, fix)
