"""Words that an editor offers: those that `check` knows, and names in the model."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import get_args

from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import JointType
from sambot_viz.robot.sdf.elements import ElementType, model_type
from sambot_viz.robot.urdf.urdf_words import URDF
from sambot_viz.robot.xacro.diagnose.source_files import definitions_in, read_source

_PARAMETER = re.compile(r"(?:^|\s)(\*{0,2}\w+)")
_XACRO = {
    "include": "filename",
    "property": "name value default",
    "arg": "name default",
    "macro": "name params",
    "if": "value",
    "unless": "value",
    "insert_block": "name",
}


@dataclass(frozen=True, slots=True)
class OfferedElement:
    """An element that an editor offers.

    Attributes:
        name: its tag.
        children: tags that it may contain.
        attributes: name → offered values.
        texts: offered texts.
        is_root: whether it may be the root of a document.
    """

    name: str
    children: tuple[str, ...] = ()
    attributes: Mapping[str, tuple[str, ...]] = field(
        default_factory=dict[str, "tuple[str, ...]"]
    )
    texts: tuple[str, ...] = ()
    is_root: bool = False


def offered(robot: Robot | None, files: Iterable[str]) -> list[OfferedElement]:
    """Return the elements that a model may have.

    Args:
        robot: last robot that loaded, whose links and joints become offers.
        files: texts of the model's files, whose macros become offers.
    """
    if robot is not None and robot.language == "sdf":
        return list(_sdf(robot))
    macros = list(_macros(files))
    calls = tuple(macro.name for macro in macros)
    own = tuple(f"xacro:{name}" for name in _XACRO)
    anywhere = (*calls, *own)
    values = _values(robot)
    made = [
        OfferedElement(
            tag,
            (*sorted(word.has), *anywhere),
            {name: values.get(f"{tag}.{name}", ()) for name in word.named},
            is_root=tag == URDF.root,
        )
        for tag, word in URDF.words.items()
    ]
    inside = tuple(sorted(URDF.words))
    for name, attributes in _XACRO.items():
        given = dict.fromkeys(attributes.split(), ())
        has = (*inside, *anywhere) if name in ("macro", "if", "unless") else ()
        made.append(OfferedElement(f"xacro:{name}", has, given))
    links = () if robot is None else tuple(robot.links)
    frames = (OfferedElement(name, texts=links) for name in _frames())
    return [*made, *macros, *frames]


def _frames() -> tuple[str, ...]:
    """Return Gazebo's elements whose text names a link."""
    # Imported late so that the first page does not wait for the rules.
    from sambot_viz.checks.around.files.gazebo import SENSOR_FRAMES
    from sambot_viz.checks.around.frames.names import DRIVE_BASES

    return (*SENSOR_FRAMES, *DRIVE_BASES)


def _values(robot: Robot | None) -> dict[str, tuple[str, ...]]:
    """Return the offered values of attributes, by "tag.name"."""
    links = () if robot is None else tuple(robot.links)
    joints = () if robot is None else tuple(robot.joints)
    return {
        "parent.link": links,
        "child.link": links,
        "gazebo.reference": (*links, *joints),
        "mimic.joint": joints,
        "joint.type": get_args(JointType),
    }


def _macros(files: Iterable[str]) -> Iterator[OfferedElement]:
    for file in files:
        source = read_source(file)
        for found in definitions_in(source, file) if source is not None else ():
            if found.kind == "macro":
                names = _PARAMETER.findall(found.params)
                plain = dict.fromkeys((n for n in names if "*" not in n), ())
                yield OfferedElement(f"xacro:{found.name}", (), plain)


def _sdf(robot: Robot) -> Iterator[OfferedElement]:
    links, joints = tuple(robot.links), tuple(robot.joints)
    texts = {"parent": ("world", *links), "child": links, "joint": joints}
    texts |= dict.fromkeys(_frames(), links)
    yield OfferedElement("sdf", ("model", "world"), {"version": ()}, is_root=True)
    merged: dict[str, OfferedElement] = {}
    for element in _below(model_type(), set()):
        made = OfferedElement(
            element.name,
            tuple(element.children),
            {name: tuple(v.words) for name, v in element.attributes.items()},
            texts.get(element.name, tuple(element.text.words)),
        )
        # One tag may have several meanings, such as <joint> in a model and a plugin.
        other = merged.get(made.name, made)
        children = tuple(dict.fromkeys((*other.children, *made.children)))
        attributes = {**other.attributes, **made.attributes}
        merged[made.name] = replace(other, children=children, attributes=attributes)
    yield from merged.values()
    for name in _frames():
        if name not in merged:
            yield OfferedElement(name, texts=links)


def _below(element: ElementType, seen: set[int]) -> Iterator[ElementType]:
    if id(element.children) in seen and element.children:
        return
    seen.add(id(element.children))
    yield element
    for child in element.children.values():
        yield from _below(child, seen)
