"""Report values in RViz configs that RViz reads as others, or cannot read."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.topics.display_settings import (
    OWN_PACKAGES,
    Settings,
    settings,
)
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import write
from sambot_viz.errors import Fix, Problem
from sambot_viz.rviz.declarations import kind_of
from sambot_viz.rviz.properties.color import ColorProperty
from sambot_viz.rviz.properties.numbers import (
    BoolProperty,
    FloatProperty,
    IntProperty,
    VectorProperty,
)
from sambot_viz.rviz.properties.property import Property
from sambot_viz.rviz.properties.texts import EnumProperty, PolicyProperty
from sambot_viz.rviz.yaml.yaml_nodes import Map, Node, Scalar

_KINDS: dict[str, type[Property]] = {
    "bool": BoolProperty,
    "color": ColorProperty,
    "float": FloatProperty,
    "int": IntProperty,
    "one": EnumProperty,
    "policy": PolicyProperty,
}
_NOTHING = ("", "~", "null")
_OF_COVARIANCE = "Frame"
_PARTS = ("X", "Y", "Z", "W")
"""The keys of vectors and quaternions."""


def unusable_values(around: Surroundings) -> Iterator[Problem]:
    """Report numbers, colours and words that RViz cannot read, or reads otherwise."""
    for one in settings(around):
        if kind_of(one.owner).rpartition("/")[0] not in OWN_PACKAGES:
            continue
        if not one.above and "X" in one.keys:
            yield from _of_vector(one)
            continue
        for key, fact in one.values.items():
            # The value of a property with others below it is beside them.
            is_own = key == "Value" and not one.above
            known = _property(one.key if is_own else key)
            # These are below another; some displays have others of the same name.
            nested = key == _OF_COVARIANCE or isinstance(known, PolicyProperty)
            unknown = known is None or (one.above and nested)
            if known is not None and not unknown and fact.value not in _NOTHING:
                yield from _read(known, Scalar(fact.value), fact)


@cache
def _property(name: str) -> Property | None:
    """Return a property of the vocabulary; None for one with any text."""
    kind, *words = vocabulary("rviz_values").get(name.replace(" ", "_"), ("",))
    if kind not in ("int", "float"):
        options = tuple(word.replace("_", " ") for word in words)
        return _KINDS[kind](name, None, options=options) if kind else None
    low, _, high = words[0].partition("..") if words else ("", "", "")
    return _KINDS[kind](name, 0, minimum=_limit(low), maximum=_limit(high))


def _limit(text: str) -> float | None:
    return int(text) if text.isdigit() else float(text) if text else None


def _read(known: Property, node: Node, fact: Fact) -> Iterator[Problem]:
    """Read a value as RViz does, and yield what is doubtful about it."""
    found: list[Problem] = []

    def report(node: Node, message: str, hint: str, right: str = "") -> None:
        del node
        fix = write(fact.place, fact.value, right, hint=hint) if right else Fix(hint)
        place = fact.place
        found.append(Problem.at(place, "warning", "config-value", message, fix))

    known.read(node, report)
    yield from found


def _of_vector(one: Settings) -> Iterator[Problem]:
    parts = Map()
    keys = tuple(key for key in _PARTS if key in one.keys)
    for key in keys:
        if key in one.values:
            parts.put(key, Scalar(one.values[key].value))
    first = one.values.get("X", one.keys["X"])
    yield from _read(VectorProperty(one.key, keys=keys), parts, first)
