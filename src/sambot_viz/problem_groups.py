"""Problems of one cause as one: a row in the page, a paragraph on the terminal.

A package that is not found makes a problem of each of its meshes, and a mistake in a
macro one of each call. Fixing the cause fixes them all, so that they are shown as one,
with their number and the one remedy.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from sambot_viz.errors import Problem, Severity

SEVERITIES: tuple[Severity, ...] = ("error", "warning", "info")
"""The order in which problems are shown."""

_SENTENCES = {
    "mesh-not-found": "{count} meshes of {cause}: not found",
    "texture-not-found": "{count} textures of {cause}: not found",
    "file-letter-case": "{count} files of {cause}: their names differ in capital "
    "letters from the files here; on Linux ROS does not find them",
    "file-other-machine": "{count} files of {cause}: their paths are of another "
    "machine; what was found here was used",
    "file-other-layout": "{count} files of {cause}: not at these places in the "
    "package; what was found elsewhere in it was used",
    "file-by-path-only": "{count} files of {cause}: not found by package or folder; "
    "files whose paths end in the same way were used",
    "package-three-slashes": "{count} files: package:/// has three slashes, so the "
    "name of the package is empty and ROS finds nothing",
    "joint-parent-unknown": "{count} joints have the parent {cause}, which does not "
    "exist; ROS refuses the model",
    "joint-child-unknown": "{count} joints have the child {cause}, which does not "
    "exist; ROS refuses the model",
    "mimic-joint-unknown": "{count} joints mimic {cause}, which does not exist; "
    "joint_state_publisher would crash",
    "material-redefined": "{count} definitions of {cause} differ from its first one; "
    "ROS uses the first one everywhere",
    **dict.fromkeys(
        (
            "mesh-compressed",
            "mesh-empty",
            "mesh-format-unknown",
            "mesh-lfs-pointer",
            "mesh-material-missing",
            "mesh-missing",
            "mesh-texture-broken",
            "mesh-texture-missing",
            "mesh-unreadable",
        ),
        "{count} meshes have the same problem: {cause}",
    ),
}
"""Code → what several problems with one `Problem.cause` say together.

Problems of other codes belong together only when they are at one place of a file.
"""


@dataclass(frozen=True, slots=True)
class ProblemGroup:
    """Problems that have one cause and go away with one remedy.

    Attributes:
        problems: all of them, at least one, in the order of `in_order`.
        severity: of each of them.
        message: the problem's own, or one for all of them with their number.
        hint: the remedy; each of them has the same one.
    """

    problems: tuple[Problem, ...]
    severity: Severity
    message: str
    hint: str

    @property
    def first(self) -> Problem:
        """The problem whose place stands for all."""
        return self.problems[0]


def group_problems(problems: Iterable[Problem]) -> list[ProblemGroup]:
    """Join problems that have one cause.

    Args:
        problems: in any order.

    Returns:
        The groups in the order of their first problems; see `in_order`.
    """
    groups: dict[object, list[Problem]] = {}
    for problem in in_order(problems):
        groups.setdefault(_key(problem), []).append(problem)
    return [_group(members) for members in groups.values()]


def in_order(problems: Iterable[Problem]) -> list[Problem]:
    """Return each problem once: errors, warnings, infos; else in the order given."""
    return sorted(dict.fromkeys(problems), key=lambda p: SEVERITIES.index(p.severity))


def _key(problem: Problem) -> object:
    """Facts that problems with one cause have in common."""
    kind = (problem.severity, problem.code, problem.hint)
    if problem.cause is not None and problem.code in _SENTENCES:
        return (*kind, problem.cause)
    if problem.file is not None and problem.line is not None:
        return (*kind, problem.file, problem.line, problem.column)
    return problem


def _group(members: list[Problem]) -> ProblemGroup:
    first = members[0]
    message, sentence = first.message, _SENTENCES.get(first.code)
    if len(members) > 1 and first.cause is not None and sentence is not None:
        message = sentence.format(count=len(members), cause=first.cause)
    elif len(members) > 1:
        message = f"{first.message} (and {len(members) - 1} more like it)"
    return ProblemGroup(tuple(members), first.severity, message, first.hint)
