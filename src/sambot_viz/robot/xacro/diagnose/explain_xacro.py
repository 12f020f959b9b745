"""From a failed expansion to the line, the cause and the mend.

xacro says what it stumbled over, never where (spec/ros-nodes.md §5.3). The child
process adds the element; the source files give the rest.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

from sambot_viz.errors import Place, Problem, did_you_mean
from sambot_viz.robot.xacro.diagnose.failed_expansion import FailedExpansion
from sambot_viz.robot.xacro.diagnose.unknown_names import (
    block_trouble,
    invalid_parameter,
    missing_parameters,
    undefined_argument,
    undefined_name,
    unknown_macro,
)
from sambot_viz.robot.xacro.result import XacroFailure

_KINDS_OF_LIMIT = {
    "Timeout": (
        "xacro-timeout",
        "expanding takes too long and was stopped",
        "look for a macro or an include that calls itself, or a very long loop",
    ),
    "OutputLimit": (
        "xacro-too-large",
        "the expanded robot is too large and was stopped",
        "look for a macro that calls itself, or a very long text in ${…}",
    ),
    "MemoryError": (
        "xacro-too-large",
        "expanding needs too much memory and was stopped",
        "look for a very large number or text in ${…}",
    ),
}


def explain_xacro(failure: XacroFailure, main_file: str) -> list[Problem]:
    """Say why an expansion failed.

    Args:
        failure: what xacro and the child process reported.
        main_file: the model as the user wrote it.

    Returns:
        At least one problem of severity "error" with a place in a file of the user.
    """
    case = FailedExpansion.of(failure, main_file)
    if failure.missing_package is not None:
        return [_missing_package(case, *failure.missing_package)]
    for pattern, explain in _BY_TEXT:
        match = re.search(pattern, failure.text, re.DOTALL)
        if match:
            return [explain(case, match)]
    by_kind = _BY_KIND.get(failure.kind)
    if by_kind is not None:
        return [by_kind(case)]
    if failure.kind in _KINDS_OF_LIMIT:
        code, message, hint = _KINDS_OF_LIMIT[failure.kind]
        at = case.place
        return [case.error(code, f"{message}{case.trail(at)}", hint, at)]
    return [_anything_else(case)]


def _in_expression(case: FailedExpansion) -> str:
    return f" in ${{{case.expression}}}" if case.expression else ""


def _missing_package(
    case: FailedExpansion, name: str, searched: tuple[str, ...]
) -> Problem:
    pattern = rf"\$\(\s*find\s+{re.escape(name)}\s*\)|find\(\W*{re.escape(name)}\b"
    at = case.sources.find(pattern, case.place) or case.place
    where = ", ".join(searched[:6]) or "nowhere"
    found = _packages_in(searched)
    names = f"; {did_you_mean(name, found)}" if found else ""
    return case.error(
        "xacro-package-not-found",
        f"the package {name} was not found (looked in {where}){case.trail(at)}",
        "give the folder that holds it (the one with package.xml): "
        f"--package-path FOLDER{names}",
        at,
    )


def _packages_in(folders: tuple[str, ...]) -> list[str]:
    """Names of the packages that lie in these folders."""
    names: set[str] = set()
    for folder in folders:
        try:
            manifests = [*Path(folder).glob("package.xml")]
            manifests += sorted(Path(folder).glob("*/package.xml"))[:200]
            for manifest in manifests:
                text = manifest.read_text("utf-8", "replace")
                name = re.search(r"<name>\s*([^<\s]+)\s*</name>", text)
                names.add(name[1] if name else manifest.parent.name)
        except (OSError, ValueError):
            continue
    return sorted(names)


def _missing_file(case: FailedExpansion, match: re.Match[str]) -> Problem:
    wanted = match[1].strip()
    name = Path(wanted).name
    at = (
        case.sources.find(
            rf"(?s)<xacro:include\b[^>]*{re.escape(name)}|load_yaml\([^)]*{re.escape(name)}",
            case.place,
        )
        or case.place
    )
    if "package://" in wanted:
        package = wanted.partition("package://")[2].partition("/")[0]
        return case.error(
            "xacro-include-missing",
            f"xacro does not understand package:// in an include ({name})",
            f"write $(find {package})/… instead",
            at,
        )
    folder = Path(wanted).parent
    beside = _files_in(folder)
    near = did_you_mean(name, beside) if beside else ""
    exists = "" if folder.is_dir() else f"; the folder {folder} does not exist either"
    hint = "correct the path, or put the file there"
    return case.error(
        "xacro-include-missing",
        f"the included file {name} was not found: {wanted} does not exist{exists}"
        f"{case.trail(at)}",
        f"{hint}; {near}" if near.startswith("did") else hint,
        at,
    )


def _files_in(folder: Path) -> list[str]:
    try:
        return sorted(p.name for p in folder.iterdir() if p.is_file())[:500]
    except OSError:
        return []


def _division(case: FailedExpansion) -> Problem:
    at = case.expression_place()
    return case.error(
        "xacro-division-by-zero",
        f"division by zero{_in_expression(case)}{case.trail(at)}",
        "one of the values is 0: check the properties and arguments in it",
        at,
    )


def _syntax(case: FailedExpansion) -> Problem:
    at = case.expression_place()
    said = re.sub(r"\s*\(<expression>, line \d+\)", "", case.failure.text).strip()
    return case.error(
        "xacro-expression-syntax",
        f"the expression ${{{case.expression}}} cannot be read ({said})"
        f"{case.trail(at)}",
        "inside ${…} stands one Python expression, such as ${2*radius}",
        at,
    )


def _cut_off(case: FailedExpansion, match: re.Match[str]) -> Problem:
    text = match[1].strip()
    at = case.sources.find(re.escape(text), case.place) or case.place
    closing = "}" if "${" in text else ")"
    return case.error(
        "xacro-expression-syntax",
        f"the expression {text} is not closed{case.trail(at)}",
        f"add {closing}; an expression may hold no {closing} before its end",
        at,
    )


def _value(case: FailedExpansion) -> Problem:
    at = case.expression_place()
    text = (
        "text" if "str" in case.failure.text or "sequence" in case.failure.text else ""
    )
    hint = (
        "one of the values is text where a number is expected: look for a unit, a "
        "comma or several numbers in a property"
        if text
        else "check the values of the properties and arguments in it"
    )
    return case.error(
        "xacro-expression-value",
        f"{case.failure.text.strip()}{_in_expression(case)}{case.trail(at)}",
        hint,
        at,
    )


def _circular(case: FailedExpansion, match: re.Match[str]) -> Problem:
    ring = [name.strip() for name in match[1].split("->")]
    pattern = rf"<xacro:property\b[^>]*name\s*=\s*[\"']{re.escape(ring[0])}[\"']"
    at = case.sources.find(pattern) or case.place
    return case.error(
        "xacro-circular-property",
        f"these properties need each other: {' → '.join(ring)}",
        "give one of them a plain value",
        at,
    )


def _conditional(case: FailedExpansion, match: re.Match[str]) -> Problem:
    at = case.place
    source = case.sources.find(
        rf"<xacro:(?:if|unless)\b[^>]*{re.escape(match[1])}", case.place
    )
    at = source or at
    became = f", which became “{match[2]}”" if match[2] != match[1] else ""
    return case.error(
        "xacro-condition",
        f"the condition “{match[1]}”{became} is neither true nor false{case.trail(at)}",
        "write true, false, a number, or a comparison such as ${x == 'a'}",
        at,
    )


def _environment(case: FailedExpansion, match: re.Match[str]) -> Problem:
    name = match[1]
    at = case.sources.find(rf"\$\(\s*env\s+{re.escape(name)}", case.place) or case.place
    return case.error(
        "xacro-environment",
        f"the environment variable {name} is not set",
        f"set it ({name}=… before the command), or write $(optenv {name} default)",
        at,
    )


def _command(case: FailedExpansion, match: re.Match[str]) -> Problem:
    said = match[1].strip()
    at = case.sources.find(re.escape(f"$({said}"), case.place) or case.place
    hint = "xacro knows $(find …), $(arg …), $(env …), $(optenv …), $(cwd), $(eval …)"
    if said.startswith("find-pkg-share"):
        hint = f"write $(find {said.partition(' ')[2]}): xacro's word is find"
    return case.error("xacro-substitution", f"xacro does not know $({said})", hint, at)


def _recursion(case: FailedExpansion) -> Problem:
    macro = case.failure.macros[0][0] if case.failure.macros else ""
    at = case.place
    what = (
        f"the macro {macro} calls itself" if macro else "the files include each other"
    )
    return case.error(
        "xacro-recursion",
        f"expanding never ends: {what} without an end",
        "stop it with a condition: <xacro:if value=…> around the inner call",
        at,
    )


def _property_name(case: FailedExpansion, match: re.Match[str]) -> Problem:
    name = match[1].strip()
    pattern = rf"<xacro:property\b[^>]*name\s*=\s*[\"']{re.escape(name)}[\"']"
    at = case.sources.find(pattern, case.place) or case.place
    mended = re.sub(r"\W", "_", name).lstrip("_") or "x"
    return case.error(
        "xacro-property-name",
        f"{name} cannot be the name of a property: letters, digits and _ only, and "
        "no __ at the start",
        f"write {mended} everywhere",
        at,
    )


def _missing_attribute(case: FailedExpansion, match: re.Match[str]) -> Problem:
    tag = match[1].removeprefix("xacro:")
    at = case.place
    return case.error(
        "xacro-attribute-missing",
        f"<xacro:{tag}> lacks the attribute {match[2]}",
        f'write <xacro:{tag} … {match[2]}="…">',
        at,
    )


def _refused(case: FailedExpansion) -> Problem:
    at = case.expression_place()
    return case.error(
        "xacro-refused",
        f"this is not allowed in a file that is not trusted: {case.failure.text}",
        "run without --untrusted if you know the author",
        at,
    )


def _anything_else(case: FailedExpansion) -> Problem:
    at: Place = case.expression_place()
    said = " ".join(case.failure.text.split()) or case.failure.kind
    return case.error(
        "xacro-failed",
        f"xacro cannot expand this: {said}{_in_expression(case)}{case.trail(at)}",
        "see the element on this line and the macros and files named above",
        at,
    )


_BY_TEXT: tuple[
    tuple[str, Callable[[FailedExpansion, re.Match[str]], Problem]], ...
] = (
    (r"^name '([^']+)' is not defined", lambda c, m: undefined_name(c, m[1])),
    (r"unknown macro name: (?:xacro:)?(\S+)", lambda c, m: unknown_macro(c, m[1])),
    (r"Undefined parameters \[([^\]]*)\]", lambda c, m: missing_parameters(c, m[1])),
    (r'Invalid parameter "([^"]*)"', lambda c, m: invalid_parameter(c, m[1])),
    (
        r"Not enough blocks|Unused block|Undefined block",
        lambda c, m: block_trouble(c, c.failure.text),
    ),
    (
        r"Undefined substitution argument:?\s*(\w[\w.\-]*)",
        lambda c, m: undefined_argument(c, m[1]),
    ),
    (r"No such file or directory: '?([^'\[\n]+)", _missing_file),
    (r"circular variable definition: ([^\n]+)", _circular),
    (r'Xacro conditional "([^"]*)" evaluated to "([^"]*)"', _conditional),
    (r"environment variable '?\"?([A-Za-z_]\w*)", _environment),
    (r"Unknown substitution command \[([^\]]*)\]", _command),
    (r"invalid expression: (.+)", _cut_off),
    (r"Property names must[^:]*:\s*(\S+)", _property_name),
    (r"((?:xacro:)?\w+): missing attribute '([^']+)'", _missing_attribute),
)

_BY_KIND: dict[str, Callable[[FailedExpansion], Problem]] = {
    "ArgException": lambda c: undefined_argument(c, c.failure.text.split()[-1]),
    "RecursionError": _recursion,
    "Refused": _refused,
    "SyntaxError": _syntax,
    "TypeError": _value,
    "ValueError": _value,
    "ZeroDivisionError": _division,
}
