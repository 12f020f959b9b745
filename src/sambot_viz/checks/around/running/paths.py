"""Find the paths in packages that actions of a launch file name."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import zip_longest

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.launching.actions import (
    Action,
    Expression,
    ForNodes,
    FromFile,
    IncludeFile,
    RobotText,
    SetArgument,
    StartNode,
    StartProcess,
)
from sambot_viz.checks.around.launching.texts import UNKNOWN, LaunchTexts
from sambot_viz.errors import Place

_Named = Iterator[tuple[Expression, Place]]


def paths_of(action: Action, texts: LaunchTexts) -> Iterator[Fact]:
    """Yield the paths in packages that an action names, with their places.

    Args:
        action: the action.
        texts: evaluates its texts.
    """
    for value, place in _named(action):
        settled = texts.settled(value)
        text = settled.source if isinstance(settled, RobotText) else settled
        said = text if isinstance(text, str) and UNKNOWN not in text else ""
        words = said.split() if SHARE in said else ()
        yield from (Fact(word, place) for word in words if word.startswith(SHARE))


def _named(action: Action) -> _Named:
    match action:
        case SetArgument(value=value, place=place):
            yield value, place
        case IncludeFile(path=path, arguments=arguments, place=place):
            yield path, place
            yield from ((value, place) for _, value in arguments)
        case StartProcess(words=words, place=place):
            yield from ((word, place) for word in words)
        case StartNode(arguments=words, argument_places=places, place=place):
            both = zip_longest(words, places[: len(words)])
            yield from ((word, there or place) for word, there in both)
        case _:
            pass
    for each in action.given if isinstance(action, (StartNode, ForNodes)) else ():
        values = (each.path,) if isinstance(each, FromFile) else each.values or ()
        yield from ((value, each.place) for value in values)
