"""Recordings beside each other: two robots, or two runs of one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from sambot_viz.sources.bag.bag import Bag
from sambot_viz.sources.bag.recording import Recording
from sambot_viz.sources.bag.renamed import RenamedBag
from sambot_viz.sources.joined import hidden_topics


@dataclass(frozen=True, slots=True)
class Beside:
    """A recording among others.

    Attributes:
        bag: it, open.
        name: what it is called.
        prefix: before its topics and frames; "" for none.
        remaps: topics with other names there (see `Prefix`).
    """

    bag: Bag
    name: str
    prefix: str
    remaps: Mapping[str, str] = field(default_factory=dict[str, str])


def beside_each_other(given: Sequence[Beside]) -> Recording:
    """Return several recordings as one, for one player.

    Those that were made at the same time play at their times. One whose time does not
    overlap with that of the first ones begins with the first one, as when both are
    played at once: so two runs can be compared.

    Args:
        given: a topic that several have is that of the first one.
    """
    bags: list[RenamedBag] = []
    seen: dict[str, None] = {}
    for one in given:
        shift_ns = _shift_ns(bags, one.bag)
        bag = RenamedBag(one.bag, one.prefix, shift_ns, tuple(seen), one.remaps)
        bags.append(bag)
        seen.update(dict.fromkeys(bag.topics))
    bare = [(g, RenamedBag(g.bag, g.prefix, remaps=g.remaps)) for g in given]
    whole = [(one.name, bag.topics) for one, bag in bare]
    return Recording(bags, hidden_topics(whole), are_beside=True)


def _shift_ns(before: Sequence[Bag], bag: Bag) -> int:
    """Return by how much a recording is moved to begin with the first one [ns]."""
    start, end = bag.start_ns, bag.end_ns
    spans = [(one.start_ns, one.end_ns) for one in before]
    known = [(a, b) for a, b in spans if a is not None and b is not None]
    if start is None or end is None or not known:
        return 0
    if any(start <= b and a <= end for a, b in known):
        return 0
    return known[0][0] - start
