"""The keys of an item that nothing declares."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from sambot_viz.rviz.declared import Declared
from sambot_viz.rviz.properties.kinds import VectorProperty
from sambot_viz.rviz.yaml.nodes import Map

Keys = tuple[str, ...]


def unknown_keys(
    node: Map, known: Mapping[Keys, Declared], own: Collection[str]
) -> Iterator[str]:
    """The undeclared keys of a map, each as a path joined by "/", in its order.

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
    """Whether a property has a key without declaring it."""
    prop = owner.property
    if isinstance(prop, VectorProperty):
        return key in prop.keys
    return prop.open_keys or (key == "Value" and prop.has_value)
