"""Find the problems around loaded models; again, when files have other texts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from sambot_viz.advice import with_edits
from sambot_viz.checks.around import built_wrongly, wrong_files
from sambot_viz.checks.consequences import edited, edited_texts
from sambot_viz.checks.model_rules import AROUND, look
from sambot_viz.checks.proven_around import proven_around
from sambot_viz.checks.rule import Subject
from sambot_viz.checks.targets import CheckedModel, Targets
from sambot_viz.errors import Edit, Problem
from sambot_viz.unsaved import unsaved

if TYPE_CHECKING:
    from sambot_viz.checks.around.workspace import Package


class Loaded(NamedTuple):
    """A loaded model, and the problems of the files around it.

    Attributes:
        target: the model.
        subject: the loaded robot.
        around: the problems.
        seen: all that the rules found, also what follows from other findings.
        configs: the problems of .rviz files, which no edit is tried for.
    """

    target: CheckedModel
    subject: Subject
    around: tuple[Problem, ...]
    seen: tuple[Problem, ...] = ()
    configs: tuple[Problem, ...] = ()


def proven_of_packages(targets: Targets, loaded: Sequence[Loaded]) -> list[Problem]:
    """Return the problems around models and of packages, with their good edits.

    See `proven_around`.
    """
    found = with_edits(_of_packages(targets, loaded))
    configs = {problem for one in loaded for problem in one.configs}
    before = [problem for problem in found if problem not in configs]
    for one in loaded:
        before += [*one.subject.robot.problems, *one.seen]
    again = partial(_with_edits_made, targets, loaded)
    return proven_around(found, tuple(dict.fromkeys(before)), again)


def _of_packages(targets: Targets, loaded: Sequence[Loaded]) -> list[Problem]:
    """Return the problems around the models, and of packages without a model."""
    found = list(targets.notes)
    for package in alone(targets, loaded):
        found += wrong_files(package)
    for package in targets.packages:
        of = (one.subject.robot for one in loaded if package in one.target.packages)
        found += built_wrongly(package, next(of, None))
    for one in loaded:
        every = (*one.around, *one.configs)
        own = _own_files(one) if len(loaded) > 1 else frozenset[str]()
        found += [p for p in every if p.file in own or _is_certain(p, one, loaded)]
    return found


def _own_files(one: Loaded) -> frozenset[str]:
    """Return the files that belong only to this robot."""
    # Import late: few checks have several models.
    from sambot_viz.checks.around.ownership import ownership

    return ownership(one.subject.robot, one.target.packages).own


def alone(targets: Targets, loaded: Sequence[Loaded]) -> list[Package]:
    """Return the packages that belong to no checked model."""
    covered = {package for one in loaded for package in one.target.packages}
    return [package for package in targets.packages if package not in covered]


def _is_certain(problem: Problem, one: Loaded, loaded: Sequence[Loaded]) -> bool:
    """Return whether a problem of a shared file is the same for all its models.

    The file may be for one of them.
    """
    if problem.file is None or len(loaded) == 1:
        return True
    file = Path(problem.file).absolute()
    if file in {each.absolute() for each in one.subject.robot.files}:
        return True
    owner = next((p for p in one.target.packages if p.folder in file.parents), None)
    return all(
        any(
            (p.code, p.place) == (problem.code, problem.place)
            for p in (*other.around, *other.configs)
        )
        for other in loaded
        if owner in other.target.packages
    )


def _with_edits_made(
    targets: Targets, loaded: Sequence[Loaded], edits: tuple[Edit, ...]
) -> list[Problem] | None:
    """Find the problems around models with edits of any of their files, in memory.

    Only the edited files are read again.

    Returns:
        All that the rules find, also what follows from others; None where the edits
        break a file or a model.
    """
    texts = edited_texts(edits)
    if texts is None:
        return None
    files = {Path(file) for file in texts}
    subjects: list[Subject] = []
    for subject in (one.subject for one in loaded):
        is_model = not files.isdisjoint(each.absolute() for each in subject.robot.files)
        better = edited(subject, edits) if is_model else subject
        if better is None:
            return None
        subjects.append(better)
    with unsaved(texts):
        other = targets.edited(files)
        models = {each.model: each for each in other.models}
        again: list[Loaded] = []
        for one, subject in zip(loaded, subjects, strict=True):
            target = models[one.target.model]
            subject = replace(subject, packages=target.packages, edited={}, texts=texts)
            found = [*subject.robot.problems, *look(AROUND, subject)]
            again.append(Loaded(target, subject, tuple(found)))
        return [*dict.fromkeys(with_edits(_of_packages(other, again)))]
