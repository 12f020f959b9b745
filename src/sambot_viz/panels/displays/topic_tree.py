"""The topics of a source as a tree of the parts of their names, with their displays."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from sambot_viz.displays.by_topic import displays_of_topic
from sambot_viz.displays.display import Display
from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.panels.rows.row import Row
from sambot_viz.rviz.declarations import short_name
from sambot_viz.text import capitalized
from sambot_viz.topics import reasons


@dataclass(frozen=True, slots=True)
class ShownTopic:
    """A topic and what shows it.

    Attributes:
        name: of the topic.
        type_name: of its messages; empty when it is not known.
        displays: the usual one first; none for a topic that cannot be shown.
    """

    name: str
    type_name: str
    displays: Sequence[type[Display]]

    @property
    def base(self) -> str:
        """Its name without the last part."""
        return self.name.rpartition("/")[0]

    def carries(self, other: ShownTopic) -> bool:
        """Return whether it brings in another form what another topic does.

        As the topic of compressed pictures does below that of the raw ones.
        """
        if self.base != other.name or self.type_name == other.type_name:
            return False
        return any(display in other.displays for display in self.displays)


def shown_topics(types: Mapping[str, str]) -> Sequence[ShownTopic]:
    """Return the topics with their displays, sorted by name.

    Args:
        types: topic → type.
    """
    return [
        ShownTopic(name, kind, displays_of_topic(name, kind))
        for name, kind in sorted(types.items())
    ]


def topic_rows(topics: Iterable[ShownTopic], prefix: str) -> Iterator[Row]:
    """Yield rows for the parts of names, and below each topic for its displays.

    As in RViz, compressed pictures are another choice at the topic of the raw ones.

    Args:
        topics: sorted by name.
        prefix: begins the ids of all rows.
    """
    listed = {topic.name: topic for topic in topics}
    others: dict[str, list[ShownTopic]] = {}
    for topic in listed.values():
        base = listed.get(topic.base)
        if base is not None and topic.carries(base):
            others.setdefault(base.name, []).append(topic)
    moved = {topic.name for carried in others.values() for topic in carried}
    done: set[str] = set()
    for topic in listed.values():
        if topic.name in moved:
            continue
        for above, name in pairwise(("", *_names_to(topic.name))):
            if name in done:
                continue
            done.add(name)
            row_id, parent = _id(prefix, name), _id(prefix, above)
            label = name.removeprefix(above)
            if name == topic.name:
                yield _topic_row(topic, row_id, parent, label)
                yield from _display_rows(topic, prefix, row_id, "")
                for other in others.get(name, ()):
                    form = other.name.removeprefix(f"{name}/")
                    yield from _display_rows(other, prefix, row_id, f" ({form})")
            else:
                yield Row(row_id, parent, "group", label, expanded=True)


def _names_to(topic: str) -> Iterator[str]:
    """Yield "/a", "/a/b" and "/a/b/c" for "/a/b/c"."""
    yield from (topic[:at] for at, one in enumerate(topic) if at and one == "/")
    yield topic


def _id(prefix: str, name: str) -> str:
    return f"{prefix}topic:{name}" if name else ""


def _topic_row(topic: ShownTopic, row_id: str, parent: str, label: str) -> Row:
    kind = topic.type_name or "not known"
    if not topic.displays:
        why = f"{capitalized(reasons.no_display(topic.type_name, ()).text)}."
        off: dict[str, object] = {"off": True}
        return Row(row_id, parent, "readonly", label, kind, help=why, extra=off)
    return Row(
        row_id,
        parent,
        "readonly",
        label,
        value=kind,
        expanded=True,
        extra=_choice(topic, topic.displays[0]),
    )


def _display_rows(
    topic: ShownTopic, prefix: str, parent: str, form: str
) -> Iterator[Row]:
    for display in topic.displays:
        name = short_name(display.kind)
        yield Row(
            f"{prefix}display:{display.kind}:{topic.name}",
            parent,
            "readonly",
            f"{name}{form}",
            value=DISPLAYS.help_of(display.kind),
            icon=name,
            extra=_choice(topic, display),
        )


def _choice(topic: ShownTopic, display: type[Display]) -> dict[str, object]:
    """Return what the page sends when this is chosen."""
    return {"display": display.kind, "topic": topic.name}
