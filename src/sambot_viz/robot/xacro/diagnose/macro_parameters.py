"""A macro call with a parameter that the macro does not have."""

from __future__ import annotations

import re

from sambot_viz.edits import Extent, rename_attribute, source_of
from sambot_viz.errors import Edit, Fix, Problem, did_you_mean, nearest
from sambot_viz.robot.slips.vocabulary import meant
from sambot_viz.robot.xacro.diagnose.failed_expansion import (
    FailedExpansion,
    line_in,
    parameters,
)
from sambot_viz.robot.xacro.diagnose.source_files import NamedElement, SourceSet
from sambot_viz.robot.xacro.macro_texts import macro_around
from sambot_viz.robot.xml.diagnose.lexer import Token

_CODE = "xacro-parameter-unknown"
_CONDITIONS = ("xacro:if", "xacro:unless")


def unknown_parameter(failed: FailedExpansion, name: str) -> Problem:
    """Explain which parameter was meant, or which macro."""
    here = failed.pointing_at(failed.call_place())
    call = here.sources.tag_at(here.at, f"xacro:{here.called}")
    macros = [m for m in here.named("macro") if m.name == here.called and m.prefixed]
    if len(macros) > 1:
        twice = _defined_twice(here, macros, name)
        if twice is not None:
            return twice
    macro = macros[-1] if macros else None
    if call is not None and macro is not None:
        lacking = _not_declared(here, macro, call)
        if lacking is not None:
            return lacking
    message = f"the macro {here.called} has no parameter {name}{here.declared}"
    if call is None or macro is None:
        return here.error(_CODE, message, f"delete {name}")
    return _other_parameter(here, message, name, macro, call)


def unused_block(failed: FailedExpansion, name: str) -> Problem:
    """Explain an element in a call that the macro does not take, or not as one."""
    here = failed.pointing_at(failed.call_place())
    macro = next((m for m in here.named("macro") if m.name == here.called), None)
    tag = here.sources.tag_at(macro.place, "xacro:macro") if macro else None
    source = here.sources.get(macro.place.file) if macro else None
    if macro is not None and source is not None and tag is not None:
        end = source.text.find("</xacro:macro>", tag.end)
        names = re.findall(
            r"<xacro:insert_block\s+name\s*=\s*[\"'](\w+)", source.text[tag.end : end]
        )
        plain = [n for n in names if f"*{n}" not in macro.params.split()]
        if len(set(plain)) == 1:
            words = [w for w in macro.params.split() if w != plain[0]]
            params = " ".join([*words, f"*{plain[0]}"])
            return here.pointing_at(macro.place).error(
                "xacro-block",
                f"the macro {macro.name} inserts the block {plain[0]}, which its "
                "params do not have with a * before it; the call on "
                f"{line_in(here.at, macro.place)} gives it",
                f'write params="{params}"',
            )
    return here.error(
        "xacro-block",
        f"the call of {here.called} contains <{name}>, which the macro does not take",
        f"delete it, or add *{name} to the params of {here.called}",
    )


def _defined_twice(
    here: FailedExpansion, macros: list[NamedElement], name: str
) -> Problem | None:
    """Report a macro that takes the name of the one that the call means."""
    first, last = macros[0], macros[-1]
    if name not in parameters(first.params) or name in parameters(last.params):
        return None
    if any(_is_conditional(here.sources, macro) for macro in macros):
        return None
    missing = _called_without_macro(here)
    return here.pointing_at(last.place).error(
        _CODE,
        f"the macro {last.name} is defined twice, on {line_in(first.place, last.place)}"
        " and again here, and only the later one counts: it has no parameter "
        f"{name}, which the call on {line_in(here.at, last.place)} gives",
        f'write name="{missing[0]}"'
        if len(missing) == 1
        else "give one of the two another name, here and in its calls",
    )


def _is_conditional(sources: SourceSet, macro: NamedElement) -> bool:
    """Return whether a macro is inside <xacro:if>, so that it may not be defined."""
    source = sources.get(macro.place.file)
    if source is None:
        return True
    offset = source.offset(macro.place.line, macro.place.column or 1)
    depth = 0
    for token in source.tags:
        if token.start < offset and token.name in _CONDITIONS:
            depth += {"open": 1, "close": -1}.get(token.kind, 0)
    return depth > 0


def _called_without_macro(here: FailedExpansion) -> list[str]:
    """Return the macros that are called and not defined, and are not words of xacro."""
    from sambot_viz.robot.slips.needs_xacro import OWN_TAGS

    known = {*OWN_TAGS, *(macro.name for macro in here.named("macro"))}
    called = {
        token.name.removeprefix("xacro:")
        for _, source in here.sources.sources()
        for token in source.tags
        if token.name.startswith("xacro:") and not token.closes
    }
    return sorted(called - known)


def _not_declared(
    here: FailedExpansion, macro: NamedElement, call: Token
) -> Problem | None:
    """Report a macro whose body uses what its calls give, and its params lack."""
    known = parameters(macro.params)
    given = [each.name for each in call.attributes if each.name not in known]
    source = here.sources.get(macro.place.file)
    tag = here.sources.tag_at(macro.place, "xacro:macro")
    if source is None or tag is None:
        return None
    end = source.text.find("</xacro:macro>", tag.end)
    uses = re.findall(r"\$\{([^}]*)\}", source.text[tag.end : max(end, tag.end)])
    if not set(given) <= set(re.findall(r"[A-Za-z_]\w*", " ".join(uses))):
        return None
    lacks = (
        f"does not declare {_listed(given)}, which its body uses"
        if known
        else ("has no params")
    )
    verb, params = ("write" if known else "add"), [*macro.params.split(), *given]
    return here.pointing_at(macro.place).error(
        _CODE,
        f"the macro {macro.name} {lacks}, but the call on "
        f"{line_in(here.at, macro.place)} gives {_listed(given)}",
        f'{verb} params="{" ".join(params)}"',
    )


def renamed_parameter(failed: FailedExpansion, name: str) -> Fix | None:
    """Return the fix for a name that only its macro's parameters have lost.

    One parameter is used nowhere in the macro, whose body uses a name that nothing
    defines.
    """
    source = source_of(failed.at.file)
    offset = 0 if source is None else source.offset(failed.at)
    macro = source and macro_around(failed.at.file, source, offset)
    if not macro:
        return None
    whole, body = rf"(?<![\w.'\"]){re.escape(name)}(?![\w'\"])", macro.body
    uses = list(re.finditer(r"\$\{[^}]*\}", body.text))
    used = " ".join(use[0] for use in uses)
    used += " ".join(re.findall(r"<xacro:insert_block\s[^>]*", body.text))
    known = [p for p in macro.defaults if not re.search(rf"(?<!\w){p}(?!\w)", used)]
    if len(known) != 1:
        return None
    edits: list[Edit] = []
    for use in uses:
        for one in re.finditer(whole, use[0]):
            start = body.extent.start + use.start() + one.start()
            edits.append(
                body._replace(extent=Extent(start, start + len(name))).edit(known[0])
            )
    places = "" if len(edits) == 1 else f" at all {len(edits)} places in the macro"
    return Fix(
        f"write {known[0]} for {name}{places}: this parameter of {macro.name} is used "
        "nowhere",
        tuple(edits),
    )


def _listed(names: list[str]) -> str:
    return " and ".join(part for part in (", ".join(names[:-1]), names[-1]) if part)


def _other_parameter(
    here: FailedExpansion, message: str, name: str, macro: NamedElement, call: Token
) -> Problem:
    """Name the parameter that was meant: one that the call does not give."""
    free = [p for p in parameters(macro.params) if call.get(p) is None]
    blocks = set(re.findall(r"\*+([^\s:]+)", macro.params))
    free = [p for p in free if p not in blocks]
    needed = [p for p in free if not re.search(rf"(?<!\S){p}\s*:?=", macro.params)]
    others = [a.name for a in call.attributes if a.name not in parameters(macro.params)]
    right = meant(name, free) or nearest(name, free)
    if len(needed) == 1 and others == [name]:
        right = needed[0]
    if right is not None:
        lost = f", and its {right} is not given" if right in needed else ""
        value = call.get(name) or ""
        hint = f'write {right}="{value}"'
        fix = rename_attribute(here.at, name, right, value, hint)
        return here.error(_CODE, message + lost, fix)
    if needed and len(needed) == len(others):
        lost = f"{message}, and the call lacks {_listed(needed)}"
        return here.error(_CODE, lost, f"write the right one of these for {name}")
    known = did_you_mean(name, parameters(macro.params))
    return here.error(
        _CODE,
        f"{message} ({known})" if known.startswith("known") else message,
        f"delete {name}, or use the version of the macro's file that fits",
    )
