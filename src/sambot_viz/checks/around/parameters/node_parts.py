"""Find the parts of a node in its parameters: plugins, layers and sensors."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import yaml

from sambot_viz.checks.around.files.parameters import Parameter, controller_types
from sambot_viz.checks.around.parameters.declared import declared_parameters
from sambot_viz.checks.around.parameters.known import (
    LISTS,
    KnownParameter,
    ParameterBlock,
    known_parameters,
    of_base,
)
from sambot_viz.checks.around.parameters.navigation import filters
from sambot_viz.checks.around.running.known import known_nodes
from sambot_viz.checks.around.surroundings import Surroundings

CLASS_KEYS = ("plugin", "class")
"""Parameters with the class of a part."""
Given = Mapping[str, Parameter]
"""Name within a part → parameter."""


@dataclass(frozen=True, slots=True)
class NodePart:
    """Parameters of a node that belong together.

    Attributes:
        node: the name of the node, without its namespace.
        section: the keys below the node's, joined with dots; empty for the node.
        block: the known parameters here; None for an unknown plugin.
        given: the parameters here.
        sections: names of the parts below → their contents.
        base: the base class of the plugins in the list that names the part.
        is_known: the node has no other parameters.
    """

    node: str
    section: str
    block: ParameterBlock | None
    given: Given
    sections: Mapping[str, Given]
    base: str = ""
    is_known: bool = True

    @property
    def title(self) -> str:
        """The section, or the node where it is the node itself."""
        return self.section or self.node

    def known(self) -> Iterator[tuple[Parameter, KnownParameter]]:
        """Yield the known parameters, each with its row of the table."""
        for name, parameter in self.given.items():
            known = self.block.find(name) if self.block is not None else None
            if known is not None:
                yield parameter, known

    def lists(self) -> Iterator[tuple[Parameter, KnownParameter]]:
        """Yield the lists of parts, without those of a wrong type."""
        for one, known in self.known():
            is_list = isinstance(one.written, yaml.SequenceNode)
            if known.kind in LISTS and is_list is (known.kind == "sections"):
                yield one, known


def names_in(parameter: Parameter) -> list[str]:
    """Return the names in a list of parts, which may be one text."""
    return " ".join(parameter.values).split()


@lru_cache(maxsize=1)
def parts_by_node(around: Surroundings) -> tuple[tuple[NodePart, ...], ...]:
    """Return the parts of each node in each file, the node itself first."""
    table = known_parameters()
    blocks = {
        node.name: table.nodes[known.name]
        for node in around.running.started
        if (known := known_nodes().nodes.get((node.package, node.executable)))
        and known.name in table.nodes
    }
    declared = declared_parameters(around)
    blocks |= {
        node.name: declared.programs[node.package, node.executable]
        for node in around.running.started
        if node.name and (node.package, node.executable) in declared.programs
    }
    blocks |= {one.node: table.nodes["filter"] for one in filters(around)}
    found: list[tuple[NodePart, ...]] = []
    for file in around.yaml_files:
        controllers = {
            name: kind.block | table.common
            for name, parameter in controller_types([file]).items()
            if (kind := table.classes.get(parameter.fact.value))
        }
        for node in file.nodes:
            name = node.rpartition("/")[2]
            block = blocks.get(node) or blocks.get(name) or table.nodes.get(name)
            block = block or declared.nodes.get(name)
            block = controllers.get(name, block)
            whole = NodePart(name, "", block or table.common, {}, {}, "", bool(block))
            found.append(tuple(_parts(whole, file.of(node))))
    return tuple(found)


def _parts(part: NodePart, given: Given) -> Iterator[NodePart]:
    """Yield a part with its parameters, and all parts inside."""
    block = part.block and _with_plugins(part.block, given)
    own: dict[str, Parameter] = {}
    sections: dict[str, dict[str, Parameter]] = {}
    for name, parameter in given.items():
        head, dot, rest = name.partition(".")
        is_own = block is not None and (head in block.groups or block.find(name))
        if dot and not is_own:
            sections.setdefault(head, {})[rest] = parameter
        else:
            own[name] = parameter
    part = replace(part, block=block, given=own, sections=sections)
    yield part
    for head, inner in sections.items():
        below = f"{part.section}.{head}" if part.section else head
        base, known = _inside(part, head, inner)
        section = replace(part, section=below, block=known, base=base)
        yield from _parts(section, inner)


def _with_plugins(block: ParameterBlock, given: Given) -> ParameterBlock:
    """Add the parameters of a plugin without a separate part."""
    for name, parameter in given.items():
        known = block.parameters.get(name)
        kind = known_parameters().classes.get(parameter.fact.value)
        if known is not None and known.kind == "string" and known.base and kind:
            block |= kind.block
    return block


def _inside(
    part: NodePart, head: str, inner: Given
) -> tuple[str, ParameterBlock | None]:
    """Return the base class and the known parameters of a part; None if unknown."""
    table, block = known_parameters(), part.block
    lists = (known for one, known in part.lists() if head in names_in(one))
    named = next(lists, None)
    base = named.base if named is not None else ""
    said = next((inner[key] for key in CLASS_KEYS if key in inner), None)
    if said is not None:
        kind = table.classes.get(said.fact.value)
        return base, kind.block | _KEYS if kind is not None else None
    if named is not None:
        return base, named.inside or of_base(base)
    return base, block.parts if block is not None and block.parts.parameters else None


_KEYS = ParameterBlock({key: KnownParameter(key, "string") for key in CLASS_KEYS})
