"""Names that xacro does not know: properties, macros, parameters, arguments."""

from __future__ import annotations

import difflib
import re

from sambot_viz.errors import Place, Problem, did_you_mean
from sambot_viz.robot.xacro.diagnose.failed_expansion import FailedExpansion, line_in
from sambot_viz.robot.xacro.diagnose.source_files import NamedElement

_OWN_TAGS = (
    "arg attribute call element if include insert_block macro property unless".split()
)
_BUILT_IN = (
    "acos asin atan atan2 ceil cos cosh degrees e exp fabs float floor fmod hypot inf "
    "int isinf isnan len list log log10 map max min nan pi pow radians range round sin "
    "sinh sqrt str tan tanh tau True False None".split()
)
_ELSEWHERE = {
    "abs": "write python.abs(…): xacro keeps it under python",
    "np": "numpy is not there; sin, cos, sqrt, pi are, without a prefix",
    "numpy": "numpy is not there; sin, cos, sqrt, pi are, without a prefix",
    "PI": "write pi",
    "Pi": "write pi",
    "M_PI": "write pi",
    "true": "write True",
    "false": "write False",
}


def undefined_name(case: FailedExpansion, name: str) -> Problem:
    """A name in ${…} that is no property, parameter or function."""
    at = case.sources.find(
        rf"\$[({{][^}}]*(?<![\w.]){re.escape(name)}(?!\w)[^}}]*[}})]",
        case.expression_place(),
    )
    at = case.expression_place() if case.expression else at or case.place
    known = [p for p in case.named("property") if p.name == name]
    unprefixed = next((p for p in known if not p.prefixed), None)
    if unprefixed and not any(p.prefixed for p in known):
        return _prefix_forgotten(case, unprefixed, at)
    outside = [p for p in known if p.prefixed and not p.inside]
    if outside:
        return _defined_after_use(case, outside[0], at)
    local = next((p for p in known if p.prefixed and p.inside), None)
    if local:
        return case.error(
            "xacro-undefined-name",
            f"{name} is not defined here: {line_in(local.place, at)} defines it only "
            f"inside the macro {local.inside}{case.trail(at)}",
            'move the property out of the macro, or add scope="parent" to it',
            at,
        )
    return case.error(
        "xacro-undefined-name",
        f"{name} is not defined{case.trail(at)}",
        _near_name(case, name, at),
        at,
    )


def _near_name(case: FailedExpansion, name: str, at: Place) -> str:
    if name in _ELSEWHERE:
        return _ELSEWHERE[name]
    if any(a.name == name for a in case.named("arg")):
        return f"{name} is an argument: write $(arg {name}) instead of ${{{name}}}"
    things = {p.name: p.place for p in case.named("property") if p.prefixed}
    for macro in case.named("macro"):
        if any(macro.name == running for running, _ in case.failure.macros):
            things.update({p: macro.place for p in _parameters(macro.params)})
    near = difflib.get_close_matches(name, [*things, *_BUILT_IN], n=1, cutoff=0.6)
    if near and near[0] in things:
        where = line_in(things[near[0]], at)
        return f"did you mean {near[0]} (defined on {where})?"
    if near:
        return f"did you mean {near[0]}?"
    return f'add <xacro:property name="{name}" value="…"/> before it' + (
        f"; {did_you_mean(name, things)}" if things else ""
    )


def _prefix_forgotten(case: FailedExpansion, thing: NamedElement, at: Place) -> Problem:
    tag = f'<{thing.kind} name="{thing.name}" …>'
    return case.error(
        "xacro-prefix-forgotten",
        f"{thing.name} is not defined (used on {line_in(at, thing.place)}): "
        f"{tag} on line {thing.place.line} lacks the prefix xacro:, so xacro does "
        "not see it",
        f'write <xacro:{thing.kind} name="{thing.name}" …>',
        thing.place,
    )


def _defined_after_use(
    case: FailedExpansion, thing: NamedElement, at: Place
) -> Problem:
    return case.error(
        f"xacro-{thing.kind}-after-use",
        f"{thing.name} is used here but defined only on "
        f"{line_in(thing.place, at)}: xacro works from top to bottom{case.trail(at)}",
        f"move the definition above line {at.line}"
        if thing.place.file == at.file
        else f"move the definition, or its include, above line {at.line}",
        at,
    )


def unknown_macro(case: FailedExpansion, name: str) -> Problem:
    """A <xacro:name> that no macro stands behind."""
    at = case.place
    if case.sources.tag_at(at, f"xacro:{name}") is None:
        calls = list(case.sources.calls(f"xacro:{name}"))
        at = calls[0][0] if calls else at
    macros = case.named("macro")
    same = [m for m in macros if m.name == name]
    if same and all(not m.prefixed for m in same):
        return _prefix_forgotten(case, same[0], at)
    if same:
        return _defined_after_use(case, same[0], at)
    elsewhere = case.sources.neighbours_with_macro(name)
    if elsewhere:
        there = elsewhere[0].place
        return case.error(
            "xacro-include-forgotten",
            f"the macro {name} is not known here: {there.file} defines it on line "
            f"{there.line}, but no file that is read includes that file"
            f"{case.trail(at)}",
            'add <xacro:include filename="…"/> with that file before the call',
            at,
        )
    return case.error(
        "xacro-unknown-macro",
        f"there is no macro {name}{case.trail(at)}",
        _near_macro(case, name, macros, at),
        at,
    )


def _near_macro(
    case: FailedExpansion, name: str, macros: list[NamedElement], at: Place
) -> str:
    own = difflib.get_close_matches(name, _OWN_TAGS, n=1, cutoff=0.75)
    places = {m.name: m.place for m in macros if m.prefixed}
    near = difflib.get_close_matches(name, list(places), n=1, cutoff=0.6)
    if near:
        return f"did you mean {near[0]} ({line_in(places[near[0]], at)})?"
    if own:
        return f"did you mean <xacro:{own[0]}>?"
    if not places:
        return (
            f"no macro is defined in the files that were read: include the file with "
            f'<xacro:macro name="{name}"> before the call; perhaps this file is a part '
            "that another one includes"
        )
    known = did_you_mean(name, places)
    return f"include the file that defines it before the call; {known}"


def _parameters(params: str) -> list[str]:
    """The names in params="a b:=1 *c **d"."""
    without_values = re.sub(
        r":?=\s*(?:'[^']*'|\"[^\"]*\"|\$\{[^}]*\}|\S+)", " ", params
    )
    return [p.strip("*") for p in without_values.split() if p.strip("*")]


def _called_macro(case: FailedExpansion) -> tuple[str, Place, NamedElement | None]:
    """The macro whose call failed, the place of the call, its definition."""
    failure = case.failure
    name = failure.macros[0][0] if failure.macros else ""
    name = (name or (failure.element or "")).removeprefix("xacro:")
    at = case.place
    if case.sources.tag_at(at, f"xacro:{name}") is None:
        calls = [p for p, _ in case.sources.calls(f"xacro:{name}")]
        inner = failure.calls[0] if failure.calls else None
        if inner is not None and inner.macro.removeprefix("xacro:") == name:
            at = Place(inner.file, inner.line)
        elif calls:
            at = calls[0]
    definition = next((m for m in case.named("macro") if m.name == name), None)
    return name, at, definition


def missing_parameters(case: FailedExpansion, names: str) -> Problem:
    """A call that does not give every parameter."""
    macro, at, definition = _called_macro(case)
    missing = [n.strip() for n in names.split(",") if n.strip()]
    shown = " and ".join(missing)
    plural = "s" if len(missing) > 1 else ""
    where = f" (declared on {line_in(definition.place, at)})" if definition else ""
    values = " ".join(f'{n}="…"' for n in missing)
    return case.error(
        "xacro-parameter-missing",
        f"the call of {macro} lacks the parameter{plural} {shown}{where}",
        f"add {values}, or give a default where it is declared: "
        f'params="… {missing[0] if missing else "x"}:=1"',
        at,
    )


def invalid_parameter(case: FailedExpansion, name: str) -> Problem:
    """A call that gives a parameter which the macro does not have."""
    macro, at, definition = _called_macro(case)
    known = _parameters(definition.params) if definition else []
    where = f" (declared on {line_in(definition.place, at)})" if definition else ""
    return case.error(
        "xacro-parameter-unknown",
        f"the macro {macro} has no parameter {name}{where}",
        f"{did_you_mean(name, known)}; or delete {name}, or take the version of the "
        "macro's file that fits",
        at,
    )


def block_trouble(case: FailedExpansion, text: str) -> Problem:
    """Blocks: too few, one too many, or one that is not declared."""
    macro, at, definition = _called_macro(case)
    declared = re.findall(r"\*+([^\s:]+)", definition.params) if definition else []
    undefined = re.search(r'Undefined block "([^"]*)"', text)
    if undefined:
        at = (
            case.sources.find(
                rf"<xacro:insert_block[^>]*name\s*=\s*[\"']{re.escape(undefined[1])}",
                case.place,
            )
            or case.place
        )
        return case.error(
            "xacro-block",
            f"insert_block asks for the block {undefined[1]}, which is not there"
            f"{case.trail(at)}",
            f"add *{undefined[1]} to the params of the macro",
            at,
        )
    unused = re.search(r'Unused block "([^"]*)"', text)
    if unused:
        return case.error(
            "xacro-block",
            f"the call of {macro} contains <{unused[1]}>, which the macro does not "
            "take",
            f"delete it, or add *{unused[1]} to the params of {macro}",
            at,
        )
    return case.error(
        "xacro-block",
        f"the call of {macro} contains fewer elements than it takes"
        + (f" ({', '.join('*' + d for d in declared)})" if declared else ""),
        f"write the elements inside: <xacro:{macro} …> <origin …/> </xacro:{macro}>",
        at,
    )


def undefined_argument(case: FailedExpansion, name: str) -> Problem:
    """$(arg name) without a value."""
    pattern = rf"\$\(\s*arg\s+{re.escape(name)}\s*\)|xacro\.arg\(\W*{re.escape(name)}\b"
    at = case.sources.find(pattern, case.place) or case.place
    known = [a for a in case.named("arg")]
    same = next((a for a in known if a.name == name), None)
    if same is not None and not same.prefixed:
        return _prefix_forgotten(case, same, at)
    if same is not None and same.place.file == at.file and same.place.line > at.line:
        return _defined_after_use(case, same, at)
    near = did_you_mean(name, sorted({a.name for a in known})) if known else ""
    near = near if near.startswith("did") else ""
    return case.error(
        "xacro-argument-missing",
        f"the argument {name} has no value{case.trail(at)}",
        f"give it on the command line: {name}:=…, or a default in the file: "
        f'<xacro:arg name="{name}" default="…"/>' + (f"; {near}" if near else ""),
        at,
    )
