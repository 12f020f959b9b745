"""Explain why xacro failed: the line, the cause and the fix.

xacro reports what it could not evaluate, but no place. The child process adds the
element, and the source files give the place. Most explanations are rows of a table.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace

from sambot_viz.errors import Place, Problem
from sambot_viz.robot.xacro.child_result import XacroFailure
from sambot_viz.robot.xacro.diagnose.exchanged_arguments import (
    exchanged_arguments,
    without_consequences,
)
from sambot_viz.robot.xacro.diagnose.failed_expansion import FailedExpansion
from sambot_viz.robot.xacro.diagnose.failing_values import (
    broken_yaml,
    placeholder,
)
from sambot_viz.robot.xacro.diagnose.given_values import name_given_values
from sambot_viz.robot.xacro.diagnose.macro_names import name_with_parameters
from sambot_viz.robot.xacro.diagnose.macro_parameters import (
    unknown_parameter,
    unused_block,
)
from sambot_viz.robot.xacro.diagnose.reports import CALL, ELEMENT, EXPRESSION, ROWS
from sambot_viz.robot.xacro.diagnose.source_files import SourceSet
from sambot_viz.robot.xacro.diagnose.source_slips import source_slip
from sambot_viz.robot.xacro.diagnose.text_for_number import wrong_value
from sambot_viz.robot.xacro.diagnose.unknown_names import (
    undefined_argument,
    undefined_name,
    unknown_macro,
)
from sambot_viz.robot.xml.element import Element

_NAMES: tuple[tuple[str, Callable[[FailedExpansion, str], Problem]], ...] = (
    (r": name '([^']+)' is not defined", undefined_name),
    (r"unknown macro name: (?:xacro:)?(\S+)", unknown_macro),
    (r"Undefined substitution argument:?\s*(\w[\w.\-]*)", undefined_argument),
    (r'Invalid parameter "([^"]*)"', unknown_parameter),
    (r'Unused block "([^"]*)"', unused_block),
    (r"^ArgException.*?(\S+)$", undefined_argument),
)
"""Reports about an unknown name, and the function that finds the intended one."""


def explain_xacro(failure: XacroFailure, main_file: str) -> list[Problem]:
    """Explain why an expansion failed.

    Args:
        failure: what xacro and the child process reported.
        main_file: the model as the user wrote it.

    Returns:
        At least one problem of severity "error" with a place in a file of the user.
    """
    failed = FailedExpansion.of(failure, main_file)
    causes = (source_slip, broken_yaml, wrong_value, placeholder)
    lines = {failed.at.line, *(call.line for call in failed.failure.calls)}
    for call in exchanged_arguments(failed.sources):
        # A name that may be of another convention breaks no expansion.
        if call.line in lines and call.severity != "info":
            return [replace(call, severity="error")]
    cause = next((p for p in (find(failed) for find in causes) if p is not None), None)
    if cause is not None:
        return [cause]
    for pattern, explain in _NAMES:
        match = re.search(pattern, failed.report)
        if match:
            return [explain(failed, match[1])]
    for pattern, code, message, hint, where in ROWS:
        match = re.search(pattern, failed.report, re.DOTALL)
        if match:
            groups = match.groups()
            x = failed.pointing_at(_place(failed, groups, where), groups)
            message, hint = message.format(*groups, x=x), hint.format(*groups, x=x)
            return [x.error(code, message, x.repair(hint))]
    raise AssertionError("the last row fits everything")


def in_source(
    problems: Sequence[Problem], document: Element, files: Sequence[str]
) -> list[Problem]:
    """Return the problems of an expanded model, related to its source.

    Args:
        problems: problems of xacro's output.
        document: root element before xacro.
        files: files that xacro has read, as the user would write them.
    """
    exchanged = list(exchanged_arguments(SourceSet.of(files)))
    found = without_consequences(problems, exchanged)
    return name_with_parameters(name_given_values(found, files), document)


def _place(failed: FailedExpansion, groups: tuple[str, ...], where: str) -> Place:
    if where == ELEMENT:
        return failed.at
    if where == EXPRESSION:
        return failed.expression_place()
    if where == CALL:
        return failed.call_place()
    first, second = (*map(re.escape, groups), "", "")[:2]
    pattern = where.replace("%s", first).replace("%2s", second)
    return failed.sources.find(pattern, failed.at) or failed.at
