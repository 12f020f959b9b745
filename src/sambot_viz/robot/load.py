"""From a model to a `Robot`: the one way in."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.model import Robot
from sambot_viz.robot.model_source import ModelSource, first_xacro, read_source
from sambot_viz.robot.packages.file_finder import FileFinder
from sambot_viz.robot.urdf.findings import UrdfFindings
from sambot_viz.robot.urdf.read_urdf import read_urdf
from sambot_viz.robot.xacro.diagnose.explain_xacro import explain_xacro
from sambot_viz.robot.xacro.diagnose.library import report_library
from sambot_viz.robot.xacro.diagnose.prefix import missing_prefixes, undeclared_prefix
from sambot_viz.robot.xacro.expand import ExpandedModel, expand_model
from sambot_viz.robot.xacro.result import ExpansionError, ExpansionXmlError
from sambot_viz.robot.xml.decode import XmlFault, declared_as_utf8
from sambot_viz.robot.xml.diagnose.explain_xml import explain_xml
from sambot_viz.robot.xml.parse import Element, parse_xml

PathLike = str | os.PathLike[str]


@dataclass(frozen=True, slots=True)
class OpenedModel:
    """A model that is well-formed XML; xacro and URDF's rules come later.

    Attributes:
        source: where the text is from.
        document: its root element.
    """

    source: ModelSource
    document: Element


def open_model(model: PathLike) -> OpenedModel:
    """Read a model's text as XML, for `load_robot`.

    Args:
        model: the file, or the XML text itself.

    Raises:
        RobotError: it cannot be read, or is not well-formed.
    """
    source = _source(model)
    return OpenedModel(source, _parsed(source.text, source.label))


def load_robot(
    model: PathLike | OpenedModel,
    *,
    xacro_args: Mapping[str, str] | None = None,
    package_path: Sequence[Path | str] = (),
    trusted: bool = True,
) -> Robot:
    """Load a robot from a URDF or xacro file, or from text.

    Args:
        model: the file, the XML text itself, or what `open_model` has read.
        xacro_args: values for ``xacro:arg``.
        package_path: where packages are: package folders, folders that hold
            packages, or ``name=folder``.
        trusted: False for a model of unknown origin: xacro then evaluates without
            attribute access, nested code and foreign paths.

    Returns:
        The robot as ROS would show it; `Robot.problems` tells what is doubtful, and
        what had to be left out.

    Raises:
        RobotError: ROS would refuse the model; `.problems` has every fault found.
    """
    opened = model if isinstance(model, OpenedModel) else open_model(model)
    source, document, written = opened.source, opened.document, opened.document
    problems = list(source.problems)
    expanded: ExpandedModel | None = None
    xacro = first_xacro(document)
    undeclared = undeclared_prefix(document, source.path)
    if undeclared is not None:
        # urdfdom does not look at prefixes: for ROS this is plain URDF.
        problems.append(undeclared)
    elif xacro is not None:
        problems += _note_ending(source, xacro)
        expanded = _expanded(source, xacro_args or {}, package_path, trusted)
        problems += expanded.problems
        document = _reparsed(expanded, source.label)
    else:
        problems += missing_prefixes(document)
    try:
        return _robot(source, document, expanded, problems, package_path, trusted)
    except RobotError as error:
        raise RobotError(report_library(error.problems, written, source.path)) from None


def expand(
    model: PathLike,
    *,
    xacro_args: Mapping[str, str] | None = None,
    package_path: Sequence[Path | str] = (),
    trusted: bool = True,
) -> str:
    """The URDF text of a model, as the xacro command prints it.

    Args:
        model: the file, or the XML text itself.
        xacro_args: values for ``xacro:arg``.
        package_path: as for `load_robot`.
        trusted: as for `load_robot`.

    Raises:
        RobotError: it is no XML, or it cannot be expanded.
    """
    source = open_model(model).source
    return _expanded(source, xacro_args or {}, package_path, trusted).text


def _note_ending(source: ModelSource, xacro: Element) -> list[Problem]:
    """Tell that a file called .urdf is xacro, because ROS's tools would not notice."""
    if source.path is None or source.path.suffix.lower() != ".urdf":
        return []
    place = xacro.place
    return [
        Problem(
            "info",
            "xacro-in-urdf",
            f"this .urdf file contains xacro (<{xacro.tag}>), so it is expanded first; "
            "a program that takes it for finished URDF skips these parts",
            "call it .urdf.xacro, and run xacro in the launch file",
            place.file,
            place.line,
            place.column,
        )
    ]


def _source(model: PathLike) -> ModelSource:
    try:
        return read_source(model)
    except XmlFault as fault:
        label = os.fspath(model)
        raise RobotError(explain_xml(fault.text, label, fault)) from None


def _parsed(text: str, label: str) -> Element:
    try:
        return parse_xml(text, label)
    except XmlFault as fault:
        raise RobotError(explain_xml(text, label, fault)) from None


def _reparsed(expanded: ExpandedModel, label: str) -> Element:
    """Read xacro's output; its elements know where the user wrote them.

    An expression can put characters into the text that XML does not allow.
    """
    try:
        return parse_xml(expanded.text, label, expanded.origins)
    except XmlFault as fault:
        problem = Problem(
            "error",
            "xacro-output-not-xml",
            f"what xacro makes of the model is no XML ({fault.message} on line "
            f"{fault.line} of the expanded text)",
            "look for an expression that gives control characters or markup",
            label,
        )
        raise RobotError([problem]) from None


def _expanded(
    source: ModelSource,
    arguments: Mapping[str, str],
    package_path: Sequence[Path | str],
    trusted: bool,
) -> ExpandedModel:
    try:
        return expand_model(
            source.label if source.path is None else str(source.path),
            source.text if source.path is None else None,
            arguments=arguments,
            package_path=package_path,
            trusted=trusted,
        )
    except ExpansionXmlError as error:
        problems = explain_xml(error.fault.text, error.file, error.fault)
        raise RobotError(problems) from None
    except ExpansionError as error:
        raise RobotError(explain_xacro(error.failure, source.label)) from None


def _robot(
    source: ModelSource,
    document: Element,
    expanded: ExpandedModel | None,
    problems: list[Problem],
    package_path: Sequence[Path | str],
    trusted: bool,
) -> Robot:
    findings = UrdfFindings()
    folder = source.path.absolute().parent if source.path is not None else None
    files = FileFinder(folder, package_path, findings, trusted)
    urdf = read_urdf(
        document, findings, files.mesh, files.texture, expanded is not None
    )
    files.report()
    problems += findings.problems
    if urdf is None or findings.rejected:
        raise RobotError(problems)
    read = expanded.files if expanded is not None else ()
    own = (Path(os.path.abspath(source.path)),) if source.path is not None else ()
    return Robot(
        urdf.name,
        urdf.root,
        urdf.links,
        urdf.joints,
        tuple(problems),
        expanded.text if expanded is not None else declared_as_utf8(source.text),
        tuple(dict.fromkeys((*own, *read))),
        files.roots,
    )
