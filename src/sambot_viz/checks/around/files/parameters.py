"""Read the parameters in the YAML files of a package, each with its line."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import yaml

from sambot_viz import limits
from sambot_viz.cached import cached_property
from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.errors import Place

_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_MOST_NAMES = 3
"""Maximum number of keys for namespaces and the name of a node."""

_MANAGER = "controller_manager"
_CONTROLLER = re.compile(r"contr?ol|broadcast", re.IGNORECASE)
"""Classes of controllers, and their packages."""

_TRUE, _FALSE = frozenset({"true", "yes", "on"}), frozenset({"false", "no", "off"})


class Parameter(NamedTuple):
    """One parameter of a node.

    Attributes:
        node: the keys above ros__parameters, joined with slashes.
        name: its name, with dots.
        values: the text of the value, or of each item of a list.
        place: its line.
        written: the value as YAML has it.
        above: the keys before it, below ros__parameters.
    """

    node: str
    name: str
    values: tuple[str, ...]
    place: Place
    written: yaml.Node
    above: tuple[yaml.ScalarNode, ...] = ()

    @property
    def value_place(self) -> Place:
        """The place where the value begins."""
        return place_of(self.written, self.place.file)

    @property
    def fact(self) -> Fact:
        """The value, as a name with its place."""
        return Fact(self.values[0] if self.values else "", self.place)

    @property
    def flag(self) -> bool | None:
        """The value as true or false; None when it is neither."""
        return flag(self.fact.value)


def flag(text: str) -> bool | None:
    """Read true or false as YAML and launch files write it; None for other text."""
    low = text.strip().lower()
    return True if low in _TRUE else False if low in _FALSE else None


@dataclass(frozen=True)
class YamlFile:
    """A YAML file.

    Attributes:
        path: relative to the package.
        shown: the path as the user would write it.
        root: its first node, not expanded: an alias is the same node again.
    """

    path: str
    shown: str
    root: yaml.Node

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """All parameters below ros__parameters, in the order of the file."""
        return tuple(self._parameters(self.root, (), _Budget()))

    @cached_property
    def nodes(self) -> dict[str, Place]:
        """The names of nodes that have parameters here, and the lines of these."""
        found: dict[str, Place] = {}
        for parameter in self.parameters:
            found.setdefault(parameter.node, parameter.place)
        return found

    @cached_property
    def keys(self) -> dict[str, Place]:
        """The lines of the names of nodes, as `nodes` has them."""
        found: dict[str, Place] = {}
        waiting: list[tuple[tuple[str, ...], yaml.Node]] = [((), self.root)]
        while waiting and len(found) < limits.YAML_VALUES.value:
            above, node = waiting.pop()
            for key, value in pairs(node):
                names = (*above, key.value)
                if len(names) <= _MOST_NAMES and key.value != "ros__parameters":
                    found["/".join(names)] = place_of(key, self.shown)
                    waiting.append((names, value))
        return {name: found[name] for name in self.nodes if name in found}

    @cached_property
    def _by_node(self) -> dict[str, dict[str, Parameter]]:
        found: dict[str, dict[str, Parameter]] = {}
        for parameter in self.parameters:
            found.setdefault(parameter.node, {})[parameter.name] = parameter
        return found

    def of(self, node: str) -> Mapping[str, Parameter]:
        """Return the parameters of a node, by their names."""
        return self._by_node.get(node, {})

    def _parameters(
        self, node: yaml.Node, keys: tuple[str, ...], budget: _Budget
    ) -> Iterator[Parameter]:
        for key, value in pairs(node):
            if not budget.spend() or len(keys) > limits.YAML_DEPTH.value:
                return
            if key.value == "ros__parameters":
                yield from self._below(value, "/".join(keys), (), budget)
            else:
                yield from self._parameters(value, (*keys, key.value), budget)

    def _below(
        self,
        node: yaml.Node,
        owner: str,
        keys: tuple[yaml.ScalarNode, ...],
        budget: _Budget,
    ) -> Iterator[Parameter]:
        for key, value in pairs(node):
            if not budget.spend() or len(keys) > limits.YAML_DEPTH.value:
                return
            if isinstance(value, yaml.MappingNode):
                yield from self._below(value, owner, (*keys, key), budget)
            else:
                place = Place(self.shown, key.start_mark.line + 1)
                name = ".".join(each.value for each in (*keys, key))
                yield Parameter(owner, name, _texts(value), place, value, keys)

    def entries(self) -> Iterator[dict[str, Fact]]:
        """Yield the mappings of a list, such as those of a bridge, key → value.

        A repeated key begins the next mapping: its "- " is missing.
        """
        if not isinstance(self.root, yaml.SequenceNode):
            return
        items: list[yaml.Node] = self.root.value
        for item in items[:1000]:
            entry: dict[str, Fact] = {}
            for key, value in pairs(item):
                if not isinstance(value, yaml.ScalarNode):
                    continue
                if key.value in entry:
                    yield entry
                    entry = {}
                place = Place(self.shown, key.start_mark.line + 1)
                entry[key.value] = Fact(value.value, place)
            yield entry


def controller_types(files: Iterable[YamlFile]) -> dict[str, Parameter]:
    """Return the controllers of ros2_control in files: name → its class.

    The class is a parameter of the controller manager, or, for a spawner with
    --param-file, one of the controller itself.
    """
    found: dict[str, Parameter] = {}
    for parameter in (one for file in files for one in file.parameters):
        node = parameter.node.rpartition("/")[2]
        if node == _MANAGER and parameter.name.endswith(".type"):
            found[parameter.name.removesuffix(".type")] = parameter
        elif parameter.name == "type" and _CONTROLLER.search(parameter.fact.value):
            found.setdefault(node, parameter)
    return found


class _Budget:
    """Limits how many nodes are visited: aliases can make a small file endless."""

    def __init__(self) -> None:
        self._left = limits.YAML_VALUES.value

    def spend(self) -> bool:
        self._left -= 1
        return self._left >= 0


def pairs(node: yaml.Node) -> Iterator[tuple[yaml.ScalarNode, yaml.Node]]:
    """Yield the keys and values of a mapping; nothing for other nodes."""
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            if isinstance(key, yaml.ScalarNode):
                yield key, value


def each_mapping(
    root: yaml.Node, left_out: Collection[str] = ()
) -> Iterator[tuple[str, yaml.Node]]:
    """Yield the mappings of a file in its order, each once, with the keys above them.

    Aliases can put a mapping into several places. It comes only at its first place, so
    that a small file never becomes endless.

    Args:
        root: where to begin.
        left_out: keys whose values are left out.
    """
    waiting, met = [("", root)], set[int]()
    while waiting:
        key, node = waiting.pop()
        if id(node) in met:
            continue
        met.add(id(node))
        if isinstance(node, yaml.SequenceNode):
            waiting += [(key, each) for each in reversed(node.value)]
        elif isinstance(node, yaml.MappingNode):
            yield key, node
            inner = [(k.value, v) for k, v in pairs(node) if k.value not in left_out]
            waiting += reversed(inner)


def place_of(node: yaml.Node, file: str) -> Place:
    """Return where a value begins in a file."""
    mark: Any = node.start_mark
    return Place(file, mark.line + 1, mark.column + 1)


def _texts(node: yaml.Node) -> tuple[str, ...]:
    if isinstance(node, yaml.ScalarNode):
        return (node.value,)
    items: list[yaml.Node] = node.value if isinstance(node, yaml.SequenceNode) else []
    return tuple(item.value for item in items if isinstance(item, yaml.ScalarNode))


def read_yaml(text: str, path: str, shown: str) -> YamlFile | None:
    """Read a YAML file; None when it is empty or not YAML."""
    try:
        root: yaml.Node | None = _LOADER(text).get_single_node()
    except (yaml.YAMLError, RecursionError):
        return None
    return None if root is None else YamlFile(path, shown, root)
