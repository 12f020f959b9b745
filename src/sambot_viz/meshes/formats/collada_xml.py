"""The XML of a COLLADA file: read strictly, else recovered with a warning."""

from __future__ import annotations

import importlib
import xml.etree.ElementTree as ET
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from sambot_viz.meshes.mesh_source import MeshSource


@dataclass(frozen=True, slots=True)
class ColladaDocument:
    """A COLLADA tree without namespaces.

    Attributes:
        root: the <COLLADA> element.
        ids: every element that has an id; the first one of each.
    """

    root: ET.Element
    ids: dict[str, ET.Element]

    def by_id(self, reference: str | None) -> ET.Element | None:
        """Return the element that "#name" refers to."""
        return self.ids.get((reference or "").strip().removeprefix("#"))

    def target(self, instance: ET.Element) -> ET.Element | None:
        """Return the element that an <instance_…> refers to."""
        return self.by_id(instance.get("url"))


def parse_document(source: MeshSource) -> ColladaDocument:
    """Read the XML.

    Raises:
        MeshError: nothing in it looks like COLLADA.
    """
    try:
        root = ET.fromstring(source.data)
    except (ET.ParseError, ValueError, LookupError) as error:
        recovered = _recover(source.data)
        if recovered is None:
            raise source.broken(
                f"the COLLADA file is not well-formed XML ({error})"
            ) from error
        root = recovered
        source.warn(
            "mesh-recovered",
            f"the COLLADA file is not well-formed XML ({error}); what could be read "
            "of it is drawn",
            "RViz may not show this mesh: export it again",
        )
    _strip_namespaces(root)
    if root.tag != "COLLADA":
        inner = root.find(".//COLLADA")
        if inner is None:
            raise source.broken(
                f"the file has no <COLLADA> element but starts with <{root.tag}>",
                "export the mesh again as COLLADA",
            )
        root = inner
    ids: dict[str, ET.Element] = {}
    for element in root.iter():
        name = element.get("id")
        if name is not None:
            ids.setdefault(name, element)
    return ColladaDocument(root, ids)


def _strip_namespaces(root: ET.Element) -> None:
    for element in root.iter():
        if "}" in element.tag:
            element.tag = element.tag.partition("}")[2]


def _recover(data: bytes) -> ET.Element | None:
    """Parse broken XML leniently; None when that fails too."""
    # Only broken files need lxml, which has no type information.
    lenient: Any = importlib.import_module("lxml.etree")
    parser = lenient.XMLParser(
        recover=True, huge_tree=True, resolve_entities=False, no_network=True
    )
    try:
        tree = lenient.fromstring(data, parser)
    except (lenient.LxmlError, ValueError):
        return None
    return None if tree is None else _copy(lenient.iterwalk(tree, ("start", "end")))


def _copy(events: Iterable[tuple[str, Any]]) -> ET.Element | None:
    """Return the lenient parser's elements as those of the strict parser.

    Broken files may be nested hundreds of thousands deep, so nothing here recurses.
    """
    top = ET.Element("")
    open_elements = [top]
    for event, found in events:
        # Comments and unknown entities have no name.
        if not isinstance(found.tag, str):
            continue
        if event == "end":
            open_elements.pop()
            continue
        attributes = {str(key): str(value) for key, value in found.items()}
        element = ET.SubElement(open_elements[-1], str(found.tag), attributes)
        element.text = found.text
        open_elements.append(element)
    return next(iter(top), None)
