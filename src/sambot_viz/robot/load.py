"""Loads a model into the parts of a `Robot`: the only way in."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple

from sambot_viz.advice import with_edits
from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.gazebo_parts import gazebo_parts
from sambot_viz.robot.model_source import (
    ModelSource,
    OpenedModel,
    PathLike,
    edited_model,
    open_model,
)
from sambot_viz.robot.packages.file_finder import FileFinder
from sambot_viz.robot.parts import Joint, Language, Link, RobotTree
from sambot_viz.robot.slips.misspelt import find_slips
from sambot_viz.robot.slips.needs_xacro import (
    OWN_TAGS,
    exchanged_name,
    first_own,
    first_substitution,
    left_over,
    missing_prefixes,
    only_names_files,
    refused_without_prefix,
    undeclared_prefix,
)
from sambot_viz.robot.urdf.attributes import NOT_REPLACED
from sambot_viz.robot.urdf.read_urdf import read_urdf
from sambot_viz.robot.urdf.urdf_words import URDF
from sambot_viz.robot.xacro.child_result import (
    ExpandedModel,
    ExpansionError,
    ExpansionXmlError,
    XacroFailure,
)
from sambot_viz.robot.xacro.expansion import expand_model
from sambot_viz.robot.xml.decode import declared_as_utf8
from sambot_viz.robot.xml.element import Element


class LoadedModel(NamedTuple):
    """The attributes of a `Robot`, in their order."""

    name: str
    root: str
    links: Mapping[str, Link]
    joints: Mapping[str, Joint]
    problems: tuple[Problem, ...]
    description: str
    files: tuple[Path, ...]
    file_roots: tuple[Path, ...] | None
    language: Language
    gazebo: tuple[Element, ...]


def load_model(
    model: PathLike | OpenedModel,
    xacro_args: Mapping[str, str],
    package_path: Sequence[Path | str],
    trusted: bool,
    edited: Mapping[str, str],
) -> LoadedModel:
    """Load a model; arguments and errors are those of `load_robot`."""
    label = "" if isinstance(model, OpenedModel) else str(model)
    try:
        if isinstance(model, OpenedModel):
            opened = edited_model(model, edited)
        else:
            opened = open_model(model, edited)
        label = opened.source.label
        loaded = _Loader(opened, xacro_args, package_path, trusted, edited).load()
        own = _at_causes(loaded.problems, label, loaded.files)
        return loaded._replace(problems=tuple(own))
    except RobotError as error:
        found = _at_causes(error.problems, label, error.files)
        raise RobotError(found, error.files) from error.__cause__


def _at_causes(
    problems: Sequence[Problem], label: str, files: Iterable[Path]
) -> list[Problem]:
    """Return problems with their edits, those of macros where their cause is."""
    found = with_edits(problems)
    if all(p.file is None or p.column is None for p in found):
        return found
    from sambot_viz.robot.xacro.at_calls import at_calls

    return at_calls(found, (label, *map(str, files)))


def expand(
    model: PathLike | OpenedModel,
    *,
    xacro_args: Mapping[str, str] | None = None,
    package_path: Sequence[Path | str] = (),
    trusted: bool = True,
) -> str:
    """Return the URDF or SDF text of a model, as the xacro command prints it.

    Args:
        model: file, XML text, or result of `open_model`.
        xacro_args: values for ``xacro:arg``.
        package_path: as for `load_robot`.
        trusted: as for `load_robot`.

    Raises:
        RobotError: the model is not XML, or xacro cannot expand it.
    """
    opened = model if isinstance(model, OpenedModel) else open_model(model)
    loader = _Loader(opened, xacro_args or {}, package_path, trusted)
    return loader.expanded().text


@dataclass(frozen=True, slots=True)
class _Loader:
    opened: OpenedModel
    xacro_args: Mapping[str, str]
    package_path: Sequence[Path | str]
    trusted: bool
    edited: Mapping[str, str] = field(default_factory=dict[str, str])

    def load(self) -> LoadedModel:
        problems = list(self.opened.source.problems)
        document, path = self.opened.document, self.opened.source.path
        problems += exchanged_name(document)
        own = first_own(document)
        undeclared = undeclared_prefix(document, own, path)
        if undeclared is not None:
            # urdfdom ignores prefixes: for ROS this is plain URDF.
            return self._without_xacro(document, problems, undeclared)
        xacro = own
        if not self.opened.source.is_published:
            # In text from a topic "${…}" is plain text, as for other subscribers.
            xacro = own or first_substitution(document)
        if xacro is None:
            problems += missing_prefixes(document)
            return self._robot(document, None, problems)
        if calls := left_over(document, path):
            return self._robot(document, None, [*problems, *calls])
        try:
            expanded = self.expanded()
        except RobotError as error:
            if not only_names_files(document):
                raise
            # urdfdom accepts "$(arg …)" in a file name and does not find the file.
            problems += [replace(p, severity="warning") for p in error.problems]
            return self._robot(document, None, problems)
        problems += _note_ending(self.opened.source, xacro)
        problems += expanded.problems
        return self._robot(expanded.root, expanded, problems)

    def _without_xacro(
        self, document: Element, problems: list[Problem], undeclared: Problem
    ) -> LoadedModel:
        """Read a file that needs xacro as ROS does; problems with xacro follow."""
        if first_substitution(document) is None:
            return self._robot(document, None, [*problems, undeclared])
        try:
            model = self._robot(document, None, [*problems, undeclared])
        except RobotError as error:
            cause = refused_without_prefix(document, undeclared)
            raise RobotError([*problems, cause], error.files) from None
        kept = [p for p in model.problems if NOT_REPLACED not in p.message]
        return model._replace(problems=tuple(kept))

    def expanded(self) -> ExpandedModel:
        source = self.opened.source
        try:
            return expand_model(
                source.label if source.path is None else str(source.path),
                source.text,
                folder=source.folder,
                arguments=self.xacro_args,
                package_path=self.package_path,
                trusted=self.trusted,
                edited=self.edited,
            )
        # Only a model that xacro refuses needs the rules that explain the cause.
        except ExpansionXmlError as error:
            from sambot_viz.robot.xml.diagnose.explain_xml import explain_xml

            fault = error.fault
            file = source.label if fault.text == source.text else error.file
            files = map(Path, error.files)
            raise RobotError(explain_xml(fault.text, file, fault), files) from None
        except ExpansionError as error:
            from sambot_viz.robot.xacro.diagnose.explain_xacro import explain_xacro

            raise RobotError(
                explain_xacro(error.failure, source.label), _wanted(error.failure)
            ) from None

    def _robot(
        self, root: Element, expanded: ExpandedModel | None, problems: list[Problem]
    ) -> LoadedModel:
        source = self.opened.source
        is_xacro = source.path is not None and source.path.suffix == ".xacro"
        findings = ModelFindings(calculates=is_xacro or expanded is not None)
        files = FileFinder(source.folder, self.package_path, findings, self.trusted)
        tree = self._tree(root, files, findings, expanded)
        if expanded is not None and (findings.problems or expanded.macros):
            from sambot_viz.robot.xacro.diagnose.explain_xacro import in_source

            names = (source.label, *map(str, expanded.files))
            document = self.opened.document
            findings.problems[:] = in_source(findings.problems, document, names)
        problems += findings.problems
        read = expanded.files if expanded is not None else ()
        if tree is None or findings.rejected:
            from sambot_viz.robot.xacro.diagnose.without_links import (
                explain_without_links,
            )

            raise RobotError(
                explain_without_links(problems, self.opened.document, source.path), read
            )
        own = (Path(os.path.abspath(source.path)),) if source.path is not None else ()
        return LoadedModel(
            *tree,
            tuple(problems),
            expanded.text if expanded is not None else declared_as_utf8(source.text),
            tuple(dict.fromkeys((*own, *read))),
            files.roots,
            "sdf" if root.tag == "sdf" else "urdf",
            gazebo_parts(root),
        )

    def _tree(
        self,
        root: Element,
        files: FileFinder,
        findings: ModelFindings,
        expanded: ExpandedModel | None,
    ) -> RobotTree | None:
        """Read a document in the language of its root element."""
        if root.tag == "sdf":
            return self._sdf(root, files, findings)
        tree = read_urdf(
            root, findings, files.mesh, files.texture, expanded is not None
        )
        macros = frozenset[str]()
        if expanded is not None:
            macros = expanded.macros.union(OWN_TAGS)
        if slips := find_slips(root, URDF, macros):
            # Imported late, as below: most models have no slips.
            from sambot_viz.robot.slips.follow_ups import report_slips

            report_slips(
                root,
                slips,
                findings,
                lambda other, found: read_urdf(
                    other, found, _no_file, _no_file, expanded is not None
                ),
            )
        return tree

    def _sdf(
        self, root: Element, files: FileFinder, findings: ModelFindings
    ) -> RobotTree | None:
        from sambot_viz.robot.sdf.misspelt_elements import sdf_slips
        from sambot_viz.robot.sdf.read_sdf import read_sdf

        written = self.opened.document
        tree = read_sdf(root, written, findings, files.mesh)
        if slips := sdf_slips(root):
            from sambot_viz.robot.slips.follow_ups import report_slips

            report_slips(
                root,
                slips,
                findings,
                lambda other, found: read_sdf(other, written, found, _no_file),
            )
        return tree


def _no_file(_name: str, _element: Element) -> None:
    """Omit a mesh or a texture when only the elements are of interest."""


def _wanted(failure: XacroFailure) -> list[Path]:
    """Return the files that an expansion wanted, and places for a missing package.

    A place that is not a folder is the name of a path variable's entry.
    """
    files = [Path(name) for name in failure.files]
    missing = failure.missing_package
    if missing is not None:
        files += [
            Path(place) / missing.name
            for place in missing.searched
            if os.path.isdir(place)
        ]
    return files


def _note_ending(source: ModelSource, xacro: Element) -> list[Problem]:
    """Note that a file called .urdf is xacro, because ROS's tools would not notice."""
    if source.path is None or source.path.suffix.lower() != ".urdf":
        return []
    return [
        Problem.at(
            xacro.place,
            "info",
            "xacro-in-urdf",
            f"this .urdf file contains xacro (<{xacro.tag}>), so it is expanded first; "
            "a program that takes it for finished URDF skips these parts",
            "call it .urdf.xacro, and run xacro in the launch file",
        )
    ]
