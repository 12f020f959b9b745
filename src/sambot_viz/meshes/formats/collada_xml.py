"""The XML of a COLLADA file: read strictly, else recovered with a warning."""

from __future__ import annotations

import importlib
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from typing import Any

from sambot_viz.meshes.assembly.assemble import MeshFindings
from sambot_viz.meshes.mesh import mesh_error


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
        """The element that "#name" refers to."""
        return self.ids.get((reference or "").strip().removeprefix("#"))

    def target(self, instance: ET.Element) -> ET.Element | None:
        """The element that an <instance_…> refers to."""
        return self.by_id(instance.get("url"))


def parse_document(data: bytes, findings: MeshFindings) -> ColladaDocument:
    """Read the XML.

    Raises:
        MeshError: nothing in it looks like COLLADA.
    """
    try:
        root = ET.fromstring(data)
    except (ET.ParseError, ValueError, LookupError) as error:
        recovered = _recover(data)
        if recovered is None:
            raise mesh_error(
                findings.path,
                "mesh-broken",
                f"the COLLADA file is not well-formed XML ({error})",
                "export the mesh again, or copy the file again if it was cut off",
            ) from error
        root = recovered
        findings.warn(
            "mesh-recovered",
            f"the COLLADA file is not well-formed XML ({error}); what could be read "
            "of it is drawn",
            "RViz may not show this mesh: export it again",
        )
    _strip_namespaces(root)
    if root.tag != "COLLADA":
        inner = root.find(".//COLLADA")
        if inner is None:
            raise mesh_error(
                findings.path,
                "mesh-broken",
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
    """What a lenient parser makes of broken XML, or None."""
    # Only broken files need lxml, which has no type information.
    lenient: Any = importlib.import_module("lxml.etree")
    parser = lenient.XMLParser(
        recover=True, huge_tree=True, resolve_entities=False, no_network=True
    )
    try:
        tree = lenient.fromstring(data, parser)
    except (lenient.LxmlError, ValueError):
        return None
    return None if tree is None else _copy(tree)


def _copy(found: Any) -> ET.Element:
    """The lenient parser's element as one of the strict parser's."""
    element = ET.Element(str(found.tag), {str(k): str(v) for k, v in found.items()})
    element.text = found.text
    # Comments and unknown entities have no name.
    element.extend(_copy(child) for child in found if isinstance(child.tag, str))
    return element
