"""Explain why xacro failed: the line, the cause and the fix.

xacro reports what it could not evaluate, but not where. The child process adds the
element, and the source files give the place. Most explanations are rows of a table.
"""

from __future__ import annotations

import re
from collections.abc import Callable

from sambot_viz.errors import Place, Problem
from sambot_viz.robot.xacro.child_result import XacroFailure
from sambot_viz.robot.xacro.diagnose.failed_expansion import FailedExpansion
from sambot_viz.robot.xacro.diagnose.unknown_names import (
    undefined_argument,
    undefined_name,
    unknown_macro,
)

_ELEMENT = "the element that xacro was working on"
_EXPRESSION = "the expression that failed"
_CALL = "the macro call that failed"

_NAMES: tuple[tuple[str, Callable[[FailedExpansion, str], Problem]], ...] = (
    (r": name '([^']+)' is not defined", undefined_name),
    (r"unknown macro name: (?:xacro:)?(\S+)", unknown_macro),
    (r"Undefined substitution argument:?\s*(\w[\w.\-]*)", undefined_argument),
    (r"^ArgException.*?(\S+)$", undefined_argument),
)
"""Reports about an unknown name, and the function that finds the one meant."""

_ROWS: tuple[tuple[str, str, str, str, str], ...] = (
    (
        r"^missing package (?!\w[\w.-]*$)(.*)",
        "xacro-package-not-found",
        "“{0}” is not the name of a package{x.trail}",
        "write the name that its package.xml has: $(find NAME)",
        r"\$\(\s*find\s+%s",
    ),
    (
        r"^missing package (\S+)",
        "xacro-package-not-found",
        "the package {0} was not found (looked in {x.searched}){x.trail}",
        "give the folder that holds it (the one with package.xml): --package-path "
        "FOLDER{x.near_package}",
        r"\$\(\s*find\s+%s\s*\)|find\(\W*%s\b",
    ),
    (
        r"Undefined parameters \[([^\]]*)\]",
        "xacro-parameter-missing",
        "the call of {x.called} lacks the {x.lacking}{x.declared}",
        "add {x.values}, or give a default where it is declared: "
        'params="… {x.listed[0]}:=1"',
        _CALL,
    ),
    (
        r'Invalid parameter "([^"]*)"',
        "xacro-parameter-unknown",
        "the macro {x.called} has no parameter {0}{x.declared}",
        "{x.near_parameter}; or delete {0}, or use the version of the macro's file "
        "that fits",
        _CALL,
    ),
    (
        r'Undefined block "([^"]*)"',
        "xacro-block",
        "insert_block uses the block {0}, which does not exist{x.trail}",
        "add *{0} to the params of the macro",
        r"<xacro:insert_block[^>]*name\s*=\s*[\"']%s",
    ),
    (
        r'Unused block "([^"]*)"',
        "xacro-block",
        "the call of {x.called} contains <{0}>, which the macro does not take",
        "delete it, or add *{0} to the params of {x.called}",
        _CALL,
    ),
    (
        r"Not enough blocks",
        "xacro-block",
        "the call of {x.called} contains fewer elements than it takes{x.blocks}",
        "write the elements inside: <xacro:{x.called} …> <origin …/> "
        "</xacro:{x.called}>",
        _CALL,
    ),
    (
        r"No such file or directory: '?[^'\[\n]*?package://([^/'\[\n]+)/(?:[^'\[\n]*/)?"
        r"([^/'\[\n]+)",
        "xacro-include-missing",
        "xacro does not understand package:// in an include ({1})",
        "write $(find {0})/… instead",
        r"(?s)<xacro:include\b[^>]*package://%s",
    ),
    (
        r"No such file or directory: '?((?:[^'\[\n]*/)?([^/'\[\n]+))",
        "xacro-include-missing",
        "the included file {1} was not found: {0} does not exist{x.folder_missing}"
        "{x.trail}",
        "correct the path, or put the file there{x.near_file}",
        r"(?s)<xacro:include\b[^>]*%2s|load_yaml\([^)]*%2s",
    ),
    (
        r"circular variable definition: ((\S+) -> [^\n]*)",
        "xacro-circular-property",
        "these properties refer to each other: {0}",
        "give one of them a plain value",
        r"<xacro:property\b[^>]*name\s*=\s*[\"']%2s[\"']",
    ),
    (
        r'Xacro conditional "([^"]*)" evaluated to "\1"',
        "xacro-condition",
        "the condition “{0}” is neither true nor false{x.trail}",
        "write true, false, a number, or a comparison such as ${{x == 'a'}}",
        r"<xacro:(?:if|unless)\b[^>]*%s",
    ),
    (
        r'Xacro conditional "([^"]*)" evaluated to "([^"]*)"',
        "xacro-condition",
        "the condition “{0}”, which became “{1}”, is neither true nor false{x.trail}",
        "write true, false, a number, or a comparison such as ${{x == 'a'}}",
        r"<xacro:(?:if|unless)\b[^>]*%s",
    ),
    (
        r"environment variable '?\"?([A-Za-z_]\w*)",
        "xacro-environment",
        "the environment variable {0} is not set",
        "set it ({0}=… before the command), or write $(optenv {0} default)",
        r"\$\(\s*env\s+%s",
    ),
    (
        r"Unknown substitution command \[(find-pkg-share ([^\]]*))\]",
        "xacro-substitution",
        "xacro does not know $({0})",
        "write $(find {1})",
        r"\$\(%s",
    ),
    (
        r"Unknown substitution command \[([^\]]*)\]",
        "xacro-substitution",
        "xacro does not know $({0})",
        "xacro knows $(find …), $(arg …), $(env …), $(optenv …), $(cwd), $(eval …)",
        r"\$\(%s",
    ),
    (
        r"invalid expression: (.*\$\{.*)",
        "xacro-expression-syntax",
        "the expression {0} is not closed{x.trail}",
        "add }}; an expression cannot contain }} before its end",
        "%s",
    ),
    (
        r"invalid expression: (.+)",
        "xacro-expression-syntax",
        "the expression {0} is not closed{x.trail}",
        "add ); an expression cannot contain ) before its end",
        "%s",
    ),
    (
        r"Property names must[^:]*:\s*(\S+)",
        "xacro-property-name",
        "{0} cannot be the name of a property: letters, digits and _ only, and no __ "
        "at the start",
        "write {x.identifier} everywhere",
        r"<xacro:property\b[^>]*name\s*=\s*[\"']%s[\"']",
    ),
    (
        r"(?:xacro:)?(\w+): missing attribute '([^']+)'",
        "xacro-attribute-missing",
        "<xacro:{0}> lacks the attribute {1}",
        'write <xacro:{0} … {1}="…">',
        _ELEMENT,
    ),
    (
        r"^RecursionError in (.+?): ",
        "xacro-recursion",
        "the expansion never ends: the macro {0} calls itself",
        "put <xacro:if value=…> around the inner call",
        _ELEMENT,
    ),
    (
        r"^RecursionError",
        "xacro-recursion",
        "the expansion never ends: the files include each other",
        "put <xacro:if value=…> around the inner include",
        _ELEMENT,
    ),
    (
        r"^Refused",
        "xacro-refused",
        "this is not allowed in a file that is not trusted: {x.text}",
        "run without --untrusted if you know the author",
        _EXPRESSION,
    ),
    (
        r"^SyntaxError",
        "xacro-expression-syntax",
        "the expression ${{{x.expression}}} cannot be read ({x.text}){x.trail}",
        "write one Python expression inside ${{…}}, such as ${{2*radius}}",
        _EXPRESSION,
    ),
    (
        r"^(?:TypeError|ValueError).*: .*(?:str|sequence)",
        "xacro-expression-value",
        "{x.text}{x.in_expression}{x.trail}",
        "one of the values is text where a number is expected: look for a unit, a "
        "comma or several numbers in a property",
        _EXPRESSION,
    ),
    (
        r"^(?:TypeError|ValueError)",
        "xacro-expression-value",
        "{x.text}{x.in_expression}{x.trail}",
        "check the values of the properties and arguments in it",
        _EXPRESSION,
    ),
    (
        r"^ZeroDivisionError",
        "xacro-division-by-zero",
        "division by zero{x.in_expression}{x.trail}",
        "one of the values is 0: check the properties and arguments in it",
        _EXPRESSION,
    ),
    (
        r"^Timeout",
        "xacro-timeout",
        "expanding takes too long and was stopped{x.trail}",
        "look for a macro or an include that calls itself, or a very long loop",
        _ELEMENT,
    ),
    (
        r"^OutputLimit",
        "xacro-too-large",
        "the expanded robot is too large and was stopped{x.trail}",
        "look for a macro that calls itself, or a very long text in ${{…}}",
        _ELEMENT,
    ),
    (
        r"^MemoryError",
        "xacro-too-large",
        "expanding needs too much memory and was stopped{x.trail}",
        "look for a very large number or text in ${{…}}",
        _ELEMENT,
    ),
    (
        r"^NotXml",
        "xacro-output-not-xml",
        "the output of xacro is not XML because of {x.text}",
        "look for an expression that gives control characters or markup",
        _ELEMENT,
    ),
    (
        "",
        "xacro-failed",
        "xacro cannot expand this: {x.text}{x.in_expression}{x.trail}",
        "look at the element on this line, and at the macros and files named here",
        _EXPRESSION,
    ),
)
"""Pattern of "kind in macro: text", code, message, hint, and where to point: one of the
three places above, or a pattern to look for, with the groups as %s and %2s. Sentences
have the groups as {0} and {1}, and properties of `FailedExpansion` as {x.…}. The first
row that fits counts."""


def explain_xacro(failure: XacroFailure, main_file: str) -> list[Problem]:
    """Explain why an expansion failed.

    Args:
        failure: what xacro and the child process reported.
        main_file: the model as the user wrote it.

    Returns:
        At least one problem of severity "error" with a place in a file of the user.
    """
    failed = FailedExpansion.of(failure, main_file)
    for pattern, explain in _NAMES:
        match = re.search(pattern, failed.report)
        if match:
            return [explain(failed, match[1])]
    for pattern, code, message, hint, where in _ROWS:
        match = re.search(pattern, failed.report, re.DOTALL)
        if match:
            groups = match.groups()
            x = failed.pointing_at(_place(failed, groups, where), groups)
            message, hint = message.format(*groups, x=x), hint.format(*groups, x=x)
            return [x.error(code, message, hint)]
    raise AssertionError("the last row fits everything")


def _place(failed: FailedExpansion, groups: tuple[str, ...], where: str) -> Place:
    if where == _ELEMENT:
        return failed.at
    if where == _EXPRESSION:
        return failed.expression_place()
    if where == _CALL:
        return failed.call_place()
    first, second = (*map(re.escape, groups), "", "")[:2]
    pattern = where.replace("%s", first).replace("%2s", second)
    return failed.sources.find(pattern, failed.at) or failed.at
