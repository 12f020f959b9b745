"""Slips in xacro's own elements that make the expansion fail somewhere else.

A macro without its prefix fails in its body, a misspelt value= where the property is
used. The source files show them; the report of xacro says whether they matter.
"""

from __future__ import annotations

import re

from sambot_viz.edits import exchange_attributes, rename_attribute, rename_element
from sambot_viz.errors import Fix, Place, Problem
from sambot_viz.robot.slips.vocabulary import meant
from sambot_viz.robot.xacro.diagnose.failed_expansion import (
    FailedExpansion,
    line_in,
    without_defaults,
)
from sambot_viz.robot.xacro.diagnose.source_files import token_place
from sambot_viz.robot.xml.diagnose.lexer import Token
from sambot_viz.robot.xml.diagnose.source_text import SourceText

_ATTRIBUTES = {
    "arg": "name default",
    "call": "macro",
    "if": "value",
    "include": "filename ns optional",
    "insert_block": "name",
    "macro": "name params",
    "property": "name value default remove scope lazy_eval",
    "unless": "value",
}
_OTHER_NAMES = {"include": {"file", "path", "href", "src"}, "macro": {"args"}}
"""Attributes that people write for the first, or the last, one of the element."""


def source_slip(failed: FailedExpansion) -> Problem | None:
    """Return the slip in the source that explains a failure, or None."""
    for file, source in failed.sources.sources():
        for token in source.tags:
            if token.closes:
                continue
            here = failed.pointing_at(token_place(source, file, token))
            for problem in (
                _misspelt_attribute(here, token),
                _exchanged_values(here, token),
                _commas_in_params(here, token),
                _without_prefix(here, token, source),
            ):
                if problem is not None:
                    return problem
    return None


def misspelt_attribute(token: Token) -> tuple[str, str, str] | None:
    """Return a wrong attribute of one of xacro's elements, the right one, the value."""
    tag = token.name.removeprefix("xacro:")
    if tag == token.name or tag not in _ATTRIBUTES:
        return None
    known = _ATTRIBUTES[tag].split()
    free = [name for name in known if token.get(name) is None]
    for attribute in token.attributes:
        if attribute.name in known or ":" in attribute.name:
            continue
        right = meant(attribute.name, free)
        if right is None and attribute.name in _OTHER_NAMES.get(tag, ()):
            right = known[0] if tag == "include" else known[-1]
        if right in free:
            return attribute.name, right, attribute.value
    return None


def _misspelt_attribute(here: FailedExpansion, token: Token) -> Problem | None:
    found = misspelt_attribute(token)
    if found is None or not _concerns(here, token):
        return None
    wrong, right, value = found
    fix = rename_attribute(here.at, wrong, right, value, f'write {right}="{value}"')
    return here.error(
        "xacro-attribute-misspelt",
        f"the attribute {wrong} of {token.shown} is not known to xacro; did you mean "
        f"{right}?{_seen(here)}",
        fix,
    )


def _exchanged_values(here: FailedExpansion, token: Token) -> Problem | None:
    """Report a property that has its value as its name, and its name as its value."""
    name, value = (token.get(each) or "" for each in ("name", "value"))
    text = here.failure.text
    if token.name != "xacro:property" or not value.isidentifier():
        return None
    if name.isidentifier() or ("Property names must" not in text and value not in text):
        return None
    return here.error(
        "xacro-property-name",
        f"the name and the value of this property are exchanged: {name} cannot be the "
        f"name of a property{_seen(here)}",
        Fix(
            f'write name="{value}" value="{name}"',
            exchange_attributes(here.at, "name", "value"),
        ),
    )


def _concerns(here: FailedExpansion, token: Token) -> bool:
    """Tell whether the failure is about what an element defines, or at the element."""
    if _is_here(here):
        return True
    name = token.get("name")
    return name is not None and name in _words(here)


def _is_here(here: FailedExpansion) -> bool:
    failure = here.failure
    return (failure.file, failure.line) == (here.at.file, here.at.line)


def _words(here: FailedExpansion) -> set[str]:
    """The names that the report is about."""
    text = f"{here.failure.text} {here.expression} {here.called}"
    return set(re.findall(r"[\w.\-]+", text))


def _seen(here: FailedExpansion) -> str:
    """Name the line where xacro noticed it: " (it fails on line 21)"."""
    failure = here.failure
    if failure.line is None or _is_here(here):
        return ""
    return f" (it fails on {line_in(Place(failure.file, failure.line), here.at)})"


def _commas_in_params(here: FailedExpansion, token: Token) -> Problem | None:
    params = token.get("params") or ""
    if token.name != "xacro:macro" or token.get("name") != here.called:
        return None
    if "," not in without_defaults(params):
        return None
    better = " ".join(re.split(r"[\s,]+", params.strip(" ,")))
    return here.error(
        "xacro-params-comma",
        f"the params of the macro {here.called} have commas, which become part of the "
        f"names{_seen(here)}",
        f'write params="{better}"',
    )


def _without_prefix(
    here: FailedExpansion, token: Token, source: SourceText
) -> Problem | None:
    """Report a <macro> whose body fails, or an <include> without which names lack."""
    if token.name == "macro" and token.get("name") is not None:
        failure, end = here.failure, _end_line(token, source)
        fails_inside = (
            failure.file == here.at.file
            and failure.line is not None
            and here.at.line < failure.line <= end
        )
        matters = fails_inside and token.get("params") is not None
    elif token.name == "include" and token.get("filename"):
        matters = bool(re.search(r"not defined|unknown macro", here.failure.text))
    else:
        return None
    if not matters:
        return None
    return here.error(
        "xacro-prefix-forgotten",
        f"{token.shown} lacks the prefix xacro:, so xacro does not see it{_seen(here)}",
        rename_element(
            here.at,
            token.name,
            f"xacro:{token.name}",
            f"write <xacro:{token.name} …>"
            + (f" and </xacro:{token.name}>" if token.kind == "open" else ""),
        ),
    )


def _end_line(token: Token, source: SourceText) -> int:
    closing = (t for t in source.tags if t.closes and t.name == token.name)
    end = next((t for t in closing if t.start > token.start), None)
    return source.line(token.start if end is None else end.start)
