"""Report options that the programs in launch files do not have."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import partial

from sambot_viz.checks.around.running.system import RunningNode
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.words import WordKind, WrittenWord, misspelt
from sambot_viz.edits import write
from sambot_viz.errors import Problem

_OPTION = WordKind(
    "program_options",
    "launch-code",
    "{owner} has no option {wrong}, but {right}: it stops, or uses its default",
    "warning",
)
_WRITTEN = re.compile(r"--?[A-Za-z][\w-]*")
_FOR_ROS = "--ros-args"


def unknown_options(around: Surroundings) -> Iterator[Problem]:
    """Report misspelt options, and those of a similar program."""
    for node in around.running.started:
        yield from misspelt(_options(node), _OPTION)


def _options(node: RunningNode) -> Iterator[WrittenWord]:
    """Yield the options of a program, up to those that ROS reads."""
    given = [word for word, _ in node.placed_arguments if word]
    owner = f"{node.package}/{node.executable}"
    for word, place in node.placed_arguments:
        if word == _FOR_ROS:
            break
        if word and _WRITTEN.fullmatch(word):
            fix = partial(write, place, word)
            yield WrittenWord(owner, word, given, place, fix, node.executable)
