"""A model as well-formed XML; what a page needs to know before it is shown."""

from __future__ import annotations

import os
from dataclasses import dataclass

from sambot_viz.errors import RobotError
from sambot_viz.robot.model_source import ModelSource, read_source
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.element import Element
from sambot_viz.robot.xml.parse import parse_xml

PathLike = str | os.PathLike[str]


@dataclass(frozen=True, slots=True)
class OpenedModel:
    """A model that is well-formed XML; xacro and URDF's rules come later.

    Attributes:
        source: the text and the file it is from.
        document: its root element.
    """

    source: ModelSource
    document: Element


def open_model(model: PathLike) -> OpenedModel:
    """Read the text of a model as XML, for `load_robot`.

    Args:
        model: the file, or the XML text itself.

    Raises:
        RobotError: it cannot be read, or it is not well-formed.
    """
    label = os.fspath(model)
    try:
        source = read_source(model)
        label = source.label
        return OpenedModel(source, parse_xml(source.text, label))
    except XmlFault as fault:
        # Only a model that is not XML needs the rules that explain why.
        from sambot_viz.robot.xml.diagnose.explain_xml import explain_xml

        raise RobotError(explain_xml(fault.text, label, fault)) from None
