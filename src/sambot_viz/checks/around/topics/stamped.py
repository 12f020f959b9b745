"""Two nodes at the ends of a topic, with messages that do not fit together.

Most of them are commands with and without a time stamp.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.endpoints import switched_off
from sambot_viz.checks.around.running.system import (
    Endpoint,
    GivenParameter,
    RunningNode,
)
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import write
from sambot_viz.errors import Fix, Problem


class _End(NamedTuple):
    """A topic of a node."""

    node: RunningNode
    end: Endpoint

    @property
    def what(self) -> str:
        """The name of the node for a message."""
        return "the bridge" if self.node.is_bridge else self.node.path.strip("/")

    @property
    def given(self) -> GivenParameter | None:
        """The parameter that decides on its type, where it is given."""
        name, _ = self.end.switch
        return self.node.parameter(name) if name else None


class _Pair(NamedTuple):
    """A publisher and a subscription of one topic with different types."""

    sender: _End
    reader: _End


def ends_of_other_types(around: Surroundings) -> Iterator[Problem]:
    """Report topics with one type at the publisher and another at all subscribers."""
    ends = [
        _End(node, end)
        for node in around.running.started
        for end in node.endpoints
        if not end.in_gazebo and end.topic.startswith("/") and end.kind
    ]
    done: set[str] = set()
    for pair in _pairs(around, ends):
        problem = _problem(pair, _turned(pair, ends))
        if problem.place not in done:
            done.add(problem.place)
            yield problem


def _pairs(around: Surroundings, ends: list[_End]) -> Iterator[_Pair]:
    off = [
        _End(node, end) for node in around.running.started for end in switched_off(node)
    ]
    for sender in ends:
        if not sender.end.publishes or sender.end.typed_at is None:
            continue
        readers = [one for one in ends if _reads(one, sender)]
        wrong = [
            one
            for one in readers
            if one.end.typed_at is not None and one.end.message != sender.end.message
        ]
        if readers and wrong == readers:
            near = (one for one in readers if _meet(around, sender.node, one.node))
            # Other rules compare a topic that a parameter names.
            first = next((r for r in near if not _is_named(r.end)), None)
            yield from [_Pair(sender, first)] if first is not None else []
        elif not readers:
            for one in off:
                fits = _reads(one, sender) and one.end.message == sender.end.message
                if fits and one.end.typed_at and _meet(around, sender.node, one.node):
                    yield _Pair(sender, one)


def _reads(one: _End, sender: _End) -> bool:
    return not one.end.publishes and one.end.topic == sender.end.topic


def _is_named(end: Endpoint) -> bool:
    is_entry = end.parameter.endswith(".topic") and end.switch[0] != ""
    return end.parameter != "" and not is_entry


def _meet(around: Surroundings, one: RunningNode, other: RunningNode) -> bool:
    """Return whether two nodes surely run at the same time."""
    if around.running.is_known:
        return True
    if one.launch == other.launch:
        return one.starts == other.starts == "yes"
    if one.launch not in around.running.launches:
        one, other = other, one
    if other.launch in around.running.launches:
        return False
    # The other one is a plugin of the model.
    simulating = {n.launch for n in around.running.started if n.is_simulator}
    return one.starts == "yes" and one.launch in simulating


def _turned(pair: _Pair, ends: list[_End]) -> _End | None:
    """Return the end whose type a parameter changes, and that fits fewer others."""
    if pair.sender.end.message == pair.reader.end.message:
        return pair.reader

    def harm(one: _End) -> tuple[int, bool]:
        own = [e for e in ends if e.node is one.node and e.end.switch == one.end.switch]
        fits = [
            other.end.message == mine.end.message
            for mine in own
            for other in ends
            if other.node is not one.node and other.end.topic == mine.end.topic
            if other.end.publishes is not mine.end.publishes and other.end.typed_at
        ]
        return fits.count(True) - fits.count(False), one.given is None

    able = [one for one in pair if one.end.switch[0]]
    return min(able, key=harm, default=None)


def _problem(pair: _Pair, turned: _End | None) -> Problem:
    sender, reader = pair
    given = turned.given if turned is not None else None
    ends = sender.end.typed_at or sender.node.place, reader.end.typed_at
    place = given.place if given is not None else ends[0]
    other = next((each for each in ends[::-1] if each not in (None, place)), ends[0])
    topic, kind = sender.end.topic, sender.end.message
    follows = f"({where(other, place)}): nothing arrives"
    if kind == reader.end.message:
        name, value = reader.end.switch
        opposite = "true" if value == "false" else "false"
        cause = f"reads it only with {name}: {opposite}"
    else:
        cause = f"reads it as {reader.end.message}"
    return Problem.at(
        place,
        "warning",
        "topic-type",
        f"{sender.what} publishes {topic} as {kind}, but {reader.what} {cause} "
        f"{follows}",
        _fix(pair, turned),
    )


def _fix(pair: _Pair, turned: _End | None) -> Fix:
    if turned is None:
        sent = pair.sender.end.message
        return Fix(f"write one type for both, {sent} or {pair.reader.end.message}")
    name, value = turned.end.switch
    if pair.sender.end.message == pair.reader.end.message:
        value = "true" if value == "false" else "false"
    hint, given = f"write {name}: {value}", turned.given
    if given is None:
        return Fix(f"give {turned.what} the parameter {name}: {value}")
    return write(given.place, given.value or "", value, hint=hint)
