"""Declared properties with their places in the file, and the keys without one."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

from sambot_viz.errors import UsageError, did_you_mean
from sambot_viz.rviz.properties.kinds import VectorProperty
from sambot_viz.rviz.properties.property import Property
from sambot_viz.rviz.yaml.nodes import Map

Keys = tuple[str, ...]


class UnknownPropertyError(UsageError):
    """A property that is not declared.

    Attributes:
        path: what was asked for.
    """

    def __init__(self, owner: str, path: str, known: Sequence[str]):
        self.path = path
        super().__init__(f"{owner} has no '{path}'; {did_you_mean(path, known)}")


@dataclass(frozen=True, slots=True)
class Declared:
    """A property with its place in the file.

    Attributes:
        path: keys from the item on, joined by "/".
        keys: the same keys.
        property: the declaration.
        above: the one whose child it is.
    """

    path: str
    keys: tuple[str, ...]
    property: Property
    above: Declared | None = None


def unknown_keys(
    node: Map, known: Mapping[Keys, Declared], own: Collection[str]
) -> Iterator[str]:
    """Yield the undeclared keys of a map as paths joined by "/", in its order.

    Args:
        node: the map of an item.
        known: the declared properties by their keys.
        own: keys of the first level that have a meaning but are not properties.
    """
    return _below(node, (), None, known, own)


def _below(
    node: Map,
    above: Keys,
    owner: Declared | None,
    known: Mapping[Keys, Declared],
    own: Collection[str],
) -> Iterator[str]:
    for key in node.keys():
        keys = (*above, key)
        declared, value = known.get(keys), node.get(key)
        if declared is not None:
            if isinstance(value, Map):
                yield from _below(value, keys, declared, known, own)
        elif not (key in own if owner is None else _belongs_to(key, owner)):
            yield "/".join(keys)


def _belongs_to(key: str, owner: Declared) -> bool:
    """Return whether a property has a key without declaring it."""
    prop = owner.property
    if isinstance(prop, VectorProperty):
        return key in prop.keys
    return prop.open_keys or (key == "Value" and prop.has_value)
